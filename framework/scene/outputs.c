#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

enum { FIELDS_MAX = 1000 };
/* More frames or checkpoints than anybody looks at. */
static const double frames_most = 1e6;

static void frames_read(struct reading *reading, const struct tree *node)
{
  struct scene *scene = reading->scene;
  const struct tree *every = tree_get(node, "every"), *frames = tree_get(node, "frames");
  double value = 0;
  if (every && frames) {
    blame_key(reading, frames, "one of them", "'every' and 'frames' are both given");
  } else if (every) {
    if (!amount_read(reading, every, "every", axis_unit(reading), &value))
      return;
    if (!(value > 0))
      blame_value(reading, every, "greater than 0", "'every' is not positive");
    else if (every_within(reading, every, "frames", value, frames_most))
      scene->output_every = value;
  } else if (frames) {
    if (!amount_read(reading, frames, "frames", "1", &value))
      return;
    if (value >= 1 && value <= frames_most && value == (double)(long)value)
      scene->output_every = -value;
    else
      blame_value(reading, frames, "a whole number from 1 to 1000000", "'frames' cannot be '%.40s'",
                  frames->text);
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

static bool known_output(const struct reading *reading, const char *name)
{
  const struct scene *scene = reading->scene;
  bool found = is_point_measure(scene->solver.descriptor, name);
  for (size_t i = 0; i < scene->materials && !found; i++)
    found = is_point_measure(scene->material[i].elasticity.descriptor, name);
  for (size_t i = 0; i < scene->effects && !found; i++)
    found = is_point_measure(scene->effect[i].instance.descriptor, name);
  return found || field_unit(reading, name, false);
}

static size_t add_measures(const struct descriptor *descriptor, const char **name, size_t count,
                           size_t capacity)
{
  for (size_t i = 0; descriptor && i < descriptor->measures && count < capacity; i++)
    if (descriptor->measure[i].at == MEASURE_POINT)
      name[count++] = descriptor->measure[i].name;
  return count;
}

static void blame_field(struct reading *reading, const struct tree *node)
{
  enum { MEASURES = 256 };
  const struct scene *scene = reading->scene;
  if (trace_is_full(reading->trace)) {
    blame_value(reading, node, NULL, "unknown field '%.60s'", node->text);
    return;
  }
  char expected[WORDS_SIZE];
  size_t fields, count = 0;
  const char **field = field_names(reading, false, &fields);
  const char **name = scene_take(fields + MEASURES, sizeof *name);
  count = add_measures(scene->solver.descriptor, name, count, MEASURES);
  for (size_t i = 0; i < scene->materials; i++)
    count = add_measures(scene->material[i].elasticity.descriptor, name, count, MEASURES);
  for (size_t i = 0; i < scene->effects; i++)
    count = add_measures(scene->effect[i].instance.descriptor, name, count, MEASURES);
  for (size_t i = 0; i < fields; i++)
    name[count++] = field[i];
  const char *now = renamed_field(node->text);
  blame_value(reading, node,
              now ? renamed_words(node->text, now, expected, sizeof expected)
                  : suggest(reading, node->text, name, count, expected, sizeof expected),
              "unknown field '%.60s'", node->text);
  free(field);
  free(name);
}

/* By wall time, or {every: 10 us} of the run. */
static void checkpoint_read(struct reading *reading, const struct tree *node)
{
  static const char *const known[] = {"every"};
  bool run = node->kind == TREE_MAPPING;
  const struct tree *given = run ? tree_get(node, "every") : node;
  double *value = run ? &reading->scene->checkpoint_every : &reading->scene->checkpoint_wall;
  if (run)
    expect_keys(reading, node, known, COUNT_OF(known), "'checkpoint'");
  if (!given)
    blame_value(reading, node, "such as {every: 10 us}, or a wall time: 10 min",
                "'checkpoint' is empty");
  else if (!amount_read(reading, given, "checkpoint", run ? axis_unit(reading) : "s", value))
    return;
  else if (!(*value > 0))
    blame_value(reading, given, "greater than 0", "'checkpoint' is not positive");
  else if (run)
    every_within(reading, given, "checkpoints", *value, frames_most);
}

void outputs_read(struct reading *reading, const struct tree *root)
{
  static const char *const known[] = {"every", "frames", "fields", "checkpoint"};
  struct scene *scene = reading->scene;
  const struct tree *node = tree_get(root, "outputs");
  if (!node || !expect_mapping(reading, node, "'outputs'"))
    return;
  expect_keys(reading, node, known, COUNT_OF(known), "'outputs'");
  frames_read(reading, node);
  const struct tree *checkpoint = tree_get(node, "checkpoint");
  if (checkpoint)
    checkpoint_read(reading, checkpoint);
  const struct tree *fields = tree_get(node, "fields");
  if (!fields)
    return;
  struct names names = names_read(reading, fields, "fields", FIELDS_MAX);
  scene->output_field = names.name;
  scene->output_fields = names.count;
  for (size_t i = 0; i < names.count; i++)
    if (!known_output(reading, names.name[i]))
      blame_field(reading, names.node[i]);
}
