/* Backward Euler in the forces of the bonds: no displacements, so nothing cancels.
 *
 * l (eps - 2 eps_old + eps_older) / dt^2 = a_right - a_left, node accelerations from the forces
 * beside them. With eps = f / (A E) + w pi this is a symmetric tridiagonal system for f. */
#include <string.h>

#include "bar.h"

gamut_status inertia_new(struct bar *bar)
{
  static const double pi = 3.14159265358979323846;
  size_t n = bar->bonds;
  bar->dynamic = gamut_bar_dynamics_of(bar->values) == GAMUT_BAR_DYNAMICS_BACKWARD_EULER;
  if (!bar->dynamic)
    return GAMUT_OK;
  /* Eq. 34: two pi periods of the slowest mode. */
  bar->time_step = gamut_given(bar->values, "time_step")
                       ? gamut_real(bar->values, "time_step")
                       : 4.0 * pi * bar->span / sqrt(bar->modulus / bar->density);
  bar->node_mass = gamut_allocate(bar->run, "inertia", (n + 1) * sizeof(double));
  double **array[] = {&bar->old_strain, &bar->older_strain, &bar->factor, &bar->right};
  for (size_t k = 0; k < sizeof array / sizeof array[0]; k++)
    if (!(*array[k] = bar_array(bar, "inertia")))
      return GAMUT_INTERNAL;
  if (!bar->node_mass)
    return GAMUT_INTERNAL;
  for (size_t i = 0; i < n; i++) {
    double half = 0.5 * bar->mass_density[i] * bar->volume[i];
    bar->node_mass[i] += half;
    bar->node_mass[i + 1] += half;
  }
  const double *m = bar->node_mass;
  double square = bar->time_step * bar->time_step;
  for (size_t i = 0; i < n; i++) {
    double own = bar->length[i] / (square * bar->section[i] * bar->stiffness[i]);
    bar->factor[i] = 1.0 / m[i] + 1.0 / m[i + 1] + own;
    if (i)
      bar->factor[i] -= 1.0 / (m[i] * m[i] * bar->factor[i - 1]);
  }
  return GAMUT_OK;
}

/* Solves the tridiagonal system in place. */
static void solve(const struct bar *bar, double *f)
{
  const double *m = bar->node_mass;
  size_t n = bar->bonds;
  for (size_t i = 1; i < n; i++)
    f[i] += f[i - 1] / (m[i] * bar->factor[i - 1]);
  f[n - 1] /= bar->factor[n - 1];
  for (size_t i = n - 1; i-- > 0;)
    f[i] = (f[i] + f[i + 1] / m[i + 1]) / bar->factor[i];
}

void inertia_begin(struct bar *bar, double force)
{
  double square = bar->time_step * bar->time_step;
  size_t n = bar->bonds;
  for (size_t i = 0; i < n; i++)
    bar->right[i] = bar->length[i] * (2.0 * bar->old_strain[i] - bar->older_strain[i]) / square;
  bar->right[0] += force / bar->node_mass[0];
  bar->right[n - 1] += force / bar->node_mass[n];
}

void inertia_stress(struct bar *bar, const double *flow, double *stress)
{
  double square = bar->time_step * bar->time_step;
  for (size_t i = 0; i < bar->bonds; i++)
    stress[i] = bar->right[i] - bar->length[i] * flow[i] / square;
  solve(bar, stress);
  for (size_t i = 0; i < bar->bonds; i++)
    stress[i] /= bar->section[i];
}

void inertia_apply(struct bar *bar, const double *x, double *y)
{
  double square = bar->time_step * bar->time_step;
  for (size_t i = 0; i < bar->bonds; i++)
    y[i] = sqrt(bar->length[i] / bar->section[i]) * x[i];
  solve(bar, y);
  for (size_t i = 0; i < bar->bonds; i++)
    y[i] = bar->stiffness[i] * x[i] - sqrt(bar->length[i] / bar->section[i]) * y[i] / square;
}

void inertia_commit(struct bar *bar)
{
  memcpy(bar->older_strain, bar->old_strain, bar->bonds * sizeof(double));
  memcpy(bar->old_strain, bar->strain, bar->bonds * sizeof(double));
}
