/* Energy: work of the ends, elastic energy of the bonds, plastic work of the families. The two are
 * booked from different sides, so the residual shows whether the weights conserve. */
#include <string.h>

#include "bar.h"

gamut_status ledger_new(struct bar *bar)
{
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  static const char account[] = "energy", unit[] = "J";
  gamut_status status =
      host->ledger(bar->run, account, "elastic", unit, GAMUT_STORED, &bar->stored);
  if (status == GAMUT_OK)
    status =
        host->ledger(bar->run, account, "work of the ends", unit, GAMUT_SUPPLIED, &bar->supplied);
  if (status == GAMUT_OK)
    status = host->ledger(bar->run, account, "plastic work", unit, GAMUT_LOST, &bar->lost);
  if (status == GAMUT_OK && bar->dynamic)
    status =
        host->ledger(bar->run, account, "inertia and its damping", unit, GAMUT_LOST, &bar->damped);
  return status;
}

static double elastic_energy(const struct bar *bar)
{
  double sum = 0.0;
  for (size_t i = 0; i < bar->bonds; i++)
    sum += bar->volume[i] * bar->stress[i] * bar->stress[i] / (2.0 * bar->stiffness[i]);
  return sum;
}

/* Work on the families: mean stress of the step, shared by the weights, times plastic strain. */
static double plastic_work(struct bar *bar)
{
  double *mean = bar->work[0], *shared = bar->work[1], sum = 0.0;
  for (size_t i = 0; i < bar->bonds; i++)
    mean[i] = 0.5 * (bar->stress[i] + bar->old_stress[i]);
  weights_apply(bar, mean, shared, bar->work[7]);
  for (size_t i = 0; i < bar->bonds; i++)
    sum += bar->volume[i] * shared[i] * (bar->families.trial_plastic[i] - bar->families.plastic[i]);
  return sum;
}

void ledger_step(struct bar *bar, double old_force, double old_strain)
{
  double mean = 0.5 * (bar->force + old_force), before = *bar->stored;
  double work = mean * bar->span * (bar->mean_strain - old_strain);
  double plastic = plastic_work(bar);
  *bar->stored = elastic_energy(bar);
  *bar->supplied += work;
  *bar->lost += plastic;
  if (bar->dynamic)
    *bar->damped += work - plastic - (*bar->stored - before);
}
