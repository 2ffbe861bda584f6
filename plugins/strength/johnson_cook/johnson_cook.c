#include "johnson_cook.gamut.h"

/* The three factors at one point, with what their slopes and derivatives need. Arguments are
 * compared such that NaN goes through to the flow stress. */
struct factors {
  double strain, log_strain, power; /* plastic strain, its logarithm, plastic_strain^n */
  double rate, log_rate;            /* r, ln r */
  double warmth, warmth_positive;   /* T*, and not below a tiny number */
  double log_warmth, heat;          /* ln T*, T*^m */
};

GAMUT_INLINE struct factors factors_of(double n, double m, double strain, double rate, double room,
                                       double melt, double temperature)
{
  const double least = 1e-300; /* keeps logarithms and quotients finite */
  struct factors f;
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

GAMUT_INLINE void law(const struct johnson_cook *b, size_t i, double plastic_strain_rate)
{
  double n = b->n[i], C = b->C[i], m = b->m[i], strain = b->plastic_strain[i];
  struct factors f = factors_of(n, m, strain, plastic_strain_rate / b->reference_rate[i],
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

static void flow_stress(const struct johnson_cook *b)
{
  GAMUT_EACH (i, b)
    law(b, i, b->plastic_strain_rate[i]);
}

/* With C = 0: the same numbers, the rate is not looked at. */
static void rate_independent(const struct johnson_cook *b)
{
  GAMUT_EACH (i, b)
    law(b, i, 0.0);
}

/* Arrays that the core does not want are null; each loop fills one that it does. */
#define FILL(array, value)                                                                         \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b) {                                                                          \
        struct terms t = terms_of(b, i);                                                           \
        b->array[i] = (value);                                                                     \
      }                                                                                            \
  } while (0)
#define FILL_ZERO(array)                                                                           \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b)                                                                            \
        b->array[i] = 0.0;                                                                         \
  } while (0)

struct terms {
  double h, hl, hll; /* plastic_strain^n times 1, ln, ln^2 of plastic strain */
  double q, ql, qll; /* T*^m times 1, ln, ln^2 of T* */
  double B, log_rate, hardening, rate_factor, softening;
};

GAMUT_INLINE struct terms terms_of(const struct johnson_cook *b, size_t i)
{
  struct factors f = factors_of(b->n[i], b->m[i], b->plastic_strain[i],
                                b->plastic_strain_rate[i] / b->reference_rate[i], b->T_room[i],
                                b->T_melt[i], b->temperature[i]);
  return (struct terms){.h = f.power,
                        .hl = f.power * f.log_strain,
                        .hll = f.power * f.log_strain * f.log_strain,
                        .q = f.heat,
                        .ql = f.heat * f.log_warmth,
                        .qll = f.heat * f.log_warmth * f.log_warmth,
                        .B = b->B[i],
                        .log_rate = f.log_rate,
                        .hardening = b->A[i] + b->B[i] * f.power,
                        .rate_factor = 1.0 + b->C[i] * f.log_rate,
                        .softening = 1.0 - f.heat};
}

static void derivatives(const struct johnson_cook *b)
{
  FILL(flow_stress_by_A, t.rate_factor * t.softening);
  FILL(flow_stress_by_B, t.h * t.rate_factor * t.softening);
  FILL(flow_stress_by_C, t.hardening * t.log_rate * t.softening);
  FILL(flow_stress_by_n, t.B * t.hl * t.rate_factor * t.softening);
  FILL(flow_stress_by_m, -t.hardening * t.rate_factor * t.ql);
  FILL_ZERO(flow_stress_by_A_A);
  FILL_ZERO(flow_stress_by_A_B);
  FILL(flow_stress_by_A_C, t.log_rate * t.softening);
  FILL_ZERO(flow_stress_by_A_n);
  FILL(flow_stress_by_A_m, -t.rate_factor * t.ql);
  FILL_ZERO(flow_stress_by_B_B);
  FILL(flow_stress_by_B_C, t.h * t.log_rate * t.softening);
  FILL(flow_stress_by_B_n, t.hl * t.rate_factor * t.softening);
  FILL(flow_stress_by_B_m, -t.h * t.rate_factor * t.ql);
  FILL_ZERO(flow_stress_by_C_C);
  FILL(flow_stress_by_C_n, t.B * t.hl * t.log_rate * t.softening);
  FILL(flow_stress_by_C_m, -t.hardening * t.log_rate * t.ql);
  FILL(flow_stress_by_n_n, t.B * t.hll * t.rate_factor * t.softening);
  FILL(flow_stress_by_n_m, -t.B * t.hl * t.rate_factor * t.ql);
  FILL(flow_stress_by_m_m, -t.hardening * t.rate_factor * t.qll);
}

GAMUT_STRENGTH(johnson_cook, .flow_stress = flow_stress, .rate_independent = rate_independent,
               .derivatives = derivatives)
