#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_integration.h>

#include "expansion.h"

static double correlation(enum covariance covariance, double r)
{
  const double root3 = 1.7320508075688772, root5 = 2.2360679774997897;
  switch (covariance) {
  case GAUSSIAN:
    return exp(-0.5 * r * r);
  case MATERN_3_2:
    return (1.0 + root3 * r) * exp(-root3 * r);
  case MATERN_5_2:
    return (1.0 + root5 * r + 5.0 / 3.0 * r * r) * exp(-root5 * r);
  case EXPONENTIAL:
  case MATERN_1_2:
    break;
  }
  return exp(-r);
}

/* Root of t = j pi / 2 + atan(ratio / t), which gathers the even and the odd modes in one line. */
static double frequency_of(size_t j, double ratio)
{
  const double quarter = 1.5707963267948966;
  const double low = (double)j * quarter, high = low + quarter;
  double t = 0.5 * (low + high);
  for (int i = 0; i < 200; i++) {
    double miss = t - low - atan(ratio / t);
    double next = t - miss / (1.0 + ratio / (t * t + ratio * ratio));
    next = fmin(fmax(next, 0.5 * (t + low)), 0.5 * (t + high));
    if (fabs(next - t) <= 1e-16 * t)
      return next;
    t = next;
  }
  return t;
}

static bool solve_exponential(struct axis *axis, size_t most)
{
  axis->frequency = calloc(most, sizeof(double));
  axis->size = calloc(most, sizeof(double));
  axis->share = calloc(most, sizeof(double));
  if (!axis->frequency || !axis->size || !axis->share)
    return false;
  for (size_t j = 0; j < most; j++) {
    double t = frequency_of(j, axis->ratio), r = axis->ratio;
    double sign = j % 2 ? -1.0 : 1.0;
    axis->frequency[j] = t;
    axis->share[j] = r / (t * t + r * r);
    axis->size[j] = sqrt(2.0 * axis->share[j] / (1.0 + sign * sin(2.0 * t) / (2.0 * t)));
  }
  axis->modes = most;
  return true;
}

struct half_problem {
  gsl_matrix *matrix, *vector;
  gsl_vector *value;
};

static void half_free(struct half_problem *half)
{
  if (half->matrix)
    gsl_matrix_free(half->matrix);
  if (half->vector)
    gsl_matrix_free(half->vector);
  if (half->value)
    gsl_vector_free(half->value);
}

static bool half_solve(const struct axis *axis, const double *root, double sign,
                       struct half_problem *half)
{
  const size_t n = axis->nodes;
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(n);
  *half =
      (struct half_problem){gsl_matrix_alloc(n, n), gsl_matrix_alloc(n, n), gsl_vector_alloc(n)};
  bool good = work && half->matrix && half->vector && half->value;
  for (size_t i = 0; good && i < n; i++)
    for (size_t k = 0; k < n; k++) {
      double near =
          correlation(axis->covariance, fabs(axis->node[i] - axis->node[k]) * axis->ratio);
      double far = correlation(axis->covariance, (axis->node[i] + axis->node[k]) * axis->ratio);
      gsl_matrix_set(half->matrix, i, k, root[i] * root[k] * (near + sign * far));
    }
  good = good && gsl_eigen_symmv(half->matrix, half->value, half->vector, work) == 0 &&
         gsl_eigen_symmv_sort(half->value, half->vector, GSL_EIGEN_SORT_VAL_DESC) == 0;
  if (work)
    gsl_eigen_symmv_free(work);
  return good;
}

/* Even and odd modes alternate, so they are taken in turn. What is left of eigenvalues below
 * rounding is no mode. */
static bool gather_modes(struct axis *axis, const double *root, const struct half_problem *half,
                         size_t most)
{
  const size_t n = axis->nodes;
  double least = (double)(2 * n) * 2.220446049250313e-16 * gsl_vector_get(half[0].value, 0);
  most = most < 2 * n ? most : 2 * n;
  axis->share = calloc(most, sizeof(double));
  axis->weight = calloc(most * n, sizeof(double));
  if (!axis->share || !axis->weight)
    return false;
  for (size_t j = 0; j < most; j++) {
    const struct half_problem *own = &half[j % 2];
    double value = gsl_vector_get(own->value, j / 2);
    if (!(value > least))
      break;
    double sign = gsl_matrix_get(own->vector, 0, j / 2) < 0.0 ? -1.0 : 1.0;
    axis->share[j] = 0.5 * value;
    for (size_t q = 0; q < n; q++)
      axis->weight[j * n + q] =
          sign * root[q] * gsl_matrix_get(own->vector, q, j / 2) / sqrt(2.0 * value);
    axis->modes = j + 1;
  }
  return true;
}

static bool solve_nystrom(struct axis *axis, size_t most)
{
  double wanted = 48.0 + 16.0 * axis->ratio;
  const size_t n = axis->nodes = wanted < 512.0 ? (size_t)wanted : 512;
  struct half_problem half[2] = {{0}, {0}};
  double *root = calloc(n, sizeof(double));
  gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(2 * n);
  axis->node = calloc(n, sizeof(double));
  bool good = root && gauss && axis->node;
  for (size_t q = 0; good && q < n; q++) {
    double weight;
    gsl_integration_glfixed_point(-1.0, 1.0, n + q, &axis->node[q], &weight, gauss);
    root[q] = sqrt(weight);
  }
  good = good && half_solve(axis, root, 1.0, &half[0]) && half_solve(axis, root, -1.0, &half[1]) &&
         gather_modes(axis, root, half, most);
  half_free(&half[0]);
  half_free(&half[1]);
  if (gauss)
    gsl_integration_glfixed_table_free(gauss);
  free(root);
  return good;
}

bool axis_new(struct axis *axis, enum covariance covariance, double lower, double upper,
              double length, size_t most)
{
  *axis = (struct axis){.centre = 0.5 * (lower + upper),
                        .half = 0.5 * (upper - lower),
                        .ratio = 0.5 * (upper - lower) / length,
                        .covariance = covariance};
  if (covariance == EXPONENTIAL || covariance == MATERN_1_2)
    return solve_exponential(axis, most);
  return solve_nystrom(axis, most);
}

void axis_free(struct axis *axis)
{
  free(axis->share);
  free(axis->frequency);
  free(axis->size);
  free(axis->node);
  free(axis->weight);
  *axis = (struct axis){0};
}

void axis_modes(const struct axis *axis, double x, size_t count, double *room, double *value)
{
  const double xi = (x - axis->centre) / axis->half;
  const size_t n = axis->nodes;
  for (size_t j = 0; n == 0 && j < count; j++)
    value[j] =
        axis->size[j] * (j % 2 ? sin(axis->frequency[j] * xi) : cos(axis->frequency[j] * xi));
  if (n == 0)
    return;
  for (size_t q = 0; q < n; q++) {
    double near = correlation(axis->covariance, fabs(xi - axis->node[q]) * axis->ratio);
    double far = correlation(axis->covariance, fabs(xi + axis->node[q]) * axis->ratio);
    room[q] = near + far;
    room[n + q] = near - far;
  }
  for (size_t j = 0; j < count; j++) {
    const double *kernel = room + (j % 2) * n, *weight = axis->weight + j * n;
    double sum = 0.0;
    for (size_t q = 0; q < n; q++)
      sum += weight[q] * kernel[q];
    value[j] = sum;
  }
}
