#include "conformance/check.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 4096 };

/* TAP gives '#' a meaning, and a line is a line. */
static void clean(char *text)
{
  for (; *text; text++)
    if (*text == '#' || *text == '\n')
      *text = ' ';
}

#define FORMAT_INTO(text, format)                                                                  \
  do {                                                                                             \
    va_list list;                                                                                  \
    va_start(list, format);                                                                        \
    vsnprintf(text, sizeof text, format, list);                                                    \
    va_end(list);                                                                                  \
  } while (0)

void check_begin(struct checks *checks, const char *format, ...)
{
  char text[TEXT];
  FORMAT_INTO(text, format);
  clean(text);
  fprintf(checks->out, "%c%s\n", CHECK_UNDER_WAY, text);
  fflush(checks->out);
}

static bool line(struct checks *checks, bool fine, const char *text)
{
  checks->count++;
  checks->failed += !fine;
  fprintf(checks->out, "%s %zu - %s\n", fine ? "ok" : "not ok", checks->count, text);
  fflush(checks->out);
  return fine;
}

bool check_that(struct checks *checks, bool fine, const char *format, ...)
{
  char text[TEXT];
  FORMAT_INTO(text, format);
  clean(text);
  return line(checks, fine, text);
}

bool check_figure(struct checks *checks, double measured, double tolerance, const char *format, ...)
{
  char text[TEXT], whole[TEXT + 80];
  FORMAT_INTO(text, format);
  clean(text);
  snprintf(whole, sizeof whole, "%s: %.3g (at most %.3g)", text, measured, tolerance);
  return line(checks, measured <= tolerance, whole);
}

bool check_least(struct checks *checks, double measured, double least, const char *format, ...)
{
  char text[TEXT], whole[TEXT + 80];
  FORMAT_INTO(text, format);
  clean(text);
  snprintf(whole, sizeof whole, "%s: %.3g (at least %.3g)", text, measured, least);
  return line(checks, measured >= least, whole);
}

void check_skip(struct checks *checks, const char *why, const char *format, ...)
{
  char text[TEXT];
  FORMAT_INTO(text, format);
  clean(text);
  checks->count++;
  fprintf(checks->out, "ok %zu - %s # SKIP %s\n", checks->count, text, why);
  fflush(checks->out);
}

void check_say(struct checks *checks, const char *format, ...)
{
  char text[TEXT];
  FORMAT_INTO(text, format);
  char *rest = text, *next;
  while ((next = strsep(&rest, "\n")))
    if (*next)
      fprintf(checks->out, "# %s\n", next);
  fflush(checks->out);
}
