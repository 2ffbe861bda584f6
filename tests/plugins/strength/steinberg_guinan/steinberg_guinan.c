#include "steinberg_guinan.gamut.h"

static void steinberg_guinan_flow_stress(const struct steinberg_guinan *b)
{
  GAMUT_EACH (i, b) {
    double cube_root = gamut_pow(1.0 + b->compression[i], 1.0 / 3.0);
    double f = 1.0 + b->A[i] * b->pressure[i] / cube_root - b->B[i] * (b->temperature[i] - 300.0);
    double inside = 1.0 + b->beta[i] * b->plastic_strain[i];
    double hard = b->y0[i] * gamut_pow(inside, b->n[i]);
    double left = f > 0.0 ? f : 0.0;
    double y = hard < b->y_max[i] ? hard : b->y_max[i];
    double slope = hard < b->y_max[i] ? b->n[i] * b->beta[i] * hard / inside : 0.0;
    b->flow_stress[i] = left * y;
    b->flow_stress_slope_plastic_strain[i] = left * slope;
    b->flow_stress_slope_temperature[i] = f > 0.0 ? -b->B[i] * y : 0.0;
    b->shear_modulus_factor[i] = left;
    GAMUT_FLAG(b, i, !(f > 0.0), STEINBERG_GUINAN_SOFT);
  }
}

GAMUT_STRENGTH(steinberg_guinan, .flow_stress = steinberg_guinan_flow_stress)
