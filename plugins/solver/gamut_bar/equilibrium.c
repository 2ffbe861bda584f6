/* One load step: T such that T = w (stress + E w pi(T)), by Newton with a line search. */
#include <string.h>

#include "bar.h"

/* Of the largest T; where rounding allows no more, the second will do. */
static const double wanted = 2e-14, enough = 1e-11;

/* Residual at T; leaves w pi in bar->flow and the stress of every bond in bar->stress. */
static gamut_status residual(struct bar *bar, const double *T, double *r)
{
  double *elastic = bar->work[1], *work = bar->work[7];
  gamut_status status = families_evaluate(bar, T);
  if (status != GAMUT_OK)
    return status;
  weights_apply(bar, bar->families.trial_plastic, bar->flow, work);
  if (bar->dynamic)
    inertia_stress(bar, bar->flow, bar->stress);
  else
    for (size_t i = 0; i < bar->bonds; i++)
      bar->stress[i] = bar->force / bar->section[i];
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    elastic[i] = bar->stress[i] + bar->stiffness[i] * bar->flow[i];
  weights_apply(bar, elastic, r, work);
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    r[i] = T[i] - r[i];
  return GAMUT_OK;
}

/* Goes from T along `way` by the largest of 1, 1/2, .. that helps; residual in r. */
static gamut_status line_search(struct bar *bar, const double *way, double before, double *T,
                                double *r, bool *better)
{
  *better = true;
  static const double least = 1e-4;
  double *from = bar->work[9];
  memcpy(from, T, bar->bonds * sizeof *T);
  for (double share = 1.0;; share *= 0.5) {
#pragma omp simd
    for (size_t i = 0; i < bar->bonds; i++)
      T[i] = from[i] + share * way[i];
    gamut_status status = residual(bar, T, r);
    if (status != GAMUT_OK)
      return status;
    double now = largest(bar->bonds, r);
    if (now < before * (1.0 - 0.1 * share) || now <= wanted * largest(bar->bonds, T))
      return GAMUT_OK;
    *better = fmax(now, before) > enough * largest(bar->bonds, T);
    if (!*better)
      return GAMUT_OK;
    if (share < least)
      return gamut_fail(bar->run, GAMUT_NUMERICS,
                        "no equilibrium at load step %llu, force %g N: residual %g Pa",
                        (unsigned long long)bar->load.step, bar->force, now);
  }
}

/* As if the step were elastic. */
static void predict(struct bar *bar, double force)
{
  double *grown = bar->work[0], *more = bar->work[1], *work = bar->work[7];
  for (size_t i = 0; i < bar->bonds; i++)
    grown[i] = (force - bar->force) / bar->section[i];
  weights_apply(bar, grown, more, work);
  for (size_t i = 0; i < bar->bonds; i++)
    bar->internal[i] += more[i];
}

static void settle(struct bar *bar)
{
  double sum = 0.0;
  for (size_t i = 0; i < bar->bonds; i++) {
    bar->strain[i] = bar->stress[i] / bar->stiffness[i] + bar->flow[i];
    sum += bar->length[i] * bar->strain[i];
  }
  bar->mean_strain = sum / bar->span;
  bar->nominal_stress = bar->force / bar->area;
}

gamut_status equilibrium(struct bar *bar, double force)
{
  enum { ROUNDS = 100 };
  double *r = bar->work[8], *way = bar->work[10], *T = bar->internal;
  size_t n = bar->bonds;
  predict(bar, force);
  bar->force = force;
  if (bar->dynamic)
    inertia_begin(bar, force);
  gamut_status status = residual(bar, T, r);
  bool better = true;
  for (int round = 0; status == GAMUT_OK && better; round++) {
    double most = largest(n, r);
    if (most <= wanted * fmax(largest(n, T), 1.0))
      break;
    if (round == ROUNDS || !(most < HUGE_VAL))
      return gamut_fail(bar->run, GAMUT_NUMERICS,
                        "no equilibrium at load step %llu, force %g N, after %d rounds: residual "
                        "%g Pa",
                        (unsigned long long)bar->load.step, force, round, most);
    for (size_t i = 0; i < n; i++)
      bar->work[11][i] = -r[i];
    status = solve_tangent(bar, bar->families.trial_slope, bar->work[11], way);
    if (status == GAMUT_OK)
      status = line_search(bar, way, most, T, r, &better);
    bar->newton++;
  }
  if (status == GAMUT_OK)
    settle(bar);
  return status;
}
