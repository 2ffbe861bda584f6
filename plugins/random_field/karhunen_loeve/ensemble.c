#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "expansion.h"

enum { BATCH = 256, KEPT_MOST = 1 << 22 };

static int by_size(const void *one, const void *other)
{
  const int64_t *a = one, *b = other;
  return (*a > *b) - (*a < *b);
}

/* Rows of the ensemble: points in the order of their ids, one column a realisation. */
static void fill_rows(const struct ensemble *ensemble, const struct gamut_stream *stream,
                      size_t rows, const int64_t *id, double *row)
{
  struct gamut_stream one = *stream;
  for (size_t k = 0; k < ensemble->samples; k++) {
    one.realisation = k;
    for (size_t i = 0; i < rows; i++)
      row[i * ensemble->samples + k] = noise_at(&ensemble->noise, &one, (uint64_t)id[i]);
  }
}

/* Householder's triangle of the n x n triangle on top of `rows` more rows, all row by row in `a`,
 * so that every inner loop runs over columns. `sum` has room for n numbers. */
static void triangulate(double *restrict a, size_t n, size_t rows, double *restrict sum)
{
  double *restrict more = a + n * n;
  for (size_t k = 0; k < n; k++) {
    double *restrict top = a + k * n, square = 0.0;
    for (size_t i = 0; i < rows; i++)
      square += more[i * n + k] * more[i * n + k];
    if (square == 0.0)
      continue;
    double norm = sqrt(top[k] * top[k] + square);
    double pivot = top[k] > 0.0 ? -norm : norm, v = top[k] - pivot;
    double scale = -1.0 / (pivot * v);
    for (size_t c = k; c < n; c++)
      sum[c] = v * top[c];
    for (size_t i = 0; i < rows; i++)
      for (size_t c = k; c < n; c++)
        sum[c] += more[i * n + k] * more[i * n + c];
    for (size_t c = k; c < n; c++)
      sum[c] *= scale;
    for (size_t c = k + 1; c < n; c++)
      top[c] -= sum[c] * v;
    for (size_t i = 0; i < rows; i++) {
      double own = more[i * n + k];
      for (size_t c = k + 1; c < n; c++)
        more[i * n + c] -= sum[c] * own;
    }
    top[k] = pivot;
  }
}

/* The small factor R of X = Q R, by blocks of rows: X itself is never needed as a whole. */
static bool small_factor(const struct ensemble *ensemble, const struct gamut_stream *stream,
                         size_t count, const int64_t *id, double *kept, double *factor)
{
  const size_t n = ensemble->samples;
  double *a = calloc(n * (n + BATCH), sizeof *a), *sum = calloc(n, sizeof *sum);
  bool good = a && sum;
  for (size_t from = 0; good && from < count; from += BATCH) {
    size_t rows = count - from < BATCH ? count - from : BATCH;
    fill_rows(ensemble, stream, rows, id + from, a + n * n);
    if (kept)
      memcpy(kept + from * n, a + n * n, rows * n * sizeof *kept);
    triangulate(a, n, rows, sum);
  }
  if (good)
    memcpy(factor, a, n * n * sizeof *factor); /* what is below its diagonal does not count */
  free(a);
  free(sum);
  return good;
}

/* Column `realisation` of the projector on the leading right singular vectors of R. */
static bool projector(const struct ensemble *ensemble, const double *factor, size_t realisation,
                      double *column, struct ensemble_report *report)
{
  const size_t n = ensemble->samples;
  gsl_matrix *u = gsl_matrix_calloc(n, n), *v = gsl_matrix_calloc(n, n);
  gsl_vector *s = gsl_vector_calloc(n);
  bool good = u && v && s;
  double all = 0.0, held = 0.0;
  for (size_t i = 0; good && i < n; i++)
    for (size_t k = i; k < n; k++)
      gsl_matrix_set(u, i, k, factor[i * n + k]);
  good = good && gsl_linalg_SV_decomp_jacobi(u, v, s) == 0;
  for (size_t j = 0; good && j < n; j++)
    all += gsl_vector_get(s, j) * gsl_vector_get(s, j);
  for (size_t j = 0; good && j < n && held < ensemble->energy * all; j++) {
    double size = gsl_vector_get(s, j);
    if (!(size >= 1e-12 * gsl_vector_get(s, 0)))
      break;
    held += size * size;
    report->modes = j + 1;
    for (size_t k = 0; k < n; k++)
      column[k] += gsl_matrix_get(v, k, j) * gsl_matrix_get(v, realisation, j);
  }
  report->held = all > 0.0 ? held / all : 1.0;
  if (u)
    gsl_matrix_free(u);
  if (v)
    gsl_matrix_free(v);
  if (s)
    gsl_vector_free(s);
  return good;
}

/* Ids of the ensemble's points, in order. */
static int64_t *population(const struct ensemble *ensemble, size_t count, const int64_t *id,
                           size_t *points, int64_t *twice)
{
  *points = ensemble->points ? ensemble->points : count;
  int64_t *all = calloc(*points + 1, sizeof *all);
  if (!all)
    return NULL;
  for (size_t i = 0; i < *points; i++)
    all[i] = ensemble->points ? (int64_t)i : id[i];
  qsort(all, *points, sizeof *all, by_size);
  for (size_t i = 1; i < *points && *twice < 0; i++)
    if (all[i] == all[i - 1])
      *twice = all[i];
  return all;
}

static void put_values(const struct ensemble *ensemble, const struct gamut_stream *stream,
                       size_t count, const int64_t *id, const double *column, double *row,
                       double *value)
{
  for (size_t i = 0; i < count; i++) {
    double sum = 0.0;
    fill_rows(ensemble, stream, 1, id + i, row);
    for (size_t k = 0; k < ensemble->samples; k++)
      sum += row[k] * column[k];
    value[i] = sum;
  }
}

/* The same from the rows that are kept, in the order of the population. */
static void put_kept(const struct ensemble *ensemble, size_t count, const int64_t *id,
                     const int64_t *all, size_t points, const double *column, const double *kept,
                     double *value)
{
  for (size_t i = 0; i < count; i++) {
    const int64_t *found = bsearch(&id[i], all, points, sizeof *all, by_size);
    const double *row = kept + (size_t)(found - all) * ensemble->samples;
    double sum = 0.0;
    for (size_t k = 0; k < ensemble->samples; k++)
      sum += row[k] * column[k];
    value[i] = sum;
  }
}

bool ensemble_sample(const struct ensemble *ensemble, const struct gamut_stream *stream,
                     size_t count, const int64_t *id, double *value, struct ensemble_report *report)
{
  const size_t n = ensemble->samples;
  size_t points;
  *report = (struct ensemble_report){.twice = -1};
  int64_t *all = population(ensemble, count, id, &points, &report->twice);
  bool keeps = !ensemble->points && points * n <= KEPT_MOST;
  double *kept = keeps ? calloc(points * n + 1, sizeof *kept) : NULL;
  double *factor = calloc(n * n + 2 * n, sizeof *factor);
  bool good = all && factor && (kept || !keeps) && report->twice < 0;
  double *column = factor + n * n, *row = column + n;
  good = good && small_factor(ensemble, stream, points, all, kept, factor) &&
         projector(ensemble, factor, stream->realisation, column, report);
  if (good && kept)
    put_kept(ensemble, count, id, all, points, column, kept, value);
  else if (good)
    put_values(ensemble, stream, count, id, column, row, value);
  free(factor);
  free(kept);
  free(all);
  return good;
}
