/* The transfers for one DIMENSION (1 to 3) and SHAPE (linear, gimp, quadratic, cubic). Included by
 * SHAPE.c once for each dimension; so it has no guard, and takes DIMENSION away at the end.
 *
 * Points are taken one after the other, in the order of their slots: the lanes of a vector are the
 * quantities of a node's line. That is right in any order of points, and sums do not depend on how
 * points are cut into chunks. */

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)
#define NAMED(name) JOIN(name, JOIN(SHAPE, DIMENSION))
#define NODES JOIN(NODES, SHAPE)
#define NODES_Y (DIMENSION > 1 ? NODES : 1)
#define NODES_Z (DIMENSION > 2 ? NODES : 1)
#define SIDE (DIMENSION == 1 ? 64 : DIMENSION == 2 ? 8 : 4)
#define TILE (SIDE + 1 + NODES)
/* Of quadratic and cubic splines it is the same everywhere. */
#define MEAN_SECOND(cell) ((cell) * (cell) / (NODES == 4 ? 3.0 : 4.0))

static bool NAMED(locate)(struct work *w, const struct locate *in, bool grow)
{
  /* a point on a node leaves a trace at the node beyond, whose linear slope it sees */
  const double scale = in->inverse_cell, end = SIDE + 2, least = NODES == 2 ? 1e-12 : 0.0;
  int lower[3] = {SIDE + 2, SIDE + 2, SIDE + 2}, upper[3] = {-1, -1, -1}, bad = 0;
  int32_t *restrict node = w->node;
  for (size_t i = 0; i < in->count; i++)
    node[i] = 0;
  int stride = 1;
  for (unsigned k = 0; k < DIMENSION; k++) {
    const double *restrict x = in->position[k];
    double *restrict place = w->place[k];
    const double origin = in->origin[k];
    int low = SIDE + 2, high = -1;
#pragma omp simd reduction(min : low) reduction(max : high) reduction(| : bad)
    for (size_t i = 0; i < in->count; i++) {
      const double at = x[i] * scale - origin;
      const int inside = at >= 0.0 && at < end;
      const int cell = (int)(inside ? at : 0.0);
      bad |= !inside;
      const double in_cell = at - cell;
      place[i] = in_cell > least ? in_cell : least;
      node[i] += stride * cell;
      low = cell < low ? cell : low;
      high = cell > high ? cell : high;
    }
    lower[k] = low;
    upper[k] = high;
    stride *= TILE;
  }
  if (bad)
    return false;
  for (unsigned k = 0; in->length[0] != NULL && k < DIMENSION; k++) {
    const double *restrict length = in->length[k];
    double *restrict reach = w->reach[k];
    const double half = 0.5 * scale;
#pragma omp simd
    for (size_t i = 0; i < in->count; i++)
      reach[i] = half * length[i] < 0.5 ? half * length[i] : 0.5;
  }
  for (unsigned k = 0; grow && k < DIMENSION; k++) {
    if (lower[k] < w->lower[k])
      w->lower[k] = lower[k];
    if (upper[k] + NODES > w->upper[k])
      w->upper[k] = upper[k] + NODES;
  }
  return true;
}

INLINE void NAMED(weights)(const struct work *w, size_t i, double scale,
                           double weight[DIMENSION][NODES][GAMUT_LANES],
                           double slope[DIMENSION][NODES][GAMUT_LANES])
{
  for (unsigned k = 0; k < DIMENSION; k++)
    JOIN(shape, SHAPE)(w->place[k] + i, w->reach[k] + i, scale, weight[k], slope[k]);
}

/* First moments of the weights about the point, and their second one: sum of w (x_node - x)^2. */
INLINE void NAMED(moments)(const struct work *w, size_t i, double cell,
                           double weight[DIMENSION][NODES][GAMUT_LANES],
                           double moment[DIMENSION][NODES][GAMUT_LANES],
                           double second[DIMENSION][GAMUT_LANES])
{
  for (unsigned k = 0; k < DIMENSION; k++) {
    const double *restrict place = w->place[k] + i;
#pragma omp simd
    for (int l = 0; l < GAMUT_LANES; l++) {
      const double from = 0.5 * (NODES - 2) + place[l];
      double sum = 0.0;
      for (int n = 0; n < NODES; n++) {
        const double away = cell * (n - from);
        moment[k][n][l] = weight[k][n][l] * away;
        sum += moment[k][n][l] * away;
      }
      second[k][l] = sum;
    }
  }
}

