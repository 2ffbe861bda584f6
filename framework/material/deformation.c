/* The deformation gradient: L is that of the beginning of the step over the places of then, so that
 * points move by x + dt v(x), whose gradient is I + dt L: F1 = (I + dt L) F0. Its determinant is
 * the volume ratio of every elasticity, J1 = det(I + dt L) J0. (Wallstedt and Guilkey, J. Comput.
 * Phys. 227 (2008) 9628-9642.) Under the material driver I + dt L = exp(A), so that a rotation is
 * exact. */
#include <string.h>

#include "catalogue/catalogue.h"
#include "material/material_private.h"

static struct field *declare(struct fields *fields, const char *name, struct trace *trace)
{
  const struct field_info *info = catalogue_find(name);
  return fields_add(fields, info->name, info->where, info->components, info->unit, info->meaning,
                    trace);
}

gamut_status deformation_declare(struct fields *fields, struct trace *trace)
{
  return declare(fields, "velocity_gradient", trace) && declare(fields, "time_step", trace)
             ? GAMUT_OK
             : GAMUT_PLUGIN;
}

void deformation_resolve(struct bound_material *bound, const struct task *task,
                         const struct fields *fields)
{
  bound->deformation.gradient = SIZE_MAX;
  for (size_t u = 0; u < task->uses; u++)
    if (task->use[u].access == GAMUT_WRITE &&
        strcmp(task->use[u].field->name, "deformation_gradient") == 0)
      bound->deformation = (struct deformation){
          task->use[u].field->handle.first, fields_find(fields, "velocity_gradient")->handle.first,
          fields_find(fields, "time_step")->handle.first};
}

void deformation_update(const struct bound_material *bound, const struct gamut_chunk *chunk)
{
  const struct deformation *at = &bound->deformation;
  if (at->gradient == SIZE_MAX)
    return;
  double *const *from = chunk->begin + at->gradient, *const *to = chunk->end + at->gradient;
  double *const *L = chunk->end + at->velocity_gradient;
  const double *dt = chunk->begin[at->time_step];
  for (size_t column = 0; column < 3; column++) {
    const double *x = from[column], *y = from[3 + column], *z = from[6 + column];
    double *X = to[column], *Y = to[3 + column], *Z = to[6 + column];
    for (size_t i = 0; i < chunk->count; i++) {
      const double a = x[i], b = y[i], c = z[i];
      X[i] = a + dt[i] * (L[0][i] * a + L[1][i] * b + L[2][i] * c);
      Y[i] = b + dt[i] * (L[3][i] * a + L[4][i] * b + L[5][i] * c);
      Z[i] = c + dt[i] * (L[6][i] * a + L[7][i] * b + L[8][i] * c);
    }
  }
}
