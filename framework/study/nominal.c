/* Before the first run of a study: what is measured, in which units, on which axes. Where runs are
 * a sample, the run at the means is it and gives the axes. Where each stands for itself, the scene
 * below the levels is no member and need not work: the first level that can be planned is taken. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "study/study_private.h"

/* The folder is taken before the first run; results.h5 is closed meanwhile, so that whatever ends
 * the program leaves it whole. */
static gamut_status begin(struct study *study, const char *folder)
{
  gamut_status status = GAMUT_OK;
  bool there = false;
  if (!folder)
    return GAMUT_OK;
  TRY(store_hold(folder, study->trace, &study->store));
  TRY(log_resume(study, folder, &there));
  if (there)
    return GAMUT_OK;
  if (study->options.resume)
    trace_note(study->trace, "there is no study in '%s' yet: it begins", folder);
  TRY(store_begin(study->store,
                  study->options.force || (study->options.resume && store_is_bare(folder)),
                  study->trace));
  TRY(store_scene(study->store, study->scene->tree, study->trace));
  status = log_begin(study, folder);
done:
  if (study->store)
    store_rest(study->store);
  return status;
}

static struct run_options options_of(const struct study *study)
{
  return (struct run_options){.threads = study->threads,
                              .stop = study->options.stop,
                              .seed = study->scene->seed,
                              .keep_steps = !study->table && study->scene->step_margin >= 0};
}

static gamut_status plan_level(struct study *study, size_t level, struct trace *trace,
                               struct scene **scene, struct gamut_run **run)
{
  gamut_status status;
  const struct run_options options = options_of(study);
  TRY(level_scene(study, level, trace, scene));
  status = run_new(*scene, study->registry, &options, trace, run);
done:
  if (status != GAMUT_OK) {
    run_free(*run);
    scene_free(*scene);
    *run = NULL;
    *scene = NULL;
  }
  return status;
}

/* Levels that cannot be planned fail later, as runs of their own. */
static gamut_status first_level(struct study *study, struct scene **scene, struct gamut_run **run)
{
  gamut_status status = GAMUT_OK;
  const size_t levels = level_count(study);
  size_t last = 0;
  *scene = NULL;
  *run = NULL;
  for (size_t i = 0; i < levels; i++) {
    struct trace *unheard = trace_new();
    status = plan_level(study, last = i, unheard, scene, run);
    trace_free(unheard);
    if (status == GAMUT_OK || !ends_run_only(status))
      break;
  }
  if (status == GAMUT_OK)
    return status;
  if (last > 0 && ends_run_only(status))
    trace_note(study->trace, "no level can be run; the error is that of the last, level %zu", last);
  return plan_level(study, last, study->trace, scene, run); /* with its place */
}

gamut_status plan_first_level(struct study *study)
{
  struct scene *scene;
  struct gamut_run *run;
  gamut_status status = first_level(study, &scene, &run);
  if (status == GAMUT_OK)
    status = measured_plan(study, run);
  run_free(run);
  scene_free(scene);
  return status;
}

gamut_status study_member(struct study *study, struct scene **scene)
{
  struct gamut_run *run = NULL;
  *scene = NULL;
  gamut_status status = study->table ? first_level(study, scene, &run) : GAMUT_OK;
  run_free(run);
  return status;
}

static bool any_curve(const struct study *study)
{
  for (size_t i = 0; i < study->quantities; i++)
    if (study->measured[i].curve)
      return true;
  return false;
}

static gamut_status outcome_begin(struct study *study, size_t level)
{
  struct outcome *outcome = &study->nominal[level].outcome;
  outcome_clear(outcome);
  if (!outcome_room(study, outcome))
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  outcome->level = level;
  for (size_t i = 0; i < study->parameters; i++)
    outcome->parameter[i] = study->scene->random_parameter[i].distribution->mean;
  for (size_t i = 0; i < study->results; i++)
    outcome->result[i] = NAN;
  return GAMUT_OK;
}

static gamut_status keep_steps(struct study *study, size_t level, const struct gamut_run *run)
{
  struct common_steps *steps = &study->nominal[level].steps;
  const double margin = study->scene->step_margin;
  free(steps->step);
  *steps = (struct common_steps){0};
  if (!(margin >= 0)) /* each run takes its own */
    return GAMUT_OK;
  return steps_make(run_steps_taken(run), run_time(run), margin, steps)
             ? GAMUT_OK
             : trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
}

