/* Reading a result back. */
#ifndef GAMUT_RESULT_H
#define GAMUT_RESULT_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

struct result;

/* Opens FOLDER/results.h5; GAMUT_OUTPUT where there is none. */
gamut_status result_open(const char *folder, struct trace *, struct result **);
void result_close(struct result *); /* accepts null */

size_t result_frames(const struct result *);

/* One body of a frame. All arrays are allocated. */
struct result_body {
  char *name;
  int axes; /* which columns of position are real */
  size_t count;
  double *position; /* count x 3 */
  double *value;    /* count; null where the body lacks the field */
};
struct result_frame {
  double time;
  uint64_t step;
  struct result_body *body;
  size_t bodies;
  char *field, *unit;  /* of `value`: "velocity_y", "velocity" for its magnitude; null: no fields */
  const char *reduced; /* "magnitude", "von Mises", "norm"; null for a scalar or a component */
};
/* Reads a frame and one field as a scalar: a component ("velocity_y", "stress_xx"), the magnitude
 * of a vector ("velocity"), von Mises of a symmetric tensor ("stress"), Frobenius norm of a tensor.
 * With field null takes plastic_strain, or else the first that is there. An unknown one is refused
 * with GAMUT_USAGE, the nearest name and the names that there are. */
gamut_status result_frame_read(const struct result *, size_t frame, const char *field,
                               struct trace *, struct result_frame **);
void result_frame_free(struct result_frame *); /* accepts null */

struct result_history {
  char *name, *unit, *axis, *axis_unit;
  char *family; /* of one of several points: the quantity's name in the scene; else null */
  size_t count;
  double *time, *value;
  char *label;       /* of one of several runs that are no sample: what sets it apart; else null */
  double *deviation; /* of a study, whose mean is `value`; null: of one run */
};
gamut_status result_histories(const struct result *, struct trace *, struct result_history **,
                              size_t *count);
void result_histories_free(struct result_history *, size_t count);

#endif
