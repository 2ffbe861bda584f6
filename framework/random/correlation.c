#include "random/correlation.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

double correlation_smallest(const double *matrix, size_t n)
{
  double least = NAN;
  if (n == 0)
    return 1;
  gsl_matrix *work = gsl_matrix_alloc(n, n);
  gsl_vector *value = gsl_vector_alloc(n);
  gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(n);
  if (work && value && space) {
    gsl_matrix_const_view view = gsl_matrix_const_view_array(matrix, n, n);
    gsl_matrix_memcpy(work, &view.matrix);
    if (gsl_eigen_symm(work, value, space) == 0)
      least = gsl_vector_min(value);
  }
  if (space)
    gsl_eigen_symm_free(space);
  if (value)
    gsl_vector_free(value);
  if (work)
    gsl_matrix_free(work);
  return least;
}

/* Without its share of the columns before. */
static double rest(const double *matrix, size_t n, const double *lower, size_t i, size_t k)
{
  double sum = matrix[i * n + k];
  for (size_t j = 0; j < k; j++)
    sum -= lower[i * n + j] * lower[k * n + j];
  return sum;
}

/* Cholesky's factor where a variable may follow from those before: its column is 0. */
static void factor_singular(const double *matrix, size_t n, double *lower)
{
  memset(lower, 0, n * n * sizeof *lower);
  for (size_t k = 0; k < n; k++) {
    const double square = rest(matrix, n, lower, k, k);
    if (square <= (double)n * CORRELATION_LEAST)
      continue;
    lower[k * n + k] = sqrt(square);
    for (size_t i = k + 1; i < n; i++)
      lower[i * n + k] = rest(matrix, n, lower, i, k) / lower[k * n + k];
  }
}

bool correlation_factor(const double *matrix, size_t n, double *lower)
{
  if (n == 0)
    return true;
  const double least = correlation_smallest(matrix, n);
  if (!(least >= -CORRELATION_LEAST))
    return false;
  if (least <= CORRELATION_LEAST) {
    factor_singular(matrix, n, lower);
    return true;
  }
  memcpy(lower, matrix, n * n * sizeof *lower);
  gsl_matrix_view view = gsl_matrix_view_array(lower, n, n);
  if (gsl_linalg_cholesky_decomp1(&view.matrix) != 0)
    return false;
  for (size_t i = 0; i < n; i++)
    for (size_t k = i + 1; k < n; k++)
      lower[i * n + k] = 0;
  return true;
}
