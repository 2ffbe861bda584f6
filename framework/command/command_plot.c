#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "command/options.h"
#include "report/report.h"

/* Frames count from 0. */
static gamut_status read_frame(struct command *command, const char *text, long *frame)
{
  char *end;
  errno = 0;
  *frame = strtol(text, &end, 10);
  if (end == text || *end || errno || *frame < 0)
    return usage_fail(command, "--frame wants the number of a frame, from 0, not '%s'", text);
  return GAMUT_OK;
}

gamut_status command_plot(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct plot_options plot = {.frame = -1};
  const char *result = NULL, *frame = NULL;
  const struct option option[] = {{"--field", 0, OPTION_TEXT, &plot.field},
                                  {"--frame", 0, OPTION_TEXT, &frame},
                                  {"--output", 'o', OPTION_TEXT, &plot.folder}};
  TRY(options_read(command, option, 3, &result, 1, 1, NULL));
  if (frame)
    TRY(read_frame(command, frame, &plot.frame));
  TRY(report_plot(result, &plot, command->trace));
done:
  return status;
}
