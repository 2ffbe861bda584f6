/* Parameters: of a plugin, of a group, of bodies and materials, and arguments of measures. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "descriptor/descriptor_private.h"

#define BIT(type) (1U << (type))
enum {
  ALL = (1U << (VALUE_GROUP + 1)) - 1,
  NUMBERS = BIT(VALUE_REAL) | BIT(VALUE_VECTOR),
  RANGED = NUMBERS | BIT(VALUE_INTEGER),
  ENTRIES = BIT(VALUE_LIST) | BIT(VALUE_MAP),
  HOLDERS = ENTRIES | BIT(VALUE_ONE_OF)
};

/* Which key has a meaning for which types. */
static const struct {
  const char *key;
  unsigned types;
} key_types[] = {
    {"type", ALL},
    {"doc", ALL},
    {"source", ALL},
    {"symbol", ALL},
    {"optional", ALL},
    {"default",
     ALL & ~(BIT(VALUE_GROUP) | BIT(VALUE_PLUGIN) | BIT(VALUE_FILE) | HOLDERS | BIT(VALUE_ENTRY))},
    {"unit", RANGED | BIT(VALUE_EXPRESSION)},
    {"unit_of", BIT(VALUE_REAL)},
    {"fit", RANGED},
    {"usual", RANGED},
    {"physical", RANGED},
    {"random", BIT(VALUE_REAL)},
    {"elsewhere", BIT(VALUE_REAL)},
    {"prepared", BIT(VALUE_REAL) | BIT(VALUE_INTEGER) | BIT(VALUE_BOOLEAN) | BIT(VALUE_CHOICE)},
    {"size", BIT(VALUE_VECTOR) | BIT(VALUE_TABLE) | ENTRIES},
    {"choices", BIT(VALUE_CHOICE)},
    {"variables", BIT(VALUE_EXPRESSION)},
    {"columns", BIT(VALUE_TABLE)},
    {"members", BIT(VALUE_GROUP)},
    {"one_of", BIT(VALUE_GROUP)},
    {"of", ENTRIES | BIT(VALUE_ENTRY)},
    {"forms", BIT(VALUE_ONE_OF)},
    {"kind", BIT(VALUE_PLUGIN)},
};

static enum value_type read_type(struct reader *reader, const struct tree *node)
{
  const char *text = read_text(reader, node, "type", false);
  if (!text)
    return VALUE_REAL;
  const char *known[VALUE_GROUP + 1];
  for (int type = VALUE_REAL; type <= VALUE_GROUP; type++) {
    known[type] = value_type_name((enum value_type)type);
    if (strcmp(known[type], text) == 0)
      return (enum value_type)type;
  }
  reader_error_at_unknown(reader, tree_get(node, "type"), false, known, ARRAY_SIZE(known),
                          "unknown type '%s'", text);
  return VALUE_REAL;
}

static void check_parameter_keys(struct reader *reader, const struct tree *node,
                                 enum value_type type)
{
  const char *known[ARRAY_SIZE(key_types)];
  size_t count = 0;
  for (size_t i = 0; i < ARRAY_SIZE(key_types); i++)
    known[count++] = key_types[i].key;
  char what[96];
  snprintf(what, sizeof what, "parameter '%s'", node->key);
  check_keys(reader, node, known, count, what);
  for (size_t i = 0; i < ARRAY_SIZE(key_types); i++) {
    const struct tree *child = tree_get(node, key_types[i].key);
    if (child && !(key_types[i].types & BIT(type)))
      reader_error_at_key(reader, child, NULL, "'%s' has no meaning for a parameter of type %s",
                          key_types[i].key, value_type_name(type));
  }
}

static void read_range(struct reader *reader, const struct tree *node, const char *key,
                       const struct parameter *parameter, struct range *range)
{
  char why[256];
  const char *text = read_text(reader, node, key, false);
  if (!text)
    return;
  const char *unit = parameter->unit ? parameter->unit : "1";
  if (!range_read(text, unit, reader->units, range, why, sizeof why)) {
    reader_error_at_value(reader, tree_get(node, key), NULL, "cannot read the range '%s': %s", text,
                          why);
    range->stated = false;
  }
}

