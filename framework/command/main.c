/* The gamut command: common options, then one subcommand. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <hdf5.h>

#include "base/array.h"
#include "base/exclusive.h"
#include "command/command.h"
#include "command/help.h"
#include "command/options.h"
#include "registry/guard.h"

static const struct entry {
  const char *name;
  gamut_status (*function)(struct command *);
} entries[] = {
#define MAIN_ENTRY(name, function, arguments, line) {name, function},
    COMMAND_LIST(MAIN_ENTRY)
#undef MAIN_ENTRY
};
enum { ENTRIES = ARRAY_SIZE(entries) };

struct common {
  struct registry_options registry;
  bool help, version;
};

/* Takes the common options out of argv, wherever they stand before "--". */
static gamut_status take_common(int *argc, char **argv, struct common *common, struct trace *trace)
{
  static const char path[] = "--plugin-path";
  int kept = 1;
  bool ended = false;
  for (int i = 1; i < *argc; i++) {
    char *word = argv[i];
    ended = ended || strcmp(word, "--") == 0;
    if (ended) {
      argv[kept++] = word;
    } else if (strcmp(word, path) == 0) {
      if (i + 1 == *argc)
        return trace_fail(trace, GAMUT_USAGE, "%s wants a folder after it", path);
      common->registry.plugin_path = argv[++i];
    } else if (strncmp(word, path, strlen(path)) == 0 && word[strlen(path)] == '=') {
      common->registry.plugin_path = word + strlen(path) + 1;
    } else if (strcmp(word, "--no-user-plugins") == 0) {
      common->registry.user_plugins = false;
    } else if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
      common->help = true;
    } else if (strcmp(word, "--version") == 0) {
      common->version = true;
    } else {
      argv[kept++] = word;
    }
  }
  *argc = kept;
  argv[kept] = NULL;
  return GAMUT_OK;
}

static gamut_status unknown_command(const char *word, struct trace *trace)
{
  const char *near = usage_nearest(word);
  if (near)
    trace_fail(trace, GAMUT_USAGE, "unknown command '%s'; did you mean '%s'?", word, near);
  else
    trace_fail(trace, GAMUT_USAGE, "unknown command '%s'", word);
  trace_note(trace, "'gamut help' lists the commands");
  return GAMUT_USAGE;
}

static gamut_status run_command(int argc, char **argv, const struct common *common,
                                struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  const struct entry *entry = NULL;
  struct command command = {.argc = argc - 1, .argv = argv + 1, .trace = trace};
  char why[256];
  for (size_t i = 0; i < ENTRIES; i++)
    if (strcmp(entries[i].name, argv[1]) == 0)
      entry = &entries[i];
  if (!entry)
    return unknown_command(argv[1], trace);
  command.units = units_new(why, sizeof why);
  if (!command.units)
    return trace_fail(trace, GAMUT_INTERNAL, "the unit database cannot be read: %s", why);
  TRY(registry_new(&common->registry, command.units, trace, &command.registry));
  status = entry->function(&command);
done:
  registry_free(command.registry);
  units_free(command.units);
  return status;
}

static gamut_status give_help(int argc, char **argv, int topic, struct trace *trace)
{
  if (argc <= topic)
    help_all(stdout);
  else if (!help_command(argv[topic], stdout))
    return unknown_command(argv[topic], trace);
  return GAMUT_OK;
}

static gamut_status dispatch(int argc, char **argv, struct trace *trace)
{
  struct common common = {.registry = {.user_plugins = true}};
  gamut_status status = take_common(&argc, argv, &common, trace);
  if (status != GAMUT_OK)
    return status;
  if (common.version) {
    puts("gamut " GAMUT_VERSION);
    return GAMUT_OK;
  }
  if (argc > 1 && strcmp(argv[1], "help") == 0)
    return give_help(argc, argv, 2, trace);
  if (common.help)
    return give_help(argc, argv, 1, trace);
  if (argc < 2) {
    help_all(stderr);
    return trace_fail(trace, GAMUT_USAGE, "no command given");
  }
  return run_command(argc, argv, &common, trace);
}

/* Results that did not reach the disk or the pipe are no results. A reader that has gone is fine.
 */
static gamut_status flush_output(struct trace *trace)
{
  errno = 0;
  bool failed = ferror(stdout) != 0;
  failed = fflush(stdout) != 0 || failed;
  if (failed && errno != EPIPE)
    return trace_fail(trace, GAMUT_OUTPUT, "cannot write to standard output: %s",
                      errno ? strerror(errno) : "write error");
  return GAMUT_OK;
}

/* Its cleaning at exit() crashes where it got no memory at its start; all files are closed by then.
 */
static void quiet_hdf5(void)
{
  EXCLUSIVE;
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

int main(int argc, char **argv)
{
  struct trace *trace = trace_new();
  if (!trace) {
    fputs("gamut: out of memory\n", stderr);
    return GAMUT_INTERNAL;
  }
  signal(SIGPIPE, SIG_DFL);
  signal(SIGXFSZ, SIG_IGN); /* the write then fails, and is reported as any other */
  guard_install(GUARD_CALL_SECONDS);
  gsl_set_error_handler_off();
  quiet_hdf5();
  gamut_status status = dispatch(argc, argv, trace);
  if (status == GAMUT_OK)
    status = flush_output(trace);
  if (trace_worst(trace) != GAMUT_OK)
    status = trace_worst(trace);
  else if (status != GAMUT_OK)
    trace_note(trace, "%s", status_text(status));
  trace_print(trace, stderr);
  trace_free(trace);
  guard_finish();
  return (int)status;
}
