/* `gamut run` of a scene that asks for a study. */
#include <stdio.h>
#include <stdlib.h>

#include "command/command_run.h"
#include "command/scene_arguments.h"
#include "report/report.h"

static gamut_status show_results(struct command *command, const struct run_arguments *arguments,
                                 const struct study *study, gamut_status ran)
{
  char *summary = study_summary(study, ran);
  if (!summary)
    return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  if (arguments->json) {
    puts(summary);
  } else {
    report_summary(summary, stdout);
    printf("results in %s\n", arguments->folder);
  }
  free(summary);
  return GAMUT_OK;
}

gamut_status run_study(struct command *command, const struct run_arguments *arguments,
                       struct scene *scene)
{
  gamut_status status = GAMUT_OK, ran;
  struct study *study = NULL;
  struct runs_progress *progress = runs_progress_new(stderr);
  const struct study_options options = {.threads = arguments->threads,
                                        .resume = arguments->resume || arguments->retry_failed,
                                        .retry_failed = arguments->retry_failed,
                                        .force = arguments->force,
                                        .stop = arguments->stop,
                                        .progress = runs_progress_tell,
                                        .progress_self = progress};
  TRY(study_new(scene, command->registry, command->units, &options, command->trace, &study));
  trace_print(command->trace, stderr);
  ran = study_run(study, arguments->folder, command->trace);
  runs_progress_free(progress);
  progress = NULL;
  if (ran == GAMUT_STOPPED)
    trace_note(command->trace, "stopped; study.log in %s has every finished run",
               arguments->folder);
  else if (ran == GAMUT_OK || ran == GAMUT_NUMERICS)
    status = show_results(command, arguments, study, ran);
  status = ran != GAMUT_OK ? ran : status;
done:
  runs_progress_free(progress);
  study_free(study);
  return status;
}
