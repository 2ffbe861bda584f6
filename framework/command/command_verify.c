#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "command/find_plugin.h"
#include "command/options.h"
#include "conformance/conformance.h"

/* One plugin's checks as a TAP subtest: its lines indented, then one line for all of them. */
static gamut_status verify_nested(struct command *command, const struct descriptor *descriptor,
                                  size_t number)
{
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  gamut_status status =
      conformance_run(command->registry, descriptor, command->units, command->trace, file);
  memory_close(file, &text);
  printf("# Subtest: %s\n", descriptor->id);
  for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"))
    printf("    %s\n", line);
  printf("%s %zu - %s\n", status == GAMUT_OK ? "ok" : "not ok", number, descriptor->id);
  fflush(stdout);
  free(text);
  return status;
}

static gamut_status verify_all(struct command *command, const char *kind)
{
  gamut_status status = GAMUT_OK;
  enum gamut_kind only = GAMUT_KINDS;
  size_t number = 0;
  if (kind && !kind_from_name(kind, &only))
    return usage_fail(command, "--kind: there is no kind '%s'", kind);
  for (size_t i = 0; i < registry_count(command->registry); i++) {
    const struct descriptor *descriptor = registry_at(command->registry, i);
    if (kind && descriptor->kind != only)
      continue;
    gamut_status one = verify_nested(command, descriptor, ++number);
    if (status == GAMUT_OK)
      status = one;
  }
  printf("1..%zu\n", number);
  return status;
}

gamut_status command_verify(struct command *command)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *descriptor = NULL;
  const char *plugin = NULL, *kind = NULL;
  bool all = false;
  size_t count = 0;
  const struct option option[] = {{"--all", 0, OPTION_FLAG, &all},
                                  {"--kind", 0, OPTION_TEXT, &kind}};
  TRY(options_read(command, option, 2, &plugin, 0, 1, &count));
  if (all == (count == 1)) {
    status = usage_fail(command, all ? "verify wants a plugin or --all, not both"
                                     : "verify wants a plugin, a folder, or --all");
    goto done;
  }
  if (all) {
    status = verify_all(command, kind);
    goto done;
  }
  TRY(find_plugin(command, plugin, &descriptor));
  status = conformance_run(command->registry, descriptor, command->units, command->trace, stdout);
done:
  return status;
}
