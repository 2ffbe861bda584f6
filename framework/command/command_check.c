#include <stdio.h>
#include <stdlib.h>

#include "command/scene_arguments.h"
#include "study/study.h"

gamut_status command_check(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = NULL;
  struct option_texts set = {0};
  const char *file = NULL;
  const struct option option[] = {{"--set", 0, OPTION_TEXTS, &set}};
  TRY(options_read(command, option, 1, &file, 1, 1, NULL));
  TRY(scene_from_arguments(command, file, &set, &scene));
  TRY(study_check(scene, command->registry, command->units, command->trace));
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
