/* Parameters that differ from point to point: those with a random field, and what follows from them
 * by the formulas of a given set. Formulas are read once and worked out for every point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

/* One formula: a derived parameter, or a constraint (target SIZE_MAX). */
struct rule {
  struct expression *expression;
  const char *text;
  size_t target;
};

struct pointwise {
  const struct values *values;
  bool *varies;
  const char **name;
  struct rule *rule; /* derivations in order, then constraints */
  size_t rules, derivations;
};

static bool is_number(const struct parameter *parameter)
{
  return parameter->type == VALUE_REAL || parameter->type == VALUE_INTEGER ||
         parameter->type == VALUE_BOOLEAN;
}

/* Other than numbers have names that no formula can use. */
static void name_variables(struct pointwise *points)
{
  static const char *const unused = "unused_";
  for (size_t i = 0; i < points->values->count; i++) {
    const struct parameter *parameter = points->values->value[i].parameter;
    points->name[i] = is_number(parameter) ? parameter->name : unused;
  }
}

static size_t index_of(const struct values *values, const char *name)
{
  for (size_t i = 0; i < values->count; i++)
    if (strcmp(values->value[i].parameter->name, name) == 0)
      return i;
  return SIZE_MAX;
}

/* Keeps the formula if something in it varies. */
static bool add_rule(struct pointwise *points, const char *text, size_t target)
{
  char why[256];
  const size_t count = points->values->count;
  struct expression *expression = expression_new(text, points->name, count, why, sizeof why);
  bool moves = false, whole = true;
  if (!expression)
    return false;
  for (size_t i = 0; i < count; i++)
    if (expression_uses(expression, i)) {
      moves = moves || points->varies[i];
      whole = whole && (points->values->value[i].present || points->varies[i]);
    }
  if (!moves || !whole) {
    expression_free(expression);
    return true;
  }
  points->rule[points->rules++] = (struct rule){expression, text, target};
  if (target != SIZE_MAX)
    points->varies[target] = true;
  return true;
}

static bool add_rules(struct pointwise *points, const struct descriptor *descriptor)
{
  const struct given_set *set = given_set_chosen(points->values, descriptor);
  bool good = true;
  for (size_t k = 0; set && k < set->derivations; k++) {
    size_t target = index_of(points->values, set->derived[k]);
    if (target != SIZE_MAX)
      good = add_rule(points, set->formula[k], target) && good;
  }
  points->derivations = points->rules;
  for (size_t k = 0; k < descriptor->constraints; k++)
    good = add_rule(points, descriptor->constraint[k], SIZE_MAX) && good;
  return good;
}

static size_t most_rules(const struct descriptor *descriptor)
{
  size_t most = descriptor ? descriptor->constraints : 0;
  for (size_t k = 0; descriptor && k < descriptor->givens; k++)
    most += descriptor->given[k].derivations;
  return most;
}

struct pointwise *pointwise_new(const struct values *values, const struct descriptor *descriptor)
{
  bool any = false;
  for (size_t i = 0; values && i < values->count; i++)
    any = any || (values->value[i].random && values->value[i].model);
  if (!any)
    return NULL;
  struct pointwise *points = scene_take(1, sizeof *points);
  points->values = values;
  points->varies = scene_take(values->count, sizeof *points->varies);
  points->name = scene_take(values->count, sizeof *points->name);
  points->rule = scene_take(most_rules(descriptor) + 1, sizeof *points->rule);
  for (size_t i = 0; i < values->count; i++)
    points->varies[i] = values->value[i].random && values->value[i].model;
  name_variables(points);
  if (descriptor && !add_rules(points, descriptor)) {
    pointwise_free(points);
    return NULL;
  }
  return points;
}

void pointwise_free(struct pointwise *points)
{
  if (!points)
    return;
  for (size_t i = 0; i < points->rules; i++)
    expression_free(points->rule[i].expression);
  free(points->rule);
  free(points->varies);
  free(points->name);
  free(points);
}

bool pointwise_varies(const struct pointwise *points, size_t index)
{
  return points && points->varies[index];
}

bool pointwise_work_out(const struct pointwise *points, double *number, size_t *index, char *why,
                        size_t size)
{
  for (size_t k = 0; k < points->derivations; k++)
    number[points->rule[k].target] = expression_value(points->rule[k].expression, number);
  for (size_t i = 0; i < points->values->count; i++) {
    const struct parameter *parameter = points->values->value[i].parameter;
    char range[160];
    *index = i;
    if (!points->varies[i] || range_holds(&parameter->physical, number[i]))
      continue;
    range_text(&parameter->physical, parameter->unit, range, sizeof range);
    snprintf(why, size, "%s = %.6g is not possible: it must be %s", parameter->name, number[i],
             range);
    return false;
  }
  for (size_t k = points->derivations; k < points->rules; k++) {
    double holds = expression_value(points->rule[k].expression, number);
    if (holds != 0 && !isnan(holds))
      continue;
    for (size_t i = points->values->count; i-- > 0;)
      if (points->varies[i] && expression_uses(points->rule[k].expression, i))
        *index = i;
    snprintf(why, size, "%s does not hold", points->rule[k].text);
    return false;
  }
  return true;
}
