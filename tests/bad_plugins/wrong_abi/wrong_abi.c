#include "wrong_abi.gamut.h"

#undef GAMUT_ABI
#define GAMUT_ABI 999

static void flow_stress(const struct wrong_abi *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(wrong_abi, .flow_stress = flow_stress)
