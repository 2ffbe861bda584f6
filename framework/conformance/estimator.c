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

struct study {
  const struct estimator_operations *ops;
  void *self;
  struct gamut_batch batch;
  double *result;
  size_t runs;
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

static gamut_status study_new(struct study *study, struct bare_run *run)
{
  *study = (struct study){.ops = run->ops};
  study->batch = (struct gamut_batch){
      .parameters = PARAMETERS, .results = RESULTS, .capacity = CAPACITY};
  study->batch.sample = calloc(CAPACITY * PARAMETERS, sizeof(double));
  study->batch.level = calloc(CAPACITY, sizeof(int));
  study->result = calloc(CAPACITY * RESULTS, sizeof(double));
  study->batch.result = study->result;
  const struct gamut_study_shape shape = {.parameters = PARAMETERS,
                                          .results = RESULTS,
                                          .levels = levels_of(run->specimen.values),
                                          .stream = stream_make(1, 0, "conformance")};
  return study->ops->create(bare_run_handle(run), run->specimen.values, &shape, &study->self);
}

static void study_free(struct study *study)
{
  if (study->self)
    study->ops->destroy(study->self);
  free(study->batch.sample);
  free(study->batch.level);
  free(study->result);
}

/* One batch; false at the end or on failure. */
static bool study_batch(struct study *study, gamut_status *status)
{
  struct gamut_batch *batch = &study->batch;
  batch->rows = 0;
  *status = study->ops->ask(study->self, batch);
  if (*status != GAMUT_OK || batch->rows == 0 || batch->rows > CAPACITY)
    return false;
  for (size_t r = 0; r < batch->rows; r++)
    quantities(batch->sample + r * PARAMETERS, study->result + r * RESULTS);
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

/* Where runs are no sample there is nothing to report. */
static gamut_status study_report(struct study *study, bool table, struct result *result)
{
  double *number = (double *)result;
  for (size_t i = 0; i < sizeof *result / sizeof *number; i++)
    number[i] = NAN;
  struct gamut_moments moments = {
      result->mean,           result->variance,       result->mean_error,
      result->variance_error, result->mean_lower,     result->mean_upper,
      result->variance_lower, result->variance_upper, result->heavy_tail};
  return table ? GAMUT_OK : study->ops->report(study->self, &moments);
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
      }
      bare_run_say(&run, &proof->checks);
      study_free(&study);
    }
  }
  bare_run_free(&run);
}
