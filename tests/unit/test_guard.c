/* A plugin that crashes, exits or hangs is named, whatever thread it runs on. Each case is a
 * process of its own. */
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "registry/guard.h"
#include "tests/tap.h"

static void crash(void)
{
  raise(SIGSEGV);
}

static void leave(void)
{
  exit(0);
}

static void hang(void)
{
  for (;;)
    pause();
}

static void many_short_calls(void)
{
  const struct timespec pause = {.tv_nsec = 100000000};
  for (int i = 0; i < 15; i++) {
    const char *before = guard_enter("strength/short");
    nanosleep(&pause, NULL);
    guard_leave(before);
  }
  guard_finish();
  exit(0);
}

static void nothing(void)
{
  guard_finish();
  exit(0);
}

static void on_other_thread(void)
{
#pragma omp parallel num_threads(2)
  {
    const char *before = guard_enter("strength/of_a_thread");
    raise(SIGFPE);
    guard_leave(before);
  }
}

static void nested(void)
{
  guard_push("elasticity/outer");
  const char *before = guard_enter("strength/inner");
  guard_leave(before);
  raise(SIGBUS);
}

/* What the process says and ends with. `plugin` null: nothing is marked. */
static int try_it(void (*function)(void), const char *plugin, char *said, size_t size)
{
  int ends[2], state = 0;
  fflush(NULL);
  if (pipe(ends) != 0)
    abort();
  pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    guard_install(1);
    if (plugin)
      guard_enter(plugin);
    function();
    _exit(99);
  }
  close(ends[1]);
  size_t used = 0;
  for (ssize_t got; (got = read(ends[0], said + used, size - 1 - used)) > 0;)
    used += (size_t)got;
  said[used] = 0;
  close(ends[0]);
  waitpid(child, &state, 0);
  return WIFEXITED(state) ? WEXITSTATUS(state) : 1000 + WTERMSIG(state);
}

int main(void)
{
  static const struct {
    const char *name;
    void (*function)(void);
    const char *plugin;
    int code;
    const char *words;
  } cases[] = {
      {"a crash", crash, "strength/a", GAMUT_PLUGIN, "plugin strength/a crashed"},
      {"a call of exit", leave, "eos/b", GAMUT_PLUGIN, "plugin eos/b ended the program"},
      {"one call too long", hang, "effect/c", GAMUT_PLUGIN, "plugin effect/c hangs"},
      {"a thread of OpenMP", on_other_thread, NULL, GAMUT_PLUGIN, "plugin strength/of_a_thread"},
      {"back in the outer plugin", nested, NULL, GAMUT_PLUGIN, "plugin elasticity/outer crashed"},
      {"a crash of the core", crash, NULL, GAMUT_INTERNAL, "internal fault"},
      {"exit before the work is done", leave, NULL, GAMUT_INTERNAL, "internal fault"},
      {"many short calls, together too long", many_short_calls, NULL, 0, ""},
      {"the end", nothing, NULL, 0, ""},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char said[2048];
#if defined(__SANITIZE_ADDRESS__)
    /* The sanitizer has the crashes of the core to itself. */
    if (cases[i].function == crash && !cases[i].plugin)
      continue;
#endif
    int code = try_it(cases[i].function, cases[i].plugin, said, sizeof said);
    tap_ok(code == cases[i].code && strstr(said, cases[i].words), "%s: ends with %d (due %d): %s",
           cases[i].name, code, cases[i].code, said);
  }
  return tap_done();
}
