#include <stdio.h>
#include <string.h>

#include <jansson.h>

#include "command/options.h"

static int longest(const struct registry *registry)
{
  size_t width = 0;
  for (size_t i = 0; i < registry_count(registry); ++i) {
    size_t length = strlen(registry_at(registry, i)->id);
    width = length > width ? length : width;
  }
  return (int)width;
}

static void list_table(const struct registry *registry)
{
  int width = longest(registry);
  const char *folder = "";
  for (size_t i = 0; i < registry_count(registry); ++i) {
    const struct descriptor *descriptor = registry_at(registry, i);
    printf("%-*s  %-5s  %s\n", width, descriptor->id, descriptor->version, descriptor->summary);
  }
  if (registry_count(registry) == 0)
    puts("no plugins are installed; 'gamut list --paths' tells where was looked");
  for (size_t i = 0; i < registry_count(registry); ++i) {
    const struct descriptor *descriptor = registry_at(registry, i);
    /* FOLDER/KIND/NAME: plugins of one folder are named once */
    size_t length = strlen(descriptor->folder), tail = strlen(descriptor->id) + 1;
    length = length > tail ? length - tail : length;
    if (strlen(folder) > length && strncmp(folder, descriptor->folder, length + 1) == 0)
      continue;
    folder = descriptor->folder;
    printf("%sin %.*s\n", i == 0 ? "\n" : "", (int)length, folder);
  }
}

static gamut_status list_json(const struct registry *registry, struct trace *trace)
{
  json_t *list = json_array();
  for (size_t i = 0; i < registry_count(registry); ++i) {
    const struct descriptor *descriptor = registry_at(registry, i);
    json_array_append_new(list, json_pack("{ss ss ss ss ss}", "id", descriptor->id, "version",
                                          descriptor->version, "summary", descriptor->summary,
                                          "digest", descriptor->digest, "file", descriptor->file));
  }
  int failed = json_dumpf(list, stdout, JSON_INDENT(2));
  json_decref(list);
  putchar('\n');
  return failed ? trace_fail(trace, GAMUT_INTERNAL, "the list cannot be written as JSON") : GAMUT_OK;
}

gamut_status command_list(struct command *command)
{
  gamut_status status = GAMUT_OK;
  bool paths = false, json = false;
  const struct option option[] = {{"--paths", 0, OPTION_FLAG, &paths},
                                  {"--json", 0, OPTION_FLAG, &json}};
  TRY(options_read(command, option, 2, NULL, 0, 0, NULL));
  if (json) {
    TRY(list_json(command->registry, command->trace));
  } else if (paths) {
    registry_paths(command->registry, stdout);
  } else {
    list_table(command->registry);
  }
done:
  return status;
}
