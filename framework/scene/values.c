#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static bool choice_read(struct scene_reader *reader, const struct parameter *parameter,
                        const struct tree *node, struct value *value)
{
  char expected[WORDS_SIZE], list[WORDS_SIZE - 64];
  if (node->kind != TREE_SCALAR) {
    snprintf(expected, sizeof expected, "one of: %s",
             list_text(parameter->choice, parameter->choices, list, sizeof list));
    error_at_value(reader, node, expected, "'%s' is %s where one word is due", parameter->name,
                   node->kind == TREE_SEQUENCE ? "a list" : "a mapping");
    return false;
  }
  for (size_t i = 0; i < parameter->choices; i++)
    if (strcmp(parameter->choice[i], node->text) == 0) {
      value->text = parameter->choice[i];
      value->real = (double)i;
      return true;
    }
  error_at_value(
      reader, node,
      suggest(reader, node->text, parameter->choice, parameter->choices, expected, sizeof expected),
      "%s: unknown choice '%.60s'", parameter->name, node->text);
  return false;
}

static bool boolean_read(struct scene_reader *reader, const struct parameter *parameter,
                         const struct tree *node, struct value *value)
{
  static const char *const word[] = {"false", "true", "off", "on", "no", "yes"};
  for (size_t i = 0; i < ARRAY_SIZE(word) && node->kind == TREE_SCALAR; i++)
    if (strcmp(word[i], node->text) == 0) {
      value->real = (double)(i % 2);
      return true;
    }
  error_at_value(reader, node, "true or false", "'%s' is neither true nor false", parameter->name);
  return false;
}

static bool real_read(struct scene_reader *reader, const struct parameter *parameter,
                      const struct tree *node, struct value *value)
{
  if (node->kind == TREE_MAPPING)
    return random_read(reader, parameter, node, value);
  return amount_read(reader, node, parameter->name, parameter->unit, &value->real) &&
         range_check(reader, parameter, node, value->real);
}

static bool integer_read(struct scene_reader *reader, const struct parameter *parameter,
                         const struct tree *node, struct value *value)
{
  if (!amount_read(reader, node, parameter->name, parameter->unit, &value->real))
    return false;
  if (fabs(value->real) > 9007199254740992.) {
    error_at_value(reader, node, "a whole number from -2^53 to 2^53",
                   "'%s' is too large for a whole number: '%.60s'", parameter->name, node->text);
    return false;
  }
  if (value->real != nearbyint(value->real)) {
    error_at_value(reader, node, "a whole number", "'%s' is no whole number: '%.60s'",
                   parameter->name, node->text);
    return false;
  }
  return range_check(reader, parameter, node, value->real);
}

static bool numbers_read(struct scene_reader *reader, const struct parameter *parameter,
                         const struct tree *node, struct value *value)
{
  size_t least = parameter->size_min, most = parameter->size_max;
  bool spatial = reader->axes > 0 && parameter->size_min == 1 && parameter->size_max == 3;
  if (spatial && node != parameter->standard)
    least = most = reader->axes; /* a vector of space has the components that the geometry has */
  value->number =
      vector_read(reader, node, parameter->name, parameter->unit, least, most, &value->numbers);
  bool fine = value->number != NULL;
  for (size_t i = 0; fine && i < value->numbers; i++)
    fine = range_check(reader, parameter, node->child[i], value->number[i]);
  return fine;
}

static bool body_read(struct scene_reader *reader, const struct parameter *parameter,
                      const struct tree *node, struct value *value)
{
  char expected[WORDS_SIZE];
  value->text = text_read(reader, node, parameter->name);
  if (!value->text || !reader->body ||
      tree_number(reader->bodies_node, value->text) < reader->bodies)
    return value->text != NULL;
  error_at_value(reader, node,
                 suggest_key(reader, value->text, reader->bodies_node, expected, sizeof expected),
                 "unknown body '%s'", value->text);
  return false;
}

