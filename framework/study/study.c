#include <math.h>
#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "base/clock.h"
#include "registry/guard.h"
#include "study/study_private.h"

bool study_wanted(const struct scene *scene)
{
  return scene->estimator.descriptor != NULL;
}

static bool has_fields(const struct values *values)
{
  for (size_t i = 0; values && i < values->count; i++)
    if ((values->value[i].random && values->value[i].model) || has_fields(values->value[i].group))
      return true;
  return false;
}

static bool any_field(const struct scene *scene)
{
  bool any = has_fields(scene->solver.values);
  for (size_t i = 0; i < scene->materials; i++) {
    const struct material *m = &scene->material[i];
    any = any || has_fields(m->eos.values) || has_fields(m->strength.values) ||
          has_fields(m->elasticity.values) || has_fields(m->extra);
  }
  for (size_t i = 0; i < scene->effects; i++)
    any = any || has_fields(scene->effect[i].instance.values);
  return any;
}

/* A sample of runs that cannot differ is hardly what was meant. */
static void warn_of_certainty(const struct study *study)
{
  const struct tree *node = study->scene->estimator.node;
  if (!study->table && study->parameters == 0 && !any_field(study->scene))
    trace_warn_at(study->trace, node ? &node->place : NULL, "uncertainty.estimator",
                  "{mean:, cv:} in place of a number",
                  "no parameter of the scene is random: every run will be the same");
}

gamut_status study_new(struct scene *scene, struct registry *registry, const struct units *units,
                       const struct study_options *options, struct trace *trace,
                       struct study **made)
{
  gamut_status status;
  struct study *study = calloc(1, sizeof *study);
  *made = NULL;
  if (!study)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  study->scene = scene;
  study->registry = registry;
  study->units = units;
  study->options = *options;
  study->trace = trace;
  study->log = -1;
  study->threads = options->threads;
#ifdef _OPENMP
  if (study->threads <= 0)
    study->threads = omp_get_max_threads();
#endif
  study->threads = study->threads < 1 ? 1 : study->threads;
  if (!scene->solver.descriptor) {
    status = trace_fail(trace, GAMUT_SCENE,
                        "%s has no solver: it is a card for other scenes, not a run", scene->file);
    goto done;
  }
  TRY(levels_make(study));
  TRY(draw_prepare(study));
  warn_of_certainty(study);
  *made = study;
  return GAMUT_OK;
done:
  study_free(study);
  return status;
}

void study_free(struct study *study)
{
  if (!study)
    return;
  log_close(study);
  store_close(study->store);
  estimator_free(study);
  levels_free(study);
  for (size_t i = 0; study->nominal && i < level_count(study); i++) {
    outcome_clear(&study->nominal[i].outcome);
    free(study->nominal[i].steps.step);
  }
  free(study->nominal);
  worker_clear(&study->probe);
  free(study->cut);
  for (size_t i = 0; study->measured && i < study->quantities; i++)
    free(study->measured[i].at);
  for (size_t i = 0; i < study->runs; i++)
    outcome_clear(&study->outcome[i]);
  for (size_t i = 0; i < study->logs; i++)
    outcome_clear(&study->logged[i]);
  free(study->log_path);
  free(study->warning);
  free(study->measured);
  free(study->outcome);
  free(study->logged);
  free(study->lower);
  free(study);
}

/* A run that the log has, if it is the same one. */
static gamut_status recall(struct study *study, size_t number)
{
  struct outcome *wanted = &study->outcome[number];
  if (number >= study->logs || !study->logged[number].done)
    return GAMUT_OK;
  struct outcome *logged = &study->logged[number];
  bool same = logged->level == wanted->level && logged->mode == wanted->mode &&
              logged->realisation == wanted->realisation;
  for (size_t i = 0; i < study->parameters; i++)
    same = same &&
           fabs(logged->parameter[i] - wanted->parameter[i]) <= 1e-9 * fabs(wanted->parameter[i]);
  if (!same)
    return trace_fail(study->trace, GAMUT_OUTPUT,
                      "run %zu of the log is not the run that the estimator asks for", number);
  logged->again = wanted->again;
  outcome_clear(wanted);
  *wanted = *logged;
  *logged = (struct outcome){0};
  study->repeated++;
  study->finished++;
  study->failed += wanted->reason != NULL;
  return GAMUT_OK;
}

