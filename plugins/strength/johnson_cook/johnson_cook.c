#include "johnson_cook.gamut.h"

/* The three factors at one point, with what their slopes and derivatives need. Arguments are
 * compared such that NaN goes through to the flow stress. */
struct johnson_cook_factors {
  double strain, log_strain, power; /* plastic strain, its logarithm, plastic_strain^n */
  double rate, log_rate;            /* r, ln r */
  double warmth, warmth_positive;   /* T*, and not below a tiny number */
  double log_warmth, heat;          /* ln T*, T*^m */
};

GAMUT_INLINE struct johnson_cook_factors johnson_cook_factors_of(double n, double m, double strain,
                                                                 double rate, double room,
                                                                 double melt, double temperature)
{
  const double least = 1e-300; /* keeps logarithms and quotients finite */
  struct johnson_cook_factors f;
  f.strain = strain <= least ? least : strain;
  f.log_strain = strain <= 0.0 ? 0.0 : gamut_log(f.strain);
  f.power = strain <= 0.0 ? 0.0 : gamut_exp(n * f.log_strain);
  f.rate = rate <= 1.0 ? 1.0 : rate;
  f.log_rate = gamut_log(f.rate);
  double warmth = (temperature - room) / (melt - room);
  f.warmth = warmth <= 0.0 ? 0.0 : warmth >= 1.0 ? 1.0 : warmth;
  f.warmth_positive = f.warmth <= least ? least : f.warmth;
  f.log_warmth = f.warmth <= 0.0 ? 0.0 : gamut_log(f.warmth_positive);
  f.heat = f.warmth <= 0.0 ? 0.0 : gamut_exp(m * f.log_warmth);
  return f;
}

GAMUT_INLINE void johnson_cook_law(const struct johnson_cook *b, size_t i,
                                   double plastic_strain_rate)
{
  double n = b->n[i], C = b->C[i], m = b->m[i], strain = b->plastic_strain[i];
  struct johnson_cook_factors f =
      johnson_cook_factors_of(n, m, strain, plastic_strain_rate / b->reference_rate[i],
                              b->T_room[i], b->T_melt[i], b->temperature[i]);
  double hardening = b->A[i] + b->B[i] * f.power;
  double rate_factor = 1.0 + C * f.log_rate, softening = 1.0 - f.heat;
  double stress = hardening * rate_factor * softening;
  b->flow_stress[i] = stress;
  b->flow_stress_slope_plastic_strain[i] =
      strain <= 0.0 ? 0.0 : n * b->B[i] * f.power / f.strain * rate_factor * softening;
  b->flow_stress_slope_plastic_strain_rate[i] =
      f.rate <= 1.0 ? 0.0 : hardening * softening * C / (f.rate * b->reference_rate[i]);
  double slope = f.heat / f.warmth_positive * m / (b->T_melt[i] - b->T_room[i]);
  b->flow_stress_slope_temperature[i] = f.warmth >= 1.0 ? 0.0 : -hardening * rate_factor * slope;
  GAMUT_FLAG(b, i, f.warmth >= 1.0, JOHNSON_COOK_MELTED);
  GAMUT_FLAG(b, i, strain < 0.0, JOHNSON_COOK_NEGATIVE_PLASTIC_STRAIN);
  GAMUT_FLAG(b, i, !(stress >= 0.0), JOHNSON_COOK_NOT_FINITE);
}

static void johnson_cook_flow_stress(const struct johnson_cook *b)
{
  GAMUT_EACH (i, b)
    johnson_cook_law(b, i, b->plastic_strain_rate[i]);
}

/* With C = 0: the same numbers, the rate is not looked at. */
static void johnson_cook_rate_independent(const struct johnson_cook *b)
{
  GAMUT_EACH (i, b)
    johnson_cook_law(b, i, 0.0);
}

/* What derivatives are made of, a number a point: exponentials and logarithms are taken once,
 * whatever the core wants. */
