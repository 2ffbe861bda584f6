#include <stdio.h>

#include "@NAME@.gamut.h"

static void drag(const struct @NAME@ *b)
{
  for (int k = 0; k < 3; k++)
    GAMUT_EACH (i, b)
      b->external_force[k][i] -= b->rate[i] * b->mass[i] * b->velocity[k][i];
}

static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)
{
  (void)self;
  snprintf(why, size, "rate = 0");
  return gamut_real(values, "rate") == 0;
}

GAMUT_EFFECT(@NAME@, .decline = decline, .drag = drag)
