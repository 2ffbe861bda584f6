#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static bool arithmetic(const struct parameter *parameter)
{
  return parameter->type == VALUE_REAL || parameter->type == VALUE_INTEGER ||
         parameter->type == VALUE_BOOLEAN;
}

static struct value *find(const struct values *values, const char *name)
{
  for (size_t i = 0; i < values->count; i++)
    if (strcmp(values->parameter[i].name, name) == 0)
      return &values->value[i];
  return NULL;
}

/* The numbers that expressions may use, with their names. */
struct numbers {
  const char **name;
  const struct value **value;
  double *number;
  size_t count;
};

static struct numbers numbers_of(const struct values *values)
{
  struct numbers n = {scene_take(values->count, sizeof *n.name),
                      scene_take(values->count, sizeof *n.value),
                      scene_take(values->count, sizeof *n.number), 0};
  for (size_t i = 0; i < values->count; i++) {
    const struct value *value = &values->value[i];
    if (!arithmetic(&values->parameter[i]))
      continue;
    n.name[n.count] = values->parameter[i].name;
    n.value[n.count] = value;
    n.number[n.count++] = value->present ? value->real : 0;
  }
  return n;
}

static void numbers_free(struct numbers *n)
{
  free(n->name);
  free(n->value);
  free(n->number);
}

/* Value of an expression; false where something that it uses has no value. */
static bool evaluate(struct scene_reader *reader, const struct numbers *n, const char *text,
                     const char *what, struct expression **expression, double *result)
{
  char why[256] = "";
  *expression = expression_new(text, n->name, n->count, why, sizeof why);
  if (!*expression) {
    reader->first = reader->first ? reader->first : GAMUT_PLUGIN;
    reader->faults++;
    trace_fail(reader->trace, GAMUT_PLUGIN, "%s: cannot read '%s': %s", what, text, why);
    return false;
  }
  for (size_t i = 0; i < n->count; i++)
    if (expression_uses(*expression, i) && !n->value[i]->present)
      return false;
  *result = expression_value(*expression, n->number);
  return true;
}

bool given_set_names(const struct descriptor *descriptor, const char *name)
{
  for (size_t i = 0; descriptor && i < descriptor->givens; i++)
    if (has_name(descriptor->given[i].name, descriptor->given[i].names, name) ||
        has_name(descriptor->given[i].derived, descriptor->given[i].derivations, name))
      return true;
  return false;
}

/* A set fits if it holds every member of sets that the scene gives, and the rest of it has
 * defaults. */
static const struct given_set *choose(const struct values *values,
                                      const struct descriptor *descriptor, size_t *given)
{
  *given = 0;
  for (size_t i = 0; i < values->count; i++)
    *given += values->value[i].given && given_set_names(descriptor, values->parameter[i].name);
  for (size_t i = 0; i < descriptor->givens; i++) {
    const struct given_set *set = &descriptor->given[i];
    size_t held = 0, lacking = 0;
    for (size_t k = 0; k < set->names; k++) {
      const struct value *value = find(values, set->name[k]);
      held += value && value->given;
      lacking += value && !value->given && !value->parameter->standard;
    }
    if (held == *given && lacking == 0)
      return set;
  }
  return NULL;
}

const struct given_set *given_set_chosen(const struct values *values,
                                         const struct descriptor *descriptor)
{
  size_t given;
  return descriptor && descriptor->givens ? choose(values, descriptor, &given) : NULL;
}

static void error_at_sets(struct scene_reader *reader, struct values *values,
                          const struct descriptor *descriptor, size_t given, const char *what)
{
  char list[WORDS_SIZE] = "", one[WORDS_SIZE];
  const char *names[16];
  size_t count = 0, length = 0;
  const struct tree *last = values->node;
  for (size_t i = 0; i < descriptor->givens && length < sizeof list; i++) {
    const struct given_set *set = &descriptor->given[i];
    list_text(set->name, set->names, one, sizeof one);
    length += (size_t)snprintf(list + length, sizeof list - length, "%s[%s]",
                               i ? " or " : "give one of the sets ", one);
  }
  for (size_t i = 0; i < values->count && count < ARRAY_SIZE(names); i++)
    if (is_typo_of(reader, values->node, values->parameter[i].name) &&
        given_set_names(descriptor, values->parameter[i].name)) {
      return;
    } else if (values->value[i].given && given_set_names(descriptor, values->parameter[i].name)) {
      names[count++] = values->parameter[i].name;
      last = values->value[i].node;
    }
  list_text(names, count, one, sizeof one);
  if (given == 0)
    error_at_missing(reader, values->node, values->path, list, "%s lacks parameters", what);
  else
    error_at_key(reader, last, list, "%s: %s %s no set that it knows", what, one,
                 given > 1 ? "together are" : "alone is");
}

