/* Latin hypercubes, each with permutations of its own. */
#include <stdlib.h>
#include <string.h>

#include "latin_hypercube.gamut.h"

/* Of one result: sums over all runs about the first value, and over the means of hypercubes. */
struct sums {
  double origin, sum, square;
  double cube, mean, mean_square;
};

struct state {
  struct gamut_stream stream;
  size_t parameters, results, quantities, size;
  uint64_t asked, told, wanted;
  const struct gamut_study_quantity *quantity;
  size_t *order;
  struct sums *sums; /* one a result */
  double *means;     /* of each hypercube, one a result */
};

static void destroy(void *self)
{
  struct state *s = self;
  if (!s)
    return;
  free(s->order);
  free(s->sums);
  free(s->means);
  free(s);
}

static size_t cubes(const struct state *s)
{
  return (size_t)(s->wanted / s->size);
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values,
                           const struct gamut_study_shape *shape, void **self)
{
  struct state *s = calloc(1, sizeof *s);
  if (!s)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  s->stream = shape->stream;
  s->parameters = shape->parameters;
  s->results = shape->results;
  s->quantities = shape->quantities;
  s->quantity = shape->quantity;
  s->size = (size_t)gamut_integer(values, "size");
  s->wanted = s->size * (uint64_t)gamut_integer(values, "hypercubes");
  s->order = calloc(s->parameters * s->size + 1, sizeof *s->order);
  s->sums = calloc(s->results + 1, sizeof *s->sums);
  s->means = calloc(cubes(s) * s->results + 1, sizeof *s->means);
  if (!s->order || !s->sums || !s->means) {
    destroy(s);
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  }
  *self = s;
  return GAMUT_OK;
}

