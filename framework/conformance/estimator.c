/* estimator: known integrals within its own error bars; saved and restored it goes on bit for bit.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/stub_host.h"
#include "random/stream.h"

/* Over independent standard normal x and y: a linear and a quadratic quantity. */
enum { PARAMETERS = 2, RESULTS = 2, CAPACITY = 4096, RUNS_MAX = 1 << 20 };
static const double true_mean[RESULTS] = {3, 1}, true_variance[RESULTS] = {4.25, 2.25};

static void quantities(const double *sample, double *result)
{
  double x[PARAMETERS];
  for (int k = 0; k < PARAMETERS; k++)
    x[k] = isnan(sample[k]) ? 0 : sample[k]; /* at its mean */
  result[0] = 3 + 2 * x[0] - 0.5 * x[1];
  result[1] = x[0] * x[0] + 0.5 * x[1];
}

struct estimator_operations {
  size_t size;
  GAMUT_ESTIMATOR_OPS(void)
};

/* What becomes of the rows of a study: as the quantities say, or something else, to see what hangs
 * on it. */
enum outcome { OUTCOME_TRUE, OUTCOME_OTHER, OUTCOME_SOME_FAIL };
enum { FAILS_ONE_IN = 8 };

struct study {
  const struct estimator_operations *ops;
  void *self;
  struct gamut_batch batch;
  double *result;
  struct gamut_row_cost *cost;
  size_t runs, levels;
  enum outcome outcome;
  uint64_t asked; /* a hash of all rows that were asked for */
};

/* Levels that the parameters make, as a grid. */
static size_t levels_of(const struct values *values)
{
  size_t levels = 0;
  for (size_t i = 0; i < values->count; i++) {
    const struct tree *list = values->value[i].levels;
    for (size_t k = 0; list && k < list->children; k++)
      levels = (levels ? levels : 1) * list->child[k]->children;
  }
  return levels;
}

/* Two scalars, in the order of `quantities`. */
static const struct gamut_study_parameter parameter[PARAMETERS] = {
    {"materials.metal.x", "Pa", 0, 1}, {"materials.metal.y", "1", 0, 1}};
static const struct gamut_study_quantity quantity[RESULTS] = {
    {.name = "linear", .unit = "m", .first = 0, .count = 1},
    {.name = "quadratic", .unit = "Pa", .first = 1, .count = 1}};

static gamut_status study_new(struct study *study, struct bare_run *run)
{
  *study = (struct study){.ops = run->ops, .levels = levels_of(run->specimen.values)};
  study->batch =
      (struct gamut_batch){.parameters = PARAMETERS, .results = RESULTS, .capacity = CAPACITY};
  study->batch.sample = calloc(CAPACITY * PARAMETERS, sizeof(double));
  study->batch.level = calloc(CAPACITY, sizeof(int));
  study->batch.mode = calloc(CAPACITY, sizeof(int));
  study->batch.realisation = calloc(CAPACITY, sizeof(uint64_t));
  study->batch.result = study->result = calloc(CAPACITY * RESULTS, sizeof(double));
  study->batch.cost = study->cost = calloc(CAPACITY, sizeof *study->cost);
  const struct gamut_study_shape shape = {.parameters = PARAMETERS,
                                          .quantities = RESULTS,
                                          .results = RESULTS,
                                          .levels = study->levels,
                                          .parameter = parameter,
                                          .quantity = quantity,
                                          .stream = stream_make(1, 0, "conformance")};
  return study->ops->create(bare_run_handle(run), run->specimen.values, &shape, &study->self);
}

static void study_free(struct study *study)
{
  if (study->self)
    study->ops->destroy(study->self);
  free(study->batch.sample);
  free(study->batch.level);
  free(study->batch.mode);
  free(study->batch.realisation);
  free(study->result);
  free(study->cost);
}

static uint64_t hash(uint64_t h, const void *bytes, size_t size)
{
  const unsigned char *byte = bytes;
  for (size_t i = 0; i < size; i++)
    h = (h ^ byte[i]) * UINT64_C(0x100000001b3);
  return h;
}

static bool study_ask(struct study *study, gamut_status *status)
{
  struct gamut_batch *batch = &study->batch;
  batch->rows = 0;
  for (size_t r = 0; r < CAPACITY; r++) {
    batch->level[r] = 0;
    batch->mode[r] = GAMUT_ROW_RUN;
    batch->realisation[r] = GAMUT_NEXT_REALISATION;
  }
  *status = study->ops->ask(study->self, batch);
  if (*status != GAMUT_OK || batch->rows == 0 || batch->rows > CAPACITY)
    return false;
  study->asked = hash(study->asked, batch->sample, batch->rows * PARAMETERS * sizeof(double));
  study->asked = hash(study->asked, batch->level, batch->rows * sizeof(int));
  study->asked = hash(study->asked, batch->realisation, batch->rows * sizeof(uint64_t));
  return true;
}

