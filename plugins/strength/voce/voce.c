#include "voce.gamut.h"

/* Where Q2 is 0 the second term is left out, with its exponential: the same numbers. */
GAMUT_INLINE void voce_law(const struct voce *b, size_t i, bool two_terms)
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

static void voce_flow_stress(const struct voce *b)
{
  GAMUT_EACH (i, b)
    voce_law(b, i, true);
}

static void voce_one_term(const struct voce *b)
{
  GAMUT_EACH (i, b)
    voce_law(b, i, false);
}

/* Arrays that the core does not want are null; each loop fills one that it does. */
#define VOCE_FILL(array, value)                                                                    \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b)                                                                            \
        b->array[i] = (value);                                                                     \
  } while (0)

/* The flow stress is linear in y0, Q1, Q2 and h: only b1 and b2 have second derivatives. */
static void voce_zero_derivatives(const struct voce *b)
{
  VOCE_FILL(flow_stress_by_y0_y0, 0.0);
  VOCE_FILL(flow_stress_by_y0_Q1, 0.0);
  VOCE_FILL(flow_stress_by_y0_b1, 0.0);
  VOCE_FILL(flow_stress_by_y0_Q2, 0.0);
  VOCE_FILL(flow_stress_by_y0_b2, 0.0);
  VOCE_FILL(flow_stress_by_y0_h, 0.0);
  VOCE_FILL(flow_stress_by_Q1_Q1, 0.0);
  VOCE_FILL(flow_stress_by_Q1_Q2, 0.0);
  VOCE_FILL(flow_stress_by_Q1_b2, 0.0);
  VOCE_FILL(flow_stress_by_Q1_h, 0.0);
  VOCE_FILL(flow_stress_by_b1_Q2, 0.0);
  VOCE_FILL(flow_stress_by_b1_b2, 0.0);
  VOCE_FILL(flow_stress_by_b1_h, 0.0);
  VOCE_FILL(flow_stress_by_Q2_Q2, 0.0);
  VOCE_FILL(flow_stress_by_Q2_h, 0.0);
  VOCE_FILL(flow_stress_by_b2_h, 0.0);
  VOCE_FILL(flow_stress_by_h_h, 0.0);
}

/* 1 - exp(-b strain) and strain exp(-b strain) of both terms, a number a point: exponentials are
 * taken once, whatever the core wants. */
struct voce_terms {
  double filled1[GAMUT_CHUNK_MAX], left1[GAMUT_CHUNK_MAX];
  double filled2[GAMUT_CHUNK_MAX], left2[GAMUT_CHUNK_MAX];
};

static void voce_find_terms(const struct voce *b, struct voce_terms *t)
{
  GAMUT_EACH (i, b) {
    double strain = b->plastic_strain[i], x1 = -b->b1[i] * strain, x2 = -b->b2[i] * strain;
    t->filled1[i] = -gamut_expm1(x1);
    t->left1[i] = strain * gamut_exp(x1);
    t->filled2[i] = -gamut_expm1(x2);
    t->left2[i] = strain * gamut_exp(x2);
  }
}

static void voce_derivatives(const struct voce *b)
{
  const double *strain = b->plastic_strain;
  struct voce_terms voce_terms, *t = &voce_terms;
  voce_find_terms(b, t);
  VOCE_FILL(flow_stress_by_y0, 1.0);
  VOCE_FILL(flow_stress_by_Q1, t->filled1[i]);
  VOCE_FILL(flow_stress_by_b1, b->Q1[i] * t->left1[i]);
  VOCE_FILL(flow_stress_by_Q2, t->filled2[i]);
  VOCE_FILL(flow_stress_by_b2, b->Q2[i] * t->left2[i]);
  VOCE_FILL(flow_stress_by_h, strain[i]);
  VOCE_FILL(flow_stress_by_Q1_b1, t->left1[i]);
  VOCE_FILL(flow_stress_by_b1_b1, -b->Q1[i] * strain[i] * t->left1[i]);
  VOCE_FILL(flow_stress_by_Q2_b2, t->left2[i]);
  VOCE_FILL(flow_stress_by_b2_b2, -b->Q2[i] * strain[i] * t->left2[i]);
  voce_zero_derivatives(b);
}

GAMUT_STRENGTH(voce, .flow_stress = voce_flow_stress, .derivatives = voce_derivatives,
               .one_term = voce_one_term)
