#include "von_mises.gamut.h"

static void von_mises_flow_stress(const struct von_mises *b)
{
  GAMUT_EACH (i, b) {
    double stress = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress[i] = stress < 0.0 ? 0.0 : stress;
    b->flow_stress_slope_plastic_strain[i] = stress < 0.0 ? 0.0 : b->hardening_modulus[i];
    GAMUT_FLAG(b, i, stress < 0.0, VON_MISES_EXHAUSTED);
  }
}

GAMUT_STRENGTH(von_mises, .flow_stress = von_mises_flow_stress)
