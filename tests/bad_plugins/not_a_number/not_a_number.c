#include "not_a_number.gamut.h"

static void flow_stress(const struct not_a_number *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + 1e8 * log(b->plastic_strain[i] - 0.1);
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(not_a_number, .flow_stress = flow_stress)
