/* Points of a body in the plane of a picture, each with the radius of the disc that it fills. */
#ifndef GAMUT_BODY_POINTS_H
#define GAMUT_BODY_POINTS_H

#include <stdbool.h>
#include <stddef.h>

#include "store/result.h"

struct disc {
  double x, y, radius, value;
};
struct cloud {
  struct disc *disc;
  size_t count;
  double lower[2], upper[2]; /* with the discs */
};

/* Which coordinates a picture shows: for bodies in space, the long direction and another one across
 * a slice through the middle. */
struct view {
  int x, y, normal; /* normal -1: no slice */
};
struct view view_of(const struct result_frame *);

/* False when out of memory. A body without the field has discs with the value NAN. */
bool cloud_make(const struct result_body *, const struct view *, struct cloud *);
void cloud_free(struct cloud *);

#endif
