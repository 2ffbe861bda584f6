/* The pair kernel through coarse nodes: G = P B P' - diagonal, P cubic interpolation, B the kernel
 * between nodes. The diagonal takes away what a bond would be to itself. There is no end of reach
 * (0.3 % of the weights lie beyond three standard deviations). */
#include "bar.h"

enum { LEAST_BONDS_A_CELL = 2, THREADED = 20000 };

/* Node k lies at (k - 1) spacing; bonds of cell c lie between nodes c + 1 and c + 2. */
struct interpolated {
  size_t bonds, cells, nodes;
  int threads;
  double spacing;
  size_t *begin; /* cells + 1: first bond of each cell */
  double *part;  /* place of each bond in its cell, 0 to 1 */
  double *diagonal;
  double *node_kernel, *node_spread;
  double *cell_sum;              /* 4 a cell */
  double *gathered, *spread_out; /* one a node */
};

/* Lagrange's cubics through -1, 0, 1, 2. */
static inline void cubics(double t, double w[4])
{
  double a = t + 1.0, b = t - 1.0, c = t - 2.0;
  w[0] = -t * b * c / 6.0;
  w[1] = a * b * c / 2.0;
  w[2] = -a * t * c / 2.0;
  w[3] = a * t * b / 6.0;
}

static void gather_cell(const struct interpolated *g, size_t cell, const double *x)
{
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0;
#pragma omp simd reduction(+ : s0, s1, s2, s3)
  for (size_t i = g->begin[cell]; i < g->begin[cell + 1]; i++) {
    double w[4];
    cubics(g->part[i], w);
    s0 += w[0] * x[i];
    s1 += w[1] * x[i];
    s2 += w[2] * x[i];
    s3 += w[3] * x[i];
  }
  double *sum = g->cell_sum + 4 * cell;
  sum[0] = s0;
  sum[1] = s1;
  sum[2] = s2;
  sum[3] = s3;
}

static void between_nodes(const struct interpolated *g)
{
  for (size_t k = 0; k < g->nodes; k++)
    g->gathered[k] = 0.0;
  for (size_t c = 0; c < g->cells; c++)
    for (size_t k = 0; k < 4; k++)
      g->gathered[c + k] += g->cell_sum[4 * c + k];
  for (size_t k = 0; k < g->nodes; k++) {
    const double *row = g->node_kernel + k * g->nodes;
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t j = 0; j < g->nodes; j++)
      sum += row[j] * g->gathered[j];
    g->spread_out[k] = sum;
  }
}

static void scatter_cell(const struct interpolated *g, size_t cell, const double *x, double *y)
{
  const double *b = g->spread_out + cell;
  double b0 = b[0], b1 = b[1], b2 = b[2], b3 = b[3];
#pragma omp simd
  for (size_t i = g->begin[cell]; i < g->begin[cell + 1]; i++) {
    double w[4];
    cubics(g->part[i], w);
    y[i] = w[0] * b0 + w[1] * b1 + w[2] * b2 + w[3] * b3 - g->diagonal[i] * x[i];
  }
}

static void interpolated_apply(const void *self, const double *x, double *y)
{
  const struct interpolated *g = self;
#pragma omp parallel for schedule(static) num_threads(g->threads) if (g->threads > 1)
  for (size_t c = 0; c < g->cells; c++)
    gather_cell(g, c, x);
  between_nodes(g);
#pragma omp parallel for schedule(static) num_threads(g->threads) if (g->threads > 1)
  for (size_t c = 0; c < g->cells; c++)
    scatter_cell(g, c, x, y);
}

/* Spreads at the nodes: means of the bonds around, which takes out the noise of single bonds. Nodes
 * at and beyond the ends go on straight. */
static void node_spreads(const struct bar *bar, const struct interpolated *g)
{
  double *sum = g->gathered, *weight = g->spread_out, *s = g->node_spread;
  size_t last = g->nodes - 1;
  for (size_t c = 0; c < g->cells; c++)
    for (size_t i = g->begin[c]; i < g->begin[c + 1]; i++) {
      double t = g->part[i];
      sum[c + 1] += (1.0 - t) * bar->spread[i];
      weight[c + 1] += 1.0 - t;
      sum[c + 2] += t * bar->spread[i];
      weight[c + 2] += t;
    }
  for (size_t k = 2; k + 2 <= last; k++)
    s[k] = sum[k] / weight[k];
  s[1] = 2.0 * s[2] - s[3];
  s[0] = 2.0 * s[1] - s[2];
  s[last - 1] = 2.0 * s[last - 2] - s[last - 3];
  s[last] = 2.0 * s[last - 1] - s[last - 2];
}

