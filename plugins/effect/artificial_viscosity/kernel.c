#define GAMUT_KERNEL
#include "artificial_viscosity.gamut.h"

void artificial_viscosity_write(const struct artificial_viscosity *b)
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