static bool formula_read(struct scene_reader *reader, const struct parameter *parameter,
                         const struct tree *node, struct value *value)
{
  char why[256] = "";
  const char *text = text_read(reader, node, parameter->name);
  if (!text)
    return false;
  value->expression = expression_new(text, parameter->choice, parameter->choices, why, sizeof why);
  if (!value->expression)
    error_at_value(reader, node, "arithmetic, such as '2 * x'", "cannot read '%s': %s", text, why);
  return value->expression != NULL;
}

/* Members of a group that is not given take their defaults; a group that may be absent asks for
 * none. */
static bool group_read(struct scene_reader *reader, const struct parameter *parameter,
                       const struct tree *node, const char *path, bool lenient, struct value *value)
{
  char below[PATH_SIZE], what[128];
  size_t faults = reader->faults;
  snprintf(below, sizeof below, "%s%s%s", path, path[0] ? "." : "", parameter->name);
  snprintf(what, sizeof what, "'%s'", parameter->name);
  if (node && !expect_mapping(reader, node, what))
    node = NULL;
  struct section section = {.parameter = parameter->member,
                            .count = parameter->members,
                            .node = node,
                            .path = below,
                            .what = what,
                            .lenient = lenient};
  value->group = section_read(reader, &section);
  return reader->faults == faults;
}

static bool value_read(struct scene_reader *reader, const struct parameter *parameter,
                       const struct tree *node, const char *path, struct value *value)
{
  switch (parameter->type) {
  case VALUE_REAL:
    return real_read(reader, parameter, node, value);
  case VALUE_INTEGER:
    return integer_read(reader, parameter, node, value);
  case VALUE_BOOLEAN:
    return boolean_read(reader, parameter, node, value);
  case VALUE_CHOICE:
    return choice_read(reader, parameter, node, value);
  case VALUE_TEXT:
    value->text = text_read(reader, node, parameter->name);
    return value->text != NULL;
  case VALUE_VECTOR:
    return numbers_read(reader, parameter, node, value);
  case VALUE_BODY:
    return body_read(reader, parameter, node, value);
  case VALUE_EXPRESSION:
    return formula_read(reader, parameter, node, value);
  case VALUE_TABLE:
    return table_read(reader, parameter, node, value);
  case VALUE_LEVELS:
    return levels_read(reader, parameter, node, value);
  case VALUE_PLUGIN:
    return plugin_read(reader, parameter->kind, node, value);
  case VALUE_GROUP:
    return group_read(reader, parameter, node, path, false, value);
  }
  return false;
}

/* Whether a group lacks something when none of its members is given. */
static bool group_needed(const struct parameter *group)
{
  for (size_t i = 0; i < group->members; i++) {
    const struct parameter *member = &group->member[i];
    if (!member->standard && !member->optional &&
        (member->type != VALUE_GROUP || group_needed(member)))
      return true;
  }
  return false;
}

static void group_text(const struct parameter *group, char *expected, size_t size)
{
  char list[WORDS_SIZE / 2];
  const char **name = scene_take(group->members, sizeof *name);
  for (size_t i = 0; i < group->members; i++)
    name[i] = group->member[i].name;
  snprintf(expected, size, "a mapping with the keys %s%s%s",
           list_text(name, group->members, list, sizeof list), group->doc ? ": " : "",
           group->doc ? group->doc : "");
  free(name);
}

static void missing(struct scene_reader *reader, const struct section *section,
                    const struct parameter *parameter)
{
  char path[PATH_SIZE], expected[WORDS_SIZE] = "";
  if (is_typo_of(reader, section->node, parameter->name))
    return;
  snprintf(path, sizeof path, "%s%s%s", section->path, section->path[0] ? "." : "",
           parameter->name);
  if (parameter->type == VALUE_REAL && !unit_is_pure(parameter->unit))
    snprintf(expected, sizeof expected, "a number with its unit, such as '%s'%s%s",
             unit_example(parameter->unit), parameter->doc ? ": " : "",
             parameter->doc ? parameter->doc : "");
  else if (parameter->type == VALUE_GROUP)
    group_text(parameter, expected, sizeof expected);
  else if (parameter->doc)
    snprintf(expected, sizeof expected, "%s", parameter->doc);
  error_at_missing(reader, section->node, path, expected[0] ? expected : NULL,
                   "'%s' is missing in %s", parameter->name, section->what);
}

