#define GAMUT_KERNEL
#include "@NAME@.gamut.h"

void @NAME@_drag(const struct @NAME@ *b)
{
  for (int k = 0; k < 3; k++)
    GAMUT_EACH (i, b)
      b->external_force[k][i] -= b->rate[i] * b->mass[i] * b->velocity[k][i];
}
