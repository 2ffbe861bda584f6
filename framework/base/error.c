#include "base/error.h"

#include <assert.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/excerpt.h"

enum { KEPT_MAX = 50, TEXT_MAX = 2000, NAME_MAX_SHOWN = 300 };

struct message {
  enum message_kind kind;
  char *file, *path, *expected, *text; /* owned, ready to print; null if absent */
  int line, column;
  struct excerpt excerpt;
  bool printed;
};

struct trace {
  pthread_mutex_t lock;
  struct message *message;
  size_t count, room;
  size_t seen[3], kept[3],
      reported[3]; /* by message_kind: all, with their words, reported missing */
  gamut_status worst;
};

struct trace *trace_new(void)
{
  enum { FIRST_ROOM = 16 }; /* the end of memory can be reported */
  struct trace *trace = calloc(1, sizeof *trace);
  struct message *message = calloc(FIRST_ROOM, sizeof *message);
  if (trace == NULL || message == NULL || pthread_mutex_init(&trace->lock, NULL) != 0) {
    free(message);
    free(trace);
    return NULL;
  }
  trace->message = message;
  trace->room = FIRST_ROOM;
  return trace;
}

static void message_clear(struct message *message)
{
  free(message->file);
  free(message->path);
  free(message->expected);
  free(message->text);
  free(message->excerpt.text);
}

void trace_free(struct trace *trace)
{
  if (trace == NULL)
    return;
  for (size_t k = 0; k < trace->count; k++)
    message_clear(&trace->message[k]);
  free(trace->message);
  pthread_mutex_destroy(&trace->lock);
  free(trace);
}

static bool same_text(const char *one, const char *other)
{
  return one == NULL || other == NULL ? one == other : strcmp(one, other) == 0;
}

static bool is_repeat(const struct trace *trace, const struct message *message)
{
  for (size_t k = 0; k < trace->count; k++) {
    const struct message *old = &trace->message[k];
    if (old->kind == message->kind && old->line == message->line &&
        old->column == message->column && same_text(old->file, message->file) &&
        same_text(old->path, message->path) && same_text(old->text, message->text))
      return true;
  }
  return false;
}

/* Takes the message or clears it. Without memory its words are lost, never the fact. */
static void keep(struct trace *trace, gamut_status status, struct message *message,
                 const struct place *place)
{
  enum message_kind kind = message->kind;
  if (is_repeat(trace, message)) {
    message_clear(message);
    return;
  }
  if (kind == MESSAGE_ERROR && trace->seen[kind] == 0)
    trace->worst = status;
  trace->seen[kind]++;
  if (trace->kept[kind] >= KEPT_MAX && kind != MESSAGE_NOTE) {
    message_clear(message);
    return;
  }
  if (trace->count == trace->room) {
    size_t room = 2 * trace->room;
    struct message *grown = realloc(trace->message, room * sizeof *grown);
    if (grown == NULL) {
      message_clear(message);
      return;
    }
    trace->message = grown;
    trace->room = room;
  }
  if (place !=
      NULL) /* last, as cutting a long line takes time that a hostile file would multiply */
    message->excerpt = excerpt_of(place->source, place->column, place->width);
  trace->message[trace->count++] = *message;
  trace->kept[kind]++;
}

static void record(struct trace *trace, enum message_kind kind, gamut_status status,
                   const struct place *place, const char *path, const char *expected,
                   const char *format, va_list arguments)
{
  if (trace == NULL)
    return;
  char text[TEXT_MAX];
  vsnprintf(text, sizeof text, format, arguments);
  struct message message = {.kind = kind,
                            .text = shown_text(text, TEXT_MAX - 100),
                            .path = shown_text(path, NAME_MAX_SHOWN),
                            .expected = shown_text(expected, TEXT_MAX)};
  if (place != NULL && place->file != NULL) {
    message.file = shown_text(place->file, NAME_MAX_SHOWN);
    message.line = place->line;
    message.column = place->column;
  }
  pthread_mutex_lock(&trace->lock);
  keep(trace, status, &message, message.file != NULL ? place : NULL);
  pthread_mutex_unlock(&trace->lock);
}

gamut_status trace_fail(struct trace *trace, gamut_status status, const char *format, ...)
{
  assert(status != GAMUT_OK);
  va_list arguments;
  va_start(arguments, format);
  record(trace, MESSAGE_ERROR, status, NULL, NULL, NULL, format, arguments);
  va_end(arguments);
  return status;
}

