#include "command/scene_arguments.h"

#include <stdlib.h>
#include <string.h>

struct override_list {
  struct scene_override *override;
  size_t count;
  char **path; /* owned; the values are borrowed from argv */
};

static gamut_status overrides_read(struct command *command, const struct option_texts *texts,
                                   struct override_list *list)
{
  *list = (struct override_list){.override = calloc(texts->count + 1, sizeof *list->override),
                                 .path = calloc(texts->count + 1, sizeof *list->path)};
  if (!list->override || !list->path)
    return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < texts->count; i++) {
    const char *equals = strchr(texts->text[i], '=');
    if (!equals || equals == texts->text[i])
      return usage_fail(command, "--set wants path=value, e.g. 'solver.cell=0.2 mm', not '%s'",
                        texts->text[i]);
    char *path = list->path[list->count] =
        strndup(texts->text[i], (size_t)(equals - texts->text[i]));
    if (!path)
      return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
    list->override[list->count++] = (struct scene_override){.path = path, .value = equals + 1};
  }
  return GAMUT_OK;
}

static void overrides_free(struct override_list *list)
{
  for (size_t i = 0; list->path && i < list->count; i++)
    free(list->path[i]);
  free(list->path);
  free(list->override);
}

gamut_status scene_from_arguments(struct command *command, const char *file,
                                  const struct option_texts *texts, struct scene **scene)
{
  gamut_status status = GAMUT_OK;
  struct override_list list;
  TRY(overrides_read(command, texts, &list));
  TRY(scene_read(file, list.override, list.count, command->registry, command->units, command->trace,
                 scene));
done:
  overrides_free(&list);
  return status;
}