static gamut_status make_room(struct study *study)
{
  if (study->runs + study->batch.rows <= study->room)
    return GAMUT_OK;
  const size_t room = 2 * study->room + study->batch.rows;
  struct outcome *grown = realloc(study->outcome, room * sizeof *grown);
  if (!grown)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  study->outcome = grown;
  study->room = room;
  return GAMUT_OK;
}

/* Rows of the batch become runs, with the realisations that the core gives. */
static gamut_status list_rows(struct study *study)
{
  gamut_status status;
  struct gamut_batch *batch = &study->batch;
  TRY(make_room(study));
  for (size_t r = 0; r < batch->rows; r++) {
    struct outcome *o = &study->outcome[study->runs];
    const size_t level = (size_t)batch->level[r], before = study->asked_on[level]++;
    TRY(nominal_of_level(study, level));
    if (batch->realisation[r] == GAMUT_NEXT_REALISATION)
      batch->realisation[r] = before;
    *o = (struct outcome){.level = level,
                          .mode = (enum gamut_row_mode)batch->mode[r],
                          .realisation = batch->realisation[r]};
    if (!outcome_room(study, o)) {
      outcome_clear(o);
      return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
    }
    const size_t number = study->runs++;
    TRY(draw_run(study, batch->sample + r * study->parameters, o));
    TRY(recall(study, number));
  }
done:
  return status;
}

static bool told_to_stop(const struct study *study)
{
  return study->options.stop && *study->options.stop;
}

/* Books a finished run; one thread at a time. */
static gamut_status book(struct study *study, size_t number)
{
  const struct outcome *o = &study->outcome[number];
  gamut_status status = log_run(study, number, o);
  study->finished++;
  study->failed += o->reason != NULL;
  if (study->options.progress)
    study->options.progress(study->options.progress_self, study->finished, study->runs,
                            study->failed);
  return status;
}

static gamut_status run_rows(struct study *study, size_t first)
{
  gamut_status end = GAMUT_OK;
#pragma omp parallel num_threads(study->threads)
  {
    struct worker worker = {0};
#pragma omp for schedule(dynamic, 1)
    for (size_t k = first; k < study->runs; k++) {
      gamut_status status, over;
#pragma omp atomic read
      over = end;
      if (over != GAMUT_OK || study->outcome[k].done || told_to_stop(study))
        continue;
      status = work_run(study, &worker, &study->outcome[k]);
#pragma omp critical(gamut_study_book)
      {
        if (status == GAMUT_OK)
          status = book(study, k);
        if (status != GAMUT_OK && end == GAMUT_OK) {
#pragma omp atomic write
          end = status;
        }
      }
    }
#pragma omp critical(gamut_study_scene)
    worker_clear(&worker);
  }
  return end == GAMUT_OK && told_to_stop(study) ? GAMUT_STOPPED : end;
}

static const char *estimator_of(const struct study *study)
{
  return study->scene->estimator.descriptor->id;
}

static gamut_status tell(struct study *study, size_t first)
{
  for (size_t r = 0; r < study->batch.rows; r++) {
    const struct outcome *o = &study->outcome[first + r];
    for (size_t q = 0; q < study->results; q++)
      study->batch_result[r * study->results + q] = o->reason ? NAN : o->result[q];
    study->batch_cost[r] = (struct gamut_row_cost){o->cpu, o->work};
  }
  return GUARDED(estimator_of(study), study->ops->tell(study->self, &study->batch));
}

size_t level_count(const struct study *study)
{
  return study->levels ? study->levels : 1;
}

