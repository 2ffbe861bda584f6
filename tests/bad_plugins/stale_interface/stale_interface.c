#include "stale_interface.gamut.h"

static void flow_stress(const struct stale_interface *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening[i];
  }
}

GAMUT_STRENGTH(stale_interface, .flow_stress = flow_stress)