/* "3" or "1..3"; of a list, map or table, which need say nothing, also "0..3". */
static void read_size(struct reader *reader, const struct tree *node, struct parameter *parameter)
{
  enum { COMPONENTS_MAX = 1000, ENTRIES_MAX = 10000, ROWS_MAX = 100000000 };
  const bool vector = parameter->type == VALUE_VECTOR;
  const bool table = parameter->type == VALUE_TABLE;
  const long least = vector || table ? 1 : 0;
  const long most = vector ? COMPONENTS_MAX : table ? ROWS_MAX : ENTRIES_MAX;
  const char *text = read_text(reader, node, "size", vector);
  parameter->size_min = (size_t)least;
  parameter->size_max = vector ? 1 : (size_t)most;
  if (!text)
    return;
  char *after;
  long low = strtol(text, &after, 10), high = low;
  bool good = after != text;
  if (good && strncmp(after, "..", 2) == 0) {
    const char *next = after + 2;
    high = strtol(next, &after, 10);
    good = after != next;
  }
  if (!good || *after || low < least || high < low || high > most) {
    reader_error_at_value(reader, tree_get(node, "size"),
                          "a number such as 3, or a span such as 1..3", "'%s' is no size of a %s",
                          text, value_type_name(parameter->type));
    return;
  }
  parameter->size_min = (size_t)low;
  parameter->size_max = (size_t)high;
}

static void read_columns(struct reader *reader, const struct tree *node,
                         struct parameter *parameter)
{
  const struct tree *columns = tree_get(node, "columns");
  if (!columns || columns->kind != TREE_MAPPING || columns->children == 0) {
    reader_error_at_value(reader, columns ? columns : node, "columns: {time: s, strain: 1}",
                          "table '%s' has no columns", parameter->name);
    return;
  }
  parameter->choice = reader_keep(reader, columns->children, sizeof *parameter->choice);
  parameter->choice_unit = reader_keep(reader, columns->children, sizeof *parameter->choice_unit);
  for (size_t i = 0; i < columns->children; i++) {
    const char *unit = read_unit(reader, columns, columns->child[i]->key, true);
    check_name(reader, columns->child[i], true, columns->child[i]->key);
    parameter->choice[i] = columns->child[i]->key;
    parameter->choice_unit[i] = unit ? unit : "1";
  }
  parameter->choices = columns->children;
}

static void read_choices(struct reader *reader, const struct tree *node, const char *key,
                         struct parameter *parameter)
{
  const struct tree *list = tree_get(node, key);
  parameter->choice = read_texts(reader, list, key, &parameter->choices);
  if (!list || (list->kind == TREE_SEQUENCE && list->children == 0))
    reader_error_at_value(reader, list ? list : node, NULL, "'%s' of '%s' is missing", key,
                          parameter->name);
}

static void check_default_number(struct reader *reader, const struct tree *node,
                                 const struct parameter *parameter)
{
  double value = 0;
  char expected[256];
  const char *unit = parameter->unit ? parameter->unit : "1";
  enum unit_result result = node->kind == TREE_SCALAR && !node->quoted
                                ? unit_read(reader->units, node->text, unit, &value)
                                : UNIT_NOT_A_NUMBER;
  snprintf(expected, sizeof expected, "for example '%s'", unit_example(unit));
  if (result != UNIT_OK)
    reader_error_at_value(reader, node, expected, "the default '%s' of '%s' is no quantity in %s",
                          node->text, parameter->name, unit);
  else if (parameter->type == VALUE_INTEGER && value != floor(value))
    reader_error_at_value(reader, node, NULL, "the default '%s' of '%s' is no whole number",
                          node->text, parameter->name);
  else if (!range_holds(&parameter->physical, value))
    reader_error_at_value(reader, node,
                          range_text(&parameter->physical, unit, expected, sizeof expected),
                          "the default of '%s' lies outside its physical range", parameter->name);
  else if (!range_holds(&parameter->fit, value))
    reader_error_at_value(reader, node,
                          range_text(&parameter->fit, unit, expected, sizeof expected),
                          "the default of '%s' lies outside the range of its fit", parameter->name);
}