static void parameter_read(struct scene_reader *reader, const struct section *section,
                           const struct parameter *parameter, struct value *value)
{
  const struct tree *node = tree_get(section->node, parameter->name);
  value->parameter = parameter;
  value->node = node;
  value->given = node != NULL;
  if (!node)
    node = parameter->standard;
  if (node) {
    value->present = value_read(reader, parameter, node, section->path, value);
    return;
  }
  bool needed = !parameter->optional && !section->lenient;
  if (parameter->type == VALUE_GROUP) {
    group_read(reader, parameter, NULL, section->path, true, value);
    value->present = !parameter->optional && !group_needed(parameter);
    needed = needed && group_needed(parameter);
  }
  if (needed && !given_set_names(section->descriptor, parameter->name))
    missing(reader, section, parameter);
}

struct values *section_read(struct scene_reader *reader, const struct section *section)
{
  struct values *values = scene_take(1, sizeof *values);
  bool outside = reader->pointwise;
  values->parameter = section->parameter;
  values->count = section->count;
  values->value = scene_take(section->count, sizeof *values->value);
  values->node = section->node;
  size_t length = strlen(section->path) + 1;
  values->path = memcpy(scene_take(length, 1), section->path, length);
  for (size_t i = 0; section->node && !section->open && i < section->node->children; i++) {
    struct tree *child = section->node->child[i];
    if (!has_name(section->also, section->others, child->key) &&
        !parameter_named(section->parameter, section->count, child->key))
      error_at_unknown(reader, child, section->parameter, section->count, section->also,
                       section->others, section->what);
  }
  for (size_t i = 0; i < section->count; i++) {
    reader->pointwise = section->pointwise;
    parameter_read(reader, section, &section->parameter[i], &values->value[i]);
  }
  reader->pointwise = outside;
  if (section->descriptor)
    values_check(reader, values, section->descriptor, section->what);
  return values;
}

gamut_status values_read(const struct descriptor *descriptor, const struct parameter *parameter,
                         size_t count, const struct tree *node, const char *path,
                         const char *const *also, size_t others, const struct units *units,
                         struct trace *trace, struct values **values)
{
  char what[160];
  struct scene_reader reader = {.units = units, .trace = trace, .here = node};
  bool own = descriptor && parameter == descriptor->parameter;
  *values = NULL;
  if (descriptor)
    snprintf(what, sizeof what, "%s '%s'", kind_name(descriptor->kind), descriptor->name);
  else
    snprintf(what, sizeof what, "'%s'", path);
  if (node && !expect_mapping(&reader, node, what))
    return GAMUT_SCENE;
  struct section section = {own ? descriptor : NULL,
                            parameter,
                            count,
                            node,
                            path,
                            what,
                            also,
                            others,
                            false,
                            false,
                            false};
  *values = section_read(&reader, &section);
  if (reader.faults) {
    values_free(*values);
    *values = NULL;
  }
  return reader.first;
}

void values_free(struct values *values)
{
  if (!values)
    return;
  for (size_t i = 0; i < values->count; i++) {
    struct value *value = &values->value[i];
    free(value->random);
    free(value->number);
    expression_free(value->expression);
    for (size_t k = 0; k < value->copies; k++)
      expression_free(value->each[k]);
    free(value->each);
    values_free(value->group);
  }
  free(values->value);
  free(values->path);
  free(values);
}

const struct value *values_find(const struct values *values, const char *path)
{
  size_t length = strcspn(path, ".");
  for (size_t i = 0; values && i < values->count; i++) {
    const struct value *value = &values->value[i];
    const char *name = value->parameter->name;
    if (strncmp(name, path, length) != 0 || name[length] != 0)
      continue;
    return path[length] ? values_find(value->group, path + length + 1) : value;
  }
  return NULL;
}

const struct geometry *values_geometry(const struct values *values)
{
  const struct value *value = values_find(values, "geometry");
  return value && value->text ? geometry_named(value->text) : NULL;
}
