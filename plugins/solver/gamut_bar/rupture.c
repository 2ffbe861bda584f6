/* States of the families: active, saturated (they take up next to no more elastic energy) and
 * broken. */
#include "bar.h"

/* Tangent over elastic modulus below which a family is saturated. */
static const double saturation = 0.05;

double bond_state(const struct bar *bar, size_t i)
{
  const struct families *f = &bar->families;
  if (f->internal[i] / bar->softening[i] >= bar->limit[i])
    return 2.0;
  return 1.0 - bar->softening[i] * f->trial_slope[i] > saturation ? 0.0 : 1.0;
}

void bonds_look(struct bar *bar)
{
  double worst = 0.0;
  size_t bond = 0;
  bar->saturated = 0;
  for (size_t i = 0; i < bar->bonds; i++) {
    double used = bar->families.internal[i] / bar->softening[i] / bar->limit[i];
    bar->saturated += bond_state(bar, i) == 1.0;
    if (used > worst) {
      worst = used;
      bond = i;
    }
  }
  if (worst < 1.0 || bar->rupture.broken)
    return;
  bar->rupture = (struct rupture){true, bond, bar->nominal_stress, bar->mean_strain};
  switch (gamut_bar_rupture_of(bar->values)) {
  case GAMUT_BAR_RUPTURE_STOP:
    bar->load.ended = true;
    break;
  case GAMUT_BAR_RUPTURE_REPORT:
    break;
  }
}
