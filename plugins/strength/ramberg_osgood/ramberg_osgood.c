#include "ramberg_osgood.gamut.h"

/* Keeps logarithms and quotients finite. */
static const double ramberg_osgood_least = 1e-300;

/* What the law and its derivatives are made of: q = plastic_strain / K. */
struct ramberg_osgood_terms {
  double stress, K, n, log_q, power; /* yield_stress, .., ln q, q^(1/n) */
};

GAMUT_INLINE struct ramberg_osgood_terms ramberg_osgood_terms_of(const struct ramberg_osgood *b,
                                                                 size_t i)
{
  double q = b->plastic_strain[i] / b->K[i];
  struct ramberg_osgood_terms t = {.stress = b->yield_stress[i], .K = b->K[i], .n = b->n[i]};
  t.log_q = q <= ramberg_osgood_least
                ? 0.0
                : gamut_log(q <= ramberg_osgood_least ? ramberg_osgood_least : q);
  t.power = q <= ramberg_osgood_least ? 0.0 : gamut_exp(t.log_q / t.n);
  return t;
}

static void ramberg_osgood_flow_stress(const struct ramberg_osgood *b)
{
  GAMUT_EACH (i, b) {
    struct ramberg_osgood_terms t = ramberg_osgood_terms_of(b, i);
    double strain = b->plastic_strain[i], stress = t.stress * t.power;
    double divisor = t.n * (strain <= ramberg_osgood_least ? ramberg_osgood_least : strain);
    b->flow_stress[i] = stress;
    b->flow_stress_slope_plastic_strain[i] = t.power > 0.0 ? stress / divisor : 0.0;
    GAMUT_FLAG(b, i, strain < 0.0, RAMBERG_OSGOOD_NEGATIVE_PLASTIC_STRAIN);
    GAMUT_FLAG(b, i, !(stress >= 0.0), RAMBERG_OSGOOD_NOT_FINITE);
  }
}

static void ramberg_osgood_inverse(const struct ramberg_osgood *b)
{
  GAMUT_EACH (i, b) {
    double q = b->flow_stress_given[i] / b->yield_stress[i];
    double strain =
        b->K[i] *
        gamut_exp(b->n[i] * gamut_log(q <= ramberg_osgood_least ? ramberg_osgood_least : q));
    b->plastic_strain_inverse[i] = q <= 0.0 ? 0.0 : strain;
  }
}

/* Arrays that the core does not want are null; each loop fills one that it does. */
#define RAMBERG_OSGOOD_FILL(array, value)                                                          \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b) {                                                                          \
        struct ramberg_osgood_terms t = ramberg_osgood_terms_of(b, i);                             \
        b->array[i] = (value);                                                                     \
      }                                                                                            \
  } while (0)

static void ramberg_osgood_derivatives(const struct ramberg_osgood *b)
{
  RAMBERG_OSGOOD_FILL(flow_stress_by_yield_stress, t.power);
  RAMBERG_OSGOOD_FILL(flow_stress_by_n, -t.stress * t.power * t.log_q / (t.n * t.n));
  RAMBERG_OSGOOD_FILL(flow_stress_by_K, -t.stress * t.power / (t.n * t.K));
  RAMBERG_OSGOOD_FILL(flow_stress_by_yield_stress_yield_stress, 0.0 * t.power);
  RAMBERG_OSGOOD_FILL(flow_stress_by_yield_stress_n, -t.power * t.log_q / (t.n * t.n));
  RAMBERG_OSGOOD_FILL(flow_stress_by_yield_stress_K, -t.power / (t.n * t.K));
  RAMBERG_OSGOOD_FILL(flow_stress_by_n_n,
                      t.stress * t.power * t.log_q * (t.log_q / t.n + 2.0) / (t.n * t.n * t.n));
  RAMBERG_OSGOOD_FILL(flow_stress_by_n_K,
                      t.stress * t.power * (t.log_q / t.n + 1.0) / (t.n * t.n * t.K));
  RAMBERG_OSGOOD_FILL(flow_stress_by_K_K,
                      t.stress * t.power * (1.0 + 1.0 / t.n) / (t.n * t.K * t.K));
}

GAMUT_STRENGTH(ramberg_osgood, .flow_stress = ramberg_osgood_flow_stress,
               .inverse = ramberg_osgood_inverse, .derivatives = ramberg_osgood_derivatives)
