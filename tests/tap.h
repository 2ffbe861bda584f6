/* A test program's voice: Test Anything Protocol. Every check prints what it measured beside what
 * it allows; tap_done() writes the plan line and gives the exit status. One thread only. */
#ifndef GAMUT_TESTS_TAP_H
#define GAMUT_TESTS_TAP_H

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

struct tap_count {
  int checks, failures;
};

static inline struct tap_count *tap_count(void)
{
  static struct tap_count count;
  return &count;
}

/* '#' starts a directive in TAP and a line end would break the protocol. */
static inline void tap_print_name(const char *name)
{
  for (; *name != '\0'; name++)
    putchar(*name == '#' ? 'n' : (unsigned char)*name < ' ' ? ' ' : *name);
}

static inline bool tap_report(bool passed, const char *name)
{
  struct tap_count *count = tap_count();
  count->checks++;
  count->failures += !passed;
  printf("%sok %d - ", passed ? "" : "not ", count->checks);
  tap_print_name(name);
  putchar('\n');
  fflush(stdout);
  return passed;
}

__attribute__((format(printf, 2, 3))) static inline bool tap_ok(bool passed, const char *format,
                                                                ...)
{
  char name[600];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(name, sizeof name, format, arguments);
  va_end(arguments);
  return tap_report(passed, name);
}

/* |got - expected| <= tolerance |expected| */
static inline bool tap_relative(const char *name, double got, double expected, double tolerance)
{
  double off = got == expected ? 0 : fabs(got - expected) / fabs(expected);
  return tap_ok(off <= tolerance,
                "%s: got %.10g, expected %.10g, relative error %.2g (allowed %.2g)", name, got,
                expected, off, tolerance);
}

/* |got - expected| <= tolerance */
static inline bool tap_absolute(const char *name, double got, double expected, double tolerance)
{
  double off = got == expected ? 0 : fabs(got - expected);
  return tap_ok(off <= tolerance, "%s: got %.10g, expected %.10g, error %.2g (allowed %.2g)", name,
                got, expected, off, tolerance);
}

static inline void tap_print_text(const char *label, const char *text)
{
  printf("# %s ", label);
  for (; text != NULL && *text != '\0'; text++)
    if (*text == '\n')
      printf("\n#   %*s ", (int)strlen(label) - 2, "");
    else
      putchar(*text);
  puts(text == NULL ? "(null)" : "");
}

/* The same words; a difference is printed below the check. Null equals null only. */
static inline bool tap_text(const char *name, const char *got, const char *expected)
{
  bool same = got == NULL || expected == NULL ? got == expected : strcmp(got, expected) == 0;
  tap_ok(same, "%s", name);
  if (!same) {
    tap_print_text("got:     ", got);
    tap_print_text("expected:", expected);
  }
  return same;
}

static inline void tap_skip(const char *name, const char *why)
{
  printf("ok %d - %s # SKIP %s\n", ++tap_count()->checks, name, why);
}

static inline int tap_done(void)
{
  printf("1..%d\n", tap_count()->checks);
  if (tap_count()->failures > 0)
    printf("# %d of %d failed\n", tap_count()->failures, tap_count()->checks);
  return tap_count()->failures > 0;
}

#endif
