#include "negative_flow_stress.gamut.h"

static void flow_stress(const struct negative_flow_stress *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] - b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = -b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(negative_flow_stress, .flow_stress = flow_stress)
