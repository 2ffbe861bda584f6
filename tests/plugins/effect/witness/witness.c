#include "witness.gamut.h"

static void heat(const struct witness *b)
{
  GAMUT_EACH (i, b)
    b->seen_temperature[i] = b->temperature[i];
}

static void place(const struct witness *b)
{
  for (int k = 0; k < 3; k++)
    GAMUT_EACH (i, b)
      b->seen_place[k][i] = b->first_position[k][i];
}

static void cell(const struct witness *b)
{
  GAMUT_EACH (i, b)
    b->opening[i] = (b->volume_ratio[i] - 1.0) * b->cell_size[i];
}

GAMUT_EFFECT(witness, .heat = heat, .place = place, .cell = cell)
