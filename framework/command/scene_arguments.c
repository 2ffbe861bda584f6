#include "command/scene_arguments.h"

#include <stdlib.h>
#include <string.h>

gamut_status scene_from_arguments(struct command *command, const char *file,
                                  const struct option_texts *texts, struct scene **scene)
{
  gamut_status status = GAMUT_OK;
  struct scene_override *override = calloc(texts->count + 1, sizeof *override);
  char **path = calloc(texts->count + 1, sizeof *path);
  if (!override || !path) {
    status = trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  for (size_t i = 0; i < texts->count; i++) {
    const char *equals = strchr(texts->text[i], '=');
    if (!equals || equals == texts->text[i]) {
      status = usage_fail(command, "--set wants path=value, e.g. 'solver.cell=0.2 mm', not '%s'",
                          texts->text[i]);
      goto done;
    }
    path[i] = strndup(texts->text[i], (size_t)(equals - texts->text[i]));
    override[i] = (struct scene_override){.path = path[i], .value = equals + 1};
  }
  TRY(scene_read(file, override, texts->count, command->registry, command->units, command->trace,
                 scene));
done:
  for (size_t i = 0; path && i < texts->count; i++)
    free(path[i]);
  free(path);
  free(override);
  return status;
}
