#include <stdio.h>
#include <stdlib.h>

#include "command/scene_arguments.h"
#include "run/run.h"
#include "study/study.h"

/* A study's cost follows from that of one of its runs. */
static gamut_status explain_study(struct command *command, struct study *study,
                                  const struct gamut_run *run, const struct run_forecast *one,
                                  char **json)
{
  struct study_forecast forecast;
  const gamut_status status = study_forecast(study, run, one, &forecast);
  if (status != GAMUT_OK)
    return status;
  if (!*json) {
    study_explain(study, &forecast, stdout);
    return GAMUT_OK;
  }
  char *text = study_explain_json(study, &forecast, *json);
  free(*json);
  *json = text;
  return text ? GAMUT_OK : trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
}

gamut_status command_explain(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = NULL, *member = NULL;
  struct study *study = NULL;
  struct gamut_run *run = NULL;
  struct run_forecast forecast = {0};
  struct option_texts set = {0};
  const char *file = NULL;
  char *text = NULL;
  bool json = false;
  const struct run_options options = {0};
  const struct study_options study_options = {0};
  const struct option option[] = {{"--set", 0, OPTION_TEXTS, &set},
                                  {"--json", 0, OPTION_FLAG, &json}};
  TRY(options_read(command, option, 2, &file, 1, 1, NULL));
  TRY(scene_from_arguments(command, file, &set, &scene));
  if (study_wanted(scene)) {
    TRY(study_new(scene, command->registry, command->units, &study_options, command->trace,
                  &study));
    TRY(study_member(study, &member));
  }
  TRY(run_new(member ? member : scene, command->registry, &options, command->trace, &run));
  if (json) {
    text = run_explain_json(run, &forecast);
    if (!text) {
      status = trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
      goto done;
    }
  } else {
    run_explain(run, stdout, &forecast);
  }
  if (study)
    TRY(explain_study(command, study, run, &forecast, &text));
  if (text)
    puts(text);
done:
  free(text);
  run_free(run);
  study_free(study);
  scene_free(member);
  scene_free(scene);
  free(set.text);
  return status;
}
