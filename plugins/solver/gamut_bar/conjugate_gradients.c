/* Newton's linear system in its symmetric, positive form: (1 - c H c) x = c b with H = w Q w
 * (scaled by V^1/2), c = sqrt(slope). Its eigenvalues lie between the least E_t / E and 1, whatever
 * the number of bonds. Letters of the method of conjugate gradients as in Golub and Van Loan,
 * Matrix Computations: residual r, direction p, its image Ap, rho = r.r, steps alpha and beta. */
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
  double *c = bar->work[2], *r = bar->work[3], *p = bar->work[4], *Ap = bar->work[5];
  for (size_t i = 0; i < n; i++) {
    c[i] = sqrt(slope[i]);
    x[i] = 0.0;
    right[i] *= sqrt(bar->volume[i]);
    r[i] = p[i] = c[i] * right[i];
  }
  double rho = sum_of_products(n, r, r), target = enough * enough * rho;
  for (int round = 0; round < ROUNDS && rho > target; round++) {
    apply_softening(bar, c, p, Ap);
#pragma omp simd
    for (size_t i = 0; i < n; i++)
      Ap[i] = p[i] - c[i] * Ap[i];
    double alpha = rho / sum_of_products(n, p, Ap), before = rho;
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
      x[i] += alpha * p[i];
      r[i] -= alpha * Ap[i];
    }
    rho = sum_of_products(n, r, r);
    double beta = rho / before;
#pragma omp simd
    for (size_t i = 0; i < n; i++)
      p[i] = r[i] + beta * p[i];
    bar->iterations++;
  }
  if (!(rho <= target))
    return gamut_fail(bar->run, GAMUT_NUMERICS,
                      "the tangent system is not solved at load step %llu: %g of the residual is "
                      "left",
                      (unsigned long long)bar->load.step, sqrt(rho / target) * enough);
  /* From the scaled unknown to the increment of T. */
  apply_softening(bar, c, x, Ap);
  for (size_t i = 0; i < n; i++)
    x[i] = (right[i] + Ap[i]) / sqrt(bar->volume[i]);
  return GAMUT_OK;
}
