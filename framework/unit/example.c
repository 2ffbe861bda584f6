#include <string.h>

#include "base/array.h"
#include "unit/unit.h"

const char *unit_example(const char *unit)
{
  static const char *const examples[][2] = {
      {"", "0.3"},
      {"1", "0.3"},
      {"m", "25.4 mm"},
      {"m2", "1.5 cm2"},
      {"m^2", "1.5 cm2"},
      {"m3", "2 cm3"},
      {"m^3", "2 cm3"},
      {"s", "80 us"},
      {"1/s", "1000 1/s"},
      {"Hz", "50 kHz"},
      {"kg", "12 g"},
      {"m/s", "190 m/s"},
      {"m/s2", "9.81 m/s2"},
      {"m/s^2", "9.81 m/s2"},
      {"K", "293.15 K"},
      {"1/K", "5e-5 1/K"},
      {"K/s", "100 K/s"},
      {"Pa", "124 GPa"},
      {"1/Pa", "0.01 1/GPa"},
      {"Pa s", "1 Pa s"},
      {"Pa/K", "1 MPa/K"},
      {"Pa m^3", "1 Pa m3"},
      {"N", "10 kN"},
      {"N/m", "10 N/m"},
      {"N s", "1 N s"},
      {"J", "10 J"},
      {"W", "10 kW"},
      {"kg/m3", "8960 kg/m3"},
      {"kg/m^3", "8960 kg/m3"},
      {"J/kg", "4.2 MJ/kg"},
      {"J/m3", "1 MJ/m3"},
      {"J/m^3", "1 MJ/m3"},
      {"J/m2", "10 kJ/m2"},
      {"J/m^2", "10 kJ/m2"},
      {"J/(kg K)", "383 J/(kg K)"},
      {"W/(m K)", "386 W/(m K)"},
      {"m2/s", "1e-4 m2/s"},
      {"m^2/s", "1e-4 m2/s"},
      {"rad", "45 degree"},
      {"rad/s", "100 rad/s"},
  };
  for (size_t k = 0; k < ARRAY_SIZE(examples); k++)
    if (strcmp(unit, examples[k][0]) == 0)
      return examples[k][1];
  return unit;
}