static void check_default_vector(struct reader *reader, const struct tree *node,
                                 const struct parameter *parameter)
{
  if (node->kind != TREE_SEQUENCE || node->children < parameter->size_min ||
      node->children > parameter->size_max) {
    char expected[96];
    snprintf(expected, sizeof expected, "a list of %zu to %zu numbers", parameter->size_min,
             parameter->size_max);
    reader_error_at_value(reader, node, expected, "the default of '%s' has the wrong size",
                          parameter->name);
    return;
  }
  for (size_t i = 0; i < node->children; i++)
    check_default_number(reader, node->child[i], parameter);
}

static void check_default(struct reader *reader, const struct parameter *parameter)
{
  const struct tree *node = parameter->standard;
  bool scalar = node->kind == TREE_SCALAR;
  switch (parameter->type) {
  case VALUE_REAL:
  case VALUE_INTEGER:
    check_default_number(reader, node, parameter);
    return;
  case VALUE_VECTOR:
    check_default_vector(reader, node, parameter);
    return;
  case VALUE_BOOLEAN:
    if (!scalar || (strcmp(node->text, "true") != 0 && strcmp(node->text, "false") != 0))
      reader_error_at_value(reader, node, "true or false",
                            "the default of '%s' is neither true nor false", parameter->name);
    return;
  case VALUE_CHOICE:
    for (size_t i = 0; scalar && i < parameter->choices; i++)
      if (strcmp(parameter->choice[i], node->text) == 0)
        return;
    reader_error_at_unknown(reader, node, false, (const char *const *)parameter->choice,
                            parameter->choices, "the default '%s' of '%s' is none of its choices",
                            node->text, parameter->name);
    return;
  case VALUE_TEXT:
  case VALUE_BODY:
    if (!scalar)
      reader_error_at_value(reader, node, "one text", "the default of '%s' is no text",
                            parameter->name);
    return;
  case VALUE_EXPRESSION:
  case VALUE_TABLE:
  case VALUE_FILE:
  case VALUE_LEVELS:
  case VALUE_PLUGIN:
  case VALUE_LIST:
  case VALUE_MAP:
  case VALUE_ENTRY:
  case VALUE_ONE_OF:
  case VALUE_GROUP:
    return;
  }
}

static void read_kind(struct reader *reader, const struct tree *node, struct parameter *parameter)
{
  const char *text = read_text(reader, node, "kind", true);
  const char *known[GAMUT_KINDS];
  if (!text || kind_from_name(text, &parameter->kind))
    return;
  for (int kind = 0; kind < GAMUT_KINDS; kind++)
    known[kind] = kind_name((enum gamut_kind)kind);
  reader_error_at_unknown(reader, tree_get(node, "kind"), false, known, ARRAY_SIZE(known),
                          "unknown kind of plugin '%s'", text);
}

static void read_by_type(struct reader *reader, const struct tree *node,
                         struct parameter *parameter)
{
  switch (parameter->type) {
  case VALUE_VECTOR:
    read_size(reader, node, parameter);
    break;
  case VALUE_CHOICE:
    read_choices(reader, node, "choices", parameter);
    break;
  case VALUE_EXPRESSION:
    read_choices(reader, node, "variables", parameter);
    break;
  case VALUE_TABLE:
    read_size(reader, node, parameter);
    read_columns(reader, node, parameter);
    break;
  case VALUE_PLUGIN:
    read_kind(reader, node, parameter);
    break;
  case VALUE_GROUP:
    if (!tree_get(node, "members"))
      reader_error_at_key(reader, node, NULL, "group '%s' has no members", parameter->name);
    parameter->members =
        read_parameters(reader, tree_get(node, "members"), DECLARED_PARAMETER, &parameter->member);
    read_one_of(reader, tree_get(node, "one_of"), parameter->member, parameter->members,
                &parameter->one_of);
    break;
  case VALUE_LIST:
  case VALUE_MAP:
    read_size(reader, node, parameter);
    read_entries(reader, node, parameter);
    break;
  case VALUE_ENTRY:
    parameter->entry_of = read_text(reader, node, "of", true);
    break;
  case VALUE_ONE_OF:
    read_forms(reader, node, parameter);
    break;
  default:
    break;
  }
}

