#include "registry/guard.h"
#include "base/array.h"
#include "base/clock.h"

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"

enum {
  STATES = 1280, /* threads that are watched at one time; crashes are named on any */
  DEPTH = 16,    /* operations of plugins that call each other through the core */
  HANDLER_STACK = 65536,
  WATCH_STACK = 131072
};

/* What one thread does. */
struct thread_state {
  _Atomic(const char *) plugin; /* innermost; null: none */
  atomic_uint turn;             /* grows with every outermost call */
  atomic_bool unlimited;        /* the outermost call may take its time */
  atomic_bool taken;
  const char *pushed[DEPTH];
  unsigned depth;
};

/* Signal handlers and the watch see the whole process: this state cannot belong to a run. */
static struct thread_state states[STATES];
static _Thread_local struct thread_state own; /* where all states are taken */
static _Thread_local struct thread_state *mine;
static pthread_key_t leaving;
static pthread_once_t once = PTHREAD_ONCE_INIT;
static atomic_bool installed;
static atomic_int limit_seconds;
static _Atomic(const volatile sig_atomic_t *) asked;

static const struct {
  int number;
  const char *text;
} crashes[] = {{SIGSEGV, "invalid memory reference (SIGSEGV)"},
               {SIGBUS, "bus error (SIGBUS)"},
               {SIGFPE, "arithmetic error (SIGFPE)"},
               {SIGILL, "illegal instruction (SIGILL)"},
               {SIGABRT, "abort (SIGABRT)"}};
enum { CRASHES = ARRAY_SIZE(crashes) };
static struct sigaction before_us[CRASHES];

struct thread_end {
  struct thread_state *state;
  void *stack;
};

static void thread_ends(void *memory)
{
  struct thread_end *end = memory;
  const stack_t off = {.ss_flags = SS_DISABLE};
  if (end->stack)
    sigaltstack(&off, NULL);
  free(end->stack);
  if (end->state)
    atomic_store(&end->state->taken, false);
  free(end);
}

static void make_key(void)
{
  if (pthread_key_create(&leaving, thread_ends) != 0)
    abort();
}

/* A stack that has run over can take no handler. */
static void *handler_stack(void)
{
  const stack_t stack = {.ss_sp = malloc(HANDLER_STACK), .ss_size = HANDLER_STACK};
  if (stack.ss_sp && sigaltstack(&stack, NULL) != 0) {
    free(stack.ss_sp);
    return NULL;
  }
  return stack.ss_sp;
}

static struct thread_state *free_state(void)
{
  for (size_t i = 0; i < STATES; i++) {
    bool taken = false;
    if (atomic_compare_exchange_strong(&states[i].taken, &taken, true))
      return &states[i];
  }
  return NULL;
}

static struct thread_state *begin_thread(void)
{
  pthread_once(&once, make_key);
  struct thread_end *end = calloc(1, sizeof *end);
  mine = &own;
  if (!end)
    return mine;
  end->state = free_state();
  if (end->state)
    mine = end->state;
  if (atomic_load(&installed))
    end->stack = handler_stack();
  if (pthread_setspecific(leaving, end) != 0)
    thread_ends(end);
  return mine;
}

static const char *enter(const char *plugin, bool unlimited)
{
  struct thread_state *state = mine ? mine : begin_thread();
  const char *before = atomic_load_explicit(&state->plugin, memory_order_relaxed);
  if (!before) {
    unsigned turn = atomic_load_explicit(&state->turn, memory_order_relaxed);
    atomic_store_explicit(&state->turn, turn + 1, memory_order_relaxed);
    atomic_store_explicit(&state->unlimited, unlimited, memory_order_relaxed);
  }
  atomic_store_explicit(&state->plugin, plugin, memory_order_relaxed);
  return before;
}

const char *guard_enter(const char *plugin)
{
  return enter(plugin, false);
}

const char *guard_enter_long(const char *plugin)
{
  return enter(plugin, true);
}

void guard_leave(const char *before)
{
  atomic_store_explicit(&mine->plugin, before, memory_order_relaxed);
}

void guard_push(const char *plugin)
{
  const char *before = guard_enter_long(plugin);
  assert(mine->depth < DEPTH);
  mine->pushed[mine->depth++] = before;
}

gamut_status guard_pop(gamut_status status)
{
  guard_leave(mine->pushed[--mine->depth]);
  return status;
}

/* Handlers may call nothing that is not async-signal-safe. */
static void say(const char *text)
{
  for (size_t left = strlen(text); left > 0;) {
    ssize_t done = write(STDERR_FILENO, text, left);
    if (done <= 0)
      return;
    text += done;
    left -= (size_t)done;
  }
}

/* The plugin of this thread; else one that waits for threads of its own, of which this may be one.
 */
static const char *plugin_here(void)
{
  const char *plugin = mine ? atomic_load(&mine->plugin) : NULL;
  for (size_t i = 0; !plugin && !mine && i < STATES; i++)
    plugin = atomic_load(&states[i].plugin);
  return plugin;
}

/* A progress line may stand there. */
static void begin_line(void)
{
  say(isatty(STDERR_FILENO) ? "\ngamut: error: " : "gamut: error: ");
}

