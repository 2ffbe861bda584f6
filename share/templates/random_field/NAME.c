#include "@NAME@.gamut.h"

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  (void)run;
  (void)values;
  *self = NULL; /* white noise has nothing to keep */
  return GAMUT_OK;
}

static void destroy(void *self)
{
  (void)self;
}

static gamut_status sample(const void *self, const struct gamut_stream *stream, size_t count,
                           const double *const position[3], const int64_t *id, double *value)
{
  (void)self;
  (void)position;
  for (size_t i = 0; i < count; i++)
    value[i] = stream->normal(stream, (uint64_t)id[i]);
  return GAMUT_OK;
}

GAMUT_RANDOM_FIELD(@NAME@, .create = create, .destroy = destroy, .sample = sample)
