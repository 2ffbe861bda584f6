#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "interval.h"
#include "monte_carlo.gamut.h"

struct state {
  struct gamut_stream stream;
  size_t parameters, results;
  uint64_t asked, wanted;
  struct sums sums[];
};

static size_t bytes_of(const struct state *s)
{
  return sizeof *s + s->results * sizeof s->sums[0];
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values,
                           const struct gamut_study_shape *shape, void **self)
{
  struct state *s = calloc(1, sizeof *s + shape->results * sizeof s->sums[0]);
  if (!s)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  s->stream = shape->stream;
  s->parameters = shape->parameters;
  s->results = shape->results;
  s->wanted = (uint64_t)gamut_integer(values, "runs");
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
    struct gamut_stream stream = s->stream;
    stream.realisation = s->asked;
    batch->level[r] = 0;
    for (size_t k = 0; k < s->parameters; k++)
      batch->sample[r * s->parameters + k] = stream.normal(&stream, k);
  }
  return GAMUT_OK;
}

static gamut_status tell(void *self, const struct gamut_batch *batch)
{
  struct state *s = self;
  for (size_t r = 0; r < batch->rows; r++)
    for (size_t q = 0; q < s->results; q++)
      sums_add(&s->sums[q], batch->result[r * s->results + q]);
  return GAMUT_OK;
}

static gamut_status report(const void *self, struct gamut_report *report)
{
  const struct state *s = self;
  const struct gamut_moments *moments = &report->moments;
  for (size_t q = 0; q < s->results; q++) {
    const struct sample sample = sample_of(&s->sums[q]);
    const struct interval mean = mean_interval(&sample), variance = variance_interval(&sample);
    const double n = sample.runs;
    moments->mean[q] = sample.mean;
    moments->variance[q] = sample.variance;
    moments->mean_error[q] = sqrt(sample.variance / n);
    moments->variance_error[q] =
        sqrt(fmax(sample.fourth - (n - 3) / (n - 1) * sample.variance * sample.variance, 0.0) / n);
    moments->mean_lower[q] = mean.lower;
    moments->mean_upper[q] = mean.upper;
    moments->variance_lower[q] = variance.lower;
    moments->variance_upper[q] = variance.upper;
    moments->heavy_tail[q] = heavy_tail(&sample);
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
  const struct gamut_stream stream = s->stream; /* of this program, not of the one that saved */
  memcpy(s, bytes, size);
  s->stream = stream;
  return GAMUT_OK;
}

GAMUT_ESTIMATOR(monte_carlo, .create = create, .destroy = destroy, .ask = ask, .tell = tell,
                .report = report, .save = save, .restore = restore)
