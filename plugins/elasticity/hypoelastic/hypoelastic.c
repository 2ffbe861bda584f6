#include "hypoelastic.h"

static void hypoelastic_stress(const struct hypoelastic *b)
{
  hypoelastic_volume(b);
  hypoelastic_strength(b);
  hypoelastic_trial(b);
  hypoelastic_return(b);
  hypoelastic_turn(b);
  hypoelastic_pressure(b);
}

GAMUT_ELASTICITY(hypoelastic, .stress = hypoelastic_stress, .start = hypoelastic_start)
