#include "conformance/conformance.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "conformance/scene_run.h"
#include "registry/guard.h"

/* A plugin that hangs is stopped. */
enum { SECONDS_MAX = 300 };

/* The last thing under way: a plugin that calls exit does not get there. */
static const char the_end[] = "the end";

static struct tree *read_known(const struct descriptor *d, struct trace *trace)
{
  struct tree *tree = NULL;
  char name[256];
  snprintf(name, sizeof name, "%s.test.yaml", d->name);
  char *file = plugin_file(d, name);
  if (!file)
    return NULL;
  if (access(file, R_OK) == 0)
    tree_read(file, GAMUT_PLUGIN, trace, &tree);
  free(file);
  return tree;
}

static void say_trace(struct checks *checks, struct trace *trace)
{
  char *text = trace_text(trace);
  check_say(checks, "%s", text ? text : "");
  free(text);
}

/* Whether kernels can be called at all: parameters were found. */
static bool prepare(struct proof *proof, struct trace *trace)
{
  char why[2048] = "";
  const struct descriptor *d = proof->descriptor;
  bool law = d->kind == GAMUT_KIND_EOS || d->kind == GAMUT_KIND_STRENGTH ||
             d->kind == GAMUT_KIND_ELASTICITY;
  proof->known = read_known(d, trace);
  if (trace_errors(trace) > 0) {
    check_that(&proof->checks, false, "%s.test.yaml can be read", d->name);
    say_trace(&proof->checks, trace);
  }
  if (find_base(d, proof->known, proof->units, &proof->base, why, sizeof why))
    return true;
  if (!law)
    return false;
  check_that(&proof->checks, false,
             "parameters that the plugin accepts are found (%s.test.yaml can give them)", d->name);
  check_say(&proof->checks, "%s", why);
  return false;
}

static void prove_kind(struct proof *proof, bool based)
{
  static void (*const suite[GAMUT_KINDS])(struct proof *) = {
      [GAMUT_KIND_EOS] = prove_eos,
      [GAMUT_KIND_STRENGTH] = prove_strength,
      [GAMUT_KIND_ELASTICITY] = prove_elasticity,
      [GAMUT_KIND_EFFECT] = prove_effect,
      [GAMUT_KIND_RANDOM_FIELD] = prove_random_field,
      [GAMUT_KIND_ESTIMATOR] = prove_estimator,
      [GAMUT_KIND_SOLVER] = prove_solver,
  };
  enum gamut_kind kind = proof->descriptor->kind;
  if (based) {
    prove_known_answers(proof);
    suite[kind](proof);
  } else if (kind == GAMUT_KIND_EFFECT || kind == GAMUT_KIND_SOLVER) {
    prove_scene(proof);
  }
  prove_scene_answers(proof);
}

/* A crash shall end the child by its signal, whatever handlers the program has, and leave no core.
 */
static void crash_plainly(void)
{
  const struct rlimit none = {0, 0};
  guard_forget();
  setrlimit(RLIMIT_CORE, &none);
}

/* The whole suite; runs in a process of its own. */
static size_t prove(struct registry *registry, const struct descriptor *descriptor,
                    const struct units *units, FILE *out)
{
  struct proof proof = {.registry = registry,
                        .descriptor = descriptor,
                        .units = units,
                        .checks = {.out = out},
                        .seed = 20240229};
  struct trace *trace = trace_new();
  const struct gamut_plugin *plugin;
  proof.slots = descriptor_layout(descriptor, &proof.slot);
  check_begin(&proof.checks, "opening the shared object");
  if (registry_open(registry, descriptor, trace, &plugin) == GAMUT_OK) {
    check_that(&proof.checks, true, "the shared object opens (%s)",
               registry_level(registry, descriptor));
    bool based = prepare(&proof, trace);
    prove_common(&proof, based);
    prove_kind(&proof, based);
  } else {
    check_that(&proof.checks, false, "the shared object opens");
    say_trace(&proof.checks, trace);
  }
  check_begin(&proof.checks, "%s", the_end);
  settings_free(&proof.base);
  tree_free(proof.known);
  free(proof.slot);
  trace_free(trace);
  return proof.checks.failed;
}

/* What was read of the child's TAP stream. */
struct reading {
  size_t count, failed;
  char under_way[512];
};

static void copy_lines(FILE *from, FILE *out, struct reading *reading)
{
  char *line = NULL;
  size_t size = 0;
  while (getline(&line, &size, from) > 0) {
    if (line[0] == CHECK_UNDER_WAY) {
      snprintf(reading->under_way, sizeof reading->under_way, "%s", line + 1);
      reading->under_way[strcspn(reading->under_way, "\n")] = 0;
      continue;
    }
    reading->count += strncmp(line, "ok ", 3) == 0 || strncmp(line, "not ok ", 7) == 0;
    reading->failed += strncmp(line, "not ok ", 7) == 0;
    fputs(line, out);
    fflush(out);
  }
  free(line);
}

static void end_reading(struct reading *reading, int state, FILE *out)
{
  if (WIFSIGNALED(state) || strcmp(reading->under_way, the_end) != 0) {
    reading->count++;
    reading->failed++;
    if (WIFSIGNALED(state) && WTERMSIG(state) == SIGALRM)
      fprintf(out, "not ok %zu - %s: not done after %d seconds\n", reading->count,
              reading->under_way, SECONDS_MAX);
    else if (WIFSIGNALED(state))
      fprintf(out, "not ok %zu - %s: crashed with signal %d (%s)\n", reading->count,
              reading->under_way, WTERMSIG(state), strsignal(WTERMSIG(state)));
    else
      fprintf(out, "not ok %zu - %s: the plugin ended the program with code %d\n", reading->count,
              reading->under_way, WEXITSTATUS(state));
  }
  fprintf(out, "1..%zu\n", reading->count);
  fflush(out);
}

gamut_status conformance_run(struct registry *registry, const struct descriptor *descriptor,
                             const struct units *units, struct trace *trace, FILE *out)
{
  struct reading reading = {.under_way = "start"};
  int ends[2], state = 0;
  fflush(NULL);
  if (pipe(ends) != 0)
    return trace_fail(trace, GAMUT_INTERNAL, "no pipe can be made: %s", strerror(errno));
  pid_t child = fork();
  if (child < 0)
    return trace_fail(trace, GAMUT_INTERNAL, "no process can be made: %s", strerror(errno));
  if (child == 0) {
    close(ends[0]);
    FILE *file = fdopen(ends[1], "w");
    crash_plainly();
    alarm(SECONDS_MAX);
    size_t failed = prove(registry, descriptor, units, file);
    fclose(file);
    _exit(failed > 0);
  }
  close(ends[1]);
  FILE *file = fdopen(ends[0], "r");
  if (!file)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  copy_lines(file, out, &reading);
  fclose(file);
  while (waitpid(child, &state, 0) < 0 && errno == EINTR)
    ;
  end_reading(&reading, state, out);
  if (reading.failed > 0)
    return trace_fail(trace, GAMUT_PLUGIN, "%s: %zu of %zu checks failed", descriptor->id,
                      reading.failed, reading.count);
  return GAMUT_OK;
}
