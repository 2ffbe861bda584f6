#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

enum { FIELDS_MAX = 1000 };
/* More frames or checkpoints than anybody looks at. */
static const double frames_most = 1e6;

static void frames_read(struct scene_reader *reader, const struct tree *node)
{
  struct scene *scene = reader->scene;
  const struct tree *every = tree_get(node, "every"), *frames = tree_get(node, "frames");
  double value = 0;
  if (every && frames) {
    error_at_key(reader, frames, "one of them", "'every' and 'frames' are both given");
  } else if (every) {
    if (!amount_read(reader, every, "every", axis_unit(reader), &value))
      return;
    if (!(value > 0))
      error_at_value(reader, every, "greater than 0", "'every' is not positive");
    else if (every_within(reader, every, "frames", value, frames_most))
      scene->output_every = value;
  } else if (frames) {
    if (!amount_read(reader, frames, "frames", "1", &value))
      return;
    if (value >= 1 && value <= frames_most && value == (double)(long)value)
      scene->output_every = -value;
    else
      error_at_value(reader, frames, "a whole number from 1 to 1000000",
                     "'frames' cannot be '%.40s'", frames->text);
  }
}

/* Measures of points, of the solver and the elasticities, may be fields of the output as well. */
static bool is_point_measure(const struct descriptor *descriptor, const char *name)
{
  for (size_t i = 0; descriptor && i < descriptor->measures; i++)
    if (descriptor->measure[i].at == MEASURE_POINT &&
        (!name || strcmp(descriptor->measure[i].name, name) == 0))
      return true;
  return false;
}

static bool known_output(const struct scene_reader *reader, const char *name)
{
  const struct scene *scene = reader->scene;
  bool found = is_point_measure(scene->solver.descriptor, name);
  for (size_t i = 0; i < scene->materials && !found; i++)
    found = is_point_measure(scene->material[i].elasticity.descriptor, name);
  for (size_t i = 0; i < scene->effects && !found; i++)
    found = is_point_measure(scene->effect[i].instance.descriptor, name);
  return found || field_unit(reader, name, false);
}

static size_t add_measures(const struct descriptor *descriptor, const char **name, size_t count,
                           size_t capacity)
{
  for (size_t i = 0; descriptor && i < descriptor->measures && count < capacity; i++)
    if (descriptor->measure[i].at == MEASURE_POINT)
      name[count++] = descriptor->measure[i].name;
  return count;
}

static void error_at_field(struct scene_reader *reader, const struct tree *node)
{
  enum { MEASURES = 256 };
  const struct scene *scene = reader->scene;
  if (trace_is_full(reader->trace)) {
    error_at_value(reader, node, NULL, "unknown field '%.60s'", node->text);
    return;
  }
  char expected[WORDS_SIZE];
  size_t fields, count = 0;
  const char **field = field_names(reader, false, &fields);
  const char **name = scene_take(fields + MEASURES, sizeof *name);
  count = add_measures(scene->solver.descriptor, name, count, MEASURES);
  for (size_t i = 0; i < scene->materials; i++)
    count = add_measures(scene->material[i].elasticity.descriptor, name, count, MEASURES);
  for (size_t i = 0; i < scene->effects; i++)
    count = add_measures(scene->effect[i].instance.descriptor, name, count, MEASURES);
  for (size_t i = 0; i < fields; i++)
    name[count++] = field[i];
  const char *now = renamed_field(node->text);
  const char *states = effect_states_expected(reader, node->text, expected, sizeof expected);
  error_at_value(reader, node,
                 now      ? renamed_words(node->text, now, expected, sizeof expected)
                 : states ? states
                          : suggest(reader, node->text, name, count, expected, sizeof expected),
                 "unknown field '%.60s'", node->text);
  free(field);
  free(name);
}

/* By wall time, or {every: 10 us} of the run. */
static void checkpoint_read(struct scene_reader *reader, const struct tree *node)
{
  static const char *const known[] = {"every"};
  bool run = node->kind == TREE_MAPPING;
  const struct tree *given = run ? tree_get(node, "every") : node;
  double *value = run ? &reader->scene->checkpoint_every : &reader->scene->checkpoint_wall;
  if (run)
    expect_keys(reader, node, known, ARRAY_SIZE(known), "'checkpoint'");
  if (!given)
    error_at_value(reader, node, "such as {every: 10 us}, or a wall time: 10 min",
                   "'checkpoint' is empty");
  else if (!amount_read(reader, given, "checkpoint", run ? axis_unit(reader) : "s", value))
    return;
  else if (!(*value > 0))
    error_at_value(reader, given, "greater than 0", "'checkpoint' is not positive");
  else if (run)
    every_within(reader, given, "checkpoints", *value, frames_most);
}

void outputs_read(struct scene_reader *reader, const struct tree *root)
{
  static const char *const known[] = {"every", "frames", "fields", "checkpoint"};
  struct scene *scene = reader->scene;
  const struct tree *node = tree_get(root, "outputs");
  if (!node || !expect_mapping(reader, node, "'outputs'"))
    return;
  expect_keys(reader, node, known, ARRAY_SIZE(known), "'outputs'");
  frames_read(reader, node);
  const struct tree *checkpoint = tree_get(node, "checkpoint");
  if (checkpoint)
    checkpoint_read(reader, checkpoint);
  const struct tree *fields = tree_get(node, "fields");
  if (!fields)
    return;
  struct names names = names_read(reader, fields, "fields", FIELDS_MAX);
  scene->output_field = names.name;
  scene->output_fields = names.count;
  for (size_t i = 0; i < names.count; i++)
    if (!known_output(reader, names.name[i]))
      error_at_field(reader, names.node[i]);
}
