#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

bool word_known(const struct parameter *parameter, const struct tree *node, size_t *number)
{
  static const char *const truth[] = {"false", "true", "off", "on", "no", "yes"};
  const bool choice = parameter->type == VALUE_CHOICE;
  const char *const *word = choice ? parameter->choice : truth;
  const size_t count = choice ? parameter->choices : ARRAY_SIZE(truth);
  for (*number = 0; *number < count && node->kind == TREE_SCALAR; ++*number)
    if (strcmp(word[*number], node->text) == 0)
      return true;
  return false;
}

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
  size_t number;
  if (word_known(parameter, node, &number)) {
    value->text = parameter->choice[number];
    value->real = (double)number;
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
  size_t number;
  if (word_known(parameter, node, &number)) {
    value->real = (double)(number % 2);
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

const char *path_below(const char *path, const char *name, char *buffer)
{
  snprintf(buffer, PATH_SIZE, "%s%s%s", path, path[0] ? "." : "", name);
  return buffer;
}

bool group_read(struct scene_reader *reader, const struct parameter *parameter,
                const struct tree *node, const char *path, const char *what, bool lenient,
                struct value *value)
{
  char below[PATH_SIZE];
  size_t faults = reader->faults;
  if (node && !expect_mapping(reader, node, what))
    node = NULL;
  struct section section = {.parameter = parameter->member,
                            .count = parameter->members,
                            .node = node,
                            .path = path_below(path, parameter->name, below),
                            .what = what,
                            .lenient = lenient,
                            .one_of = &parameter->one_of};
  value->group = section_read(reader, &section);
  return reader->faults == faults;
}

bool value_read(struct scene_reader *reader, const struct parameter *parameter,
                const struct tree *node, const char *path, struct value *value)
{
  char what[128];
  switch (parameter->type) {
  case VALUE_REAL:
    return real_read(reader, parameter, node, value);
  case VALUE_INTEGER:
    return integer_read(reader, parameter, node, value);
  case VALUE_BOOLEAN:
    return boolean_read(reader, parameter, node, value);
  case VALUE_CHOICE:
  case VALUE_ENTRY: /* of the scene's map: those that read it have made a choice of it */
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
  case VALUE_FILE:
    return file_value_read(reader, parameter, node, value);
  case VALUE_LEVELS:
    return levels_read(reader, parameter, node, value);
  case VALUE_PLUGIN:
    return plugin_read(reader, parameter->kind, node, value);
  case VALUE_LIST:
  case VALUE_MAP:
    return entries_read(reader, parameter, node, path, value);
  case VALUE_ONE_OF:
    return one_of_read(reader, parameter, node, path, value);
  case VALUE_GROUP:
    snprintf(what, sizeof what, "'%s'", parameter->name);
    return group_read(reader, parameter, node, path, what, false, value);
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

/* What holds others is there for whoever asks for them. Whether it lacks something. */
static bool absent_read(struct scene_reader *reader, const struct section *section,
                        const struct parameter *parameter, struct value *value)
{
  switch (parameter->type) {
  case VALUE_GROUP:
    group_read(reader, parameter, NULL, section->path, parameter->name, true, value);
    value->present = !parameter->optional && !group_needed(parameter);
    return group_needed(parameter);
  case VALUE_LIST:
  case VALUE_MAP:
    entries_read(reader, parameter, NULL, section->path, value);
    return true;
  case VALUE_ONE_OF:
    one_of_read(reader, parameter, NULL, section->path, value);
    return true;
  default:
    return true;
  }
}

static void parameter_read(struct scene_reader *reader, const struct section *section,
                           const struct parameter *parameter, unsigned alternative,
                           struct value *value)
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
  bool lacks = absent_read(reader, section, parameter, value);
  if (lacks && !parameter->optional && !section->lenient && parameter->set == alternative &&
      !given_set_names(section->descriptor, parameter->name))
    missing(reader, section, parameter);
}

struct values *values_new(const struct parameter *parameter, size_t count, const struct tree *node,
                          const char *path)
{
  struct values *values = scene_take(1, sizeof *values);
  size_t length = strlen(path) + 1;
  *values = (struct values){.parameter = parameter,
                            .count = count,
                            .value = scene_take(count, sizeof *values->value),
                            .node = node,
                            .path = memcpy(scene_take(length, 1), path, length)};
  return values;
}

struct values *section_read(struct scene_reader *reader, const struct section *section)
{
  struct values *values =
      values_new(section->parameter, section->count, section->node, section->path);
  const unsigned alternative = alternative_given(section);
  bool outside = reader->pointwise;
  for (size_t i = 0; section->node && !section->open && i < section->node->children; i++) {
    struct tree *child = section->node->child[i];
    if (!has_name(section->also, section->others, child->key) &&
        !parameter_named(section->parameter, section->count, child->key))
      error_at_unknown(reader, child, section->parameter, section->count, section->also,
                       section->others, section->what);
  }
  for (size_t i = 0; i < section->count; i++) {
    const struct parameter *parameter = &section->parameter[i];
    reader->pointwise = section->pointwise && !parameter->prepared;
    parameter_read(reader, section, parameter, parameter->set ? alternative : 0, &values->value[i]);
  }
  reader->pointwise = outside;
  alternatives_check(reader, section, alternative);
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
  struct section section = {.descriptor = own ? descriptor : NULL,
                            .parameter = parameter,
                            .count = count,
                            .node = node,
                            .path = path,
                            .what = what,
                            .also = also,
                            .others = others,
                            .one_of = own ? &descriptor->one_of : NULL};
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
    value_file_free(value->file);
    expression_free(value->expression);
    for (size_t k = 0; k < value->copies; k++)
      expression_free(value->each[k]);
    free(value->each);
    values_free(value->group);
  }
  free(values->value);
  free(values->path);
  free(values->own);
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
