/* Local and nonlocal deformation-gamuts: Eqs. 2 and 3 in the energy of the theory page. */
#include "bar.h"

/* R(e) E~ e^2 / 2 on Ramberg and Osgood's curve, without cancellation. */
static double on_curve(const struct bar *bar, size_t i, double s, double plastic)
{
  double n = bar->families.law[i / FAMILY_CHUNK].n[i % FAMILY_CHUNK];
  return s * plastic / (n + 1.0) + 0.5 * bar->softening[i] * plastic * plastic;
}

/* dU = pi dT along the branches that are remembered; each is the curve twice as large. */
double nonlocal_gamut(const struct bar *bar, size_t i)
{
  const struct families *f = &bar->families;
  double T = 0.0, s = 0.0, plastic = 0.0, energy = 0.0;
  if (isnan(bar->n))
    return NAN;
  for (size_t k = 0; k <= f->count[i]; k++) {
    bool last = k == f->count[i];
    size_t at = k * bar->bonds + i;
    double T_to = last ? f->internal[i] : f->turn[0][at];
    double s_to = last ? f->stress[i] : f->turn[1][at];
    double plastic_to = last ? f->plastic[i] : f->turn[2][at];
    double size = k ? 2.0 : 1.0;
    energy += plastic * (T_to - T) +
              size * size * on_curve(bar, i, (s_to - s) / size, (plastic_to - plastic) / size);
    T = T_to;
    s = s_to;
    plastic = plastic_to;
  }
  return energy;
}

/* R(e) E eps^2 / 2 with the bond's own modulus and strain: the same where strain is uniform. */
double local_gamut(const struct bar *bar, size_t i)
{
  double T = bar->families.internal[i], eps = bar->strain[i];
  if (T == 0.0)
    return 0.0;
  return nonlocal_gamut(bar, i) * bar->stiffness[i] * eps * eps * bar->softening[i] / (T * T);
}
