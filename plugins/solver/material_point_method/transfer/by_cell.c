/* Transfers of three dimensions by cell: points that follow each other in one cell share what the
 * cell gives. Gathering, the lanes of a vector are points of a cell; scattering with linear shapes,
 * they are its eight nodes, and the sums stay in registers until the cell changes. The last cell's
 * sums wait for the next chunk of the block, so that no sum depends on how a block is cut. */
#include <string.h>

#include "transfer/line.h"
#include "transfer/transfer.h"

enum { CELL_SIDE = 4, LINEAR_TILE = CELL_SIDE + 3, QUADRATIC_TILE = CELL_SIDE + 4 };

/* One past the last point that follows `i` in its cell. */
INLINE size_t run_end(const int32_t *node, size_t i, size_t count)
{
  const int32_t cell = node[i];
  do
    i++;
  while (i < count && node[i] == cell);
  return i;
}

/* Lanes beyond the cell's points may be written where the next cell overwrites them; beyond the
 * chunk they may not. */
INLINE void put(double *to, vector a, size_t lanes)
{
  if (lanes >= WIDTH)
    vector_write(to, a);
  else
    for (size_t l = 0; l < lanes; l++)
      to[l] = a[l];
}

/* ---- gather ------------------------------------------------------------------------------------
 */

/* The cell's polynomial, one line a coefficient: 1, x, y, xy, z, xz, yz, xyz. */
INLINE void linear_polynomial(const double *tile, double q[8 * LINE])
{
  struct line c[8];
  for (int n = 0; n < 8; n++)
    line_read(&c[n],
              tile + LINE * ((n & 1) + LINEAR_TILE * ((n >> 1 & 1) + LINEAR_TILE * (n >> 2))));
  for (int n = 0; n < 8; n += 2)
    line_subtract(&c[n + 1], &c[n]);
  for (int n = 0; n < 8; n += 4)
    for (int x = n; x < n + 2; x++)
      line_subtract(&c[x + 2], &c[x]);
  for (int n = 0; n < 4; n++)
    line_subtract(&c[n + 4], &c[n]);
  for (int n = 0; n < 8; n++)
    line_write(&c[n], q + LINE * n);
}

INLINE void linear_gather(struct work *w, size_t count, int first, double inverse_cell,
                          double *const *gradient)
{
  double q[8 * LINE] __attribute__((aligned(64)));
  for (size_t i = 0, end; i < count; i = end) {
    end = run_end(w->node, i, count);
    linear_polynomial(w->tile + LINE * w->node[i], q);
    for (size_t p = i; p < end; p += WIDTH) {
      const size_t lanes = count - p;
      const vector x = vector_read(w->place[0] + p), y = vector_read(w->place[1] + p),
                   z = vector_read(w->place[2] + p);
      for (int f = first; f < 6; f++) {
        const double *c = q + f;
        const vector low_y = c[0] + c[8] * x, high_y = c[16] + c[24] * x;
        const vector far_low = c[32] + c[40] * x, far_high = c[48] + c[56] * x;
        const vector near = low_y + high_y * y, by_z = far_low + far_high * y;
        put(w->value[f] + p, near + by_z * z, lanes);
        if (f >= 3 || gradient == NULL)
          continue;
        const vector by_x = (c[8] + c[24] * y) + (c[40] + c[56] * y) * z;
        put(gradient[3 * f] + p, by_x * inverse_cell, lanes);
        put(gradient[3 * f + 1] + p, (high_y + far_high * z) * inverse_cell, lanes);
        put(gradient[3 * f + 2] + p, by_z * inverse_cell, lanes);
      }
    }
  }
}

static void gather_linear(struct work *w, size_t count, bool velocity)
{
  if (velocity)
    linear_gather(w, count, 0, 1.0, NULL);
  else
    linear_gather(w, count, 3, 1.0, NULL);
}

static void gather_gradient_linear(struct work *w, size_t count, double inverse_cell,
                                   double *const gradient[9])
{
  linear_gather(w, count, 0, inverse_cell, gradient);
}

INLINE void quadratic_weights(const double *place, double scale, vector weight[3], vector slope[3])
{
  const vector x = vector_read(place), y = 1.0 - x;
  weight[0] = 0.5 * y * y;
  weight[1] = 0.5 + x * y;
  weight[2] = 0.5 * x * x;
  slope[0] = -y * scale;
  slope[1] = (y - x) * scale;
  slope[2] = x * scale;
}

