#include "keeps_state.gamut.h"

static double last;

static void flow_stress(const struct keeps_state *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + last;
    last = 1e6 * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(keeps_state, .flow_stress = flow_stress)
