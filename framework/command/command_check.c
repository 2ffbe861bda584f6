#include <stdio.h>
#include <stdlib.h>

#include "command/scene_arguments.h"
#include "run/run.h"
#include "study/study.h"

/* The levels of a study are scenes of their own. */
static gamut_status check_study(struct command *command, struct scene *scene)
{
  struct study *study = NULL;
  const struct study_options options = {0};
  if (!study_wanted(scene))
    return GAMUT_OK;
  gamut_status status =
      study_new(scene, command->registry, command->units, &options, command->trace, &study);
  study_free(study);
  return status;
}

/* What only plugins can tell: all of a run up to its first step. */
static gamut_status check_plan(struct command *command, struct scene *scene)
{
  struct gamut_run *run = NULL;
  const struct run_options options = {.seed = scene->seed};
  if (scene->solver.descriptor == NULL)
    return GAMUT_OK;
  gamut_status status = run_new(scene, command->registry, &options, command->trace, &run);
  if (status == GAMUT_OK)
    status = run_check(run, command->trace);
  run_free(run);
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
  TRY(check_study(command, scene));
  TRY(check_plan(command, scene));
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
