/* Derivatives by differences: smooth functions, kinks, ends of a domain. */
#include "bench/difference.h"
#include "tests/tap.h"

static double smooth(void *self, double x, double y)
{
  const double *at = self;
  return exp(at[0] + x) * pow(at[1] + y, 3);
}

static double kink(void *self, double x, double y)
{
  (void)self;
  (void)y;
  return x < 0 ? 2 * x : 5 * x;
}

/* Has no value below zero. */
static double root(void *self, double x, double y)
{
  const double *at = self;
  (void)y;
  return sqrt(*at + x);
}

int main(void)
{
  double at[2] = {1.3, 0.7}, zero = 1e-3, error;
  const double e = exp(1.3), c = 0.7 * 0.7 * 0.7;
  const struct difference d = {.value = smooth, .self = at, .step_x = 0.03, .step_y = 0.02};
  tap_relative("first derivative", difference_first(&d, &error), e * c, 1e-11);
  tap_relative("second derivative", difference_second(&d, &error), e * c, 1e-8);
  tap_relative("mixed derivative", difference_mixed(&d, &error), 3 * e * 0.49, 1e-9);

  const struct difference k = {.value = kink, .step_x = 0.1};
  tap_relative("right of a kink", difference_sided(&k, 1, &error), 5, 1e-14);
  tap_relative("left of a kink", difference_sided(&k, -1, &error), 2, 1e-14);

  const struct difference r = {.value = root, .self = &zero, .step_x = 0.01};
  tap_relative("steps out of the domain are left out", difference_first(&r, &error),
               0.5 / sqrt(zero), 1e-7);
  return tap_done();
}
