/* Karhunen-Loeve: eigenvalues against the closed form, modes orthonormal, covariance given back,
 * the same field on any mesh, ensembles against a dense decomposition, tables. */
#include <stdlib.h>

#include <gsl/gsl_integration.h>
#include <gsl/gsl_linalg.h>

#include "plugins/random_field/karhunen_loeve/expansion.h"
#include "random/stream.h"
#include "tests/tap.h"

static double covariance_of(enum covariance covariance, double r)
{
  const double a = sqrt(3.0) * r, b = sqrt(5.0) * r;
  switch (covariance) {
  case GAUSSIAN:
    return exp(-0.5 * r * r);
  case MATERN_3_2:
    return (1 + a) * exp(-a);
  case MATERN_5_2:
    return (1 + b + b * b / 3) * exp(-b);
  default:
    return exp(-r);
  }
}

/* Ghanem and Spanos: roots of cot(t) = t / ratio and tan(t) = -t / ratio, by bisection. */
static double root_of(int j, double ratio)
{
  const double quarter = acos(-1.0) / 2;
  double low = j * quarter, high = low + quarter;
  for (int i = 0; i < 200; i++) {
    double t = 0.5 * (low + high);
    double even = t * sin(t) - ratio * cos(t), odd = t * cos(t) + ratio * sin(t);
    double sign = j / 2 % 2 ? -1 : 1, value = sign * (j % 2 ? -odd : even);
    if (value < 0)
      low = t;
    else
      high = t;
  }
  return 0.5 * (low + high);
}

static void test_exponential(void)
{
  static const double ratios[] = {1e-4, 0.05, 1, 7, 200};
  for (size_t r = 0; r < sizeof ratios / sizeof *ratios; r++) {
    struct axis axis;
    double worst = 0, ratio = ratios[r];
    axis_new(&axis, EXPONENTIAL, 2, 6, 2 / ratio, 300);
    for (int j = 0; j < 300; j++) {
      double t = root_of(j, ratio), share = ratio / (t * t + ratio * ratio);
      worst = fmax(worst, fabs(axis.share[j] / share - 1));
    }
    char name[96];
    snprintf(name, sizeof name, "exponential, half length %g: 300 eigenvalues", ratio);
    tap_absolute(name, worst, 0, 1e-11);
    axis_free(&axis);
  }
  struct axis axis;
  axis_new(&axis, EXPONENTIAL, -1, 1, 1, 4);
  tap_relative("first root of t tan t = 1, as listed", axis.frequency[0], 0.86033358902, 1e-11);
  tap_relative("first root of tan t = -t", axis.frequency[1], 2.02875783811, 1e-11);
  tap_relative("second root of t tan t = 1", axis.frequency[2], 3.42561845949, 1e-11);
  axis_free(&axis);
}

/* Modes at Gauss's nodes: orthonormal, and eigenfunctions of the covariance. */
static void test_orthonormal(const char *label, enum covariance covariance, double length,
                             double allowed)
{
  enum { NODES = 400, MODES = 12 };
  static double mode[NODES][MODES], room[2048];
  struct axis axis;
  double x[NODES], w[NODES], worst = 0, residual = 0;
  char name[128];
  gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(NODES);
  axis_new(&axis, covariance, 1, 3, length, MODES);
  size_t count = axis.modes;
  for (size_t q = 0; q < NODES; q++) {
    gsl_integration_glfixed_point(1, 3, q, &x[q], &w[q], gauss);
    axis_modes(&axis, x[q], count, room, mode[q]);
  }
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++) {
      double sum = 0, size = sqrt(2 * axis.share[i] * 2 * axis.share[j]);
      for (size_t q = 0; q < NODES; q++)
        sum += w[q] * mode[q][i] * mode[q][j] / size;
      worst = fmax(worst, fabs(sum - (i == j)));
    }
  for (size_t j = 0; j < count && j < 6; j++)
    for (size_t p = 0; p < NODES; p += 37) {
      double sum = 0;
      for (size_t q = 0; q < NODES; q++)
        sum += w[q] * covariance_of(covariance, fabs(x[p] - x[q]) / length) * mode[q][j];
      residual = fmax(residual, fabs(sum - 2 * axis.share[j] * mode[p][j]));
    }
  snprintf(name, sizeof name, "%s, length %g: orthonormal modes", label, length);
  tap_absolute(name, worst, 0, allowed);
  snprintf(name, sizeof name, "%s, length %g: eigenfunctions", label, length);
  tap_absolute(name, residual, 0, covariance == EXPONENTIAL ? 2e-5 : allowed);
  gsl_integration_glfixed_table_free(gauss);
  axis_free(&axis);
}

