#include <stdio.h>

#include "@NAME@.gamut.h"

void @NAME@_drag(const struct @NAME@ *); /* @NAME@_kernel.c */

static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)
{
  (void)self;
  snprintf(why, size, "rate = 0");
  return gamut_real(values, "rate") == 0;
}

GAMUT_EFFECT(@NAME@, .decline = decline, .drag = @NAME@_drag)
