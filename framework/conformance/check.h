/* TAP lines with the measured figure beside its tolerance. */
#ifndef GAMUT_CHECK_H
#define GAMUT_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct checks {
  FILE *out;
  size_t count, failed;
};

/* Lines that begin so say what is under way; whoever reads the TAP stream takes them out, and names
 * the last one when the plugin's code crashed. */
#define CHECK_UNDER_WAY '\001'

/* Says what comes, in case it crashes. */
void check_begin(struct checks *, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* One line of TAP; returns `fine`. */
bool check_that(struct checks *, bool fine, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Fine if measured <= tolerance; NaN is not. Prints both. */
bool check_figure(struct checks *, double measured, double tolerance, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Fine if measured >= least. */
bool check_least(struct checks *, double measured, double least, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void check_skip(struct checks *, const char *why, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* "# ..." below a line. Several lines of text are each given their own. */
void check_say(struct checks *, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