/* The argument that says whose unit is meant. A default or a range would need one unit of all. */
static const char *read_unit_of(struct reader *reader, const struct tree *node, bool argument)
{
  static const char *const others[] = {"unit", "default", "physical", "fit", "usual"};
  for (size_t i = 0; i < ARRAY_SIZE(others) && tree_get(node, "unit_of"); i++)
    if (tree_get(node, others[i]))
      reader_error_at_value(reader, tree_get(node, others[i]), NULL,
                            "'unit_of' leaves the unit to the scene: '%s' cannot stand beside it",
                            others[i]);
  if (tree_get(node, "unit_of") && !argument)
    reader_error_at_value(reader, tree_get(node, "unit_of"), NULL,
                          "only an argument of a measure has 'unit_of'");
  return read_text(reader, node, "unit_of", false);
}

void read_parameter(struct reader *reader, const struct tree *node, enum declared declared,
                    struct parameter *parameter)
{
  parameter->name = node->key;
  check_name(reader, node, true, node->key);
  if (node->kind != TREE_MAPPING) {
    reader_error_at_value(reader, node, "{unit: Pa, doc: ...}", "parameter '%s' is no mapping",
                          node->key);
    return;
  }
  enum value_type type = parameter->type = read_type(reader, node);
  if (type == VALUE_ENTRY && declared != DECLARED_ARGUMENT)
    reader_error_at_value(reader, tree_get(node, "type"), NULL,
                          "only an argument of a measure names an entry");
  check_parameter_keys(reader, node, type);
  bool dimensional = (NUMBERS | BIT(VALUE_EXPRESSION)) & BIT(type);
  if (dimensional || type == VALUE_INTEGER)
    parameter->unit = read_unit(reader, node, "unit", dimensional && !tree_get(node, "unit_of"));
  if (type == VALUE_INTEGER && parameter->unit && strcmp(parameter->unit, "1") != 0)
    reader_error_at_value(reader, tree_get(node, "unit"), NULL, "an integer has no unit but 1");
  if (!parameter->unit && (dimensional || type == VALUE_INTEGER))
    parameter->unit = "1";
  parameter->unit_of = read_unit_of(reader, node, declared == DECLARED_ARGUMENT);
  parameter->symbol = read_text(reader, node, "symbol", false);
  parameter->doc = read_text(reader, node, "doc", declared == DECLARED_PARAMETER);
  parameter->source = read_text(reader, node, "source", false);
  parameter->optional = read_flag(reader, node, "optional", false);
  parameter->random = read_flag(reader, node, "random", false);
  parameter->elsewhere = read_flag(reader, node, "elsewhere", false);
  parameter->prepared = read_flag(reader, node, "prepared", false);
  read_by_type(reader, node, parameter);
  read_range(reader, node, "fit", parameter, &parameter->fit);
  read_range(reader, node, "physical", parameter, &parameter->physical);
  read_range(reader, node, "usual", parameter, &parameter->usual);
  if (!range_within(&parameter->fit, &parameter->physical))
    reader_error_at_value(reader, tree_get(node, "fit"), NULL,
                          "the range of the fit of '%s' reaches beyond its physical range",
                          parameter->name);
  parameter->standard = tree_get(node, "default");
  /* A unit that cannot be read is one fault, not two. */
  bool judged = !dimensional || tree_get(node, "unit");
  if (parameter->standard && judged)
    check_default(reader, parameter);
}

size_t read_parameters(struct reader *reader, const struct tree *node, enum declared declared,
                       struct parameter **list)
{
  *list = NULL;
  if (!node)
    return 0;
  if (node->kind != TREE_MAPPING) {
    if (node->kind == TREE_SEQUENCE || node->text[0])
      reader_error_at_value(reader, node, "{name: {unit: Pa, doc: ...}}", "'%s' is no mapping",
                            node->key);
    return 0;
  }
  *list = reader_keep(reader, node->children, sizeof **list);
  for (size_t i = 0; i < node->children; i++)
    read_parameter(reader, node->child[i], declared, &(*list)[i]);
  return node->children;
}
