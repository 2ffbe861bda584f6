#define GAMUT_KERNEL
#include "adiabatic_heating.gamut.h"

static void adiabatic_heating_heat(const struct adiabatic_heating *b)
{
  GAMUT_EACH (i, b) {
    double capacity = b->reference_density[i] * b->specific_heat[i];
    b->temperature[i] =
        b->temperature_begin[i] + b->taylor_quinney[i] * b->plastic_dissipation[i] / capacity;
  }
}

GAMUT_EFFECT(adiabatic_heating, .heat = adiabatic_heating_heat)
