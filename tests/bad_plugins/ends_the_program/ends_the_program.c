#include <stdlib.h>

#include "ends_the_program.gamut.h"

static void flow_stress(const struct ends_the_program *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
    if (b->plastic_strain[i] > 1)
      exit(0);
  }
}

GAMUT_STRENGTH(ends_the_program, .flow_stress = flow_stress)
