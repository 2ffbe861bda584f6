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

static gamut_status study_fail_in_file(struct gamut_run *run, const struct gamut_values *values,
                                       const char *path, size_t line, const char *expected,
                                       const char *format, ...)
{
  va_list list;
  va_start(list, format);
  gamut_status status =
      host_messages_fail_in_file(host_of(run)->trace, values, path, line, expected, format, list);
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
    .fail_in_file = study_fail_in_file,
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

static bool describe(struct study *study)
{
  study->parameter = calloc(study->parameters + 1, sizeof *study->parameter);
  study->quantity = calloc(study->quantities + 1, sizeof *study->quantity);
  if (!study->parameter || !study->quantity)
    return false;
  for (size_t i = 0; i < study->parameters; i++) {
    const struct random_parameter *random = &study->scene->random_parameter[i];
    study->parameter[i] = (struct gamut_study_parameter){
        .name = random->path,
        .unit = random->parameter->unit ? random->parameter->unit : "1",
        .mean = random->distribution->mean,
        .deviation = random->distribution->deviation};
  }
  for (size_t i = 0; i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    study->quantity[i] = (struct gamut_study_quantity){.name = m->quantity->name,
                                                       .unit = m->unit,
                                                       .first = m->first,
                                                       .count = m->count,
                                                       .axis = m->curve ? m->axis : NULL,
                                                       .axis_unit = m->curve ? m->axis_unit : NULL,
                                                       .at = m->curve ? m->at : NULL};
  }
  return true;
}

static bool batch_new(struct study *study)
{
  const size_t rows = batch_rows(study);
  struct gamut_batch *batch = &study->batch;
  *batch = (struct gamut_batch){
      .parameters = study->parameters, .results = study->results, .capacity = rows};
  batch->sample = calloc(rows * study->parameters + 1, sizeof *batch->sample);
  batch->level = calloc(rows, sizeof *batch->level);
  batch->mode = calloc(rows, sizeof *batch->mode);
  batch->realisation = calloc(rows, sizeof *batch->realisation);
  batch->result = study->batch_result =
      calloc(rows * study->results + 1, sizeof *study->batch_result);
  batch->cost = study->batch_cost = calloc(rows, sizeof *study->batch_cost);
  study->asked_on = calloc(study->levels + 1, sizeof *study->asked_on);
  return batch->sample && batch->level && batch->mode && batch->realisation && batch->result &&
         batch->cost && study->asked_on;
}

static bool moments_new(struct study *study)
{
  const size_t results = study->results;
  double *moment = study->moment = calloc(MOMENTS * results + 1, sizeof *moment);
  if (!moment)
    return false;
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
  return true;
}

gamut_status estimator_new(struct study *study)
{
  gamut_status status;
  const struct instance *instance = &study->scene->estimator;
  const struct gamut_plugin *plugin;
  TRY(registry_open(study->registry, instance->descriptor, study->trace, &plugin));
  const struct estimator_operations *ops = plugin->ops;
  if (!describe(study) || !batch_new(study) || !moments_new(study))
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  TRY(report_new(study));
  study->host =
      (struct estimator_host){.head = {&study_host}, .trace = study->trace, .node = instance->node};
  host_of_values(instance->values, &study_host);
  const struct gamut_study_shape shape = {
      .parameters = study->parameters,
      .quantities = study->quantities,
      .results = study->results,
      .levels = study->levels,
      .parameter = study->parameter,
      .quantity = study->quantity,
      .correlation = study->scene->correlation,
      .stream = stream_make(study->scene->seed, 0, "uncertainty.estimator")};
  TRY(GUARDED(instance->descriptor->id, ops->create((struct gamut_run *)(void *)&study->host,
                                                    instance->values, &shape, &study->self)));
  study->ops = ops;
done:
  return status;
}

static gamut_status check_row(const struct study *study, size_t row)
{
  const struct gamut_batch *batch = &study->batch;
  const char *id = study->scene->estimator.descriptor->id;
  const int level = batch->level[row], mode = batch->mode[row];
  if (level < 0 || (size_t)level >= (study->levels ? study->levels : 1))
    return trace_fail(study->trace, GAMUT_PLUGIN, "%s asks for level %d, which is not there", id,
                      level);
  if (mode != GAMUT_ROW_RUN)
    return trace_fail(study->trace, GAMUT_PLUGIN,
                      "%s asks for a row of mode %d, which this gamut does not know", id, mode);
  return GAMUT_OK;
}

gamut_status estimator_ask(struct study *study)
{
  gamut_status status;
  struct gamut_batch *batch = &study->batch;
  batch->rows = 0;
  for (size_t r = 0; r < batch->capacity; r++) {
    batch->level[r] = 0;
    batch->mode[r] = GAMUT_ROW_RUN;
    batch->realisation[r] = GAMUT_NEXT_REALISATION;
  }
  TRY(GUARDED(study->scene->estimator.descriptor->id, study->ops->ask(study->self, batch)));
  if (batch->rows > batch->capacity)
    return trace_fail(study->trace, GAMUT_PLUGIN, "%s asks for more runs than there is room for",
                      study->scene->estimator.descriptor->id);
  for (size_t r = 0; r < batch->rows; r++)
    TRY(check_row(study, r));
done:
  return status;
}

void estimator_free(struct study *study)
{
  if (study->ops)
    study->ops->destroy(study->self);
  report_free(study);
  free(study->parameter);
  free(study->quantity);
  free(study->batch.sample);
  free(study->batch.level);
  free(study->batch.mode);
  free(study->batch.realisation);
  free(study->batch_result);
  free(study->batch_cost);
  free(study->moment);
  free(study->asked_on);
}
