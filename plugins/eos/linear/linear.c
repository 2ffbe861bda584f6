#include "linear.gamut.h"

static void linear_pressure(const struct linear *b)
{
  GAMUT_EACH (i, b) {
    b->pressure[i] = b->bulk_modulus[i] * b->compression[i];
    b->pressure_slope_compression[i] = b->bulk_modulus[i];
    b->sound_speed[i] = sqrt(b->bulk_modulus[i] / b->reference_density[i]);
    GAMUT_FLAG(b, i, b->compression[i] <= -1.0, LINEAR_VACUUM);
  }
}

GAMUT_EOS(linear, .pressure = linear_pressure)
