#include "wrong_slope.gamut.h"

static void flow_stress(const struct wrong_slope *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = 1.001 * b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(wrong_slope, .flow_stress = flow_stress)
