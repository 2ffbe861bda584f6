#include "bench/difference.h"

#include <float.h>
#include <math.h>

enum { LEVELS = 10 };

enum stencil { FIRST, SECOND, MIXED, FORWARD, BACKWARD };

static double estimate(const struct difference *d, enum stencil stencil, double share)
{
  double x = d->step_x * share, y = d->step_y * share;
  switch (stencil) {
  case FIRST:
    return (d->value(d->self, x, 0) - d->value(d->self, -x, 0)) / (2 * x);
  case SECOND:
    return ((d->value(d->self, x, 0) - d->value(d->self, 0, 0)) +
            (d->value(d->self, -x, 0) - d->value(d->self, 0, 0))) /
           (x * x);
  case MIXED:
    return ((d->value(d->self, x, y) - d->value(d->self, x, -y)) -
            (d->value(d->self, -x, y) - d->value(d->self, -x, -y))) /
           (4 * x * y);
  case FORWARD:
    return (d->value(d->self, x, 0) - d->value(d->self, 0, 0)) / x;
  case BACKWARD:
    return (d->value(d->self, 0, 0) - d->value(d->self, -x, 0)) / x;
  }
  return NAN;
}

/* Halves the step down the table and removes one power of it a column; keeps the entry that moved
 * least. Rows with values that are not finite (out of the function's domain) are skipped. */
static double extrapolate(const struct difference *d, enum stencil stencil, double *error)
{
  const double power = stencil == FORWARD || stencil == BACKWARD ? 2.0 : 4.0;
  double table[LEVELS][LEVELS], best = NAN, share = 1.0;
  int rows = 0;
  *error = DBL_MAX;
  for (int level = 0; level < LEVELS; level++, share *= 0.5) {
    double factor = power;
    table[rows][0] = estimate(d, stencil, share);
    if (!isfinite(table[rows][0])) {
      rows = 0;
      continue;
    }
    for (int k = 1; k <= rows; k++, factor *= power) {
      table[rows][k] = (factor * table[rows][k - 1] - table[rows - 1][k - 1]) / (factor - 1);
      double moved = fmax(fabs(table[rows][k] - table[rows][k - 1]),
                          fabs(table[rows][k] - table[rows - 1][k - 1]));
      if (moved < *error) {
        *error = moved;
        best = table[rows][k];
      }
    }
    rows++;
  }
  return best;
}

double difference_first(const struct difference *d, double *error)
{
  return extrapolate(d, FIRST, error);
}

double difference_second(const struct difference *d, double *error)
{
  return extrapolate(d, SECOND, error);
}

double difference_mixed(const struct difference *d, double *error)
{
  return extrapolate(d, MIXED, error);
}

double difference_sided(const struct difference *d, int side, double *error)
{
  return extrapolate(d, side > 0 ? FORWARD : BACKWARD, error);
}
