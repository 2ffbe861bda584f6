#define GAMUT_KERNEL
#include "limit.gamut.h"

static void limit(const struct limit *b)
{
  GAMUT_EACH (i, b)
    b->opening_tension[i] =
        b->tension[i] < b->opening_tension[i] ? b->tension[i] : b->opening_tension[i];
}

GAMUT_EFFECT(limit, .limit = limit)