/* All modes together give the covariance back; truncated ones what they hold. */
static void test_covariance(const char *label, enum covariance covariance, double length,
                            double energy, double allowed)
{
  const double lower[3] = {0, 0, 0}, upper[3] = {1, 0, 0}, lengths[3] = {length, 0, 0};
  struct expansion e = {0};
  double worst = 0, held = 0, own[4096], other[4096], room[2048];
  char name[128];
  gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(300);
  expansion_new(&e, covariance, lower, upper, lengths, energy, 4096);
  for (size_t q = 0; q < 300; q++) {
    double x, w;
    gsl_integration_glfixed_point(0, 1, q, &x, &w, gauss);
    axis_modes(&e.axis[0], x, e.modes, room, own);
    for (size_t m = 0; m < e.modes; m++)
      held += w * own[m] * own[m];
  }
  for (double x = 0.05; x < 1; x += 0.1)
    for (double y = 0; y <= 1; y += 0.1) {
      double sum = 0;
      axis_modes(&e.axis[0], x, e.modes, room, own);
      axis_modes(&e.axis[0], y, e.modes, room, other);
      for (size_t m = 0; m < e.modes; m++)
        sum += own[m] * other[m];
      worst = fmax(worst, fabs(sum - covariance_of(covariance, fabs(x - y) / length)));
    }
  snprintf(name, sizeof name, "%s, length %g: variance that %zu modes hold", label, length,
           e.modes);
  tap_absolute(name, held, e.held, covariance == MATERN_3_2 ? 1e-5 : 1e-7);
  snprintf(name, sizeof name, "%s, length %g: covariance with energy %.10g", label, length, energy);
  tap_absolute(name, worst, 0, allowed);
  gsl_integration_glfixed_table_free(gauss);
  expansion_free(&e);
}

static void test_mesh(void)
{
  enum { FEW = 50, MANY = 5000 };
  static double x[MANY], zero[MANY], fine[MANY];
  double coarse_x[FEW], coarse[FEW], worst = 0;
  const double lower[3] = {0, 0, 0}, upper[3] = {1, 0, 0}, length[3] = {0.1, 0, 0};
  static const enum covariance kernel[] = {EXPONENTIAL, GAUSSIAN, MATERN_3_2, MATERN_5_2};
  for (size_t k = 0; k < 4; k++) {
    struct expansion e = {.unit_variance = true};
    const struct gamut_stream stream = stream_make(7, 3, "mesh");
    expansion_new(&e, kernel[k], lower, upper, length, 0.95, 5000);
    for (size_t i = 0; i < MANY; i++)
      x[i] = (double)i / (MANY - 1);
    for (size_t i = 0; i < FEW; i++)
      coarse_x[i] = x[i * 101];
    const double *const many[3] = {x, zero, zero}, *const few[3] = {coarse_x, zero, zero};
    expansion_sample(&e, &stream, MANY, many, fine);
    expansion_sample(&e, &stream, FEW, few, coarse);
    for (size_t i = 0; i < FEW; i++)
      worst = fmax(worst, fabs(coarse[i] - fine[i * 101]));
    expansion_free(&e);
  }
  tap_absolute("the same field at the same places on meshes of 50 and 5000 points", worst, 0,
               1e-10);
}