static void node_kernel(const struct interpolated *g)
{
  static const double two_pi = 6.28318530717958647693;
  for (size_t j = 0; j < g->nodes; j++)
    for (size_t k = 0; k < g->nodes; k++) {
      double d = g->spacing * ((double)j - (double)k);
      double v =
          0.5 * (g->node_spread[j] * g->node_spread[j] + g->node_spread[k] * g->node_spread[k]);
      g->node_kernel[j * g->nodes + k] = exp(-d * d / (2.0 * v)) / sqrt(two_pi * v);
    }
}

static void own_share(const struct interpolated *g)
{
  for (size_t c = 0; c < g->cells; c++)
    for (size_t i = g->begin[c]; i < g->begin[c + 1]; i++) {
      double w[4], sum = 0.0;
      cubics(g->part[i], w);
      for (size_t j = 0; j < 4; j++)
        for (size_t k = 0; k < 4; k++)
          sum += w[j] * w[k] * g->node_kernel[(c + j) * g->nodes + c + k];
      g->diagonal[i] = sum;
    }
}

static void sort_bonds(const struct bar *bar, struct interpolated *g)
{
  size_t cell = 0;
  for (size_t i = 0; i < g->bonds; i++) {
    double at = bar->place[i] / g->spacing;
    size_t in = (size_t)at < g->cells - 1 ? (size_t)at : g->cells - 1;
    while (cell < in)
      g->begin[++cell] = i;
    g->part[i] = at - (double)in;
  }
  while (cell < g->cells)
    g->begin[++cell] = g->bonds;
}

static bool lay_out(struct bar *bar, struct interpolated *g)
{
  static const char label[] = "interpolated operator";
  struct gamut_run *run = bar->run;
  size_t n = g->bonds, m = g->nodes;
  g->begin = gamut_allocate(run, label, (g->cells + 1) * sizeof *g->begin);
  g->part = gamut_allocate(run, label, n * sizeof(double));
  g->diagonal = gamut_allocate(run, label, n * sizeof(double));
  g->node_kernel = gamut_allocate(run, label, m * m * sizeof(double));
  g->cell_sum = gamut_allocate(run, label, 4 * g->cells * sizeof(double));
  g->node_spread = gamut_allocate(run, label, m * sizeof(double));
  g->gathered = gamut_allocate(run, label, m * sizeof(double));
  g->spread_out = gamut_allocate(run, label, m * sizeof(double));
  return g->begin && g->part && g->diagonal && g->node_kernel && g->cell_sum && g->node_spread &&
         g->gathered && g->spread_out;
}

gamut_status interpolated_new(struct bar *bar, struct pair_kernel *kernel)
{
  enum { FEWEST_CELLS = 8 };
  struct interpolated *g = gamut_allocate(bar->run, "interpolated operator", sizeof *g);
  double least = HUGE_VAL;
  if (!g)
    return GAMUT_INTERNAL;
  for (size_t i = 0; i < bar->bonds; i++)
    least = fmin(least, bar->spread[i]);
  double wanted = bar->span / least * (double)gamut_integer(bar->values, "nodes_a_spread");
  double most = (double)bar->bonds / LEAST_BONDS_A_CELL;
  /* Threads cost more to wake than a small product. */
  *g = (struct interpolated){.bonds = bar->bonds,
                             .threads = bar->bonds >= THREADED ? bar->threads : 1};
  g->cells = (size_t)ceil(fmin(wanted, most));
  if (g->cells < FEWEST_CELLS)
    return gamut_fail_at(bar->run, bar->values, "operator", "dense",
                         "the interpolated operator needs more than %zu bonds", bar->bonds);
  g->nodes = g->cells + 3;
  g->spacing = bar->span / (double)g->cells;
  if (!lay_out(bar, g))
    return GAMUT_INTERNAL;
  sort_bonds(bar, g);
  node_spreads(bar, g);
  node_kernel(g);
  own_share(g);
  *kernel = (struct pair_kernel){interpolated_apply, g};
  return GAMUT_OK;
}
