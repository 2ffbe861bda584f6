#define GAMUT_KERNEL
#include "burn.gamut.h"

static void burn(const struct burn *b)
{
  GAMUT_EACH (i, b)
    b->burn_fraction[i] = b->fraction[i];
}

GAMUT_EFFECT(burn, .burn = burn)
