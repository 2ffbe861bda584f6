#include "bench/lone_run.h"

#include <stdarg.h>

#include "run/host.h"

static struct lone_run *bare(struct gamut_run *run)
{
  return (struct lone_run *)(void *)run;
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

static gamut_status bare_fail_in_file(struct gamut_run *run, const struct gamut_values *values,
                                      const char *path, size_t line, const char *expected,
                                      const char *format, ...)
{
  va_list list;
  va_start(list, format);
  gamut_status status =
      host_messages_fail_in_file(bare(run)->trace, values, path, line, expected, format, list);
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
    .fail_in_file = bare_fail_in_file,
    .warn = bare_note,
    HOST_OF_VALUES,
    HOST_OF_SUMS,
    .allocate = bare_allocate,
    .release = bare_release,
    .threads = bare_threads,
    .domain = bare_domain,
    .note = bare_note,
};

void lone_run_open(struct lone_run *lone, struct trace *trace, struct arena *arena)
{
  *lone = (struct lone_run){.head = {&bare_host}, .trace = trace, .arena = arena};
}

struct gamut_run *lone_run_handle(struct lone_run *lone)
{
  return (struct gamut_run *)(void *)lone;
}

void lone_run_values(struct gamut_values *values)
{
  host_of_values(values, &bare_host);
}