/* One component of the lines at points of one cell; sum[0] the value, sum[1 to 3] its gradient. */
INLINE void quadratic_sum(const double *line, vector weight[3][3], vector slope[3][3],
                          bool gradient, vector sum[4])
{
  for (int k = 0; k < 4; k++)
    sum[k] = (vector){0};
  for (int z = 0; z < 3; z++) {
    vector value = {0}, by_x = {0}, by_y = {0};
    for (int y = 0; y < 3; y++) {
      const double *c = line + LINE * QUADRATIC_TILE * (y + QUADRATIC_TILE * z);
      const vector row = c[0] * weight[0][0] + c[LINE] * weight[0][1] + c[2 * LINE] * weight[0][2];
      value += row * weight[1][y];
      if (!gradient)
        continue;
      by_x += (c[0] * slope[0][0] + c[LINE] * slope[0][1] + c[2 * LINE] * slope[0][2]) *
              weight[1][y];
      by_y += row * slope[1][y];
    }
    sum[0] += value * weight[2][z];
    if (!gradient)
      continue;
    sum[1] += by_x * weight[2][z];
    sum[2] += by_y * weight[2][z];
    sum[3] += value * slope[2][z];
  }
}

INLINE void quadratic_gather(struct work *w, size_t count, int first, double inverse_cell,
                             double *const *gradient)
{
  for (size_t i = 0, end; i < count; i = end) {
    end = run_end(w->node, i, count);
    const double *tile = w->tile + LINE * w->node[i];
    for (size_t p = i; p < end; p += WIDTH) {
      vector weight[3][3], slope[3][3], sum[4];
      for (int k = 0; k < 3; k++)
        quadratic_weights(w->place[k] + p, inverse_cell, weight[k], slope[k]);
      for (int f = first; f < 6; f++) {
        const bool slopes = gradient != NULL && f < 3;
        quadratic_sum(tile + f, weight, slope, slopes, sum);
        put(w->value[f] + p, sum[0], count - p);
        for (int k = 0; slopes && k < 3; k++)
          put(gradient[3 * f + k] + p, sum[k + 1], count - p);
      }
    }
  }
}

static void gather_quadratic(struct work *w, size_t count, bool velocity)
{
  quadratic_gather(w, count, velocity ? 0 : 3, 1.0, NULL);
}

static void gather_gradient_quadratic(struct work *w, size_t count, double inverse_cell,
                                      double *const gradient[9])
{
  quadratic_gather(w, count, 0, inverse_cell, gradient);
}

/* ---- scatter -----------------------------------------------------------------------------------
 */

#if WIDTH == 8
/* Sums of a cell, by node: mass, momentum, force component by slope component, external force. */
enum { SUM_M, SUM_P, SUM_F = SUM_P + 3, SUM_E = SUM_F + 9 };

static const vector sign[3] = {{-1, 1, -1, 1, -1, 1, -1, 1},
                               {-1, -1, 1, 1, -1, -1, 1, 1},
                               {-1, -1, -1, -1, 1, 1, 1, 1}};
static const vector base[3] = {{1, 0, 1, 0, 1, 0, 1, 0},
                               {1, 1, 0, 0, 1, 1, 0, 0},
                               {1, 1, 1, 1, 0, 0, 0, 0}};

typedef int64_t shuffle __attribute__((vector_size(64)));

INLINE void transpose(vector r[8])
{
  const shuffle low1 = {0, 8, 2, 10, 4, 12, 6, 14}, high1 = {1, 9, 3, 11, 5, 13, 7, 15};
  const shuffle low2 = {0, 1, 8, 9, 4, 5, 12, 13}, high2 = {2, 3, 10, 11, 6, 7, 14, 15};
  const shuffle low4 = {0, 1, 2, 3, 8, 9, 10, 11}, high4 = {4, 5, 6, 7, 12, 13, 14, 15};
  vector t[8], u[8];
  for (int i = 0; i < 8; i += 2) {
    t[i] = __builtin_shuffle(r[i], r[i + 1], low1);
    t[i + 1] = __builtin_shuffle(r[i], r[i + 1], high1);
  }
  for (int i = 0; i < 8; i += 4)
    for (int j = i; j < i + 2; j++) {
      u[j] = __builtin_shuffle(t[j], t[j + 2], low2);
      u[j + 2] = __builtin_shuffle(t[j], t[j + 2], high2);
    }
  for (int j = 0; j < 4; j++) {
    r[j] = __builtin_shuffle(u[j], u[j + 4], low4);
    r[j + 4] = __builtin_shuffle(u[j], u[j + 4], high4);
  }
}

