#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"

gamut_status overrides_read(const char *const *text, size_t count, struct trace *trace,
                            struct override_list *list)
{
  *list = (struct override_list){.override = calloc(count + 1, sizeof *list->override),
                                 .path = calloc(count + 1, sizeof *list->path)};
  if (!list->override || !list->path)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < count; i++) {
    const char *equals = strchr(text[i], '=');
    if (!equals || equals == text[i])
      return trace_fail(trace, GAMUT_USAGE,
                        "--set wants path=value, e.g. 'solver.cell=0.2 mm', not '%s'", text[i]);
    char *path = list->path[list->count] = strndup(text[i], (size_t)(equals - text[i]));
    if (!path)
      return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    list->override[list->count++] = (struct scene_override){.path = path, .value = equals + 1};
  }
  return GAMUT_OK;
}

void overrides_free(struct override_list *list)
{
  for (size_t i = 0; list->path && i < list->count; i++)
    free(list->path[i]);
  free(list->path);
  free(list->override);
}
