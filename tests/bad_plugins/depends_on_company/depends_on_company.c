#include "depends_on_company.gamut.h"

static void flow_stress(const struct depends_on_company *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[0];
    b->flow_stress_slope_plastic_strain[i] = 0;
  }
}

GAMUT_STRENGTH(depends_on_company, .flow_stress = flow_stress)