static void test_moments(void)
{
  enum { POINTS = 4, RUNS = 40000 };
  const double x[POINTS] = {0, 0.3, 0.3, 1}, y[POINTS] = {0, 0.1, 0.4, 0.5}, z[POINTS] = {0};
  const double *const place[3] = {x, y, z};
  const double lower[3] = {0, 0, 0}, upper[3] = {1, 0.5, 0}, length[3] = {0.5, 0.3, 0};
  struct expansion e = {.unit_variance = false};
  struct gamut_stream stream = stream_make(1, 0, "moments");
  double sum[POINTS] = {0}, square[POINTS][POINTS] = {{0}}, mean = 0, covariance = 0;
  expansion_new(&e, GAUSSIAN, lower, upper, length, 0.999999, 5000);
  for (stream.realisation = 0; stream.realisation < RUNS; stream.realisation++) {
    double value[POINTS];
    expansion_sample(&e, &stream, POINTS, place, value);
    for (int i = 0; i < POINTS; i++) {
      sum[i] += value[i] / RUNS;
      for (int k = 0; k < POINTS; k++)
        square[i][k] += value[i] * value[k] / RUNS;
    }
  }
  for (int i = 0; i < POINTS; i++) {
    mean = fmax(mean, fabs(sum[i]));
    for (int k = 0; k < POINTS; k++) {
      double r = hypot((x[i] - x[k]) / length[0], (y[i] - y[k]) / length[1]);
      covariance = fmax(covariance, fabs(square[i][k] - exp(-0.5 * r * r)));
    }
  }
  tap_absolute("plane Gaussian field: mean over 40000 realisations", mean, 0, 5 / sqrt(RUNS));
  tap_absolute("its covariance, which depends on the distance alone", covariance, 0,
               5 * sqrt(2.0 / RUNS));
  expansion_free(&e);
}

static void test_lengths(void)
{
  const double lower[3] = {0, 0, 0}, upper[3] = {1, 0, 0};
  struct expansion far = {0}, near = {0};
  expansion_new(&far, MATERN_5_2, lower, upper, (double[]){1e6, 0, 0}, 0.95, 5000);
  tap_ok(far.modes == 1 && fabs(far.held - 1) < 1e-9,
         "a length far above the domain: %zu mode holds %.12f", far.modes, far.held);
  expansion_new(&near, EXPONENTIAL, lower, upper, (double[]){1e-5, 0, 0}, 0.95, 500);
  tap_ok(near.modes == 500 && near.held < 0.1,
         "a length far below it: 500 modes hold only %.4f, which is told", near.held);
  expansion_free(&far);
  expansion_free(&near);
}

enum { POINTS = 700, RUNS = 30 };

static double noise_of(const struct ensemble *ensemble, int64_t id, size_t run)
{
  const struct gamut_stream stream = stream_make(5, run, "ensemble");
  return noise_at(&ensemble->noise, &stream, (uint64_t)id);
}

static void draw_run(const struct ensemble *ensemble, size_t run, size_t count, const int64_t *id,
                     double *value, struct ensemble_report *report)
{
  const struct gamut_stream stream = stream_make(5, run, "ensemble");
  if (!ensemble_sample(ensemble, &stream, count, id, value, report))
    tap_ok(false, "an ensemble of %zu points", count);
}

