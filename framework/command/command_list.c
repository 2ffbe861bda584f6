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

/* Length of FOLDER in FOLDER/KIND/NAME, where the plugin was found. */
static size_t home_length(const struct descriptor *descriptor)
{
  size_t length = strlen(descriptor->folder), tail = strlen(descriptor->id) + 1;
  return length > tail ? length - tail : length;
}

static bool same_home(const struct descriptor *one, const struct descriptor *other)
{
  size_t length = home_length(one);
  return length == home_length(other) && strncmp(one->folder, other->folder, length) == 0;
}

/* One table for each folder, in the order of the first plugin found there. */
static void list_tables(const struct registry *registry)
{
  size_t count = registry_count(registry);
  int width = longest(registry);
  if (count == 0)
    puts("no plugins are installed; 'gamut list --paths' shows where was looked");
  for (size_t first = 0; first < count; ++first) {
    const struct descriptor *home = registry_at(registry, first);
    size_t earlier = 0;
    while (!same_home(registry_at(registry, earlier), home))
      ++earlier;
    if (earlier < first)
      continue;
    printf("%sin %.*s\n", first ? "\n" : "", (int)home_length(home), home->folder);
    for (size_t i = first; i < count; ++i) {
      const struct descriptor *descriptor = registry_at(registry, i);
      if (same_home(descriptor, home))
        printf("  %-*s  %-5s  %s\n", width, descriptor->id, descriptor->version,
               descriptor->summary);
    }
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
  return failed ? trace_fail(trace, GAMUT_INTERNAL, "the list cannot be written as JSON")
                : GAMUT_OK;
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
    list_tables(command->registry);
  }
done:
  return status;
}
