#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "command/options.h"
#include "scene/scene.h"

static gamut_status write_file(struct command *command, const char *name)
{
  FILE *file = fopen(name, "w");
  if (!file)
    return trace_fail(command->trace, GAMUT_OUTPUT, "cannot write '%s': %s", name, strerror(errno));
  schema_write(command->registry, file);
  errno = 0;
  bool failed = ferror(file) != 0;
  failed = fclose(file) != 0 || failed;
  if (!failed)
    return GAMUT_OK;
  return trace_fail(command->trace, GAMUT_OUTPUT, "cannot write '%s': %s", name,
                    errno ? strerror(errno) : "write error");
}

gamut_status command_schema(struct command *command)
{
  gamut_status status = GAMUT_OK;
  const char *file = NULL;
  const struct option option[] = {{"--output", 'o', OPTION_TEXT, &file}};
  TRY(options_read(command, option, 1, NULL, 0, 0, NULL));
  if (file)
    status = write_file(command, file);
  else
    schema_write(command->registry, stdout);
done:
  return status;
}
