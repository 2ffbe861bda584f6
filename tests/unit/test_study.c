/* What a study draws: normal variables made values, and correlated by Cholesky. */
#include <math.h>

#include <gsl/gsl_errno.h>

#include "../tap.h"
#include "random/correlation.h"
#include "random/distribution_types.h"
#include "random/stream.h"
#include "scene/scene.h"
#include "study/study_private.h"

/* Probability of a standard normal variable below z. */
static double normal_below(double z)
{
  return 0.5 * erfc(-z / sqrt(2));
}

static void test_values(void)
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
      {distribution_named("normal"), 3, 0.5, -INFINITY, 3.2, true, false},
      {distribution_named("lognormal"), 3, 0.5, 2.5, 3.5, true, false},
  };
  for (size_t i = 0; i < sizeof d / sizeof d[0]; i++) {
    double worst = 0;
    char name[96];
    for (double z = -3; z <= 3; z += 0.125)
      worst = fmax(worst, fabs(distribution_below(&d[i], distribution_of_normal(&d[i], z)) -
                               normal_below(z)));
    snprintf(name, sizeof name, "%s%s: probability of a normal variable's value", d[i].type->name,
             d[i].truncated ? ", truncated" : "");
    tap_absolute(name, worst, 0, 1e-12);
    bool finite = true, rising = true;
    for (double z = -12; z < 12; z += 0.5) {
      double low = distribution_of_normal(&d[i], z), high = distribution_of_normal(&d[i], z + 0.5);
      finite = finite && isfinite(low);
      rising = rising && low <= high;
    }
    tap_ok(finite && rising, "%s: finite and rising to twelve deviations", d[i].type->name);
  }
}

static void test_matrix(void)
{
  const double equal[9] = {1, -0.6, -0.6, -0.6, 1, -0.6, -0.6, -0.6, 1};
  const double good[9] = {1, 0.5, 0.2, 0.5, 1, -0.3, 0.2, -0.3, 1};
  double lower[9], worst = 0;
  tap_absolute("smallest eigenvalue of three equal correlations", correlation_smallest(equal, 3),
               -0.2, 1e-14);
  tap_ok(!correlation_factor(equal, 3, lower), "it has no factor");
  tap_ok(correlation_factor(good, 3, lower), "a positive definite one has");
  for (size_t i = 0; i < 3; i++)
    for (size_t k = 0; k < 3; k++) {
      double sum = 0;
      for (size_t j = 0; j < 3; j++)
        sum += lower[i * 3 + j] * lower[k * 3 + j];
      worst = fmax(worst, fabs(sum - good[i * 3 + k]));
    }
  tap_absolute("factor times its transpose", worst, 0, 1e-15);
  /* The third follows from the others. */
  const double singular[9] = {1, 0, 0.6, 0, 1, -0.8, 0.6, -0.8, 1};
  tap_ok(correlation_factor(singular, 3, lower), "a singular matrix has a factor");
  tap_absolute("whose last variable has no part of its own", lower[8], 0, 1e-6);
  tap_absolute("and follows the first", lower[6], 0.6, 1e-15);
  tap_absolute("and the second", lower[7], -0.8, 1e-15);
}

static void test_draws(void)
{
  enum { N = 20000 };
  const struct distribution normal = {
      distribution_named("normal"), 10, 2, -INFINITY, INFINITY, false, false};
  static const double matrix[9] = {1, 0.5, 0.2, 0.5, 1, -0.3, 0.2, -0.3, 1};
  struct random_parameter random[3] = {
      {.distribution = &normal}, {.distribution = &normal}, {.distribution = &normal}};
  struct scene scene = {.random_parameter = random, .random_parameters = 3};
  double lower[9], product[3] = {0}, sum[3] = {0}, value[3];
  struct study study = {.scene = &scene, .parameters = 3, .lower = lower};
  correlation_factor(matrix, 3, lower);
  for (uint64_t r = 0; r < N; r++) {
    struct gamut_stream stream = stream_make(1, r, "draws");
    double z[3] = {stream.normal(&stream, 0), stream.normal(&stream, 1), stream.normal(&stream, 2)};
    draw_row(&study, z, value);
    for (int i = 0; i < 3; i++) {
      sum[i] += (value[i] - 10) / N;
      product[i] += (value[i] - 10) * (value[(i + 1) % 3] - 10) / 4 / N;
    }
  }
  const double expected[3] = {0.5, -0.3, 0.2};
  for (int i = 0; i < 3; i++) {
    tap_absolute("mean of 20000 draws, less 10", sum[i], 0, 4 * 2 / sqrt(N));
    tap_absolute("correlation of 20000 draws", product[i], expected[i], 4 * sqrt(1.25 / N));
  }
  const double mean[3] = {NAN, 1, NAN};
  draw_row(&study, mean, value);
  tap_absolute("NaN leaves a parameter at its mean", value[0], 10, 0);
}

int main(void)
{
  gsl_set_error_handler_off();
  test_values();
  test_matrix();
  test_draws();
  return tap_done();
}
