/* Scattering in three dimensions by cell, with linear shapes: the lanes of a vector are the eight
 * nodes of a cell, and its sums stay in registers until the cell changes. The last cell's sums wait
 * for the next chunk of the block, so that no sum depends on how a block is cut. */
#include <string.h>

#include "transfer/line.h"
#include "transfer/transfer.h"

#if WIDTH == 8
/* Sums of a cell, by node: mass, momentum, force component by slope component, external force,
 * squared mass. */
enum { SUM_M, SUM_P, SUM_F = SUM_P + 3, SUM_E = SUM_F + 9, SUM_S = SUM_E + 3 };

static const vector sign[3] = {
    {-1, 1, -1, 1, -1, 1, -1, 1}, {-1, -1, 1, 1, -1, -1, 1, 1}, {-1, -1, -1, -1, 1, 1, 1, 1}};
static const vector base[3] = {
    {1, 0, 1, 0, 1, 0, 1, 0}, {1, 1, 0, 0, 1, 1, 0, 0}, {1, 1, 1, 1, 0, 0, 0, 0}};

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
  r[NODE_SQUARE] = sum[SUM_S];
  transpose(r);
  for (int n = 0; n < 8; n++) {
    double *line =
        tile + NODE_SIZE * ((n & 1) + TILE_LINEAR * ((n >> 1 & 1) + TILE_LINEAR * (n >> 2)));
    vector_write(line, vector_read(line) + r[n]);
  }
}

/* Which sums a scatter makes beside mass and momentum. */
enum { FORCE = 1, OUTER = 2, SQUARES = 4 };

INLINE void add_point(const struct work *w, const double *mass, size_t i, int kinds,
                      vector sum[PENDING])
{
  static const int component[3][3] = {{6, 9, 11}, {9, 7, 10}, {11, 10, 8}};
  const vector x = base[0] + sign[0] * w->place[0][i], y = base[1] + sign[1] * w->place[1][i],
               z = base[2] + sign[2] * w->place[2][i];
  const vector slope[3] = {y * z, x * z, x * y}, weight = x * slope[0];
  sum[SUM_M] += weight * mass[i];
  for (int c = 0; c < 3; c++)
    sum[SUM_P + c] += weight * w->prepared[c][i];
  for (int c = 0; (kinds & FORCE) && c < 3; c++)
    for (int k = 0; k < 3; k++)
      sum[SUM_F + 3 * c + k] += slope[k] * w->prepared[component[c][k]][i];
  for (int c = 0; (kinds & OUTER) && c < 3; c++)
    sum[SUM_E + c] += weight * w->prepared[3 + c][i];
  if (kinds & SQUARES)
    sum[SUM_S] += weight * (mass[i] * mass[i]);
}

INLINE void linear_scatter(struct work *w, const struct point_view *p, int kinds)
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
        add_cell(w->sums + NODE_SIZE * cell, sum);
      for (int k = 0; k < PENDING; k++)
        sum[k] = (vector){0};
      cell = w->node[i];
    }
    end = run_end(w->node, i, real);
    for (size_t j = i; j < end; j++)
      add_point(w, p->mass, j, kinds, sum);
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
    add_cell(w->sums + NODE_SIZE * w->pending_node, sum);
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

static void prepare_force(struct work *w, const struct point_view *p, double cell)
{
  const double *restrict mass = p->mass, *restrict ratio = p->volume_ratio;
  const double over = -1.0 / (cell * p->density);
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

static void scatter_linear(struct work *w, const struct point_view *p, double cell)
{
  prepare_momentum(w, p);
  prepare_force(w, p, cell);
  const int kinds = FORCE | (p->force[0] != NULL ? OUTER : 0) | (p->squares ? SQUARES : 0);
  if (kinds == FORCE)
    linear_scatter(w, p, FORCE);
  else if (kinds == (FORCE | SQUARES))
    linear_scatter(w, p, FORCE | SQUARES);
  else if (kinds == (FORCE | OUTER))
    linear_scatter(w, p, FORCE | OUTER);
  else
    linear_scatter(w, p, FORCE | OUTER | SQUARES);
}

static void scatter_momentum_linear(struct work *w, const struct point_view *p, double cell)
{
  (void)cell;
  prepare_momentum(w, p);
  linear_scatter(w, p, 0);
}
#endif

void scatter_by_cell(struct transfer *t)
{
#if WIDTH == 8
  t->scatter = scatter_linear;
  t->scatter_momentum = scatter_momentum_linear;
  t->finish = finish;
#else
  (void)t;
#endif
}
