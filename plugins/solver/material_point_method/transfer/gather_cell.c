/* Gathering in three dimensions by cell: the lanes of a vector are points that follow each other in
 * one cell, so that they share its nodes. */
#include "transfer/formulas.h"
#include "transfer/transfer.h"

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

/* The cell's polynomial, one line a coefficient: 1, x, y, xy, z, xz, yz, xyz. */
INLINE void linear_polynomial(const double *tile, double q[8 * NODE_SIZE])
{
  struct line c[8];
  for (int n = 0; n < 8; n++)
    line_read(&c[n],
              tile + NODE_SIZE * ((n & 1) + TILE_LINEAR * ((n >> 1 & 1) + TILE_LINEAR * (n >> 2))));
  for (int n = 0; n < 8; n += 2)
    line_subtract(&c[n + 1], &c[n]);
  for (int n = 0; n < 8; n += 4)
    for (int x = n; x < n + 2; x++)
      line_subtract(&c[x + 2], &c[x]);
  for (int n = 0; n < 4; n++)
    line_subtract(&c[n + 4], &c[n]);
  for (int n = 0; n < 8; n++)
    line_write(&c[n], q + NODE_SIZE * n);
}

INLINE void linear_gather(struct work *w, size_t count, int first, double inverse_cell,
                          double *const *gradient)
{
  double q[8 * NODE_SIZE] __attribute__((aligned(64)));
  for (size_t i = 0, end; i < count; i = end) {
    end = run_end(w->node, i, count);
    linear_polynomial(w->tile + NODE_SIZE * w->node[i], q);
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

INLINE void weights_of(enum shape shape, const struct work *w, int k, size_t p, double scale,
                       vector weight[NODES_MAX], vector slope[NODES_MAX])
{
  const vector place = vector_read(w->place[k] + p), reach = vector_read(w->reach[k] + p);
  if (shape == SHAPE_GIMP)
    weights_gimp(place, reach, scale, weight, slope);
  else if (shape == SHAPE_QUADRATIC)
    weights_quadratic(place, reach, scale, weight, slope);
  else
    weights_cubic(place, reach, scale, weight, slope);
}

/* One component of the lines at points of one cell; sum[0] the value, sum[1 to 3] its gradient. */
INLINE void spline_sum(int nodes, const double *line, vector weight[3][NODES_MAX],
                       vector slope[3][NODES_MAX], bool gradient, vector sum[4])
{
  const int tile = CELL_SIDE + 1 + nodes;
  for (int k = 0; k < 4; k++)
    sum[k] = (vector){0};
  for (int z = 0; z < nodes; z++) {
    vector value = {0}, by_x = {0}, by_y = {0};
    for (int y = 0; y < nodes; y++) {
      const double *c = line + NODE_SIZE * tile * (y + tile * z);
      vector row = c[0] * weight[0][0], row_by_x = c[0] * slope[0][0];
      for (int x = 1; x < nodes; x++) {
        row += c[NODE_SIZE * x] * weight[0][x];
        if (gradient)
          row_by_x += c[NODE_SIZE * x] * slope[0][x];
      }
      value += row * weight[1][y];
      if (!gradient)
        continue;
      by_x += row_by_x * weight[1][y];
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

INLINE void spline_gather(enum shape shape, int nodes, struct work *w, size_t count, int first,
                          double inverse_cell, double *const *gradient)
{
  for (size_t i = 0, end; i < count; i = end) {
    end = run_end(w->node, i, count);
    const double *tile = w->tile + NODE_SIZE * w->node[i];
    for (size_t p = i; p < end; p += WIDTH) {
      vector weight[3][NODES_MAX], slope[3][NODES_MAX], sum[4];
      for (int k = 0; k < 3; k++)
        weights_of(shape, w, k, p, inverse_cell, weight[k], slope[k]);
      for (int f = first; f < 6; f++) {
        const bool slopes = gradient != NULL && f < 3;
        spline_sum(nodes, tile + f, weight, slope, slopes, sum);
        put(w->value[f] + p, sum[0], count - p);
        for (int k = 0; slopes && k < 3; k++)
          put(gradient[3 * f + k] + p, sum[k + 1], count - p);
      }
    }
  }
}

#define SPLINE_GATHERS(name, shape)                                                                \
  static void gather_##name(struct work *w, size_t count, bool velocity)                           \
  {                                                                                                \
    spline_gather(shape, NODES_##name, w, count, velocity ? 0 : 3, 1.0, NULL);                     \
  }                                                                                                \
  static void gather_gradient_##name(struct work *w, size_t count, double inverse_cell,            \
                                     double *const gradient[9])                                    \
  {                                                                                                \
    spline_gather(shape, NODES_##name, w, count, 0, inverse_cell, gradient);                       \
  }

SPLINE_GATHERS(gimp, SHAPE_GIMP)
SPLINE_GATHERS(quadratic, SHAPE_QUADRATIC)
SPLINE_GATHERS(cubic, SHAPE_CUBIC)

void gather_by_cell(struct transfer *t, enum shape shape)
{
  static void (*const gather[SHAPES])(struct work *, size_t, bool) = {
      gather_linear, gather_gimp, gather_quadratic, gather_cubic};
  static void (*const gather_gradient[SHAPES])(struct work *, size_t, double, double *const *) = {
      gather_gradient_linear, gather_gradient_gimp, gather_gradient_quadratic,
      gather_gradient_cubic};
  t->gather = gather[shape];
  t->gather_gradient = gather_gradient[shape];
}
