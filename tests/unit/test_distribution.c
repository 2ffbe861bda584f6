/* Distributions: quantiles and probabilities agree, mean and deviation are the stated ones. */
#include <math.h>
#include <string.h>

#include "random/distribution_types.h"
#include "tests/tap.h"

/* Each is among those that are tried above. */
static void test_names(const struct distribution *d, size_t count)
{
  const char *name[DISTRIBUTIONS_MAX];
  const size_t names = distribution_names(name);
  for (size_t k = 0; k < names; k++) {
    size_t tried = 0;
    for (size_t i = 0; i < count; i++)
      tried += strcmp(d[i].type->name, name[k]) == 0 && !d[i].truncated;
    tap_ok(tried == 1, "%s is tried, %zu time", name[k], tried);
  }
  tap_ok(distribution_named(NULL) == distribution_named("normal") && !distribution_named("none"),
         "the first is meant where none is named; one of no name is unknown");
}

static void test_distributions(void)
{
  const struct distribution d[] = {
      {distribution_named("normal"), 3, 0.5, -INFINITY, INFINITY, false, false},
      {distribution_named("lognormal"), 3, 0.5, -INFINITY, INFINITY, false, false},
      {distribution_named("uniform"), 3, 0.577350269189626, 2, 4, false, false},
      {distribution_named("weibull"), 3, 0.5, -INFINITY, INFINITY, false, false},
      {distribution_named("gamma"), 3, 0.5, -INFINITY, INFINITY, false, false},
      {distribution_named("beta"), 3, 0.5, 1, 6, false, false},
      {distribution_named("triangular"), 3, 0.8164965809277260, 1, 5, false, false},
      {distribution_named("normal"), 3, 0.5, 4, INFINITY, true, false},
      {distribution_named("lognormal"), 3, 0.5, 2.5, 3.5, true, false},
  };
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
    snprintf(name, sizeof name, "%s%s: probability of the quantile", d[i].type->name,
             d[i].truncated ? ", truncated" : "");
    tap_absolute(name, worst, 0, 1e-10);
    if (d[i].truncated)
      continue;
    snprintf(name, sizeof name, "%s: mean by midpoints", d[i].type->name);
    tap_relative(name, mean, d[i].mean, 1e-5);
    snprintf(name, sizeof name, "%s: deviation by midpoints", d[i].type->name);
    tap_relative(name, sqrt(square - mean * mean), d[i].deviation, 1e-3);
  }
  test_names(d, sizeof d / sizeof d[0]);
}

int main(void)
{
  test_distributions();
  return tap_done();
}
