#include "@NAME@.gamut.h"

static void @NAME@_flow_stress(const struct @NAME@ *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(@NAME@, .flow_stress = @NAME@_flow_stress)
