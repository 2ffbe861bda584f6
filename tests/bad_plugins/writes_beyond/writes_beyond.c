#include "writes_beyond.gamut.h"

static void flow_stress(const struct writes_beyond *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
  b->flow_stress[b->count] = 0;
}

GAMUT_STRENGTH(writes_beyond, .flow_stress = flow_stress)