/* Adds the sums of a cell to its nodes' lines. */
INLINE void add_cell(double *tile, const vector sum[PENDING])
{
  vector r[8] = {sum[SUM_M], sum[SUM_P], sum[SUM_P + 1], sum[SUM_P + 2]};
  for (int c = 0; c < 3; c++)
    r[4 + c] = sum[SUM_F + 3 * c] * sign[0] + sum[SUM_F + 3 * c + 1] * sign[1] +
               sum[SUM_F + 3 * c + 2] * sign[2] + sum[SUM_E + c];
  transpose(r);
  for (int n = 0; n < 8; n++) {
    double *line = tile + LINE * ((n & 1) + LINEAR_TILE * ((n >> 1 & 1) + LINEAR_TILE * (n >> 2)));
    vector_write(line, vector_read(line) + r[n]);
  }
}

INLINE void add_point(const struct work *w, const double *mass, size_t i, bool force, bool outer,
                      vector sum[PENDING])
{
  static const int component[3][3] = {{6, 9, 11}, {9, 7, 10}, {11, 10, 8}};
  const vector x = base[0] + sign[0] * w->place[0][i], y = base[1] + sign[1] * w->place[1][i],
               z = base[2] + sign[2] * w->place[2][i];
  const vector slope[3] = {y * z, x * z, x * y}, weight = x * slope[0];
  sum[SUM_M] += weight * mass[i];
  for (int c = 0; c < 3; c++)
    sum[SUM_P + c] += weight * w->prepared[c][i];
  for (int c = 0; force && c < 3; c++)
    for (int k = 0; k < 3; k++)
      sum[SUM_F + 3 * c + k] += slope[k] * w->prepared[component[c][k]][i];
  for (int c = 0; outer && c < 3; c++)
    sum[SUM_E + c] += weight * w->prepared[3 + c][i];
}

INLINE void linear_scatter(struct work *w, const struct point_view *p, bool force, bool outer)
{
  const size_t real = p->real;
  if (real == 0)
    return;
  vector sum[PENDING];
  for (int k = 0; k < PENDING; k++)
    sum[k] = vector_read(w->pending[k]);
  int32_t cell = w->pending_node;
  for (size_t i = 0, end; i < real; i = end) {
    if (w->node[i] != cell) {
      if (cell >= 0)
        add_cell(w->sums + LINE * cell, sum);
      for (int k = 0; k < PENDING; k++)
        sum[k] = (vector){0};
      cell = w->node[i];
    }
    end = run_end(w->node, i, real);
    for (size_t j = i; j < end; j++)
      add_point(w, p->mass, j, force, outer, sum);
  }
  for (int k = 0; k < PENDING; k++)
    vector_write(w->pending[k], sum[k]);
  w->pending_node = cell;
}

static void finish(struct work *w)
{
  vector sum[PENDING];
  for (int k = 0; k < PENDING; k++) {
    sum[k] = vector_read(w->pending[k]);
    vector_write(w->pending[k], (vector){0});
  }
  if (w->pending_node >= 0)
    add_cell(w->sums + LINE * w->pending_node, sum);
  w->pending_node = -1;
}

static void prepare_momentum(struct work *w, const struct point_view *p)
{
  const double *restrict mass = p->mass;
  for (int c = 0; c < 3; c++) {
    const double *restrict v = p->velocity[c];
    double *restrict to = w->prepared[c];
#pragma omp simd
    for (size_t i = 0; i < p->count; i++)
      to[i] = mass[i] * v[i];
  }
}

static void prepare_force(struct work *w, const struct point_view *p, double inverse_cell)
{
  const double *restrict mass = p->mass, *restrict ratio = p->volume_ratio;
  const double over = -inverse_cell / p->density;
  for (int k = 0; k < 6; k++) {
    const double *restrict stress = p->stress[k];
    double *restrict to = w->prepared[6 + k];
#pragma omp simd
    for (size_t i = 0; i < p->count; i++)
      to[i] = over * mass[i] * ratio[i] * stress[i];
  }
  for (int c = 0; c < 3 && p->force[0] != NULL; c++)
    memcpy(w->prepared[3 + c], p->force[c], p->count * sizeof(double));
}

static void scatter_linear(struct work *w, const struct point_view *p, double inverse_cell)
{
  prepare_momentum(w, p);
  prepare_force(w, p, inverse_cell);
  if (p->force[0] != NULL)
    linear_scatter(w, p, true, true);
  else
    linear_scatter(w, p, true, false);
}

static void scatter_momentum_linear(struct work *w, const struct point_view *p)
{
  prepare_momentum(w, p);
  linear_scatter(w, p, false, false);
}
#endif

void transfer_by_cell(struct transfer *t, unsigned order)
{
  t->gather = order == 1 ? gather_linear : gather_quadratic;
  t->gather_gradient = order == 1 ? gather_gradient_linear : gather_gradient_quadratic;
#if WIDTH == 8
  if (order == 1) {
    t->scatter = scatter_linear;
    t->scatter_momentum = scatter_momentum_linear;
    t->finish = finish;
  }
#endif
}
