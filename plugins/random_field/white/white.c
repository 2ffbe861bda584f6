#include <stdlib.h>

#include "../noise.h"
#include "white.gamut.h"

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct noise *noise = malloc(sizeof *noise);
  *self = NULL;
  if (!noise)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  switch (white_distribution_of(values)) {
  case WHITE_DISTRIBUTION_NORMAL:
    *noise = noise_read(values, false);
    *self = noise;
    return GAMUT_OK;
  case WHITE_DISTRIBUTION_WEIBULL:
    *noise = noise_read(values, true);
    *self = noise;
    return GAMUT_OK;
  }
  free(noise);
  return gamut_fail(run, GAMUT_PLUGIN, "white does not know this distribution");
}

static gamut_status sample(const void *self, const struct gamut_stream *stream, size_t count,
                           const double *const position[3], const int64_t *id, double *value)
{
  (void)position;
  for (size_t i = 0; i < count; i++)
    value[i] = noise_at(self, stream, (uint64_t)id[i]);
  return GAMUT_OK;
}

static double below(const void *self, double value)
{
  return noise_is_standard(self) ? NAN : noise_below(self, value);
}

GAMUT_RANDOM_FIELD(white, .create = create, .destroy = free, .sample = sample, .below = below)
