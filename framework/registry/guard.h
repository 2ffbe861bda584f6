/* Whose code runs on which thread: a plugin that crashes, ends the program or hangs is named
 * and the command's exit code says so. The marks cost a few nanoseconds a call of a kernel; only a
 * program that calls guard_install has its signals touched (a program that embeds the library keeps
 * its own). */
#ifndef GAMUT_GUARD_H
#define GAMUT_GUARD_H

#include <gamut/status.h>
#include <signal.h>

enum {
  GUARD_CALL_SECONDS = 60, /* the longest that a kernel may take with one block of points */
  GUARD_GRACE_SECONDS = 4  /* from a request to end until the program ends without asking further */
};

/* Marks that this thread runs the plugin's code on one block of points. Calls nest: what comes out
 * goes into guard_leave. The text must stay until then. */
const char *guard_enter(const char *plugin);
/* The same for code that may take as long as it needs (create, a task that runs once a step). */
const char *guard_enter_long(const char *plugin);
void guard_leave(const char *before);

/* GUARDED(plugin, call of one of its operations that returns a status). */
#define GUARDED(plugin, call) (guard_push(plugin), guard_pop(call))
void guard_push(const char *plugin);
gamut_status guard_pop(gamut_status);

/* From now on a crash, exit() or hang in a plugin ends the program with GAMUT_PLUGIN and the
 * plugin's name, a crash outside of plugins, or the end of memory, with GAMUT_INTERNAL. Call once,
 * from main. */
void guard_install(int call_seconds);
/* `stop` becomes the number of the signal that asks for the end. Where that is SIGTERM, a plugin
 * that is in one call throughout the grace is ended as one that hangs, and the program in any case.
 */
void guard_obey(const volatile sig_atomic_t *stop);
/* The program comes to its end by itself: exit() is no longer a fault. */
void guard_finish(void);
/* Undoes the handlers in a child process that reports crashes by itself. */
void guard_forget(void);

#endif
