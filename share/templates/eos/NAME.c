#include "@NAME@.gamut.h"

static void @NAME@_pressure(const struct @NAME@ *b)
{
  GAMUT_EACH (i, b) {
    b->pressure[i] = b->bulk_modulus[i] * b->compression[i];
    b->pressure_slope_compression[i] = b->bulk_modulus[i];
    b->sound_speed[i] = sqrt(b->bulk_modulus[i] / b->reference_density[i]);
    GAMUT_FLAG(b, i, b->compression[i] <= -1, @UPPER@_VACUUM);
  }
}

GAMUT_EOS(@NAME@, .pressure = @NAME@_pressure)
