#include <stdlib.h>
#include <string.h>

#include "@NAME@.gamut.h"

/* Sums of the powers 1 to 4 of each quantity, about the value of the first run. */
struct sums {
  double runs, origin, power[4];
};

struct state {
  struct gamut_stream stream;
  size_t parameters, results;
  uint64_t asked, wanted;
  struct sums sums[];
};

enum { BATCH = 64 };

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
  rows = rows < BATCH ? rows : BATCH;
  batch->rows = rows < batch->capacity ? (size_t)rows : batch->capacity;
  for (size_t r = 0; r < batch->rows; r++, s->asked++) {
    batch->level[r] = 0;
    for (size_t k = 0; k < s->parameters; k++)
      batch->sample[r * s->parameters + k] =
          s->stream.normal(&s->stream, s->asked * s->parameters + k);
  }
  return GAMUT_OK;
}

static gamut_status tell(void *self, const struct gamut_batch *batch)
{
  struct state *s = self;
  for (size_t r = 0; r < batch->rows; r++)
    for (size_t q = 0; q < s->results; q++) {
      struct sums *sums = &s->sums[q];
      double value = batch->result[r * s->results + q];
      if (!isfinite(value))
        continue; /* a failed run */
      if (sums->runs == 0)
        sums->origin = value;
      double x = value - sums->origin, power = 1;
      for (int k = 0; k < 4; k++)
        sums->power[k] += power *= x;
      sums->runs += 1;
    }
  return GAMUT_OK;
}

static gamut_status report(const void *self, struct gamut_report *report)
{
  const struct state *s = self;
  const struct gamut_moments *moments = &report->moments;
  for (size_t q = 0; q < s->results; q++) {
    const struct sums *sums = &s->sums[q];
    double n = sums->runs, m = sums->power[0] / n;
    double p2 = sums->power[1] / n, p3 = sums->power[2] / n, p4 = sums->power[3] / n;
    double spread = p2 - m * m;
    double fourth = p4 - 4 * m * p3 + 6 * m * m * p2 - 3 * m * m * m * m;
    moments->mean[q] = sums->origin + m;
    moments->variance[q] = spread * n / (n - 1);
    moments->mean_error[q] = sqrt(moments->variance[q] / n);
    moments->variance_error[q] = sqrt(fmax(fourth - spread * spread, 0) / n);
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

GAMUT_ESTIMATOR(@NAME@, .create = create, .destroy = destroy, .ask = ask, .tell = tell,
                .report = report, .save = save, .restore = restore)
