#include "conformance/stub_host.h"

#include <stdarg.h>
#include <stdlib.h>

#include "run/host.h"

static struct bare_run *bare(struct gamut_run *run)
{
  return (struct bare_run *)(void *)run;
}

static gamut_status bare_fail(struct gamut_run *run, gamut_status status, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  status = host_messages_fail(bare(run)->trace, status, NULL, format, list);
  va_end(list);
  return status;
}

static gamut_status bare_fail_at(struct gamut_run *run, const struct gamut_values *values,
                                 const char *path, const char *expected, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  gamut_status status =
      host_messages_fail_at(bare(run)->trace, values, path, expected, format, list);
  va_end(list);
  return status;
}

static void bare_note(struct gamut_run *run, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  host_messages_note(bare(run)->trace, format, list);
  va_end(list);
}

static void *bare_allocate(struct gamut_run *run, const char *label, size_t bytes)
{
  return arena_take(bare(run)->arena, label, bytes);
}

static void bare_release(struct gamut_run *run, void *memory)
{
  arena_give(bare(run)->arena, memory);
}

static int bare_threads(const struct gamut_run *run)
{
  (void)run;
  return 1;
}

/* A cube in which the places of the suites lie. */
static bool bare_domain(const struct gamut_run *run, double lower[3], double upper[3])
{
  (void)run;
  for (int k = 0; k < 3; k++) {
    lower[k] = 0.0;
    upper[k] = 0.1;
  }
  return true;
}

static const struct gamut_host bare_host = {
    .size = sizeof(struct gamut_host),
    .fail = bare_fail,
    .fail_at = bare_fail_at,
    .warn = bare_note,
    HOST_OF_VALUES,
    HOST_OF_SUMS,
    .allocate = bare_allocate,
    .release = bare_release,
    .threads = bare_threads,
    .domain = bare_domain,
    .note = bare_note,
};

bool bare_run_new(struct bare_run *run, struct proof *proof)
{
  gamut_status status = GAMUT_OK;
  const struct gamut_plugin *plugin;
  *run = (struct bare_run){.head = {&bare_host}, .trace = trace_new(), .arena = arena_new()};
  TRY(specimen_values(&run->specimen, proof->descriptor, &proof->base, "base", proof->units,
                      run->trace));
  TRY(registry_open(proof->registry, proof->descriptor, run->trace, &plugin));
  host_of_values(run->specimen.values, &bare_host);
  run->ops = plugin->ops;
done:
  if (status != GAMUT_OK) {
    check_that(&proof->checks, false, "the plugin can be given its parameters");
    bare_run_say(run, &proof->checks);
  }
  return status == GAMUT_OK;
}

void bare_run_free(struct bare_run *run)
{
  specimen_close(&run->specimen);
  arena_free(run->arena);
  trace_free(run->trace);
}

struct gamut_run *bare_run_handle(struct bare_run *run)
{
  return (struct gamut_run *)(void *)run;
}

void bare_run_say(struct bare_run *run, struct checks *checks)
{
  char *text = trace_text(run->trace);
  check_say(checks, "%s", text ? text : "");
  free(text);
}
