#include <stdio.h>

#include "artificial_viscosity.gamut.h"

void artificial_viscosity_write(const struct artificial_viscosity *); /* kernel.c */

static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)
{
  (void)self;
  if (gamut_real(values, "linear") != 0.0 || gamut_real(values, "quadratic") != 0.0)
    return false;
  snprintf(why, size, "linear = quadratic = 0");
  return true;
}

GAMUT_EFFECT(artificial_viscosity, .viscosity = artificial_viscosity_write, .decline = decline)
