#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sweep.gamut.h"

/* Sums of one quantity, about its first value. */
struct sums {
  double runs, origin, sum, square;
};

struct state {
  size_t parameters, quantities;
  uint64_t asked, wanted;
  struct sums sums[];
};

static size_t bytes_of(const struct state *s)
{
  return sizeof *s + s->quantities * sizeof s->sums[0];
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values,
                           const struct gamut_study_shape *shape, void **self)
{
  struct state *s = calloc(1, sizeof *s + shape->quantities * sizeof s->sums[0]);
  (void)values; /* the study makes the levels of them */
  if (!s)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  s->parameters = shape->parameters;
  s->quantities = shape->quantities;
  s->wanted = shape->levels ? shape->levels : 1;
  *self = s;
  return GAMUT_OK;
}

static void destroy(void *self)
{
  free(self);
}

static gamut_status ask(void *self, struct gamut_batch *batch)
{
  struct state *s = self;
  uint64_t rows = s->wanted - s->asked;
  batch->rows = rows < batch->capacity ? (size_t)rows : batch->capacity;
  for (size_t r = 0; r < batch->rows; r++, s->asked++) {
    batch->level[r] = (int)s->asked;
    for (size_t k = 0; k < s->parameters; k++)
      batch->point[r * s->parameters + k] = NAN;
  }
  return GAMUT_OK;
}

static gamut_status tell(void *self, const struct gamut_batch *batch)
{
  struct state *s = self;
  for (size_t r = 0; r < batch->rows; r++)
    for (size_t q = 0; q < s->quantities; q++) {
      struct sums *sums = &s->sums[q];
      double value = batch->value[r * s->quantities + q];
      if (!isfinite(value))
        continue;
      if (sums->runs == 0.0)
        sums->origin = value;
      sums->runs += 1.0;
      sums->sum += value - sums->origin;
      sums->square += (value - sums->origin) * (value - sums->origin);
    }
  return GAMUT_OK;
}

static gamut_status report(const void *self, struct gamut_moments *moments)
{
  const struct state *s = self;
  for (size_t q = 0; q < s->quantities; q++) {
    const struct sums *sums = &s->sums[q];
    double m = sums->sum / sums->runs;
    moments->mean[q] = sums->origin + m;
    moments->variance[q] = fmax(sums->square - m * sums->sum, 0.0) / (sums->runs - 1.0);
    moments->mean_error[q] = INFINITY;
    moments->variance_error[q] = INFINITY;
  }
  return GAMUT_OK;
}

static size_t save(const void *self, void *bytes)
{
  const struct state *s = self;
  if (bytes)
    memcpy(bytes, s, bytes_of(s));
  return bytes_of(s);
}

static gamut_status restore(void *self, const void *bytes, size_t size)
{
  struct state *s = self;
  if (size != bytes_of(s))
    return GAMUT_OUTPUT;
  memcpy(s, bytes, size);
  return GAMUT_OK;
}

GAMUT_ESTIMATOR(sweep, .create = create, .destroy = destroy, .ask = ask, .tell = tell,
                .report = report, .save = save, .restore = restore)