/* The normal variable with this probability below it, by halving. */
static double normal_of(double probability)
{
  double low = -9, high = 9;
  for (int i = 0; i < 60; i++) {
    const double middle = 0.5 * (low + high);
    if (0.5 * erfc(-middle * sqrt(0.5)) < probability)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

/* Permutations of the strata, one a parameter, from the stream of the hypercube. */
static void shuffle(struct state *s, struct gamut_stream *stream)
{
  for (size_t k = 0; k < s->parameters; k++) {
    size_t *order = s->order + k * s->size;
    for (size_t i = 0; i < s->size; i++) {
      const double u = stream->uniform(stream, k * s->size + i);
      const size_t j = (size_t)(u * (double)(i + 1));
      order[i] = order[j];
      order[j] = i;
    }
  }
}

static gamut_status ask(void *self, struct gamut_batch *batch)
{
  struct state *s = self;
  while (s->asked < s->wanted && batch->rows < batch->capacity) {
    struct gamut_stream stream = s->stream;
    const size_t place = (size_t)(s->asked % s->size);
    stream.realisation = s->asked / s->size;
    shuffle(s, &stream);
    double *sample = batch->sample + batch->rows * s->parameters;
    for (size_t k = 0; k < s->parameters; k++) {
      const double within =
          stream.uniform(&stream, (s->parameters + k) * s->size + place); /* of its stratum */
      sample[k] = normal_of(((double)s->order[k * s->size + place] + within) / (double)s->size);
    }
    batch->rows++;
    s->asked++;
  }
  return GAMUT_OK;
}

static void add(struct state *s, size_t q, double value)
{
  struct sums *sums = &s->sums[q];
  if (s->told == 0)
    sums->origin = value;
  const double x = value - sums->origin;
  sums->sum += x;
  sums->square += x * x;
  sums->cube += x;
  if ((s->told + 1) % s->size != 0)
    return;
  const double mean = sums->cube / (double)s->size;
  s->means[s->told / s->size * s->results + q] = sums->origin + mean;
  sums->mean += mean;
  sums->mean_square += mean * mean;
  sums->cube = 0;
}

static gamut_status tell(void *self, const struct gamut_batch *batch)
{
  struct state *s = self;
  for (size_t r = 0; r < batch->rows; r++, s->told++)
    for (size_t q = 0; q < s->results; q++)
      add(s, q, batch->result[r * s->results + q]);
  return GAMUT_OK;
}

/* Mean of the hypercubes' means, a row a hypercube and scalar quantity. */
static gamut_status report_cubes(const struct state *s, struct gamut_report *report)
{
  const size_t rows = cubes(s) * s->quantities;
  gamut_status status = GAMUT_INTERNAL;
  double *cube = calloc(rows + 1, sizeof *cube), *mean = calloc(rows + 1, sizeof *mean);
  const char **name = calloc(rows + 1, sizeof *name);
  if (cube && mean && name) {
    for (size_t r = 0; r < rows; r++) {
      const struct gamut_study_quantity *quantity = &s->quantity[r % s->quantities];
      cube[r] = (double)(r / s->quantities);
      name[r] = quantity->name;
      mean[r] =
          quantity->count > 0 ? s->means[r / s->quantities * s->results + quantity->first] : NAN;
    }
    const struct gamut_table_column column[] = {
        {.name = "hypercube", .unit = "1", .meaning = "its number", .number = cube},
        {.name = "quantity", .meaning = "of the scene; the first place of a curve", .text = name},
        {.name = "mean", .meaning = "over the hypercube", .number = mean}};
    status = report->table(report, "hypercubes", "means of the hypercubes", column, 3, rows);
  }
  free(cube);
  free(mean);
  free(name);
  return status;
}

static gamut_status report(const void *self, struct gamut_report *report)
{
  const struct state *s = self;
  const struct gamut_moments *moments = &report->moments;
  const double n = (double)s->told, m = (double)cubes(s);
  gamut_status status = GAMUT_OK;
  double *ratio = calloc(s->results + 1, sizeof *ratio);
  if (!ratio)
    return GAMUT_INTERNAL;
  for (size_t q = 0; q < s->results; q++) {
    const struct sums *sums = &s->sums[q];
    const double mean = sums->sum / n, between = sums->mean / m;
    const double variance = (sums->square - n * mean * mean) / (n - 1);
    const double spread = fmax(sums->mean_square - m * between * between, 0) / (m - 1);
    moments->mean[q] = sums->origin + mean;
    moments->variance[q] = variance;
    moments->mean_error[q] = sqrt(spread / m);
    moments->variance_error[q] = INFINITY;
    ratio[q] = spread / m / (variance / n);
  }
  for (size_t i = 0; i < s->quantities && status == GAMUT_OK; i++)
    status = report->number(report, i, "variance_ratio", "1",
                            "variance of the mean over that of as many independent runs",
                            ratio + s->quantity[i].first);
  free(ratio);
  return status == GAMUT_OK ? report_cubes(s, report) : status;
}

static size_t save(const void *self, void *bytes)
{
  const struct state *s = self;
  const size_t sums = s->results * sizeof *s->sums;
  const size_t means = cubes(s) * s->results * sizeof *s->means;
  if (bytes) {
    memcpy(bytes, (const uint64_t[]){s->asked, s->told}, 16);
    memcpy((char *)bytes + 16, s->sums, sums);
    memcpy((char *)bytes + 16 + sums, s->means, means);
  }
  return 16 + sums + means;
}

static gamut_status restore(void *self, const void *bytes, size_t size)
{
  struct state *s = self;
  const size_t sums = s->results * sizeof *s->sums;
  const char *at = bytes;
  if (size != save(self, NULL))
    return GAMUT_OUTPUT;
  memcpy(&s->asked, at, 8);
  memcpy(&s->told, at + 8, 8);
  memcpy(s->sums, at + 16, sums);
  memcpy(s->means, at + 16 + sums, size - 16 - sums);
  return GAMUT_OK;
}

GAMUT_ESTIMATOR(latin_hypercube, .create = create, .destroy = destroy, .ask = ask, .tell = tell,
                .report = report, .save = save, .restore = restore)
