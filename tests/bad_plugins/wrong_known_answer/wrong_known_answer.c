#include "wrong_known_answer.gamut.h"

static void flow_stress(const struct wrong_known_answer *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(wrong_known_answer, .flow_stress = flow_stress)
