#include <fenv.h>

#include "floating_point_flags.gamut.h"

__attribute__((constructor)) static void spoil(void)
{
  fesetround(FE_UPWARD);
}

static void flow_stress(const struct floating_point_flags *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(floating_point_flags, .flow_stress = flow_stress)
