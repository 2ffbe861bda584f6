/* Random fields over space: values of mean 0 at given points; of variance 1 and normal unless the
 * plugin says otherwise. */
#ifndef GAMUT_RANDOM_FIELD_H
#define GAMUT_RANDOM_FIELD_H

#include <gamut/host.h>

#define GAMUT_RANDOM_FIELD_OPERATIONS(OP, B)                                                       \
  OP(gamut_status, create, (struct gamut_run *, const struct gamut_values *, void **self))         \
  OP(void, destroy, (void *self))                                                                  \
  /* required. Writes one value a point. position has three arrays of `count` (metres), id one.    \
   * The same point must get the same value whatever other points are asked for with it. */        \
  OP(gamut_status, sample,                                                                         \
     (const void *self, const struct gamut_stream *, size_t count,                                 \
      const double *const position[3], const int64_t *id, double *value))                          \
  /* optional: the probability that the field is below `value` at a point, where its values are    \
   * not standard normal (where they are: NaN). By it a random parameter keeps its own             \
   * distribution. */                                                                              \
  OP(double, below, (const void *self, double value))
#define GAMUT_RANDOM_FIELD_OPS(B) GAMUT_RANDOM_FIELD_OPERATIONS(GAMUT_OPERATION, B)

#endif