bool may_fail(const struct study *study)
{
  return study->scene->estimator.descriptor->omits_failed_runs;
}

bool too_many_fail(const struct study *study)
{
  if (!may_fail(study))
    return study->failed > 0;
  const size_t levels = study->table ? level_count(study) : 0;
  const size_t runs = levels > study->runs ? levels : study->runs;
  return (double)study->failed > study->scene->failures * (double)runs || study->failed >= runs;
}

static gamut_status judge_failures(struct study *study)
{
  const char *reason = NULL;
  if (!too_many_fail(study))
    return GAMUT_OK;
  for (size_t i = 0; i < study->runs && !reason; i++)
    reason = study->outcome[i].reason;
  if (!may_fail(study))
    return trace_fail_at(study->trace, GAMUT_NUMERICS, NULL, NULL, "study.csv has every reason",
                         "%zu of %zu runs failed, and %s can leave none out; the first: %s",
                         study->failed, study->runs, estimator_of(study), reason);
  return trace_fail_at(study->trace, GAMUT_NUMERICS, NULL, NULL,
                       study->table ? "study.csv has every reason"
                                    : "the moments of what is left would mislead; study.csv has "
                                      "every reason",
                       "%zu of %zu runs failed, more than the share of %g that "
                       "uncertainty.failures allows; the first: %s",
                       study->failed, study->runs, study->scene->failures, reason);
}

static gamut_status run_batches(struct study *study)
{
  gamut_status status = GAMUT_OK;
  for (;;) {
    const size_t first = study->runs;
    TRY(estimator_ask(study));
    if (study->batch.rows == 0)
      break;
    TRY(list_rows(study));
    TRY(run_rows(study, first));
    TRY(tell(study, first));
    TRY(judge_failures(study));
  }
  if (study->runs == 0)
    return trace_fail(study->trace, GAMUT_SCENE, "%s asks for no run",
                      study->scene->estimator.descriptor->id);
  status = report_take(study);
done:
  return status;
}

static gamut_status write_all(struct study *study, gamut_status status)
{
  if (!study->store || study->runs == 0 || (status != GAMUT_OK && status != GAMUT_NUMERICS))
    return status;
  gamut_status written = log_there(study);
  if (written == GAMUT_OK)
    written = store_renew(study->store, study->trace);
  if (written == GAMUT_OK)
    written = results_write(study, study->store, status);
  return status != GAMUT_OK ? status : written;
}

/* Many runs of one scene that are all the same are hardly what was meant. */
static void warn_of_sameness(const struct study *study)
{
  size_t same = 0, other = 0;
  for (size_t i = 1; i < study->runs; i++) {
    const struct outcome *one = &study->outcome[i - 1], *next = &study->outcome[i];
    if (one->level != next->level || one->reason || next->reason)
      continue;
    bool alike = memcmp(one->result, next->result, study->results * sizeof *one->result) == 0;
    same += alike;
    other += !alike;
  }
  if (same > 0 && other == 0 && study->results > 0 && study->parameters > 0)
    trace_warn_at(study->trace, NULL, "uncertainty", "{mean:, cv:} in place of a number",
                  "%zu runs gave the same values to the last bit: no quantity depends on what is "
                  "random",
                  study->runs);
}

gamut_status study_run(struct study *study, const char *folder, struct trace *trace)
{
  gamut_status status;
  double begun = clock_seconds(CLOCK_MONOTONIC);
  study->trace = trace;
  TRY(nominal_prepare(study, folder));
  status = run_batches(study);
  study->wall = clock_seconds(CLOCK_MONOTONIC) - begun;
  warn_of_sameness(study);
  if (study->warned)
    trace_warn_at(trace, NULL, NULL, NULL, "%zu of %zu runs had warnings; one of them: %s",
                  study->warned, study->runs, study->warning ? study->warning : "");
  status = write_all(study, status);
done:
  log_close(study);
  store_close(study->store);
  study->store = NULL;
  return status;
}
