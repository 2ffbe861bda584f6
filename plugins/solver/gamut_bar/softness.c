/* Modulus, softness and yield of each bond, from the nominal values and the noise. */
#include "bar.h"

/* Bounds that noise is kept within, so that a modulus stays positive and a softness within 0 and 1.
 * What is kept is counted and reported. */
static const double noise_bound = 0.95;

static void bound(struct bar *bar, double *noise)
{
  for (size_t i = 0; i < bar->bonds; i++) {
    double kept = fmax(-noise_bound, fmin(noise_bound, noise[i]));
    bar->clipped += kept != noise[i];
    noise[i] = kept;
  }
}

static gamut_status scale_by_noise(struct bar *bar, const char *name, double *array)
{
  double *noise = bar->work[2];
  bool given;
  gamut_status status = noise_of_bonds(bar, name, noise, &given);
  if (status != GAMUT_OK)
    return status;
  if (given)
    bound(bar, noise);
  for (size_t i = 0; i < bar->bonds; i++)
    array[i] *= given ? 1.0 + noise[i] : 1.0;
  return GAMUT_OK;
}

/* Ramberg and Osgood's curve of one bond, and its failure point. */
struct curve {
  double modulus, yield, n, K, stress, strain;
};

/* Eq. 30 without cancellation: the share of the elastic energy of a brittle bond that it does not
 * take up at its failure point. */
static double softness_of(const struct curve *c)
{
  double plastic = c->strain - c->stress / c->modulus;
  double ratio = pow(c->stress / c->yield, c->n + 1.0);
  double lost = 0.5 * c->modulus * plastic * plastic + c->K * c->yield / (c->n + 1.0) * ratio;
  return lost / (0.5 * c->modulus * c->strain * c->strain);
}

/* The factor of yield and failure stress at which Eq. 30 gives this softness, strain held. */
static double yield_factor(const struct curve *c, double softness)
{
  double ratio = pow(c->stress / c->yield, c->n + 1.0);
  double a = c->stress * c->strain - c->K * c->yield / (c->n + 1.0) * ratio;
  double b = 0.5 * c->stress * c->stress / c->modulus;
  double taken = (1.0 - softness) * 0.5 * c->modulus * c->strain * c->strain;
  return 2.0 * taken / (a + sqrt(fmax(a * a - 4.0 * b * taken, 0.0)));
}

/* The noise is scaled by what is left to 1, so that a softness stays within 0 and 1. */
static void soften(struct bar *bar, const struct family_law *law, size_t k, double noise)
{
  size_t i = law->from + k;
  struct curve c = {.modulus = bar->stiffness[i],
                    .yield = law->yield[k],
                    .n = law->n[k],
                    .K = law->K[k],
                    .stress = bar->failure_stress};
  c.strain = bar->failure_strain + c.stress * (1.0 / c.modulus - 1.0 / bar->modulus);
  double softness = softness_of(&c);
  bar->limit[i] = c.strain;
  bar->softness[i] = softness * (1.0 + noise * (1.0 - softness));
  bar->yield_factor[i] = yield_factor(&c, bar->softness[i]);
}

static void soften_all(struct bar *bar, const double *noise)
{
  for (size_t l = 0; l < bar->families.laws; l++) {
    const struct family_law *law = &bar->families.law[l];
    for (size_t k = 0; k < law->count; k++)
      soften(bar, law, k, noise[law->from + k]);
  }
}

/* Without noise the factor is 1 but for rounding: the law's own figures then stand. */
static void give_to_laws(struct bar *bar)
{
  for (size_t l = 0; l < bar->families.laws; l++) {
    const struct family_law *law = &bar->families.law[l];
    for (size_t k = 0; k < law->count; k++)
      law->yield[k] *= bar->yield_factor[law->from + k];
  }
}

/* Parameters of the strength that are random fields get their values at the bonds; the moduli of
 * the bonds follow. */
static gamut_status place_laws(struct bar *bar)
{
  double *zero = bar->work[0];
  int64_t *id = (int64_t *)(void *)bar->work[1];
  bool own = gamut_given(GAMUT_HOST(bar->run)->body_values(bar->body), "youngs_modulus");
  for (size_t i = 0; i < bar->bonds; i++) {
    zero[i] = 0.0;
    id[i] = (int64_t)i;
  }
  for (size_t l = 0; l < bar->families.laws; l++) {
    const struct family_law *law = &bar->families.law[l];
    const double *const position[3] = {bar->place + law->from, zero, zero};
    gamut_status status =
        GAMUT_HOST(bar->run)->law_places(bar->run, law->law, position, id + law->from);
    if (status != GAMUT_OK)
      return status;
    for (size_t k = 0; k < law->count; k++)
      bar->stiffness[law->from + k] *= own || !law->modulus ? bar->modulus : law->modulus[k];
  }
  return GAMUT_OK;
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
  gamut_status status = place_laws(bar);
  for (size_t i = 0; i < bar->bonds; i++)
    bar->mass_density[i] *= bar->density;
  if (status == GAMUT_OK)
    status = scale_by_noise(bar, "modulus", bar->stiffness);
  if (status == GAMUT_OK)
    status = scale_by_noise(bar, "density", bar->mass_density);
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
  }
  if (whole)
    soften_all(bar, noise);
  if (any)
    give_to_laws(bar);
  if (bar->clipped)
    gamut_warn(bar->run, "%zu values of noise lay beyond %g and were kept there", bar->clipped,
               noise_bound);
  return GAMUT_OK;
}