gamut_status trace_fail_at(struct trace *trace, gamut_status status, const struct place *place,
                           const char *path, const char *expected, const char *format, ...)
{
  assert(status != GAMUT_OK);
  va_list arguments;
  va_start(arguments, format);
  record(trace, MESSAGE_ERROR, status, place, path, expected, format, arguments);
  va_end(arguments);
  return status;
}

void trace_warn_at(struct trace *trace, const struct place *place, const char *path,
                   const char *expected, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  record(trace, MESSAGE_WARNING, GAMUT_OK, place, path, expected, format, arguments);
  va_end(arguments);
}

void trace_note(struct trace *trace, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  record(trace, MESSAGE_NOTE, GAMUT_OK, NULL, NULL, NULL, format, arguments);
  va_end(arguments);
}

static size_t seen(const struct trace *trace, enum message_kind kind)
{
  if (trace == NULL)
    return 0;
  pthread_mutex_t *lock = (pthread_mutex_t *)&trace->lock;
  pthread_mutex_lock(lock);
  size_t count = trace->seen[kind];
  pthread_mutex_unlock(lock);
  return count;
}

size_t trace_errors(const struct trace *trace)
{
  return seen(trace, MESSAGE_ERROR);
}

size_t trace_warnings(const struct trace *trace)
{
  return seen(trace, MESSAGE_WARNING);
}

bool trace_is_full(const struct trace *trace)
{
  if (trace == NULL)
    return true;
  pthread_mutex_t *lock = (pthread_mutex_t *)&trace->lock;
  pthread_mutex_lock(lock);
  bool full = trace->kept[MESSAGE_ERROR] >= KEPT_MAX;
  pthread_mutex_unlock(lock);
  return full;
}

const char *trace_first(const struct trace *trace, enum message_kind kind)
{
  for (size_t k = 0; seen(trace, kind) > 0 && k < trace->count; k++)
    if (trace->message[k].kind == kind)
      return trace->message[k].text;
  return NULL;
}

gamut_status trace_worst(const struct trace *trace)
{
  return trace_errors(trace) > 0 ? trace->worst : GAMUT_OK;
}

static void print_caret(const struct message *message, FILE *stream)
{
  fprintf(stream, "%5d | %s\n", message->line, message->excerpt.text);
  fprintf(stream, "      | %*s^", message->excerpt.before, "");
  for (int k = 1; k < message->excerpt.width; k++)
    putc('~', stream);
  if (message->expected != NULL)
    fprintf(stream, "  %s", message->expected);
  putc('\n', stream);
}

static void print_message(const struct message *message, FILE *stream)
{
  static const char *const kind[] = {"error", "warning", "note"};
  if (message->file != NULL && message->line > 0)
    fprintf(stream, "%s:%d:%d: ", message->file, message->line, message->column);
  else if (message->file != NULL)
    fprintf(stream, "%s: ", message->file);
  fprintf(stream, "%s: %s\n", kind[message->kind],
          message->text != NULL ? message->text : "(no memory left for the words)");
  if (message->excerpt.text != NULL && message->line > 0)
    print_caret(message, stream);
  else if (message->expected != NULL)
    fprintf(stream, "  %s\n", message->expected);
  if (message->path != NULL && message->path[0] != '\0')
    fprintf(stream, "(%s)\n", message->path);
}

void trace_print(struct trace *trace, FILE *stream)
{
  if (trace == NULL)
    return;
  pthread_mutex_lock(&trace->lock);
  for (size_t k = 0; k < trace->count; k++) {
    if (!trace->message[k].printed)
      print_message(&trace->message[k], stream);
    trace->message[k].printed = true;
  }
  for (enum message_kind kind = MESSAGE_ERROR; kind <= MESSAGE_WARNING; kind++) {
    size_t silent = trace->seen[kind] - trace->kept[kind] - trace->reported[kind];
    if (silent > 0)
      fprintf(stream, "%zu more %s%s not shown\n", silent,
              kind == MESSAGE_ERROR ? "error" : "warning", silent > 1 ? "s" : "");
    trace->reported[kind] += silent;
  }
  fflush(stream);
  pthread_mutex_unlock(&trace->lock);
}

const char *status_text(gamut_status status)
{
  switch (status) {
#define STATUS_CASE(name, code, text)                                                              \
  case name:                                                                                       \
    return text;
    GAMUT_STATUS_LIST(STATUS_CASE)
#undef STATUS_CASE
  }
  return "unknown status";
}