static void derive(struct scene_reader *reader, struct values *values,
                   const struct descriptor *descriptor, const char *what)
{
  size_t given;
  if (descriptor->givens == 0)
    return;
  bool all_optional = true;
  for (size_t i = 0; i < values->count; i++)
    if (given_set_names(descriptor, values->parameter[i].name))
      all_optional = all_optional && values->parameter[i].optional;
  const struct given_set *set = choose(values, descriptor, &given);
  if (!set) {
    if (given || !all_optional)
      error_at_sets(reader, values, descriptor, given, what);
    return;
  }
  for (size_t k = 0; k < set->derivations; k++) {
    struct value *value = find(values, set->derived[k]);
    struct expression *expression = NULL;
    struct numbers n = numbers_of(values);
    double result;
    if (value && evaluate(reader, &n, set->formula[k], what, &expression, &result)) {
      value->real = result;
      value->present = range_check(reader, value->parameter, values->node, result);
    }
    expression_free(expression);
    numbers_free(&n);
  }
}

/* The numbers that a constraint compares, "T_melt = 200 K, T_room = 298 K"; and the last given one.
 */
static const struct tree *compared(const struct numbers *n, const struct expression *expression,
                                   char *list, size_t size)
{
  const struct tree *node = NULL;
  size_t length = 0;
  list[0] = 0;
  for (size_t i = 0; i < n->count && length < size; i++) {
    if (!expression_uses(expression, i))
      continue;
    const char *unit = n->value[i]->parameter->unit;
    length += (size_t)snprintf(list + length, size - length, "%s%s = %.6g%s%s", length ? ", " : "",
                               n->name[i], n->number[i], unit_is_pure(unit) ? "" : " ",
                               unit_is_pure(unit) ? "" : unit);
    if (n->value[i]->node && !node)
      node = n->value[i]->node;
  }
  return node;
}

static void constrain(struct scene_reader *reader, struct values *values,
                      const struct descriptor *descriptor, const char *what)
{
  struct numbers n = numbers_of(values);
  char list[WORDS_SIZE], expected[WORDS_SIZE];
  for (size_t i = 0; i < descriptor->constraints; i++) {
    struct expression *expression;
    double holds = 1;
    if (evaluate(reader, &n, descriptor->constraint[i], what, &expression, &holds) &&
        !(holds != 0 && !isnan(holds))) {
      const struct tree *node = compared(&n, expression, list, sizeof list);
      snprintf(expected, sizeof expected, "%s asks for %s", what, descriptor->constraint[i]);
      error_at_value(reader, node ? node : values->node, expected, "%s is not possible", list);
    }
    expression_free(expression);
  }
  numbers_free(&n);
}

void values_check(struct scene_reader *reader, struct values *values,
                  const struct descriptor *descriptor, const char *what)
{
  derive(reader, values, descriptor, what);
  constrain(reader, values, descriptor, what);
}

bool values_conflict(struct values *values, const struct descriptor *descriptor, char *conflict,
                     size_t size)
{
  struct scene_reader unheard = {.here = values->node};
  derive(&unheard, values, descriptor, "");
  bool found = unheard.faults > 0;
  if (found)
    snprintf(conflict, size, "the ranges of what follows from them");
  struct numbers n = numbers_of(values);
  for (size_t i = 0; i < descriptor->constraints && !found; i++) {
    struct expression *expression;
    double holds = 1;
    found = evaluate(&unheard, &n, descriptor->constraint[i], "", &expression, &holds) &&
            !(holds != 0 && !isnan(holds));
    if (found)
      snprintf(conflict, size, "%s", descriptor->constraint[i]);
    expression_free(expression);
  }
  numbers_free(&n);
  return found;
}

gamut_status values_set(struct values *values, const struct descriptor *descriptor,
                        size_t parameter, double real, struct trace *trace)
{
  char what[160];
  struct value *value = &values->value[parameter];
  struct scene_reader reader = {.trace = trace, .here = values->node};
  snprintf(what, sizeof what, "%s '%s'", kind_name(descriptor->kind), descriptor->name);
  value->real = real;
  value->present = range_check(&reader, value->parameter, value->node, real);
  if (value->present)
    values_check(&reader, values, descriptor, what);
  return reader.first;
}
