/* The one clock. */
#ifndef GAMUT_CLOCK_H
#define GAMUT_CLOCK_H

#include <time.h>

/* Seconds of CLOCK_MONOTONIC (by the wall, from some beginning), CLOCK_PROCESS_CPUTIME_ID or
 * CLOCK_THREAD_CPUTIME_ID. Any thread. */
double clock_seconds(clockid_t);

#endif