/* What came of the run at the means. */
static gamut_status keep(struct study *study, size_t level, const struct gamut_run *run,
                         const char *reason)
{
  gamut_status status;
  struct outcome *outcome = &study->nominal[level].outcome;
  const struct run_cost cost = run_cost_of(run);
  if (!reason && !log_has_axes(study))
    TRY(measured_axes(study, run));
  TRY(outcome_begin(study, level));
  if (reason)
    outcome->reason = memory_copy(reason);
  else
    TRY(measured_take(study, run, outcome));
  TRY(keep_steps(study, level, run));
  outcome->steps = cost.steps;
  outcome->points = cost.points;
  outcome->work = cost.work;
  outcome->wall = cost.wall;
  outcome->cpu = cost.cpu;
  outcome->done = true;
done:
  return status;
}

/* Where there are curves the first one gives their axes and must not fail. */
static gamut_status march_nominal(struct study *study, size_t level, struct gamut_run *run)
{
  gamut_status status;
  const bool needed = level == 0 && any_curve(study);
  struct trace *trace = needed ? study->trace : trace_new();
  const gamut_status marched = run_march(run, trace);
  const char *words = trace_first(trace, MESSAGE_ERROR);
  if (marched == GAMUT_NUMERICS && needed)
    trace_note(trace, "this was the run at the means, whose curves give the common axes");
  if (marched != GAMUT_OK && (marched != GAMUT_NUMERICS || needed)) {
    status = marched;
    goto done;
  }
  const char *reason = marched == GAMUT_OK ? NULL : words ? words : status_text(marched);
  TRY(keep(study, level, run, reason));
  if (reason)
    trace_warn_at(study->trace, NULL, NULL, NULL,
                  study->scene->step_margin >= 0
                      ? "the run at the means failed, so that each run takes its own steps: %s"
                      : "the run at the means failed: %s",
                  reason);
  if (level == 0)
    TRY(log_axes(study));
  status = log_nominal(study, level);
done:
  if (trace != study->trace)
    trace_free(trace);
  return status;
}

static bool is_made(const struct study *study, size_t level)
{
  return study->nominal[level].outcome.done && (level > 0 || log_has_axes(study));
}

gamut_status nominal_of_level(struct study *study, size_t level)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = NULL;
  struct gamut_run *run = NULL;
  if (!study->nominal || is_made(study, level))
    return GAMUT_OK;
  TRY(plan_level(study, level, study->trace, &scene, &run));
  status = march_nominal(study, level, run);
done:
  run_free(run);
  scene_free(scene);
  return status;
}

const struct outcome *nominal_done(const struct study *study, size_t index)
{
  for (size_t i = 0; study->nominal && i < level_count(study); i++)
    if (study->nominal[i].outcome.done && index-- == 0)
      return &study->nominal[i].outcome;
  return NULL;
}

size_t nominals_done(const struct study *study)
{
  size_t count = 0;
  while (nominal_done(study, count))
    count++;
  return count;
}

static gamut_status prepare_sample(struct study *study, const char *folder)
{
  gamut_status status;
  struct scene *scene = NULL;
  struct gamut_run *run = NULL;
  const struct gamut_plugin *plugin;
  study->nominal = calloc(level_count(study), sizeof *study->nominal);
  if (!study->nominal)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  TRY(plan_level(study, 0, study->trace, &scene, &run));
  TRY(measured_plan(study, run));
  TRY(registry_open(study->registry, study->scene->estimator.descriptor, study->trace, &plugin));
  log_digest(study);
  TRY(begin(study, folder));
  if (!is_made(study, 0))
    status = march_nominal(study, 0, run);
done:
  run_free(run);
  scene_free(scene);
  return status;
}

static gamut_status prepare_table(struct study *study, const char *folder)
{
  gamut_status status;
  const struct gamut_plugin *plugin;
  TRY(plan_first_level(study));
  TRY(registry_open(study->registry, study->scene->estimator.descriptor, study->trace, &plugin));
  log_digest(study);
  status = begin(study, folder);
done:
  return status;
}

gamut_status nominal_prepare(struct study *study, const char *folder)
{
  const gamut_status status =
      study->table ? prepare_table(study, folder) : prepare_sample(study, folder);
  return status == GAMUT_OK ? estimator_new(study) : status;
}
