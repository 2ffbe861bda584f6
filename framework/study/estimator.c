#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

#include "random/stream.h"
#include "registry/guard.h"
#include "run/host.h"
#include "study/study_private.h"

enum { BYTES_A_BATCH = 1 << 26, ROWS_MIN = 16, ROWS_MAX = 4096 };

static const struct estimator_host *host_of(struct gamut_run *run)
{
  return (const struct estimator_host *)(const void *)run;
}

static gamut_status study_fail(struct gamut_run *run, gamut_status status, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  status = host_messages_fail(host_of(run)->trace, status, host_of(run)->node, format, list);
  va_end(list);
  return status;
}

static gamut_status study_fail_at(struct gamut_run *run, const struct gamut_values *values,
                                  const char *path, const char *expected, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  gamut_status status =
      host_messages_fail_at(host_of(run)->trace, values, path, expected, format, list);
  va_end(list);
  return status;
}

static void study_warn(struct gamut_run *run, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  host_messages_warn(host_of(run)->trace, format, list);
  va_end(list);
}

static const struct gamut_host study_host = {
    .size = sizeof(struct gamut_host),
    .fail = study_fail,
    .fail_at = study_fail_at,
    .warn = study_warn,
    HOST_OF_VALUES,
    HOST_OF_SUMS,
};

/* Fixed by the scene alone, so that batches are the same whatever the machine. */
static size_t batch_rows(const struct study *study)
{
  size_t columns = study->results + study->parameters + 1;
  size_t rows = BYTES_A_BATCH / (columns * sizeof(double));
  return rows < ROWS_MIN ? ROWS_MIN : rows > ROWS_MAX ? ROWS_MAX : rows;
}

gamut_status estimator_new(struct study *study)
{
  gamut_status status;
  const struct instance *instance = &study->scene->estimator;
  const struct gamut_plugin *plugin;
  size_t rows = batch_rows(study), results = study->results;
  TRY(registry_open(study->registry, instance->descriptor, study->trace, &plugin));
  const struct estimator_operations *ops = plugin->ops;
  if (!ops->create || !ops->destroy || !ops->ask || !ops->tell || (!study->table && !ops->report))
    return trace_fail(study->trace, GAMUT_PLUGIN,
                      "%s lacks one of the operations create, destroy, ask, tell%s",
                      instance->descriptor->id, study->table ? "" : ", report");
  struct gamut_batch *batch = &study->batch;
  *batch =
      (struct gamut_batch){.parameters = study->parameters, .results = results, .capacity = rows};
  batch->sample = calloc(rows * study->parameters + 1, sizeof *batch->sample);
  batch->level = calloc(rows, sizeof *batch->level);
  batch->result = study->batch_result = calloc(rows * results + 1, sizeof *study->batch_result);
  double *moment = study->moment = calloc(MOMENTS * results + 1, sizeof *moment);
  study->asked_on = calloc(study->levels + 1, sizeof *study->asked_on);
  if (!batch->sample || !batch->level || !study->batch_result || !moment || !study->asked_on)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < MOMENTS * results; i++)
    moment[i] = NAN;
  study->moments = (struct gamut_moments){.mean = moment,
                                          .variance = moment + results,
                                          .mean_error = moment + 2 * results,
                                          .variance_error = moment + 3 * results,
                                          .mean_lower = moment + 4 * results,
                                          .mean_upper = moment + 5 * results,
                                          .variance_lower = moment + 6 * results,
                                          .variance_upper = moment + 7 * results,
                                          .heavy_tail = moment + 8 * results};
  study->host = (struct estimator_host){
      .head = {&study_host}, .trace = study->trace, .node = instance->node};
  host_of_values(instance->values, &study_host);
  const struct gamut_study_shape shape = {
      .parameters = study->parameters,
      .results = results,
      .levels = study->levels,
      .stream = stream_make(study->scene->seed, 0, "uncertainty.estimator")};
  TRY(GUARDED(instance->descriptor->id, ops->create((struct gamut_run *)(void *)&study->host,
                                                    instance->values, &shape, &study->self)));
  study->ops = ops;
done:
  return status;
}

void estimator_free(struct study *study)
{
  if (study->ops)
    study->ops->destroy(study->self);
  free(study->batch.sample);
  free(study->batch.level);
  free(study->batch_result);
  free(study->moment);
  free(study->asked_on);
}
