/* Newton's linear system in its symmetric, positive form: (1 - c H c) x = c b with H = w Q w
 * (scaled by V^1/2), c = sqrt(slope). Its eigenvalues lie between the least E_t / E and 1, whatever
 * the number of bonds. */
#include "bar.h"

static void apply_stiffness(struct bar *bar, const double *x, double *y)
{
  if (bar->dynamic) {
    inertia_apply(bar, x, y);
    return;
  }
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    y[i] = bar->stiffness[i] * x[i];
}

/* y = H (c x) */
static void apply_softening(struct bar *bar, const double *c, const double *x, double *y)
{
  double *scaled = bar->work[6], *work = bar->work[7];
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    scaled[i] = c[i] * x[i];
  weights_apply_symmetric(bar, scaled, y, work);
  apply_stiffness(bar, y, scaled);
  weights_apply_symmetric(bar, scaled, y, work);
}

gamut_status solve_tangent(struct bar *bar, const double *slope, double *right, double *x)
{
  enum { ROUNDS = 2000 };
  static const double enough = 1e-9;
  size_t n = bar->bonds;
  double *c = bar->work[2], *rest = bar->work[3], *way = bar->work[4], *image = bar->work[5];
  for (size_t i = 0; i < n; i++) {
    c[i] = sqrt(slope[i]);
    x[i] = 0.0;
    right[i] *= sqrt(bar->volume[i]);
    rest[i] = way[i] = c[i] * right[i];
  }
  double now = sum_of_products(n, rest, rest), target = enough * enough * now;
  for (int round = 0; round < ROUNDS && now > target; round++) {
    apply_softening(bar, c, way, image);
#pragma omp simd
    for (size_t i = 0; i < n; i++)
      image[i] = way[i] - c[i] * image[i];
    double share = now / sum_of_products(n, way, image), before = now;
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
      x[i] += share * way[i];
      rest[i] -= share * image[i];
    }
    now = sum_of_products(n, rest, rest);
    double ratio = now / before;
#pragma omp simd
    for (size_t i = 0; i < n; i++)
      way[i] = rest[i] + ratio * way[i];
    bar->iterations++;
  }
  if (!(now <= target))
    return gamut_fail(bar->run, GAMUT_NUMERICS,
                      "the tangent system is not solved at load step %llu: %g of the residual is "
                      "left",
                      (unsigned long long)bar->load.step, sqrt(now / target) * enough);
  /* From the scaled unknown to the increment of T. */
  apply_softening(bar, c, x, image);
  for (size_t i = 0; i < n; i++)
    x[i] = (right[i] + image[i]) / sqrt(bar->volume[i]);
  return GAMUT_OK;
}
