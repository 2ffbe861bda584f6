#include "quadratic_energy.gamut.h"

static void quadratic_energy_pressure(const struct quadratic_energy *b)
{
  GAMUT_EACH (i, b) {
    double e = b->energy[i], ratio = 1.0 + b->compression[i];
    double slope = b->g[i] + 2.0 * b->q[i] * e;
    double p = b->K[i] * b->compression[i] + (b->g[i] + b->q[i] * e) * e;
    double square = b->K[i] + p * slope / (ratio * ratio);
    b->pressure[i] = p;
    b->pressure_slope_compression[i] = b->K[i];
    b->pressure_slope_energy[i] = slope;
    b->sound_speed[i] = sqrt((square > 0.0 ? square : 0.0) / b->reference_density[i]);
  }
}

GAMUT_EOS(quadratic_energy, .pressure = quadratic_energy_pressure)
