#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "catalogue/catalogue.h"
#include "run/run_private.h"

static const char density_name[] = "reference_density";

/* Names of all components of point fields, in the order of their numbers, and the density. */
static char **variable_names(const struct fields *fields, size_t count)
{
  char **name = calloc(count + 1, sizeof(*name));
  for (size_t k = 0; name && k < count; k++) {
    const struct field *field = fields_of_component(fields, k);
    const char *component =
        component_name(field->handle.components, (unsigned)(k - field->handle.first));
    size_t size = strlen(field->name) + strlen(component) + 2;
    name[k] = malloc(size);
    if (!name[k])
      memory_ended();
    snprintf(name[k], size, "%s%s%s", field->name, *component ? "_" : "", component);
    /* A scene path is no name that a formula can use. */
    for (char *at = name[k]; *at; at++)
      *at = *at == '.' || *at == '-' ? '_' : *at;
  }
  return name;
}

static void free_names(char **name, size_t count)
{
  for (size_t k = 0; name && k < count; k++)
    free(name[k]);
  free(name);
}

static bool offers(const struct descriptor *d, const struct measure *measure)
{
  for (size_t i = 0; d && i < d->measures; i++)
    if (&d->measure[i] == measure)
      return true;
  return false;
}

/* The plugin that offers a measure of points: the solver, or the elasticity of a material. */
static const struct descriptor *owner_of(const struct gamut_run *run, const struct measure *measure)
{
  const struct scene *scene = run->scene;
  for (size_t m = 0; m < scene->materials; m++)
    if (offers(scene->material[m].elasticity.descriptor, measure))
      return scene->material[m].elasticity.descriptor;
  return offers(scene->solver.descriptor, measure) ? scene->solver.descriptor : NULL;
}

/* A plugin's optional input is zero where nobody provides it, for its measures as for its kernels.
 */
static bool zero_for(const struct descriptor *d, const struct field *field)
{
  for (size_t i = 0; d && i < d->inputs; i++)
    if (d->input[i].optional && strcmp(d->input[i].name, field->name) == 0)
      return true;
  return false;
}

static gamut_status keep_used(struct formula *formula, const struct gamut_run *run,
                              const struct descriptor *owner, size_t count, size_t density)
{
  formula->variable = calloc(count + 1, sizeof *formula->variable);
  formula->position = calloc(count + 1, sizeof *formula->position);
  formula->value = calloc(count + 1, sizeof *formula->value);
  formula->zero = calloc(count + 1, sizeof *formula->zero);
  if (!formula->variable || !formula->position || !formula->value || !formula->zero)
    return GAMUT_INTERNAL;
  for (size_t k = 0; k < count; k++)
    if (expression_uses(formula->expression, k)) {
      formula->position[formula->variables] = k;
      formula->zero[formula->variables] =
          k != density && zero_for(owner, fields_of_component(run->fields, k));
      formula->variable[formula->variables++] = k == density ? SIZE_MAX : k;
    }
  return GAMUT_OK;
}

/* Fields of the catalogue that nobody has asked for yet and that a text names, by itself or by a
 * component. Who wants them must then find who writes them. */
gamut_status formula_declare(struct gamut_run *run, const char *text)
{
  static const char letters[] = "_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  char word[160], name[160];
  for (const char *at = text; *at;) {
    size_t length = strspn(at, letters);
    snprintf(word, sizeof word, "%.*s", (int)length, at);
    at += length ? length : 1;
    for (size_t i = 0; length && catalogue_at(i); i++) {
      const struct field_info *v = catalogue_at(i);
      bool named = strcmp(word, v->name) == 0;
      for (unsigned k = 0; v->components > 1 && k < v->components && !named; k++) {
        snprintf(name, sizeof name, "%s_%s", v->name, component_name(v->components, k));
        named = strcmp(word, name) == 0;
      }
      if (named && v->where == GAMUT_AT_POINT &&
          !fields_add(run->fields, v->name, v->where, v->components, v->unit, v->meaning,
                      run->trace))
        return GAMUT_INTERNAL;
    }
  }
  return GAMUT_OK;
}

gamut_status formula_new(struct gamut_run *run, const struct measure *measure,
                         struct formula *formula)
{
  char why[256];
  const char *text = measure->formula;
  gamut_status status = formula_declare(run, text);
  size_t count = fields_components(run->fields), density = count;
  const struct field *known = fields_find(run->fields, density_name);
  char **name = variable_names(run->fields, count);
  *formula = (struct formula){.plain = SIZE_MAX};
  if (!name || status != GAMUT_OK)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  if (known)
    density = known->handle.first;
  else
    name[count++] = memory_copy(density_name);
  formula->expression = expression_new(text, (const char *const *)name, count, why, sizeof why);
  if (!formula->expression)
    status =
        trace_fail(run->trace, GAMUT_PLUGIN,
                   "the measure's formula '%s' cannot be worked out in this scene: %s", text, why);
  else if (keep_used(formula, run, owner_of(run, measure), count, density) != GAMUT_OK)
    status = trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  free_names(name, count);
  return status;
}

gamut_status formula_plain(struct gamut_run *run, const char *name, struct formula *formula)
{
  unsigned component;
  *formula = (struct formula){.plain = SIZE_MAX};
  if (formula_declare(run, name) != GAMUT_OK)
    return GAMUT_INTERNAL;
  const struct field *field = fields_component(run->fields, name, &component);
  if (!field || field->where != GAMUT_AT_POINT)
    return trace_fail(run->trace, GAMUT_SCENE,
                      "'%s' is wanted, but no plugin of this scene has such a field", name);
  formula->plain = field->handle.first + component;
  return GAMUT_OK;
}

double formula_value(struct formula *formula, const struct gamut_run *run,
                     const struct point_set *set, size_t slot)
{
  if (!formula->expression)
    return set->array[formula->plain] ? set->array[formula->plain][slot] : NAN;
  for (size_t i = 0; i < formula->variables; i++) {
    size_t k = formula->variable[i];
    const double *array = k == SIZE_MAX ? NULL : set->array[k];
    formula->value[formula->position[i]] = k == SIZE_MAX
                                               ? run->scene->material[set->material].density
                                           : array            ? array[slot]
                                           : formula->zero[i] ? 0.0
                                                              : NAN;
  }
  return expression_value(formula->expression, formula->value);
}

void formula_want(const struct formula *formula, struct gamut_run *run, size_t set, const char *why,
                  const struct place *place)
{
  if (!formula->expression && formula->plain != SIZE_MAX)
    schedule_want(run->schedule, fields_of_component(run->fields, formula->plain), set, why, place,
                  false);
  for (size_t i = 0; i < formula->variables; i++)
    if (formula->variable[i] != SIZE_MAX)
      schedule_want(run->schedule, fields_of_component(run->fields, formula->variable[i]), set, why,
                    place, formula->zero[i]);
}

void formula_free(struct formula *formula)
{
  expression_free(formula->expression);
  free(formula->variable);
  free(formula->position);
  free(formula->value);
  free(formula->zero);
  *formula = (struct formula){.plain = SIZE_MAX};
}
