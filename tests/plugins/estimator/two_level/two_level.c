/* Two levels that see the same samples and realisations. */
#include <stdlib.h>
#include <string.h>

#include "two_level.gamut.h"

enum { CHEAP, DIFFERENCE, TERMS };

/* Of one result and term: about the first value; of differences also the dear level alone. */
struct sums {
  double count, origin, sum, square;
};

struct state {
  struct gamut_stream stream;
  size_t parameters, results, quantities;
  uint64_t pilot, samples; /* samples: given out so far, one a realisation */
  uint64_t asked[TERMS], wanted[TERMS];
  double budget, cost[TERMS]; /* cost: work told so far */
  uint64_t told[TERMS];
  bool weighed;
  struct sums sums[]; /* results x TERMS, then results x 2: both levels of the pairs */
};

static size_t bytes_of(const struct state *s)
{
  return sizeof *s + 2 * TERMS * s->results * sizeof s->sums[0];
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values,
                           const struct gamut_study_shape *shape, void **self)
{
  struct state *s = calloc(1, sizeof *s + 2 * TERMS * shape->results * sizeof s->sums[0]);
  if (!s)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  if (shape->levels < 2) {
    free(s);
    return gamut_fail_at(run, values, "over", "two levels", "there is nothing to compare");
  }
  s->stream = shape->stream;
  s->parameters = shape->parameters;
  s->results = shape->results;
  s->quantities = shape->quantities;
  s->pilot = (uint64_t)gamut_integer(values, "pilot");
  s->budget = gamut_real(values, "work");
  s->wanted[CHEAP] = s->wanted[DIFFERENCE] = s->pilot;
  *self = s;
  return GAMUT_OK;
}

static void destroy(void *self)
{
  free(self);
}

static void put_row(struct state *s, struct gamut_batch *batch, int level)
{
  struct gamut_stream stream = s->stream;
  const size_t r = batch->rows++;
  stream.realisation = batch->realisation[r] = s->samples;
  batch->level[r] = level;
  for (size_t k = 0; k < s->parameters; k++)
    batch->sample[r * s->parameters + k] = stream.normal(&stream, k);
}

/* Pairs come first, dear level after cheap one. */
static gamut_status ask(void *self, struct gamut_batch *batch)
{
  struct state *s = self;
  for (; s->asked[DIFFERENCE] < s->wanted[DIFFERENCE] && batch->rows + 2 <= batch->capacity;
       s->samples++, s->asked[DIFFERENCE]++) {
    put_row(s, batch, 0);
    put_row(s, batch, 1);
  }
  if (s->asked[DIFFERENCE] < s->wanted[DIFFERENCE])
    return GAMUT_OK;
  for (; s->asked[CHEAP] < s->wanted[CHEAP] && batch->rows < batch->capacity;
       s->samples++, s->asked[CHEAP]++)
    put_row(s, batch, 0);
  return GAMUT_OK;
}

static void add(struct sums *sums, double value)
{
  if (!isfinite(value))
    return;
  if (sums->count == 0)
    sums->origin = value;
  const double x = value - sums->origin;
  sums->count += 1;
  sums->sum += x;
  sums->square += x * x;
}

static double mean_of(const struct sums *sums)
{
  return sums->origin + sums->sum / sums->count;
}

static double variance_of(const struct sums *sums)
{
  const double n = sums->count, mean = sums->sum / n;
  return fmax(sums->square - n * mean * mean, 0) / (n - 1);
}

static const struct sums *pairs_of(const struct state *s, size_t q)
{
  return &s->sums[TERMS * s->results + 2 * q];
}

/* Samples of each term for the least error of the first result at the given work. */
static void weigh(struct state *s)
{
  double share[TERMS], work = 0, each[TERMS];
  for (int t = 0; t < TERMS; t++) {
    each[t] = s->cost[t] / (double)s->told[t];
    share[t] = s->results ? sqrt(variance_of(&s->sums[t]) / each[t]) : 1;
    work += share[t] * each[t];
  }
  for (int t = 0; t < TERMS && work > 0; t++) {
    const double wanted = s->budget * share[t] / work;
    s->wanted[t] = wanted > (double)s->pilot ? (uint64_t)wanted : s->pilot;
  }
  s->weighed = true;
}

static gamut_status tell(void *self, const struct gamut_batch *batch)
{
  struct state *s = self;
  for (size_t r = 0; r < batch->rows; r++) {
    const bool pair = r + 1 < batch->rows && batch->level[r + 1] == 1;
    const double *cheap = batch->result + r * s->results, *dear = cheap + s->results;
    const int term = pair ? DIFFERENCE : CHEAP;
    s->told[term]++;
    s->cost[term] += batch->cost[r].work + (pair ? batch->cost[r + 1].work : 0);
    for (size_t q = 0; q < s->results; q++) {
      add(&s->sums[TERMS * q + (size_t)term], pair ? dear[q] - cheap[q] : cheap[q]);
      if (pair && isfinite(dear[q]) && isfinite(cheap[q])) {
        struct sums *both = &s->sums[TERMS * s->results + 2 * q];
        add(&both[0], cheap[q]);
        add(&both[1], dear[q]);
      }
    }
    r += pair;
  }
  if (!s->weighed && s->told[CHEAP] == s->pilot && s->told[DIFFERENCE] == s->pilot)
    weigh(s);
  return GAMUT_OK;
}

static gamut_status report_levels(const struct state *s, struct gamut_report *report)
{
  static const char *const name[TERMS] = {"cheap", "difference"};
  double samples[TERMS], each[TERMS], variance[TERMS];
  for (int t = 0; t < TERMS; t++) {
    samples[t] = (double)s->told[t];
    each[t] = s->cost[t] / samples[t];
    variance[t] = s->results ? variance_of(&s->sums[t]) : NAN;
  }
  const struct gamut_table_column column[] = {
      {.name = "term", .meaning = "of the mean", .text = name},
      {.name = "samples", .unit = "1", .number = samples},
      {.name = "work", .unit = "1", .meaning = "of a sample, steps times points", .number = each},
      {.name = "variance", .meaning = "of the first result", .number = variance}};
  return report->table(report, "levels", "what each term of the mean cost", column, 4, TERMS);
}

static gamut_status report(const void *self, struct gamut_report *report)
{
  const struct state *s = self;
  const struct gamut_moments *moments = &report->moments;
  for (size_t q = 0; q < s->results; q++) {
    const struct sums *term = &s->sums[TERMS * q], *both = pairs_of(s, q);
    double error = 0;
    moments->mean[q] = 0;
    for (int t = 0; t < TERMS; t++) {
      moments->mean[q] += mean_of(&term[t]);
      error += variance_of(&term[t]) / term[t].count;
    }
    moments->mean_error[q] = sqrt(error);
    moments->variance[q] =
        variance_of(&term[CHEAP]) + variance_of(&both[1]) - variance_of(&both[0]);
    moments->variance_error[q] = INFINITY;
  }
  return report_levels(s, report);
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

GAMUT_ESTIMATOR(two_level, .create = create, .destroy = destroy, .ask = ask, .tell = tell,
                .report = report, .save = save, .restore = restore)
