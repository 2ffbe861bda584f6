#include "missing_dependency.gamut.h"

double hardening_of_a_library(double plastic_strain);

static void flow_stress(const struct missing_dependency *b)
{
  for (size_t i = 0; i < b->count; i++) {
    b->flow_stress[i] = hardening_of_a_library(b->plastic_strain[i]);
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}

GAMUT_STRENGTH(missing_dependency, .flow_stress = flow_stress)