#define WEIGHT(array, k, node, missing)                                                            \
  (DIMENSION > (k) ? array[(k) < DIMENSION ? (k) : 0][node][l] : (missing))

/* Value and gradient of a whole line at one point. */
INLINE void NAMED(interpolate)(const double *tile, double weight[DIMENSION][NODES][GAMUT_LANES],
                               double slope[DIMENSION][NODES][GAMUT_LANES], int l, bool gradient,
                               struct line out[4])
{
  for (int k = 0; k < 4; k++)
    line_clear(&out[k]);
  for (int z = 0; z < NODES_Z; z++) {
    struct line value, by_x, by_y;
    line_clear(&value);
    line_clear(&by_x);
    line_clear(&by_y);
    for (int y = 0; y < NODES_Y; y++) {
      struct line row, row_by_x, node;
      line_clear(&row);
      line_clear(&row_by_x);
      for (int x = 0; x < NODES; x++) {
        line_read(&node, tile + NODE_SIZE * (x + TILE * (y + TILE * z)));
        line_add(&row, weight[0][x][l], &node);
        if (gradient)
          line_add(&row_by_x, slope[0][x][l], &node);
      }
      const double wy = WEIGHT(weight, 1, y, 1.0);
      line_add(&value, wy, &row);
      if (gradient) {
        line_add(&by_x, wy, &row_by_x);
        line_add(&by_y, WEIGHT(slope, 1, y, 0.0), &row);
      }
    }
    const double wz = WEIGHT(weight, 2, z, 1.0);
    line_add(&out[0], wz, &value);
    if (gradient) {
      line_add(&out[1], wz, &by_x);
      line_add(&out[2], wz, &by_y);
      line_add(&out[3], WEIGHT(slope, 2, z, 0.0), &value);
    }
  }
}

