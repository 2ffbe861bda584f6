#include <stdio.h>
#include <stdlib.h>

#include "command/scene_arguments.h"
#include "run/run.h"

gamut_status command_explain(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = NULL;
  struct gamut_run *run = NULL;
  struct option_texts set = {0};
  const char *file = NULL;
  char *text = NULL;
  bool json = false;
  const struct run_options options = {0};
  const struct option option[] = {{"--set", 0, OPTION_TEXTS, &set},
                                  {"--json", 0, OPTION_FLAG, &json}};
  TRY(options_read(command, option, 2, &file, 1, 1, NULL));
  TRY(scene_from_arguments(command, file, &set, &scene));
  TRY(run_new(scene, command->registry, &options, command->trace, &run));
  if (json) {
    text = run_explain_json(run);
    if (!text) {
      status = trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
      goto done;
    }
    puts(text);
  } else {
    run_explain(run, stdout);
  }
done:
  free(text);
  run_free(run);
  scene_free(scene);
  free(set.text);
  return status;
}
