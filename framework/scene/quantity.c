#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const char *const own_keys[] = {"measure", "effect", "body", "at", "reduce", "every"};

struct provider {
  const struct descriptor *descriptor;
  const char *effect;
};

/* Whoever may provide measures: the solver, the elasticities, the effects (all, or the one named).
 */
static size_t providers_of(const struct scene *scene, const char *effect, struct provider *list)
{
  size_t count = 0;
  if (!effect && scene->solver.descriptor)
    list[count++] = (struct provider){scene->solver.descriptor, NULL};
  for (size_t i = 0; i < scene->materials && !effect; i++) {
    const struct descriptor *elasticity = scene->material[i].elasticity.descriptor;
    bool known = !elasticity;
    for (size_t k = 0; k < count && !known; k++)
      known = list[k].descriptor == elasticity;
    if (!known)
      list[count++] = (struct provider){elasticity, NULL};
  }
  for (size_t i = 0; i < scene->effects; i++) {
    const struct instance *one = &scene->effect[i].instance;
    if (one->descriptor && (!effect || strcmp(effect, one->name) == 0))
      list[count++] = (struct provider){one->descriptor, one->name};
  }
  return count;
}

static const struct measure *measure_named(const struct descriptor *descriptor, const char *name)
{
  for (size_t i = 0; i < descriptor->measures; i++)
    if (strcmp(descriptor->measure[i].name, name) == 0)
      return &descriptor->measure[i];
  return NULL;
}

static void error_at_measure(struct scene_reader *reader, const struct tree *node,
                             const struct provider *list, size_t count, bool fields)
{
  char expected[WORDS_SIZE];
  size_t names = 0, known_fields = 0;
  if (trace_is_full(reader->trace)) {
    error_at_value(reader, node, NULL, "unknown measure '%.60s'", node->text);
    return;
  }
  const char **field = fields ? field_names(reader, true, &known_fields) : NULL;
  size_t all = known_fields;
  for (size_t i = 0; i < count; i++)
    all += list[i].descriptor->measures;
  const char **name = scene_take(all, sizeof *name);
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < list[i].descriptor->measures; k++)
      if (!has_name(name, names, list[i].descriptor->measure[k].name))
        name[names++] = list[i].descriptor->measure[k].name;
  for (size_t i = 0; i < known_fields; i++)
    if (!has_name(name, names, field[i]))
      name[names++] = field[i];
  const char *now = renamed_field(node->text);
  const char *states = effect_states_expected(reader, node->text, expected, sizeof expected);
  error_at_value(reader, node,
                 now      ? renamed_words(node->text, now, expected, sizeof expected)
                 : states ? states
                          : suggest(reader, node->text, name, names, expected, sizeof expected),
                 "unknown measure '%.60s'", node->text);
  free(name);
  free(field);
}

/* A field as a measure of its own: its formula is the field. */
static bool plain_field(struct scene_reader *reader, const char *name, struct quantity *quantity)
{
  const char *unit = field_unit(reader, name, true);
  if (!unit)
    return false;
  struct measure *measure = scene_keep(reader, 1, sizeof *measure);
  *measure = (struct measure){.name = name, .unit = unit, .formula = name, .at = MEASURE_POINT};
  quantity->measure = measure;
  quantity->field = name;
  return true;
}

static bool effect_named(struct scene_reader *reader, const struct tree *node, const char **effect)
{
  const struct scene *scene = reader->scene;
  char expected[WORDS_SIZE];
  *effect = NULL;
  if (!node)
    return true;
  const char *text = text_read(reader, node, "effect");
  bool found = text && tree_number(scene->effects_node, text) < scene->effects;
  if (text && !found)
    error_at_value(reader, node,
                   suggest_key(reader, text, scene->effects_node, expected, sizeof expected),
                   "unknown effect '%.60s'", text);
  *effect = text;
  return found;
}

