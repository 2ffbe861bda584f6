#include "voce.gamut.h"

/* Where Q2 is 0 the second term is left out: the same numbers in half the time. */
GAMUT_INLINE void law(const struct voce *b, size_t i, bool two_terms)
{
  double strain = b->plastic_strain[i], rest1 = gamut_expm1(-b->b1[i] * strain);
  double rest2 = two_terms ? gamut_expm1(-b->b2[i] * strain) : 0.0;
  double second = two_terms ? b->Q2[i] * rest2 : 0.0;
  double second_slope = two_terms ? b->Q2[i] * b->b2[i] * (1.0 + rest2) : 0.0;
  double stress = b->y0[i] - b->Q1[i] * rest1 - second + b->h[i] * strain;
  b->flow_stress[i] = stress < 0.0 ? 0.0 : stress;
  b->flow_stress_slope_plastic_strain[i] =
      b->Q1[i] * b->b1[i] * (1.0 + rest1) + second_slope + b->h[i];
  GAMUT_FLAG(b, i, strain < 0.0, VOCE_NEGATIVE_PLASTIC_STRAIN);
  GAMUT_FLAG(b, i, stress < 0.0, VOCE_EXHAUSTED);
  GAMUT_FLAG(b, i, stress != stress, VOCE_NOT_FINITE);
}

static void flow_stress(const struct voce *b)
{
  GAMUT_EACH (i, b)
    law(b, i, true);
}

static void one_term(const struct voce *b)
{
  GAMUT_EACH (i, b)
    law(b, i, false);
}

/* Arrays that the core does not want are null; each loop fills one that it does. */
#define FILL(array, value)                                                                         \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b)                                                                            \
        b->array[i] = (value);                                                                     \
  } while (0)

/* The flow stress is linear in y0, Q1, Q2 and h: only b1 and b2 have second derivatives. */
static void zero_derivatives(const struct voce *b)
{
  FILL(flow_stress_by_y0_y0, 0.0);
  FILL(flow_stress_by_y0_Q1, 0.0);
  FILL(flow_stress_by_y0_b1, 0.0);
  FILL(flow_stress_by_y0_Q2, 0.0);
  FILL(flow_stress_by_y0_b2, 0.0);
  FILL(flow_stress_by_y0_h, 0.0);
  FILL(flow_stress_by_Q1_Q1, 0.0);
  FILL(flow_stress_by_Q1_Q2, 0.0);
  FILL(flow_stress_by_Q1_b2, 0.0);
  FILL(flow_stress_by_Q1_h, 0.0);
  FILL(flow_stress_by_b1_Q2, 0.0);
  FILL(flow_stress_by_b1_b2, 0.0);
  FILL(flow_stress_by_b1_h, 0.0);
  FILL(flow_stress_by_Q2_Q2, 0.0);
  FILL(flow_stress_by_Q2_h, 0.0);
  FILL(flow_stress_by_b2_h, 0.0);
  FILL(flow_stress_by_h_h, 0.0);
}

static void derivatives(const struct voce *b)
{
  const double *strain = b->plastic_strain;
  FILL(flow_stress_by_y0, 1.0);
  FILL(flow_stress_by_Q1, -gamut_expm1(-b->b1[i] * strain[i]));
  FILL(flow_stress_by_b1, b->Q1[i] * strain[i] * gamut_exp(-b->b1[i] * strain[i]));
  FILL(flow_stress_by_Q2, -gamut_expm1(-b->b2[i] * strain[i]));
  FILL(flow_stress_by_b2, b->Q2[i] * strain[i] * gamut_exp(-b->b2[i] * strain[i]));
  FILL(flow_stress_by_h, strain[i]);
  FILL(flow_stress_by_Q1_b1, strain[i] * gamut_exp(-b->b1[i] * strain[i]));
  FILL(flow_stress_by_b1_b1, -b->Q1[i] * strain[i] * strain[i] * gamut_exp(-b->b1[i] * strain[i]));
  FILL(flow_stress_by_Q2_b2, strain[i] * gamut_exp(-b->b2[i] * strain[i]));
  FILL(flow_stress_by_b2_b2, -b->Q2[i] * strain[i] * strain[i] * gamut_exp(-b->b2[i] * strain[i]));
  zero_derivatives(b);
}

GAMUT_STRENGTH(voce, .flow_stress = flow_stress, .one_term = one_term, .derivatives = derivatives)
