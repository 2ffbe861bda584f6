#include "ideal_gas.gamut.h"

static void ideal_gas_pressure(const struct ideal_gas *b)
{
  GAMUT_EACH (i, b) {
    double slope = (b->gamma[i] - 1.0) * b->energy[i];
    double ratio = 1.0 + b->compression[i], p = slope * ratio;
    b->pressure[i] = p;
    b->pressure_slope_compression[i] = slope;
    b->pressure_slope_energy[i] = (b->gamma[i] - 1.0) * ratio;
    b->sound_speed[i] = sqrt(b->gamma[i] * p / (b->reference_density[i] * ratio));
    GAMUT_FLAG(b, i, b->energy[i] < 0.0, IDEAL_GAS_NEGATIVE_ENERGY);
    GAMUT_FLAG(b, i, ratio <= 0.0, IDEAL_GAS_VACUUM);
  }
}

GAMUT_EOS(ideal_gas, .pressure = ideal_gas_pressure)
