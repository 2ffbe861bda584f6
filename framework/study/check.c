/* In place of a run or a study: what is known of it before its first step. */
#include <stdlib.h>

#include "base/memory.h"
#include "study/study_private.h"

static gamut_status check_run(struct scene *scene, struct registry *registry, struct trace *trace)
{
  gamut_status status;
  struct gamut_run *run = NULL;
  const struct run_options options = {.seed = scene->seed};
  TRY(run_new(scene, registry, &options, trace, &run));
  status = run_check(run, trace);
done:
  run_free(run);
  return status;
}

/* Levels say the same as a rule: what is no error is counted, the first one's words are printed. */
static void hear(struct study *study, const struct trace *trace, size_t level)
{
  const char *warning = trace_first(trace, MESSAGE_WARNING);
  const char *note = trace_first(trace, MESSAGE_NOTE);
  if (note && !study->noted)
    trace_note(study->trace, "level %zu: %s", level, note);
  study->noted = study->noted || note;
  study->warned += warning != NULL;
  if (warning && !study->warning)
    study->warning = memory_copy(warning);
}

/* One that cannot begin is a run that fails, as it is in the study. */
static gamut_status check_level(struct study *study, size_t level)
{
  struct scene *scene = NULL;
  struct trace *unheard = trace_new();
  gamut_status status = level_scene(study, level, unheard, &scene);
  if (status == GAMUT_OK)
    status = check_run(scene, study->registry, unheard);
  const char *first = trace_first(unheard, MESSAGE_ERROR);
  const char *words = first ? first : status_text(status);
  if (ends_run_only(status)) {
    trace_warn_at(study->trace, NULL, NULL, NULL, "level %zu cannot be run: %s", level, words);
    study->failed++;
    status = GAMUT_OK;
  } else if (status != GAMUT_OK) {
    trace_fail(study->trace, status, "level %zu: %s", level, words);
  } else {
    hear(study, unheard, level);
  }
  scene_free(scene);
  trace_free(unheard);
  return status;
}

static gamut_status check_levels(struct study *study)
{
  gamut_status status;
  const size_t levels = level_count(study);
  TRY(plan_first_level(study));
  for (size_t i = 0; i < levels && !too_many_fail(study); i++)
    TRY(check_level(study, i));
  if (study->warned)
    trace_warn_at(study->trace, NULL, NULL, NULL,
                  "%zu of %zu levels have warnings; one of them: %s", study->warned, levels,
                  study->warning);
  if (too_many_fail(study))
    status = trace_fail(study->trace, GAMUT_NUMERICS,
                        "at least %zu of %zu levels cannot be run, more than the share of %g that "
                        "uncertainty.failures allows",
                        study->failed, levels, study->scene->failures);
done:
  return status;
}

gamut_status study_check(struct scene *scene, struct registry *registry, const struct units *units,
                         struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct study *study = NULL;
  const struct study_options options = {0};
  if (study_wanted(scene)) {
    TRY(study_new(scene, registry, units, &options, trace, &study));
    status = study->table ? check_levels(study) : check_run(scene, registry, trace);
  } else if (scene->solver.descriptor) { /* else it is a card */
    status = check_run(scene, registry, trace);
  }
done:
  study_free(study);
  return status;
}