static bool measure_find(struct scene_reader *reader, const struct tree *node, const char *effect,
                         struct quantity *quantity)
{
  const struct scene *scene = reader->scene;
  struct provider *list = scene_take(1 + scene->materials + scene->effects, sizeof *list);
  size_t count = providers_of(scene, effect, list), found = 0, of_effects = 0;
  for (size_t i = 0; i < count; i++) {
    const struct measure *measure = measure_named(list[i].descriptor, node->text);
    if (!measure)
      continue;
    of_effects += list[i].effect != NULL;
    if (found++)
      continue;
    quantity->measure = measure;
    quantity->provider = list[i].descriptor;
    quantity->effect = list[i].effect;
  }
  if (quantity->effect && of_effects > 1) {
    error_at_value(reader, node, "'effect:' names the one that is meant",
                   "measure '%s' is offered by several effects", node->text);
    quantity->measure = NULL;
  } else if (!found && (effect || !plain_field(reader, node->text, quantity))) {
    if (!reader->geometry_unknown || effect)
      error_at_measure(reader, node, list, count, !effect);
  }
  free(list);
  return quantity->measure != NULL;
}

static const double samples_most = 1e7;

static void when_read(struct scene_reader *reader, const struct tree *node,
                      struct quantity *quantity)
{
  const struct tree *reduce = tree_get(node, "reduce"), *every = tree_get(node, "every");
  if (reduce)
    reduction_read(reader, reduce, quantity->measure, &quantity->reduction);
  if (!every || !amount_read(reader, every, "every", axis_unit(reader), &quantity->every))
    return;
  if (!(quantity->every > 0))
    error_at_value(reader, every, "greater than 0", "'every' is not positive");
  else
    every_within(reader, every, "samples", quantity->every, samples_most);
}

static void error_at_old_field(struct scene_reader *reader, const struct tree *named)
{
  char expected[WORDS_SIZE];
  const char *now = renamed_field(named->text);
  const char *words = now ? renamed_words(named->text, now, expected, sizeof expected)
                          : effect_states_expected(reader, named->text, expected, sizeof expected);
  if (words)
    error_at_value(reader, named, words, "unknown field '%.60s'", named->text);
}

/* The unit of the field, or of the measure of points, that an argument names. */
static const char *unit_named(struct scene_reader *reader, const struct tree *node,
                              const struct quantity *quantity, const char *argument)
{
  const struct scene *scene = reader->scene;
  const struct tree *named = argument ? tree_get(node, argument) : NULL;
  if (!named || named->kind != TREE_SCALAR)
    return NULL;
  const char *unit = field_unit(reader, named->text, true);
  struct provider *list = scene_take(1 + scene->materials + scene->effects, sizeof *list);
  size_t count = providers_of(scene, quantity->effect, list);
  for (size_t i = 0; i < count && !unit; i++) {
    const struct measure *measure = measure_named(list[i].descriptor, named->text);
    unit = measure && measure->at == MEASURE_POINT ? measure->unit : NULL;
  }
  free(list);
  if (!unit)
    error_at_old_field(reader, named);
  return unit;
}

/* An argument that names an entry of a map becomes a choice of those that the scene has. */
static void entries_as_choices(struct scene_reader *reader, const struct quantity *quantity,
                               struct parameter *argument)
{
  const struct scene *scene = reader->scene;
  const struct values *values = scene->solver.values;
  if (quantity->effect)
    values = scene->effect[tree_number(scene->effects_node, quantity->effect)].instance.values;
  const struct value *map = values_find(values, argument->entry_of);
  argument->type = VALUE_CHOICE;
  argument->choices = map && map->group ? map->group->count : 0;
  argument->choice = scene_keep(reader, argument->choices, sizeof *argument->choice);
  for (size_t i = 0; i < argument->choices; i++)
    argument->choice[i] = map->group->parameter[i].name;
}

/* A measure of a field that the scene names has the field's unit, and so have its arguments. Of a
 * field that nobody has the unit is left open; it is refused when the run is planned. */