/* One batch; false at the end or on failure. */
static bool study_batch(struct study *study, gamut_status *status)
{
  struct gamut_batch *batch = &study->batch;
  if (!study_ask(study, status))
    return false;
  for (size_t r = 0; r < batch->rows; r++) {
    double *result = study->result + r * RESULTS;
    const size_t number = study->runs + r;
    if (batch->realisation[r] == GAMUT_NEXT_REALISATION)
      batch->realisation[r] = number;
    quantities(batch->sample + r * PARAMETERS, result);
    for (int q = 0; q < RESULTS; q++)
      if (study->outcome == OUTCOME_OTHER)
        result[q] = 1e3 * (double)(number % 7) - result[q];
      else if (study->outcome == OUTCOME_SOME_FAIL && number % FAILS_ONE_IN == 3)
        result[q] = NAN;
    study->cost[r] = (struct gamut_row_cost){1e-3, 1e3 * (double)(batch->level[r] + 1)};
  }
  study->runs += batch->rows;
  *status = study->ops->tell(study->self, batch);
  return *status == GAMUT_OK && study->runs < RUNS_MAX;
}

static gamut_status study_end(struct study *study)
{
  gamut_status status = GAMUT_OK;
  while (study_batch(study, &status))
    ;
  return status;
}

struct result {
  double mean[RESULTS], variance[RESULTS], mean_error[RESULTS], variance_error[RESULTS];
  double mean_lower[RESULTS], mean_upper[RESULTS];
  double variance_lower[RESULTS], variance_upper[RESULTS];
  double heavy_tail[RESULTS];
};

static gamut_status hear_number(struct gamut_report *report, size_t index, const char *name,
                                const char *unit, const char *meaning, const double *value)
{
  (void)report, (void)unit, (void)meaning;
  return index < RESULTS && name && value ? GAMUT_OK : GAMUT_PLUGIN;
}

static gamut_status hear_table(struct gamut_report *report, const char *name, const char *meaning,
                               const struct gamut_table_column *column, size_t columns, size_t rows)
{
  (void)report, (void)meaning, (void)rows;
  for (size_t c = 0; c < columns; c++)
    if (!column[c].name || !column[c].number == !column[c].text)
      return GAMUT_PLUGIN;
  return name && columns > 0 ? GAMUT_OK : GAMUT_PLUGIN;
}

/* Where runs are no sample there are no moments. */
static gamut_status study_report(struct study *study, bool table, struct result *result)
{
  double *number = (double *)result;
  for (size_t i = 0; i < sizeof *result / sizeof *number; i++)
    number[i] = NAN;
  struct gamut_report report = {.moments = {result->mean, result->variance, result->mean_error,
                                            result->variance_error, result->mean_lower,
                                            result->mean_upper, result->variance_lower,
                                            result->variance_upper, result->heavy_tail},
                                .number = hear_number,
                                .table = hear_table};
  if (table)
    report.moments = (struct gamut_moments){0};
  return study->ops->report ? study->ops->report(study->self, &report) : GAMUT_OK;
}

/* An interval that is stated holds the estimate, and the truth lies within twice its width. */
static void prove_interval(struct checks *checks, const char *what, double truth, double estimate,
                           double lower, double upper)
{
  if (isnan(lower) && isnan(upper))
    return;
  check_that(checks, lower <= estimate && estimate <= upper, "the interval of %s holds it", what);
  check_figure(checks, fabs(truth - estimate), 2 * fmax(upper - estimate, estimate - lower),
               "%s against twice its interval", what);
}

static void prove_integrals(struct checks *checks, const struct study *study,
                            const struct result *result)
{
  static const char *const name[RESULTS] = {"a linear", "a quadratic"};
  for (int q = 0; q < RESULTS; q++) {
    check_figure(checks, fabs(result->mean[q] - true_mean[q]),
                 4 * result->mean_error[q] + 1e-9 * true_mean[q],
                 "mean of %s quantity after %zu runs, against four of its error bars", name[q],
                 study->runs);
    check_figure(checks, fabs(result->variance[q] - true_variance[q]),
                 4 * result->variance_error[q] + 1e-9 * true_variance[q],
                 "variance of %s quantity, against four of its error bars", name[q]);
    prove_interval(checks, "the mean", true_mean[q], result->mean[q], result->mean_lower[q],
                   result->mean_upper[q]);
    prove_interval(checks, "the variance", true_variance[q], result->variance[q],
                   result->variance_lower[q], result->variance_upper[q]);
  }
}

