/* Quantities: scalars and histories that a scene wants to know. */
#ifndef GAMUT_QUANTITY_ROOM_H
#define GAMUT_QUANTITY_ROOM_H

#include <stddef.h>

#include "base/error.h"
#include "scene/scene.h"

/* A recorded history. Times never change the step: samples lie at multiples of `every` (and at 0
 * and the end), interpolated linearly between the steps around them. A curve against another
 * measure, and a history of a run whose end is not known, hold every step as it was. */
struct history {
  const struct quantity *quantity;
  const char *unit;             /* of the measure */
  const char *axis, *axis_unit; /* "time", "s"; the run sets them where its axis is another */
  double every;
  double *time, *value;
  size_t count, capacity;
  double last_time, last_value;
  bool has_last;
  bool every_step, grows;  /* no sampling; memory is taken on the way */
  bool failed;             /* and was not there */
  bool placed;             /* one of a point: */
  double place[3];         /* where it was at the start, m */
};
/* Null when the memory does not suffice for the samples. The caller may set unit, axis, axis_unit.
 */
struct history *history_new(const struct quantity *, double end);
void history_free(struct history *);
/* Records the value now; called at the start and after every step, in order of time. Takes memory
 * only where every step is kept or the end is not known. */
void history_tell(struct history *, double time, double value, bool final);

/* Makes a fresh history go on from `count` samples of another run. Its sampling is kept where `end`
 * has moved, so `every` is that of the other run. The caller sets what was recorded last. False
 * without memory. */
bool history_go_on(struct history *, double end, double every, const double *time,
                   const double *value, size_t count);

/* The value of a reduction over a history, with its unit (the measure's, s, or unit/s). False with
 * a reason when it has none (level never crossed, empty window, values that are not finite). The
 * history is taken as straight lines between its samples; a window is cut to what was recorded. */
bool reduction_value(const struct reduction *, const struct history *, double *value, char *unit,
                     size_t unit_size, char *why, size_t size);

#endif
