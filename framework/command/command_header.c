#include <stdio.h>

#include "command/options.h"

gamut_status command_header(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct descriptor *descriptor = NULL;
  const char *file = NULL;
  TRY(options_read(command, NULL, 0, &file, 1, 1, NULL));
  TRY(descriptor_read(file, command->units, command->trace, &descriptor));
  descriptor_header(descriptor, stdout);
done:
  descriptor_free(descriptor);
  return status;
}