/* A study cut after `batches` and taken up by a fresh estimator. */
static bool cut_study(struct bare_run *run, size_t batches, bool table, struct result *result,
                      size_t *runs)
{
  struct study first, second = {0};
  gamut_status status = study_new(&first, run);
  void *bytes = NULL;
  for (size_t i = 0; status == GAMUT_OK && i < batches; i++)
    if (!study_batch(&first, &status))
      break;
  if (status == GAMUT_OK) {
    size_t size = first.ops->save(first.self, NULL);
    bytes = malloc(size + 1);
    if (first.ops->save(first.self, bytes) != size)
      status = GAMUT_PLUGIN;
    if (status == GAMUT_OK)
      status = study_new(&second, run);
    if (status == GAMUT_OK)
      status = second.ops->restore(second.self, bytes, size);
    if (status == GAMUT_OK)
      status = study_end(&second);
    if (status == GAMUT_OK)
      status = study_report(&second, table, result);
    *runs = first.runs + second.runs;
  }
  free(bytes);
  study_free(&first);
  study_free(&second);
  return status == GAMUT_OK;
}

static void prove_restore(struct proof *proof, struct bare_run *run, const struct result *whole,
                          size_t runs)
{
  const bool table = proof->descriptor->yields_table;
  for (size_t batches = 0; batches < 3; batches++) {
    struct result result;
    check_begin(&proof->checks, "save and restore after %zu batches", batches);
    size_t made = 0;
    bool fine = cut_study(run, batches, table, &result, &made);
    check_that(&proof->checks, fine && made == runs && memcmp(&result, whole, sizeof result) == 0,
               "saved after %zu batches and restored, it ends with the same bits", batches);
  }
}

/* Each level is run, once. */
static void prove_levels(struct checks *checks, const struct bare_run *run,
                         const struct study *study)
{
  const size_t levels = levels_of(run->specimen.values);
  check_that(checks, study->runs == (levels ? levels : 1), "%zu runs of %zu levels", study->runs,
             levels);
}

/* What the descriptor says of it: that it asks for the same rows whatever came back, and that it
 * can do with what is left where some runs failed. */
static void prove_claims(struct proof *proof, struct bare_run *run, const struct study *whole)
{
  const struct descriptor *d = proof->descriptor;
  gamut_status status;
  struct study other;
  if (!d->adaptive) {
    check_begin(&proof->checks, "a study that gives other results");
    status = study_new(&other, run);
    other.outcome = OUTCOME_OTHER;
    if (status == GAMUT_OK)
      status = study_end(&other);
    check_that(&proof->checks,
               status == GAMUT_OK && other.runs == whole->runs && other.asked == whole->asked,
               "`adaptive: false`: it asks for the same rows whatever it is told");
    study_free(&other);
  }
  if (d->omits_failed_runs && !d->yields_table) {
    struct result result;
    check_begin(&proof->checks, "a study with failed runs");
    status = study_new(&other, run);
    other.outcome = OUTCOME_SOME_FAIL;
    if (status == GAMUT_OK)
      status = study_end(&other);
    if (status == GAMUT_OK)
      status = study_report(&other, false, &result);
    check_that(&proof->checks,
               status == GAMUT_OK && isfinite(result.mean[0]) && isfinite(result.variance[0]),
               "`omits_failed_runs: true`: mean and variance where one run in %d failed",
               FAILS_ONE_IN);
    study_free(&other);
  }
}

void prove_estimator(struct proof *proof)
{
  struct bare_run run;
  struct study study = {0};
  struct result result;
  check_begin(&proof->checks, "making the estimator");
  if (bare_run_new(&run, proof)) {
    const struct estimator_operations *ops = run.ops;
    const bool table = proof->descriptor->yields_table;
    bool whole = ops->create && ops->destroy && ops->ask && ops->tell && (table || ops->report) &&
                 ops->save && ops->restore;
    if (check_that(&proof->checks, whole, "all operations are there")) {
      gamut_status status = study_new(&study, &run);
      check_begin(&proof->checks, "a study of a linear and a quadratic quantity");
      if (status == GAMUT_OK)
        status = study_end(&study);
      if (status == GAMUT_OK)
        status = study_report(&study, table, &result);
      bool ended = status == GAMUT_OK && study.runs > 0 && study.runs < RUNS_MAX;
      if (check_that(&proof->checks, ended, "a study ends (%zu runs)", study.runs)) {
        if (table)
          prove_levels(&proof->checks, &run, &study);
        else
          prove_integrals(&proof->checks, &study, &result);
        prove_restore(proof, &run, &result, study.runs);
        prove_claims(proof, &run, &study);
      }
      bare_run_say(&run, &proof->checks);
      study_free(&study);
    }
  }
  bare_run_free(&run);
}
