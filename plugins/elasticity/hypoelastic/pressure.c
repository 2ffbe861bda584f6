/* Pressure and energy at the end of the step, solved together by Newton in the energy:
 * e1 = known - p(compression, e1) (J1 - J0) / 2. */
#include "hypoelastic.h"

enum { HYPOELASTIC_PRESSURE_ITERATIONS = 40 };

GAMUT_INLINE double hypoelastic_mean_pressure_begin(const struct hypoelastic *b, size_t i)
{
  return -(b->stress_begin[0][i] + b->stress_begin[1][i] + b->stress_begin[2][i]) * (1.0 / 3.0);
}

static void hypoelastic_pressure_begin(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    double half_step = 0.5 * b->scratch[HYPOELASTIC_VOLUME_STEP][i],
           before = hypoelastic_mean_pressure_begin(b, i);
    double known = b->energy_begin[i] + b->scratch[HYPOELASTIC_WORK_TRIAL][i] -
                   half_step * (before + b->viscous_pressure[i]);
    b->scratch[HYPOELASTIC_ENERGY_KNOWN][i] = known;
    b->eos->compression[i] = b->scratch[HYPOELASTIC_COMPRESSION][i];
    b->eos->energy[i] = known - half_step * before;
    b->scratch[HYPOELASTIC_ACTIVE][i] = 1.0;
  }
}

/* One Newton step; a point whose energy and pressure agree to round-off is left alone. */
static void hypoelastic_pressure_newton(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    double half_step = 0.5 * b->scratch[HYPOELASTIC_VOLUME_STEP][i], e = b->eos->energy[i];
    double known = b->scratch[HYPOELASTIC_ENERGY_KNOWN][i], work = half_step * b->eos->pressure[i];
    double residual = (e - known) + work;
    double scale = fabs(known) + fabs(b->energy_begin[i]) + fabs(work);
    double apart = fabs(residual) > 1e-14 * scale ? 1.0 : 0.0;
    double active = b->scratch[HYPOELASTIC_ACTIVE][i] * apart;
    double step = residual / (1.0 + half_step * b->eos->pressure_slope_energy[i]);
    b->scratch[HYPOELASTIC_ACTIVE][i] = active;
    b->eos->energy[i] = e - (active > 0.0 ? step : 0.0);
  }
}

static void hypoelastic_pressure_iterate(const struct hypoelastic *b)
{
  uint32_t lane[GAMUT_CHUNK_MAX];
  for (int k = 0; k < HYPOELASTIC_PRESSURE_ITERATIONS; k++) {
    size_t lanes = b->count;
    if (b->count <= GAMUT_CHUNK_MAX)
      lanes = hypoelastic_lanes(b->scratch[HYPOELASTIC_ACTIVE], b->count, lane);
    if (lanes == 0)
      return;
    bool few = 2 * lanes < b->count;
    gamut_evaluate_eos(b->eos, few ? lane : NULL, few ? lanes : b->count);
    hypoelastic_pressure_newton(b);
  }
}

GAMUT_INLINE double hypoelastic_longitudinal(const struct hypoelastic *b, size_t i, double shear,
                                             double J)
{
  double bulk = b->eos->sound_speed[i];
  return sqrt(bulk * bulk + (4.0 / 3.0) * shear * J / b->reference_density[i]);
}

void hypoelastic_pressure(const struct hypoelastic *b)
{
  hypoelastic_pressure_begin(b);
  hypoelastic_pressure_iterate(b);
  const double *shear = hypoelastic_shear(b);
  GAMUT_EACH (i, b) {
    double p = b->eos->pressure[i], total = p + b->viscous_pressure[i];
    /* From the work once more: energy and work then balance to the last bit. */
    double e =
        b->scratch[HYPOELASTIC_ENERGY_KNOWN][i] - 0.5 * b->scratch[HYPOELASTIC_VOLUME_STEP][i] * p;
    double xx = b->scratch[HYPOELASTIC_TRIAL + 0][i], yy = b->scratch[HYPOELASTIC_TRIAL + 1][i];
    double zz = b->scratch[HYPOELASTIC_TRIAL + 2][i], xy = b->scratch[HYPOELASTIC_TRIAL + 3][i];
    double yz = b->scratch[HYPOELASTIC_TRIAL + 4][i], zx = b->scratch[HYPOELASTIC_TRIAL + 5][i];
    b->energy[i] = e;
    b->stress[0][i] = xx - total;
    b->stress[1][i] = yy - total;
    b->stress[2][i] = zz - total;
    b->stress[3][i] = xy;
    b->stress[4][i] = yz;
    b->stress[5][i] = zx;
    b->sound_speed[i] = hypoelastic_longitudinal(b, i, shear[i], b->volume_ratio[i]);
    double sum =
        fabs(xx) + fabs(yy) + fabs(zz) + fabs(xy) + fabs(yz) + fabs(zx) + fabs(total) + fabs(e);
    GAMUT_FLAG(b, i, b->scratch[HYPOELASTIC_ACTIVE][i] > 0.0, HYPOELASTIC_ENERGY_FAILED);
    GAMUT_FLAG(b, i, !(sum < HUGE_VAL), HYPOELASTIC_NOT_FINITE);
  }
}

void hypoelastic_start(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    double J = b->volume_ratio_begin[i];
    b->scratch[HYPOELASTIC_COMPRESSION][i] = (1.0 - J) / J;
  }
  if (b->strength && b->strength->shear_modulus_factor)
    hypoelastic_strength(b);
  GAMUT_EACH (i, b) {
    b->eos->compression[i] = b->scratch[HYPOELASTIC_COMPRESSION][i];
    b->eos->energy[i] = b->energy_begin[i];
  }
  gamut_evaluate_eos(b->eos, NULL, b->count);
  const double *shear = hypoelastic_shear(b);
  GAMUT_EACH (i, b) {
    double p = b->eos->pressure[i], J = b->volume_ratio_begin[i];
    b->stress[0][i] = b->stress[1][i] = b->stress[2][i] = -p;
    b->stress[3][i] = b->stress[4][i] = b->stress[5][i] = 0.0;
    b->volume_ratio[i] = J;
    b->plastic_strain[i] = b->plastic_strain_begin[i];
    b->energy[i] = b->energy_begin[i];
    b->plastic_strain_rate[i] = 0.0;
    b->plastic_dissipation[i] = 0.0;
    b->sound_speed[i] = hypoelastic_longitudinal(b, i, shear[i], J);
    GAMUT_FLAG(b, i, !(J > 0.0), HYPOELASTIC_INVERTED);
    GAMUT_FLAG(b, i, !(fabs(p) < HUGE_VAL), HYPOELASTIC_NOT_FINITE);
  }
}
