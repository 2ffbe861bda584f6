/* Fields that a quantity of a body needs because one of its arguments names them: the argument
 * `field` of a measure is a field, a component of one, or a measure of the body's points. */
#include <string.h>

#include "run/run_private.h"

static const struct measure *of_points(const struct gamut_run *run, const struct quantity *quantity,
                                       const char *name)
{
  const struct material *material =
      &run->scene->material[run->scene->body[quantity->body].material];
  const struct descriptor *d = material->elasticity.descriptor;
  for (size_t i = 0; d && i < d->measures; i++)
    if (d->measure[i].at == MEASURE_POINT && d->measure[i].formula &&
        strcmp(d->measure[i].name, name) == 0)
      return &d->measure[i];
  return NULL;
}

gamut_status wants_of_arguments(struct gamut_run *run, const struct quantity *quantity,
                                const char *why, struct formula *derived)
{
  gamut_status status;
  struct formula formula = {.plain = SIZE_MAX};
  const struct value *field =
      quantity->arguments && quantity->body >= 0 ? values_find(quantity->arguments, "field") : NULL;
  if (!field || !field->present || field->parameter->type != VALUE_TEXT || !field->text)
    return GAMUT_OK;
  const struct tree *node = field->node ? field->node : quantity->node;
  const struct place *place = node ? &node->place : NULL;
  char path[256];
  const struct measure *measure = of_points(run, quantity, field->text);
  unsigned component;
  TRY(formula_declare(run, field->text));
  if (measure)
    TRY(formula_new(run, measure, &formula));
  else if (fields_component(run->fields, field->text, &component))
    TRY(formula_plain(run, field->text, &formula));
  else
    return trace_fail_at(run->trace, GAMUT_SCENE, place,
                         node ? tree_path(node, path, sizeof path) : NULL,
                         "a field, a component of one (stress_xx), or a measure of points",
                         "no plugin of this scene has a field '%s'", field->text);
  formula_want(&formula, run, (size_t)quantity->body, why, place);
  if (measure)
    *derived = formula;
done:
  if (!derived->expression)
    formula_free(&formula);
  return status;
}

gamut_status wants_derive(struct gamut_run *run, const char *name, bool *derived)
{
  struct probe *probe = run->measured;
  const struct value *field =
      probe && probe->derived.expression ? values_find(probe->quantity->arguments, "field") : NULL;
  *derived = field && strcmp(field->text, name) == 0;
  if (!*derived)
    return GAMUT_OK;
  struct point_set *set = run->set[probe->quantity->body];
  double *value = set_derive(set);
  if (!value)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t slot = 0; slot < set->open.slots; slot++)
    value[slot] =
        set->id[slot] >= 0 ? formula_value(&probe->derived, run, set, slot) : 0.0;
  return GAMUT_OK;
}