static void measure_of_scene(struct scene_reader *reader, const struct tree *node,
                             struct quantity *quantity)
{
  const struct measure *measure = quantity->measure;
  bool any = measure->unit_of;
  for (size_t i = 0; i < measure->arguments; i++)
    any |= measure->argument[i].unit_of || measure->argument[i].type == VALUE_ENTRY;
  if (!any)
    return;
  struct measure *own = scene_keep(reader, 1, sizeof *own);
  *own = *measure;
  const char *unit = unit_named(reader, node, quantity, own->unit_of);
  own->unit = unit ? unit : own->unit;
  own->argument = scene_keep(reader, own->arguments, sizeof *own->argument);
  for (size_t i = 0; i < own->arguments; i++) {
    struct parameter *argument = &own->argument[i];
    *argument = measure->argument[i];
    unit = unit_named(reader, node, quantity, argument->unit_of);
    argument->unit = unit ? unit : argument->unit;
    if (argument->type == VALUE_ENTRY)
      entries_as_choices(reader, quantity, argument);
  }
  quantity->measure = own;
}

static void quantity_read(struct scene_reader *reader, const struct tree *node,
                          struct quantity *quantity, struct places *places)
{
  char path[PATH_SIZE], what[160];
  const char *effect;
  snprintf(what, sizeof what, "quantity '%s'", node->key);
  expect_name(reader, node, "a quantity");
  if (!expect_mapping(reader, node, what))
    return;
  tree_path(node, path, sizeof path);
  const struct tree *measure = tree_get(node, "measure");
  if (!measure) {
    char missing[PATH_SIZE + 16];
    for (size_t i = 0; i < node->children; i++)
      if (nearest(node->child[i]->key, own_keys, 1))
        error_at_unknown(reader, node->child[i], NULL, 0, own_keys, ARRAY_SIZE(own_keys), what);
    if (is_typo_of(reader, node, "measure"))
      return;
    snprintf(missing, sizeof missing, "%s.measure", path);
    error_at_missing(reader, node, missing, "'gamut show' of the solver lists its measures",
                     "'measure' is missing in %s", what);
    return;
  }
  if (!text_read(reader, measure, "measure") ||
      !effect_named(reader, tree_get(node, "effect"), &effect) ||
      !measure_find(reader, measure, effect, quantity))
    return;
  measure_of_scene(reader, node, quantity);
  struct section section = {.parameter = quantity->measure->argument,
                            .count = quantity->measure->arguments,
                            .node = node,
                            .path = path,
                            .what = what,
                            .also = own_keys,
                            .others = ARRAY_SIZE(own_keys)};
  quantity->arguments = section_read(reader, &section);
  at_read(reader, node, quantity, places);
  when_read(reader, node, quantity);
}

/* One quantity for each of several points: NAME.01, NAME.02, ..., which no other has: a name with
 * a dot does not stand beside its first part. */
static void put_tracers(struct scene_reader *reader, const struct quantity *quantity,
                        const struct places *places)
{
  struct scene *scene = reader->scene;
  const int digits = snprintf(NULL, 0, "%zu", places->count);
  for (size_t i = 0; i < places->count; i++) {
    struct quantity *one = &scene->quantity[scene->quantities++];
    *one = *quantity;
    one->family = quantity->name;
    one->name = scene_text(reader, "%s.%0*zu", quantity->name, digits, i + 1);
    one->arguments = i == 0 ? quantity->arguments : NULL; /* freed once; points need none */
    memcpy(one->point, &places->place[3 * i], sizeof one->point);
  }
}

static void room_for(struct scene *scene, size_t *room, size_t more)
{
  if (scene->quantities + more <= *room)
    return;
  *room = 2 * (scene->quantities + more);
  struct quantity *grown = scene_take(*room, sizeof *grown);
  if (scene->quantities > 0)
    memcpy(grown, scene->quantity, scene->quantities * sizeof *grown);
  free(scene->quantity);
  scene->quantity = grown;
}

void quantities_read(struct scene_reader *reader, const struct tree *root)
{
  struct scene *scene = reader->scene;
  const struct tree *node = tree_get(root, "quantities");
  if (!node || !expect_mapping(reader, node, "'quantities'"))
    return;
  size_t room = 0;
  for (size_t i = 0; i < node->children; i++) {
    struct places places = {0};
    struct quantity quantity = {.name = node->child[i]->key, .body = -1, .node = node->child[i]};
    quantity_read(reader, node->child[i], &quantity, &places);
    room_for(scene, &room, places.count > 0 ? places.count : 1);
    if (places.count > 0)
      put_tracers(reader, &quantity, &places);
    else
      scene->quantity[scene->quantities++] = quantity;
    free(places.place);
  }
}
