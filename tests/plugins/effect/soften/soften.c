#define GAMUT_KERNEL
#include "soften.gamut.h"

static void soften(const struct soften *b)
{
  GAMUT_EACH (i, b)
    b->flow_stress_factor[i] *=
        b->left[i] * (1.0 - b->plastic_strain[i] / b->vanishing_strain[i]);
}

GAMUT_EFFECT(soften, .soften = soften)