static _Noreturn void end_by_plugin(const char *plugin, const char *what, const char *cause)
{
  begin_line();
  say("plugin ");
  say(plugin);
  say(what);
  say(cause);
  say("\n  results and the last checkpoint, if any, are kept as they were before; "
      "`gamut verify ");
  say(plugin);
  say("` says more\n");
  _exit(GAMUT_PLUGIN);
}

static void on_crash(int number, siginfo_t *info, void *context)
{
  (void)info;
  (void)context;
  size_t k = 0;
  while (k + 1 < CRASHES && crashes[k].number != number)
    k++;
  const char *plugin = plugin_here();
  if (plugin)
    end_by_plugin(plugin, " crashed: ", crashes[k].text);
  if (before_us[k].sa_handler != SIG_DFL && before_us[k].sa_handler != SIG_IGN) {
    sigaction(number, &before_us[k], NULL); /* the fault comes again, to whoever was there first */
    return;
  }
  begin_line();
  say("internal fault: ");
  say(crashes[k].text);
  say(" outside of plugins; please report it with the scene\n");
  _exit(GAMUT_INTERNAL);
}

static void on_exit_call(void)
{
  if (!atomic_load(&installed))
    return;
  const char *plugin = plugin_here();
  if (plugin)
    end_by_plugin(plugin, " ended the program: ", "it called exit()");
  begin_line();
  say("internal fault: something called exit() before the work was done\n");
  _exit(GAMUT_INTERNAL);
}

static void end_without_memory(void)
{
  begin_line();
  say("no memory left; results and the last checkpoint, if any, are kept as they were before\n");
  _exit(GAMUT_INTERNAL);
}

/* How long a thread has been in what it does now. */
struct stay {
  unsigned turn;
  double since;
};

static void look_at(const struct thread_state *state, struct stay *stay, double now,
                    double asked_for)
{
  const char *plugin = atomic_load(&state->plugin);
  unsigned turn = atomic_load(&state->turn);
  if (!plugin || turn != stay->turn) {
    *stay = (struct stay){turn, now};
    return;
  }
  if (!atomic_load(&state->unlimited) && now - stay->since > atomic_load(&limit_seconds))
    end_by_plugin(plugin, " hangs: ", "it takes longer over one block of points than a kernel may");
  /* The first look after a call began may come a little late. */
  if (asked_for >= GUARD_GRACE_SECONDS && now - stay->since > 0.8 * GUARD_GRACE_SECONDS)
    end_by_plugin(plugin, " hangs: ", "the program was asked to end and waited for it");
}

static _Noreturn void end_unfinished(int number)
{
  begin_line();
  say("asked to end, and what is under way takes too long to be waited for; the last checkpoint, "
      "if any, is kept\n");
  signal(number, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, number);
  pthread_sigmask(SIG_UNBLOCK, &set, NULL);
  raise(number);
  _exit(GAMUT_INTERNAL);
}

static void *watch(void *unused)
{
  static struct stay stay[STATES];
  const struct timespec pause = {.tv_nsec = 100000000};
  double asked_at = clock_seconds(CLOCK_MONOTONIC);
  (void)unused;
  for (;;) {
    nanosleep(&pause, NULL);
    const double now = clock_seconds(CLOCK_MONOTONIC);
    const volatile sig_atomic_t *stop = atomic_load(&asked);
    const int number = stop ? *stop : 0;
    if (number != SIGTERM)
      asked_at = now;
    const double asked_for = now - asked_at;
    for (size_t i = 0; i < STATES; i++)
      if (atomic_load(&states[i].taken))
        look_at(&states[i], &stay[i], now, asked_for);
    if (asked_for > GUARD_GRACE_SECONDS + 0.3)
      end_unfinished(number);
  }
  return NULL;
}

/* The watch also takes signals that a plugin has blocked in its own thread. */
static void start_watch(void)
{
  pthread_t thread;
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0)
    return;
  pthread_attr_setstacksize(&attributes, WATCH_STACK);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  if (pthread_create(&thread, &attributes, watch, NULL) != 0)
    say("gamut: warning: no thread can be made that watches for plugins that hang\n");
  pthread_attr_destroy(&attributes);
}

void guard_install(int call_seconds)
{
  struct sigaction action = {.sa_sigaction = on_crash, .sa_flags = SA_SIGINFO | SA_ONSTACK};
  sigemptyset(&action.sa_mask);
  atomic_store(&limit_seconds, call_seconds);
  atomic_store(&installed, true);
  for (size_t i = 0; i < CRASHES; i++)
    sigaction(crashes[i].number, &action, &before_us[i]);
  memory_at_end(end_without_memory);
  atexit(on_exit_call);
  start_watch();
}

void guard_obey(const volatile sig_atomic_t *stop)
{
  atomic_store(&asked, stop);
}

void guard_finish(void)
{
  atomic_store(&installed, false);
}

void guard_forget(void)
{
  atomic_store(&installed, false);
  for (size_t i = 0; i < CRASHES; i++)
    signal(crashes[i].number, SIG_DFL);
}