static void test_ensemble(void)
{
  static double value[POINTS];
  static int64_t id[POINTS];
  struct ensemble ensemble = {.noise = {true, 1, 2, 10}, .samples = RUNS, .energy = 0.95};
  struct ensemble_report report;
  gsl_matrix *x = gsl_matrix_alloc(POINTS, RUNS), *v = gsl_matrix_alloc(RUNS, RUNS);
  gsl_vector *s = gsl_vector_alloc(RUNS);
  double all = 0, held = 0, worst = 0, orthonormal = 0, weibull = 0;
  size_t modes = 0;
  for (size_t i = 0; i < POINTS; i++) {
    id[i] = (int64_t)(3 * i);
    for (size_t k = 0; k < RUNS; k++) {
      double noise = noise_of(&ensemble, id[i], k);
      gsl_matrix_set(x, i, k, noise);
      weibull += noise * noise / (POINTS * RUNS);
    }
  }
  gsl_linalg_SV_decomp_jacobi(x, v, s);
  for (size_t j = 0; j < RUNS; j++)
    all += pow(gsl_vector_get(s, j), 2);
  while (held < 0.95 * all)
    held += pow(gsl_vector_get(s, modes++), 2);
  for (size_t a = 0; a < RUNS; a++)
    for (size_t b = 0; b < RUNS; b++) {
      double sum = 0;
      for (size_t i = 0; i < POINTS; i++)
        sum += gsl_matrix_get(x, i, a) * gsl_matrix_get(x, i, b);
      orthonormal = fmax(orthonormal, fabs(sum - (a == b)));
    }
  for (size_t k = 0; k < RUNS; k += 7) {
    draw_run(&ensemble, k, POINTS, id, value, &report);
    for (size_t i = 0; i < POINTS; i++) {
      double sum = 0;
      for (size_t j = 0; j < modes; j++)
        sum += gsl_matrix_get(x, i, j) * gsl_vector_get(s, j) * gsl_matrix_get(v, k, j);
      worst = fmax(worst, fabs(sum - value[i]));
    }
  }
  tap_absolute("ensemble: the dense decomposition's modes are orthonormal", orthonormal, 0, 1e-12);
  tap_absolute("ensemble: realisations against the dense decomposition", worst, 0, 1e-12);
  tap_ok(report.modes == modes, "ensemble: %zu of %d modes, %zu expected", report.modes, RUNS,
         modes);
  tap_absolute("ensemble: share of the variance that they hold", report.held, held / all, 1e-12);
  tap_relative("Weibull noise over 10: variance", weibull, 0.01, 5 / sqrt(POINTS * RUNS));
  gsl_matrix_free(x);
  gsl_matrix_free(v);
  gsl_vector_free(s);
}

/* The projector on the modes, seen through unit noise at as many points as there are runs. */
static void test_projector(void)
{
  static double field[RUNS][POINTS];
  static int64_t id[POINTS], back[POINTS];
  struct ensemble ensemble = {.noise = {false, 1, 2, 1}, .samples = RUNS, .energy = 0.9};
  struct ensemble_report report;
  static double turned[POINTS];
  double trace = 0, kept = 0, given = 0;
  for (size_t i = 0; i < POINTS; i++)
    id[i] = back[POINTS - 1 - i] = (int64_t)i;
  for (size_t k = 0; k < RUNS; k++) {
    draw_run(&ensemble, k, POINTS, id, field[k], &report);
    for (size_t i = 0; i < POINTS; i++) {
      double noise = noise_of(&ensemble, id[i], k);
      kept += field[k][i] * field[k][i];
      given += noise * noise;
      trace += field[k][i] * (noise - field[k][i]);
    }
  }
  tap_absolute("ensemble: share that the fields hold", kept / given, report.held, 1e-12);
  tap_absolute("ensemble: what is dropped is orthogonal to them", trace / given, 0, 1e-12);
  draw_run(&ensemble, 4, POINTS, back, turned, &report);
  double worst = 0;
  for (size_t i = 0; i < POINTS; i++)
    worst = fmax(worst, fabs(turned[i] - field[4][POINTS - 1 - i]));
  tap_absolute("ensemble: points in another order", worst, 0, 0);
  ensemble.points = POINTS;
  draw_run(&ensemble, 4, 5, id + 100, turned, &report);
  worst = 0;
  for (size_t i = 0; i < 5; i++)
    worst = fmax(worst, fabs(turned[i] - field[4][100 + i]));
  tap_absolute("ensemble of stated points: some of them alone", worst, 0, 0);
  ensemble.points = 0;
  ensemble.energy = 1;
  draw_run(&ensemble, 4, 10, id, turned, &report);
  worst = 0;
  for (size_t i = 0; i < 10; i++)
    worst = fmax(worst, fabs(turned[i] - noise_of(&ensemble, id[i], 4)));
  tap_ok(report.modes <= 10, "fewer points than samples: %zu modes of rank 10", report.modes);
  tap_absolute("all of the energy: the noise itself", worst, 0, 1e-11);
  int64_t twice[] = {1, 8, 3, 8};
  const struct gamut_stream stream = stream_make(5, 0, "ensemble");
  bool taken = ensemble_sample(&ensemble, &stream, 4, twice, turned, &report);
  tap_ok(!taken && report.twice == 8, "a point that comes twice is refused: %lld",
         (long long)report.twice);
}

