/* Modulus, softness and yield of each bond, from the nominal values and the noise. */
#include "bar.h"

/* Bounds that noise is kept within, so that a modulus stays positive and a softness within 0 and 1.
 * What is kept is counted and told. */
static const double noise_bound = 0.95;

static void bound(struct bar *bar, double *noise)
{
  for (size_t i = 0; i < bar->bonds; i++) {
    double kept = fmax(-noise_bound, fmin(noise_bound, noise[i]));
    bar->clipped += kept != noise[i];
    noise[i] = kept;
  }
}

static gamut_status scale_by_noise(struct bar *bar, const char *name, double nominal, double *array)
{
  double *noise = bar->work[2];
  bool given;
  gamut_status status = noise_of_bonds(bar, name, noise, &given);
  if (status != GAMUT_OK)
    return status;
  if (given)
    bound(bar, noise);
  for (size_t i = 0; i < bar->bonds; i++)
    array[i] *= nominal * (given ? 1.0 + noise[i] : 1.0);
  return GAMUT_OK;
}

/* Eq. 30 without cancellation: the share of the elastic energy of a brittle bond that it does not
 * take up at (stress, strain). */
static double softness_at(const struct bar *bar, double modulus, double stress, double strain)
{
  double plastic = strain - stress / modulus;
  double ratio = pow(stress / bar->yield, bar->n + 1.0);
  double lost = 0.5 * modulus * plastic * plastic + bar->K * bar->yield / (bar->n + 1.0) * ratio;
  return lost / (0.5 * modulus * strain * strain);
}

/* The factor of yield and failure stress at which Eq. 30 gives this softness, strain held. */
static double yield_factor(const struct bar *bar, double modulus, double strain, double softness)
{
  double ratio = pow(bar->failure_stress / bar->yield, bar->n + 1.0);
  double a = bar->failure_stress * strain - bar->K * bar->yield / (bar->n + 1.0) * ratio;
  double b = 0.5 * bar->failure_stress * bar->failure_stress / modulus;
  double taken = (1.0 - softness) * 0.5 * modulus * strain * strain;
  return 2.0 * taken / (a + sqrt(fmax(a * a - 4.0 * b * taken, 0.0)));
}

/* The noise is scaled by what is left to 1, so that a softness stays within 0 and 1. */
static void soften(struct bar *bar, size_t i, double noise)
{
  double E = bar->stiffness[i], stress = bar->failure_stress;
  double strain = bar->failure_strain + stress * (1.0 / E - 1.0 / bar->modulus);
  double softness = softness_at(bar, E, stress, strain);
  bar->limit[i] = strain;
  bar->softness[i] = softness * (1.0 + noise * (1.0 - softness));
  bar->yield_factor[i] = yield_factor(bar, E, strain, bar->softness[i]);
}

static void give_to_laws(struct bar *bar)
{
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  for (size_t c = 0; c < bar->families.laws; c++) {
    double *yield = host->law_array(bar->families.law[c].law, "yield_stress");
    size_t from = c * FAMILY_CHUNK;
    for (size_t i = 0; i < FAMILY_CHUNK && from + i < bar->bonds; i++)
      yield[i] = bar->yield * bar->yield_factor[from + i];
  }
}

static gamut_status needs_curve(struct bar *bar)
{
  return gamut_fail_at(bar->run, bar->values, "noise", "ramberg_osgood with a failure pair",
                       "noise and tables of softness need the strength ramberg_osgood with "
                       "failure_stress and failure_strain");
}

gamut_status softness_new(struct bar *bar)
{
  double *noise = bar->work[3];
  bool given, any = false,
              whole = bar->n > 0.0 && bar->failure_stress > 0.0 && bar->failure_strain > 0.0;
  gamut_status status = scale_by_noise(bar, "modulus", bar->modulus, bar->stiffness);
  if (status == GAMUT_OK)
    status = scale_by_noise(bar, "density", bar->density, bar->mass_density);
  if (status == GAMUT_OK)
    status = noise_of_bonds(bar, "softness", noise, &given);
  if (status != GAMUT_OK)
    return status;
  for (size_t i = 0; i < bar->bonds; i++) {
    noise[i] = bar->softness[i] + (given ? noise[i] : 0.0);
    any |= noise[i] != 0.0;
  }
  if ((any || bar->random) && !whole)
    return needs_curve(bar);
  bound(bar, noise);
  for (size_t i = 0; i < bar->bonds; i++) {
    bar->limit[i] = bar->failure_strain > 0.0 ? bar->failure_strain : HUGE_VAL;
    bar->softness[i] = 1.0;
    bar->yield_factor[i] = 1.0;
    if (whole)
      soften(bar, i, noise[i]);
  }
  /* Without noise the factor is 1 but for rounding: the law's own figures then stand. */
  if (any)
    give_to_laws(bar);
  if (bar->clipped)
    gamut_warn(bar->run, "%zu values of noise lay beyond %g and were kept there", bar->clipped,
               noise_bound);
  return GAMUT_OK;
}
