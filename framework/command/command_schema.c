#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "command/options.h"
#include "scene/scene.h"
#include "store/file.h"

static gamut_status write_file(struct command *command, const char *name)
{
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (memory)
    schema_write(command->registry, memory);
  gamut_status status = memory && memory_close(memory, &text)
                            ? file_write(name, text, size, command->trace)
                            : trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  free(text);
  return status;
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
