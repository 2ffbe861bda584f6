/* The registration line is missing. */
#include "missing_symbol.gamut.h"

void flow_stress(const struct missing_symbol *);

void flow_stress(const struct missing_symbol *b)
{
  GAMUT_EACH (i, b) {
    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];
  }
}
