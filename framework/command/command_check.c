#include <stdio.h>
#include <stdlib.h>

#include "command/scene_arguments.h"
#include "run/run.h"
#include "study/study.h"

/* What only plugins can tell: all of a run up to its first step. */
static gamut_status check_plan(struct command *command, struct scene *scene, struct trace *trace)
{
  struct gamut_run *run = NULL;
  const struct run_options options = {.seed = scene->seed};
  if (scene->solver.descriptor == NULL)
    return GAMUT_OK;
  gamut_status status = run_new(scene, command->registry, &options, trace, &run);
  if (status == GAMUT_OK)
    status = run_check(run, trace);
  run_free(run);
  return status;
}

static gamut_status check_level(struct command *command, struct study *study, size_t level,
                                struct trace *trace)
{
  struct scene *scene = NULL;
  gamut_status status = study_member(study, level, trace, &scene);
  if (status == GAMUT_OK)
    status = check_plan(command, scene, trace);
  scene_free(scene);
  return status;
}

/* As `run` does: a level that cannot be planned is a run that fails, and the next one is asked. */
static gamut_status check_levels(struct command *command, struct study *study, size_t levels)
{
  gamut_status status = GAMUT_SCENE;
  for (size_t i = 0; i + 1 < levels && status != GAMUT_OK; i++) {
    struct trace *unheard = trace_new();
    status = check_level(command, study, i, unheard);
    const char *words = trace_first(unheard, MESSAGE_ERROR);
    if (status != GAMUT_OK)
      trace_warn_at(command->trace, NULL, NULL, NULL, "level %zu cannot be run: %s", i,
                    words ? words : status_text(status));
    trace_free(unheard);
  }
  return status == GAMUT_OK ? status : check_level(command, study, levels - 1, command->trace);
}

/* The levels of a study are scenes of their own. Where they stand for themselves, that the scene
 * below them could not be run says nothing of the study. */
static gamut_status check_scene(struct command *command, struct scene *scene)
{
  gamut_status status = GAMUT_OK;
  struct study *study = NULL;
  const struct study_options options = {0};
  if (study_wanted(scene))
    TRY(study_new(scene, command->registry, command->units, &options, command->trace, &study));
  const size_t levels = study ? study_members(study) : 0;
  status = levels > 0 ? check_levels(command, study, levels)
                      : check_plan(command, scene, command->trace);
done:
  study_free(study);
  return status;
}

gamut_status command_check(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = NULL;
  struct option_texts set = {0};
  const char *file = NULL;
  const struct option option[] = {{"--set", 0, OPTION_TEXTS, &set}};
  TRY(options_read(command, option, 1, &file, 1, 1, NULL));
  TRY(scene_from_arguments(command, file, &set, &scene));
  TRY(check_scene(command, scene));
  printf("%s: fine (solver %s, %zu material%s, %zu bod%s, %zu effect%s, %zu quantit%s)\n", file,
         scene->solver.descriptor ? scene->solver.descriptor->name : "none: a card",
         scene->materials, scene->materials == 1 ? "" : "s", scene->bodies,
         scene->bodies == 1 ? "y" : "ies", scene->effects, scene->effects == 1 ? "" : "s",
         scene->quantities, scene->quantities == 1 ? "y" : "ies");
done:
  scene_free(scene);
  free(set.text);
  return status;
}
