#include <stdio.h>

#include "artificial_viscosity.gamut.h"

static void viscosity(const struct artificial_viscosity *b)
{
  GAMUT_EACH (i, b) {
    double rate =
        b->velocity_gradient[0][i] + b->velocity_gradient[4][i] + b->velocity_gradient[8][i];
    double closing = rate < 0.0 ? -rate : 0.0, h = b->cell_size[i], c = b->sound_speed[i];
    double rho = b->reference_density[i] / b->volume_ratio[i];
    double linear = b->linear[i] * (closing > 0.0 ? c : 0.0);
    double quadratic = b->quadratic[i] * h * closing;
    b->viscous_pressure[i] = rho * h * closing * (linear + quadratic);
    /* c x, the damping ratio x times c: stays finite in material without sound speed. */
    double damping = linear + 2.0 * quadratic;
    double square = 2.0 * damping * (damping + sqrt(c * c + damping * damping));
    b->omega_squared[i] += 4.0 / (h * h) * square;
  }
}

static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)
{
  (void)self;
  if (gamut_real(values, "linear") != 0.0 || gamut_real(values, "quadratic") != 0.0)
    return false;
  snprintf(why, size, "linear = quadratic = 0");
  return true;
}

GAMUT_EFFECT(artificial_viscosity, .viscosity = viscosity, .decline = decline)
