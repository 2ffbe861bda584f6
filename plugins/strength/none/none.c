#include "none.gamut.h"

static void none_flow_stress(const struct none *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = 0.0;
    b->flow_stress_slope_plastic_strain[i] = 0.0;
  }
}

GAMUT_STRENGTH(none, .flow_stress = none_flow_stress)
