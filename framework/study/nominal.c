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
  return (struct run_options){
      .threads = study->threads, .stop = study->options.stop, .seed = study->scene->seed};
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
  const size_t levels = levels_of_table(study);
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

static gamut_status nominal_begin(struct study *study)
{
  struct outcome *nominal = &study->nominal;
  outcome_clear(nominal);
  if (!outcome_room(study, nominal))
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < study->parameters; i++)
    nominal->parameter[i] = study->scene->random_parameter[i].distribution->mean;
  for (size_t i = 0; i < study->results; i++)
    nominal->result[i] = NAN;
  return GAMUT_OK;
}

static gamut_status march_nominal(struct study *study, struct gamut_run *run)
{
  gamut_status status, marched;
  struct outcome *nominal = &study->nominal;
  if (nominal->done && log_has_axes(study))
    return GAMUT_OK;
  struct trace *trace = any_curve(study) ? study->trace : trace_new();
  marched = run_march(run, trace);
  if (marched == GAMUT_NUMERICS && trace == study->trace)
    trace_note(trace, "this was the run at the means, whose curves give the common axes");
  const char *words = trace_first(trace, MESSAGE_ERROR);
  if (marched != GAMUT_OK && (marched != GAMUT_NUMERICS || trace == study->trace)) {
    status = marched;
    goto done;
  }
  if (marched == GAMUT_OK)
    TRY(measured_axes(study, run));
  TRY(nominal_begin(study));
  if (marched == GAMUT_OK)
    TRY(measured_take(study, run, nominal));
  else
    nominal->reason = memory_copy(words ? words : status_text(marched));
  const struct run_cost cost = run_cost_of(run);
  nominal->steps = cost.steps;
  nominal->points = cost.points;
  nominal->work = cost.work;
  nominal->wall = cost.wall;
  nominal->cpu = cost.cpu;
  nominal->done = true;
  if (nominal->reason)
    trace_warn_at(study->trace, NULL, NULL, NULL, "the run at the means failed: %s",
                  nominal->reason);
  TRY(log_axes(study));
  status = log_nominal(study);
done:
  if (trace != study->trace)
    trace_free(trace);
  return status;
}

static gamut_status prepare_sample(struct study *study, const char *folder)
{
  gamut_status status;
  struct gamut_run *run = NULL;
  const struct gamut_plugin *plugin;
  const struct run_options options = options_of(study);
  TRY(run_new(study->scene, study->registry, &options, study->trace, &run));
  TRY(measured_plan(study, run));
  TRY(registry_open(study->registry, study->scene->estimator.descriptor, study->trace, &plugin));
  log_digest(study);
  TRY(begin(study, folder));
  status = march_nominal(study, run);
done:
  run_free(run);
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