static void NAMED(gather)(struct work *w, size_t count, bool velocity)
{
  (void)velocity;
  for (size_t i = 0; i < count; i += GAMUT_LANES) {
    double weight[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double slope[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double out[GAMUT_LANES][NODE_SIZE] __attribute__((aligned(64)));
    NAMED(weights)(w, i, 1.0, weight, slope);
    for (int l = 0; l < GAMUT_LANES; l++) {
      struct line sum[4];
      NAMED(interpolate)
      (w->tile + NODE_SIZE * w->node[i + (size_t)l], weight, slope, l, false, sum);
      line_write(&sum[0], out[l]);
    }
    for (int c = 0; c < 6; c++)
      for (size_t l = 0; l < GAMUT_LANES; l++)
        w->value[c][i + l] = out[l][c];
  }
}

static void NAMED(gather_gradient)(struct work *w, size_t count, double inverse_cell,
                                   double *const gradient[9])
{
  for (size_t i = 0; i < count; i += GAMUT_LANES) {
    double weight[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double slope[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double out[DIMENSION + 1][GAMUT_LANES][NODE_SIZE] __attribute__((aligned(64)));
    NAMED(weights)(w, i, inverse_cell, weight, slope);
    for (int l = 0; l < GAMUT_LANES; l++) {
      struct line sum[4];
      NAMED(interpolate)(w->tile + NODE_SIZE * w->node[i + (size_t)l], weight, slope, l, true, sum);
      for (int k = 0; k <= DIMENSION; k++)
        line_write(&sum[k], out[k][l]);
    }
    for (int c = 0; c < 6; c++)
      for (size_t l = 0; l < GAMUT_LANES; l++)
        w->value[c][i + l] = out[0][l][c];
    for (int c = 0; c < DIMENSION; c++)
      for (int k = 0; k < DIMENSION; k++)
        for (size_t l = 0; l < GAMUT_LANES; l++)
          gradient[3 * c + k][i + l] = out[k + 1][l][c];
  }
}

/* First moments of the nodes' velocity about each point, over the second moment that the weights
 * have on the mean. Where a point scatters, the second moment there turns them into a slope: so it
 * gives back just the moment of momentum that it was given. Jiang et al. (2015), Eqs. 9 and 15. */
static void NAMED(gather_affine)(struct work *w, size_t count, double cell, double *const affine[9])
{
  const double over = 1.0 / MEAN_SECOND(cell);
  for (size_t i = 0; i < count; i += GAMUT_LANES) {
    double weight[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double slope[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double moment[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double second[DIMENSION][GAMUT_LANES];
    double out[DIMENSION][GAMUT_LANES][NODE_SIZE] __attribute__((aligned(64)));
    NAMED(weights)(w, i, 1.0, weight, slope);
    NAMED(moments)(w, i, cell, weight, moment, second);
    for (int l = 0; l < GAMUT_LANES; l++) {
      struct line sum[4];
      NAMED(interpolate)
      (w->tile + NODE_SIZE * w->node[i + (size_t)l], weight, moment, l, true, sum);
      for (int k = 0; k < DIMENSION; k++)
        line_write(&sum[k + 1], out[k][l]);
    }
    for (int c = 0; c < DIMENSION; c++)
      for (int k = 0; k < DIMENSION; k++)
        for (size_t l = 0; l < GAMUT_LANES; l++)
          affine[3 * c + k][i + l] = over * out[k][l][c];
  }
}

/* Lines of eight points: what goes with N, and with its slopes by x, y and z. Entries that stay
 * zero are not written. */
INLINE void NAMED(prepare)(const struct point_view *p, size_t i, bool force,
                           double out[DIMENSION + 1][GAMUT_LANES][NODE_SIZE])
{
  double momentum[DIMENSION][GAMUT_LANES], outer[DIMENSION][GAMUT_LANES];
  double inner[6][GAMUT_LANES];
  const double *restrict mass = p->mass + i;
  for (int c = 0; c < DIMENSION; c++) {
    const double *restrict v = p->velocity[c] + i;
#pragma omp simd
    for (int l = 0; l < GAMUT_LANES; l++)
      momentum[c][l] = mass[l] * v[l];
  }
  for (int l = 0; l < GAMUT_LANES; l++) {
    out[0][l][NODE_MASS] = mass[l];
    out[0][l][NODE_SQUARE] = p->squares ? mass[l] * mass[l] : 0.0;
    for (int c = 0; c < DIMENSION; c++)
      out[0][l][NODE_MOMENTUM + c] = momentum[c][l];
  }
  if (!force)
    return;
  static const int component[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const double *restrict ratio = p->volume_ratio + i;
  const double over = -1.0 / p->density;
  double minus_volume[GAMUT_LANES];
#pragma omp simd
  for (int l = 0; l < GAMUT_LANES; l++)
    minus_volume[l] = over * mass[l] * ratio[l];
  for (int k = 0; k < 6; k++) {
    const double *restrict stress = p->stress[k] + i;
#pragma omp simd
    for (int l = 0; l < GAMUT_LANES; l++)
      inner[k][l] = minus_volume[l] * stress[l];
  }
  for (int c = 0; c < DIMENSION; c++)
    for (int l = 0; l < GAMUT_LANES; l++)
      outer[c][l] = p->force[c] == NULL ? 0.0 : p->force[c][i + (size_t)l];
  if (DIMENSION == 2 && p->axisymmetric)
    for (int l = 0; l < GAMUT_LANES; l++)
      outer[0][l] += inner[2][l] / p->position[0][i + (size_t)l];
  for (int l = 0; l < GAMUT_LANES; l++)
    for (int c = 0; c < DIMENSION; c++) {
      out[0][l][NODE_FORCE + c] = outer[c][l];
      for (int k = 0; k < DIMENSION; k++)
        out[k + 1][l][NODE_FORCE + c] = inner[component[c][k]][l];
    }
}

/* The same of the affine part of their momentum, which goes with the first moments. */
INLINE void NAMED(prepare_affine)(const struct point_view *p, size_t i, double cell,
                                  double second[DIMENSION][GAMUT_LANES],
                                  double out[DIMENSION + 1][GAMUT_LANES][NODE_SIZE])
{
  const double mean = MEAN_SECOND(cell);
  for (int c = 0; c < DIMENSION; c++)
    for (int k = 0; k < DIMENSION; k++)
      for (int l = 0; l < GAMUT_LANES; l++)
        out[k + 1][l][NODE_MOMENTUM + c] =
            p->mass[i + (size_t)l] * p->affine[3 * c + k][i + (size_t)l] * (mean / second[k][l]);
}

INLINE void NAMED(spread)(double *tile, double weight[DIMENSION][NODES][GAMUT_LANES],
                          double slope[DIMENSION][NODES][GAMUT_LANES], int l, bool force,
                          double point[DIMENSION + 1][GAMUT_LANES][NODE_SIZE])
{
  struct line plain, by_x, by_y, by_z;
  line_read(&plain, point[0][l]);
  if (force) {
    line_read(&by_x, point[1][l]);
    line_read(&by_y, point[DIMENSION > 1 ? 2 : 1][l]);
    line_read(&by_z, point[DIMENSION > 2 ? 3 : 1][l]);
  }
  for (int z = 0; z < NODES_Z; z++) {
    const double wz = WEIGHT(weight, 2, z, 1.0);
    struct line plain_z, by_x_z, by_y_z;
    line_scale(&plain_z, wz, &plain);
    if (force) {
      line_scale(&by_x_z, wz, &by_x);
      line_scale(&by_y_z, wz, &by_y);
      if (DIMENSION > 2)
        line_add(&plain_z, WEIGHT(slope, 2, z, 0.0), &by_z);
    }
    for (int y = 0; y < NODES_Y; y++) {
      const double wy = WEIGHT(weight, 1, y, 1.0);
      struct line plain_y, by_x_y;
      line_scale(&plain_y, wy, &plain_z);
      if (force) {
        line_scale(&by_x_y, wy, &by_x_z);
        if (DIMENSION > 1)
          line_add(&plain_y, WEIGHT(slope, 1, y, 0.0), &by_y_z);
      }
      for (int x = 0; x < NODES; x++) {
        double *at = tile + NODE_SIZE * (x + TILE * (y + TILE * z));
        struct line node;
        line_read(&node, at);
        line_add(&node, weight[0][x][l], &plain_y);
        if (force)
          line_add(&node, slope[0][x][l], &by_x_y);
        line_write(&node, at);
      }
    }
  }
}

INLINE void NAMED(scatter_as)(struct work *w, const struct point_view *p, double cell, bool force,
                              bool affine)
{
  double point[DIMENSION + 1][GAMUT_LANES][NODE_SIZE] __attribute__((aligned(64))) = {{{0.0}}};
  double whirl[DIMENSION + 1][GAMUT_LANES][NODE_SIZE] __attribute__((aligned(64))) = {{{0.0}}};
  for (size_t i = 0; i < p->real; i += GAMUT_LANES) {
    double weight[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double slope[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double moment[DIMENSION][NODES][GAMUT_LANES] __attribute__((aligned(64)));
    double second[DIMENSION][GAMUT_LANES];
    const size_t here = p->real - i < GAMUT_LANES ? p->real - i : GAMUT_LANES;
    NAMED(weights)(w, i, 1.0 / cell, weight, slope);
    NAMED(prepare)(p, i, force, point);
    if (affine) {
      NAMED(moments)(w, i, cell, weight, moment, second);
      NAMED(prepare_affine)(p, i, cell, second, whirl);
      w->mean_second = MEAN_SECOND(cell);
      for (int k = 0; k < DIMENSION; k++)
        memcpy(w->second[k] + i, second[k], sizeof second[k]);
    }
    /* point by point, so that no sum depends on how a block is cut */
    for (int l = 0; l < (int)here; l++) {
      double *at = w->sums + NODE_SIZE * w->node[i + (size_t)l];
      NAMED(spread)(at, weight, slope, l, force, point);
      if (affine)
        NAMED(spread)(at, weight, moment, l, true, whirl);
    }
  }
}

static void NAMED(scatter)(struct work *w, const struct point_view *p, double cell)
{
  if (p->affine[0] != NULL)
    NAMED(scatter_as)(w, p, cell, true, true);
  else
    NAMED(scatter_as)(w, p, cell, true, false);
}

static void NAMED(scatter_momentum)(struct work *w, const struct point_view *p, double cell)
{
  if (p->affine[0] != NULL)
    NAMED(scatter_as)(w, p, cell, false, true);
  else
    NAMED(scatter_as)(w, p, cell, false, false);
}

#undef WEIGHT
#undef MEAN_SECOND
#undef TILE
#undef SIDE
#undef NODES_Z
#undef NODES_Y
#undef NODES
#undef NAMED
#undef JOIN
#undef JOIN_
#undef DIMENSION
