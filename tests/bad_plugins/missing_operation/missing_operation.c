#include "missing_operation.gamut.h"

static void flow_stress(const struct missing_operation *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(missing_operation, .derivatives = flow_stress)
