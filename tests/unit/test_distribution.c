/* Distributions: quantiles and probabilities agree, mean and deviation are the stated ones. */
#include <math.h>

#include "tests/tap.h"
#include "random/distribution.h"

static void test_distributions(void)
{
  static const struct distribution d[] = {
      {DISTRIBUTION_NORMAL, 3, 0.5, -INFINITY, INFINITY, false, false},
      {DISTRIBUTION_LOGNORMAL, 3, 0.5, -INFINITY, INFINITY, false, false},
      {DISTRIBUTION_UNIFORM, 3, 0.577350269189626, 2, 4, false, false},
      {DISTRIBUTION_WEIBULL, 3, 0.5, -INFINITY, INFINITY, false, false},
      {DISTRIBUTION_GAMMA, 3, 0.5, -INFINITY, INFINITY, false, false},
      {DISTRIBUTION_BETA, 3, 0.5, 1, 6, false, false},
      {DISTRIBUTION_TRIANGULAR, 3, 0.8164965809277260, 1, 5, false, false},
      {DISTRIBUTION_NORMAL, 3, 0.5, 4, INFINITY, true, false},
      {DISTRIBUTION_LOGNORMAL, 3, 0.5, 2.5, 3.5, true, false},
  };
  static const char *const names[] = DISTRIBUTION_NAMES;
  for (size_t i = 0; i < sizeof d / sizeof d[0]; i++) {
    enum { N = 20000 };
    double worst = 0, mean = 0, square = 0;
    char name[64];
    for (int k = 0; k < N; k++) {
      double u = (k + 0.5) / N, x = distribution_quantile(&d[i], u);
      worst = fmax(worst, fabs(distribution_below(&d[i], x) - u));
      mean += x / N;
      square += x * x / N;
    }
    snprintf(name, sizeof name, "%s%s: probability of the quantile", names[d[i].kind],
             d[i].truncated ? ", truncated" : "");
    tap_absolute(name, worst, 0, 1e-10);
    if (d[i].truncated)
      continue;
    snprintf(name, sizeof name, "%s: mean by midpoints", names[d[i].kind]);
    tap_relative(name, mean, d[i].mean, 1e-5);
    snprintf(name, sizeof name, "%s: deviation by midpoints", names[d[i].kind]);
    tap_relative(name, sqrt(square - mean * mean), d[i].deviation, 1e-3);
  }
}

int main(void)
{
  test_distributions();
  return tap_done();
}
