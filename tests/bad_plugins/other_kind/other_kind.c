#include "other_kind.gamut.h"

static void flow_stress(const struct other_kind *b)
{
  (void)b;
}

GAMUT_PLUGIN_(GAMUT_KIND_EOS, other_kind, .flow_stress = flow_stress)
