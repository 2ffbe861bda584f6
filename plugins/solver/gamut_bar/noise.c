/* Random fields over bonds and pairs of bonds, as the scene names them. */
#include <stdio.h>

#include "bar.h"

gamut_status noise_of_bonds(struct bar *bar, const char *name, double *value, bool *given)
{
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  const double *const position[3] = {bar->place, bar->work[0], bar->work[0]};
  int64_t *id = (int64_t *)(void *)bar->work[1];
  char path[64];
  snprintf(path, sizeof path, "noise.%s", name);
  for (size_t i = 0; i < bar->bonds; i++) {
    bar->work[0][i] = 0.0;
    id[i] = (int64_t)i;
  }
  gamut_status status =
      host->sample(bar->run, bar->values, path, name, bar->bonds, position, id, value, given);
  bar->random |= *given;
  return status;
}

/* Pairs p < q row by row. Their place is their number over the number of pairs: weights have no
 * place in the bar, and a field over them no correlation length in metres. */
static void number_pairs(size_t pairs, double *place, int64_t *id)
{
  for (size_t k = 0; k < pairs; k++) {
    place[k] = ((double)k + 0.5) / (double)pairs;
    id[k] = (int64_t)k;
  }
}

gamut_status noise_of_pairs(struct bar *bar, double **value, bool *given)
{
  enum { MOST = 5000 };
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  size_t n = bar->bonds, pairs = n * (n - 1) / 2;
  *value = NULL;
  *given = gamut_given(bar->values, "noise.weights");
  if (!*given)
    return GAMUT_OK;
  if (n > MOST)
    return gamut_fail_at(bar->run, bar->values, "noise.weights", "fewer bonds",
                         "%zu bonds have too many pairs for noise of weights; %d are the most", n,
                         MOST);
  double *place = gamut_allocate(bar->run, "noise of pairs", 2 * pairs * sizeof *place);
  int64_t *id = gamut_allocate(bar->run, "noise of pairs", pairs * sizeof *id);
  *value = gamut_allocate(bar->run, "noise of pairs", pairs * sizeof **value);
  if (!place || !id || !*value)
    return GAMUT_INTERNAL;
  const double *const position[3] = {place, place + pairs, place + pairs};
  number_pairs(pairs, place, id);
  gamut_status status = host->sample(bar->run, bar->values, "noise.weights", "weights", pairs,
                                     position, id, *value, given);
  gamut_release(bar->run, place);
  gamut_release(bar->run, id);
  bar->random = true;
  return status;
}
