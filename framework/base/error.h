/* Errors for people. A trace collects every message of one command: where, what, what was expected,
 * what to do. Rooms return a gamut_status and leave the words here. */
#ifndef GAMUT_ERROR_H
#define GAMUT_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include <gamut/status.h>

/* A place in a text file. Strings are borrowed from the tree that was read. line and column
 * from 1. */
struct place {
  const char *file; /* null: no place */
  int line, column;
  int width;          /* characters to underline, at least 1 */
  const char *source; /* the whole line, without its end; null if not known */
};

enum message_kind { MESSAGE_ERROR, MESSAGE_WARNING, MESSAGE_NOTE };

struct trace; /* thread-safe: messages may come from any thread */

struct trace *trace_new(void);
void trace_free(struct trace *); /* accepts null */

/* Records a message and returns `status`. printf format. A message is kept once if it is repeated
 * word for word at the same place; after 50 errors (and 50 warnings) the rest is counted only. A
 * null trace throws the words away, here and below. */
gamut_status trace_fail(struct trace *, gamut_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The full form: place (copied), scene path ("materials.copper.strength.A" or null), what was
 * expected or what to do (or null). */
gamut_status trace_fail_at(struct trace *, gamut_status status, const struct place *,
                           const char *path, const char *expected, const char *format, ...)
    __attribute__((format(printf, 6, 7)));
void trace_warn_at(struct trace *, const struct place *, const char *path, const char *expected,
                   const char *format, ...) __attribute__((format(printf, 5, 6)));
void trace_note(struct trace *, const char *format, ...) __attribute__((format(printf, 2, 3)));

size_t trace_errors(const struct trace *);
size_t trace_warnings(const struct trace *);
/* Whether another error would only be counted: then nobody needs its words. */
bool trace_is_full(const struct trace *);
/* Words of the first error, warning or note; null if there is none. Owned by the trace. */
const char *trace_first(const struct trace *, enum message_kind);
gamut_status trace_worst(const struct trace *); /* status of the first error; GAMUT_OK if none */

/* Prints what has not been printed yet, and marks it printed:
 *   inputs/flyer.yaml:12:5: error: unknown key 'strengt' in material 'copper'
 *      12 |     strengt: johnson_cook
 *         |     ^~~~~~~  did you mean 'strength'?
 *   (materials.copper.strengt)
 * Control characters and line ends in any text are made harmless; a long line of the source is cut
 * around the caret. Without a source line, `expected` stands on a line of its own. */
void trace_print(struct trace *, FILE *);

/* One sentence for a status code. */
const char *status_text(gamut_status);

/* The nearest of `candidates` by Damerau-Levenshtein distance after folding case and '-', '_', ' ',
 * within max(1, length / 3); null if none is near. */
const char *nearest(const char *word, const char *const *candidates, size_t count);

/* TRY(call): for functions with `gamut_status status` and a label `done`. */
#define TRY(call)                                                                                  \
  do {                                                                                             \
    status = (call);                                                                               \
    if (status != GAMUT_OK)                                                                        \
      goto done;                                                                                   \
  } while (0)

#endif
