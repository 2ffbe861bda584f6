#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "study/study_private.h"

bool outcome_room(struct study *study, struct outcome *outcome)
{
  outcome->parameter = calloc(study->parameters + 1, sizeof(double));
  outcome->result = calloc(study->results + 1, sizeof(double));
  outcome->owns = study->table ? study->quantities : 0;
  outcome->own = calloc(outcome->owns + 1, sizeof *outcome->own);
  return outcome->parameter && outcome->result && outcome->own;
}

void outcome_clear(struct outcome *outcome)
{
  free(outcome->parameter);
  free(outcome->result);
  free(outcome->reason);
  for (size_t i = 0; outcome->own && i < outcome->owns; i++) {
    free(outcome->own[i].at);
    free(outcome->own[i].value);
  }
  free(outcome->own);
  *outcome = (struct outcome){0};
}

void worker_clear(struct worker *worker)
{
  scene_free(worker->scene);
  free(worker->parameter);
  *worker = (struct worker){0};
}

/* Which of the study's parameters the scene's are: a level may have made one certain. */
static bool map_parameters(const struct study *study, struct worker *worker)
{
  const struct scene *scene = worker->scene;
  worker->parameter = calloc(scene->random_parameters + 1, sizeof *worker->parameter);
  for (size_t i = 0; worker->parameter && i < scene->random_parameters; i++)
    for (size_t k = 0; k < study->parameters; k++)
      if (strcmp(study->scene->random_parameter[k].path, scene->random_parameter[i].path) == 0)
        worker->parameter[i] = k;
  return worker->parameter != NULL;
}

/* What the scene warns of was printed when the levels were checked. */
gamut_status worker_take(const struct study *study, struct worker *worker, size_t level,
                         struct trace *trace)
{
  if (worker->scene && worker->level == level)
    return GAMUT_OK;
  struct trace *unheard = trace_new();
  worker_clear(worker);
  worker->level = level;
  gamut_status status = level_scene(study, level, unheard, &worker->scene);
  if (status != GAMUT_OK)
    trace_fail(trace, status, "%s", trace_first(unheard, MESSAGE_ERROR));
  else if (!map_parameters(study, worker))
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  trace_free(unheard);
  return status;
}

static gamut_status draw(const struct worker *worker, const struct outcome *outcome,
                         struct trace *trace)
{
  size_t count = worker->scene->random_parameters;
  double *value = calloc(count + 1, sizeof *value);
  if (!value)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < count; i++)
    value[i] = outcome->parameter[worker->parameter[i]];
  gamut_status status = scene_draw(worker->scene, value, trace);
  free(value);
  return status;
}

static gamut_status make(const struct study *study, struct worker *worker,
                         const struct outcome *outcome, struct trace *trace, struct gamut_run **run)
{
  gamut_status status;
  const struct run_options options = {.threads = 1,
                                      .stop = study->options.stop,
                                      .seed = study->scene->seed,
                                      .realisation = outcome->realisation,
                                      .given = steps_of(study, outcome->level)};
/* Units are read by one thread at a time. */
#pragma omp critical(gamut_study_scene)
  status = worker_take(study, worker, outcome->level, trace);
  TRY(status);
  TRY(draw(worker, outcome, trace));
  TRY(run_new(worker->scene, study->registry, &options, trace, run));
done:
  return status;
}

static gamut_status collect(const struct study *study, const struct gamut_run *run,
                            struct outcome *outcome)
{
  const struct run_cost cost = run_cost_of(run);
  outcome->steps = cost.steps;
  outcome->points = cost.points;
  outcome->work = cost.work;
  if (!outcome->reason && measured_take(study, run, outcome) != GAMUT_OK)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  return GAMUT_OK;
}

/* Warnings come from many runs at once: they are counted, the first one is printed. */
static void take_warning(struct study *study, const struct trace *trace)
{
  const char *words = trace_first(trace, MESSAGE_WARNING);
  if (!words)
    return;
#pragma omp critical(gamut_study_warning)
  {
    study->warned++;
    if (!study->warning)
      study->warning = memory_copy(words);
  }
}

bool ends_run_only(gamut_status status)
{
  return status == GAMUT_NUMERICS || status == GAMUT_SCENE;
}

gamut_status work_run(struct study *study, struct worker *worker, struct outcome *outcome)
{
  gamut_status status = GAMUT_INTERNAL;
  struct gamut_run *run = NULL;
  struct trace *trace = trace_new();
  double wall = clock_seconds(CLOCK_MONOTONIC), cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  for (size_t i = 0; i < study->results; i++)
    outcome->result[i] = NAN;
  if (trace)
    status = make(study, worker, outcome, trace, &run);
  if (status == GAMUT_OK)
    status = run_march(run, trace);
  if (ends_run_only(status)) {
    const char *words = trace_first(trace, MESSAGE_ERROR);
    outcome->reason = memory_copy(words ? words : status_text(status));
    status = outcome->reason ? GAMUT_OK : GAMUT_INTERNAL;
  } else if (status != GAMUT_OK && status != GAMUT_STOPPED) {
    const char *words = trace_first(trace, MESSAGE_ERROR);
    trace_fail(study->trace, status, "%s", words ? words : status_text(status));
  }
  if (run && status == GAMUT_OK)
    status = collect(study, run, outcome);
  run_free(run);
  take_warning(study, trace);
  trace_free(trace);
  outcome->wall = clock_seconds(CLOCK_MONOTONIC) - wall;
  outcome->cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - cpu;
  outcome->done = status == GAMUT_OK;
  return status;
}
