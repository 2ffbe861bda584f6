#include "command/find_plugin.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool is_path(const char *text)
{
  struct stat entry;
  size_t length = strlen(text);
  if (text[0] == '.' || text[0] == '/' || (length > 5 && strcmp(text + length - 5, ".yaml") == 0))
    return true;
  return stat(text, &entry) == 0 && S_ISDIR(entry.st_mode);
}

static gamut_status unknown_plugin(struct command *command, const char *text)
{
  size_t count = registry_count(command->registry);
  const char **id = calloc(count + 1, sizeof *id), **name = calloc(count + 1, sizeof *name);
  const char *near = NULL;
  for (size_t i = 0; id && name && i < count; i++) {
    id[i] = registry_at(command->registry, i)->id;
    name[i] = registry_at(command->registry, i)->name;
  }
  if (id && name) {
    near = nearest(text, id, count);
    if (!near && !strchr(text, '/') && nearest(text, name, count))
      near = nearest(text, name, count);
  }
  if (near)
    trace_fail(command->trace, GAMUT_PLUGIN, "no plugin '%s' is installed; did you mean '%s'?",
               text, near);
  else
    trace_fail(
        command->trace, GAMUT_PLUGIN,
        "no plugin '%s' is installed; 'gamut list' shows what is, 'gamut list --paths' where "
        "was looked",
        text);
  free(id);
  free(name);
  return GAMUT_PLUGIN;
}

gamut_status find_plugin(struct command *command, const char *text,
                         const struct descriptor **descriptor)
{
  size_t alike = 0;
  *descriptor = registry_find(command->registry, text);
  if (*descriptor)
    return GAMUT_OK;
  if (is_path(text))
    return registry_add(command->registry, text, command->trace, descriptor);
  for (size_t i = 0; i < registry_count(command->registry); i++)
    if (strcmp(registry_at(command->registry, i)->name, text) == 0) {
      *descriptor = registry_at(command->registry, i);
      alike++;
    }
  if (alike > 1)
    return trace_fail(command->trace, GAMUT_PLUGIN,
                      "%zu plugins are called '%s'; say which kind, e.g. '%s'", alike, text,
                      (*descriptor)->id);
  return alike == 1 ? GAMUT_OK : unknown_plugin(command, text);
}