/* Probabilities of the noise, of what a normal number becomes, and back. */
static void test_noise(void)
{
  const struct noise noise = {true, 1.5, 2.5, 4};
  double worst = 0;
  for (double z = -6; z <= 6; z += 0.05)
    worst = fmax(worst, fabs(noise_below(&noise, noise_of_normal(&noise, z)) -
                             0.5 * erfc(-z / sqrt(2.0))));
  tap_absolute("Weibull noise: probability of what a normal number becomes", worst, 0, 1e-14);
  const struct gamut_stream stream = stream_make(1, 0, "noise");
  enum { DRAWS = 20000 };
  double first = 0, second = 0;
  for (uint64_t i = 0; i < DRAWS; i++) {
    double u = noise_below(&noise, noise_at(&noise, &stream, i));
    first += u / DRAWS;
    second += u * u / DRAWS;
  }
  tap_absolute("Weibull noise: mean of its probabilities", first, 0.5, 5 / sqrt(12.0 * DRAWS));
  tap_absolute("Weibull noise: mean of their squares", second, 1.0 / 3,
               5 * sqrt(4.0 / 45 / DRAWS));
}

static void test_table(void)
{
  double row[24][4], x[3] = {0.5, 1.25, -0.5};
  struct table table = {0};
  size_t n = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 2; j >= 0; j--)
      for (int k = 0; k < 2; k++, n++) {
        row[n][0] = i * 0.3;
        row[n][1] = j;
        row[n][2] = -k;
        row[n][3] = 1 + 2 * row[n][0] - row[n][1] + 3 * row[n][2];
      }
  tap_ok(table_new(&table, row[0], 24) == NULL, "a table of a full grid, in any order");
  tap_absolute("its linear function between places", table_at(&table, x), 1 + 1 - 1.25 - 1.5,
               1e-14);
  x[0] = 9;
  tap_absolute("beyond the end", table_at(&table, x), 1 + 2 * 0.9 - 1.25 - 1.5, 1e-14);
  table_free(&table);
  table = (struct table){0};
  row[5][0] = row[4][0], row[5][1] = row[4][1], row[5][2] = row[4][2];
  tap_ok(table_new(&table, row[0], 24) != NULL, "a place that stands twice is refused");
  table_free(&table);
}

int main(void)
{
  test_exponential();
  test_orthonormal("exponential", EXPONENTIAL, 0.5, 1e-9);
  test_orthonormal("gaussian", GAUSSIAN, 0.2, 1e-9);
  test_orthonormal("matern_3_2", MATERN_3_2, 0.3, 1e-4);
  test_orthonormal("matern_5_2", MATERN_5_2, 0.3, 1e-5);
  test_covariance("exponential", EXPONENTIAL, 0.3, 0.9999, 1e-3);
  test_covariance("gaussian", GAUSSIAN, 0.1, 1, 1e-9);
  test_covariance("gaussian", GAUSSIAN, 1, 1, 1e-10);
  test_covariance("matern_3_2", MATERN_3_2, 0.2, 0.99999, 1e-4);
  test_covariance("matern_5_2", MATERN_5_2, 0.2, 0.999999, 1e-5);
  test_mesh();
  test_moments();
  test_lengths();
  test_ensemble();
  test_projector();
  test_noise();
  test_table();
  return tap_done();
}
