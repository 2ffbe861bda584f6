#include "leaves_unwritten.gamut.h"

static void flow_stress(const struct leaves_unwritten *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    if (b->plastic_strain[i] > 0.5)
      b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(leaves_unwritten, .flow_stress = flow_stress)