struct johnson_cook_terms {
  double h[GAMUT_CHUNK_MAX], hl[GAMUT_CHUNK_MAX],
      hll[GAMUT_CHUNK_MAX]; /* strain^n, times ln, ln^2 */
  double q[GAMUT_CHUNK_MAX], ql[GAMUT_CHUNK_MAX], qll[GAMUT_CHUNK_MAX]; /* T*^m, likewise */
  double log_rate[GAMUT_CHUNK_MAX];
  double hardening[GAMUT_CHUNK_MAX], rate_factor[GAMUT_CHUNK_MAX], softening[GAMUT_CHUNK_MAX];
};

static void johnson_cook_find_terms(const struct johnson_cook *b, struct johnson_cook_terms *t)
{
  GAMUT_EACH (i, b) {
    struct johnson_cook_factors f = johnson_cook_factors_of(
        b->n[i], b->m[i], b->plastic_strain[i], b->plastic_strain_rate[i] / b->reference_rate[i],
        b->T_room[i], b->T_melt[i], b->temperature[i]);
    t->h[i] = f.power;
    t->hl[i] = f.power * f.log_strain;
    t->hll[i] = f.power * f.log_strain * f.log_strain;
    t->q[i] = f.heat;
    t->ql[i] = f.heat * f.log_warmth;
    t->qll[i] = f.heat * f.log_warmth * f.log_warmth;
    t->log_rate[i] = f.log_rate;
    t->hardening[i] = b->A[i] + b->B[i] * f.power;
    t->rate_factor[i] = 1.0 + b->C[i] * f.log_rate;
    t->softening[i] = 1.0 - f.heat;
  }
}

/* Arrays that the core does not want are null. */
#define JOHNSON_COOK_FILL(array, value)                                                            \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b)                                                                            \
        b->array[i] = (value);                                                                     \
  } while (0)

static void johnson_cook_first_derivatives(const struct johnson_cook *b,
                                           const struct johnson_cook_terms *t)
{
  JOHNSON_COOK_FILL(flow_stress_by_A, t->rate_factor[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_B, t->h[i] * t->rate_factor[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_C, t->hardening[i] * t->log_rate[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_n, b->B[i] * t->hl[i] * t->rate_factor[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_m, -t->hardening[i] * t->rate_factor[i] * t->ql[i]);
}

static void johnson_cook_derivatives(const struct johnson_cook *b)
{
  struct johnson_cook_terms johnson_cook_terms, *t = &johnson_cook_terms;
  johnson_cook_find_terms(b, t);
  johnson_cook_first_derivatives(b, t);
  JOHNSON_COOK_FILL(flow_stress_by_A_A, 0.0);
  JOHNSON_COOK_FILL(flow_stress_by_A_B, 0.0);
  JOHNSON_COOK_FILL(flow_stress_by_A_C, t->log_rate[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_A_n, 0.0);
  JOHNSON_COOK_FILL(flow_stress_by_A_m, -t->rate_factor[i] * t->ql[i]);
  JOHNSON_COOK_FILL(flow_stress_by_B_B, 0.0);
  JOHNSON_COOK_FILL(flow_stress_by_B_C, t->h[i] * t->log_rate[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_B_n, t->hl[i] * t->rate_factor[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_B_m, -t->h[i] * t->rate_factor[i] * t->ql[i]);
  JOHNSON_COOK_FILL(flow_stress_by_C_C, 0.0);
  JOHNSON_COOK_FILL(flow_stress_by_C_n, b->B[i] * t->hl[i] * t->log_rate[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_C_m, -t->hardening[i] * t->log_rate[i] * t->ql[i]);
  JOHNSON_COOK_FILL(flow_stress_by_n_n, b->B[i] * t->hll[i] * t->rate_factor[i] * t->softening[i]);
  JOHNSON_COOK_FILL(flow_stress_by_n_m, -b->B[i] * t->hl[i] * t->rate_factor[i] * t->ql[i]);
  JOHNSON_COOK_FILL(flow_stress_by_m_m, -t->hardening[i] * t->rate_factor[i] * t->qll[i]);
}

GAMUT_STRENGTH(johnson_cook, .flow_stress = johnson_cook_flow_stress,
               .derivatives = johnson_cook_derivatives,
               .rate_independent = johnson_cook_rate_independent)
