/* A small result with known numbers: an axisymmetric bar that flattens, and a second body. */
#ifndef GAMUT_TESTS_SAMPLE_RESULT_H
#define GAMUT_TESTS_SAMPLE_RESULT_H

#include "store/store.h"

enum { SAMPLE_COLUMNS = 12, SAMPLE_ROWS = 80, SAMPLE_FRAMES = 5, SAMPLE_ANVIL = 40 };

/* Writes everything that a run writes; leaves the store open. Where it shrinks the bar loses points
 * and the anvil goes. */
gamut_status sample_result(const char *folder, bool force, bool shrinks, struct trace *,
                           struct store **);
/* One more frame, for tests of failing disks. */
gamut_status sample_frame(struct store *, int frame, struct trace *);

#endif
