/* The pair kernel as rows: each holds the bonds from the first to the last within reach. */
#include "bar.h"

/* Weights end at this many standard deviations. */
static const double reach = 3.0;

struct dense {
  size_t bonds;
  int threads;
  size_t *begin;   /* bonds + 1: where rows begin in `entry` */
  uint32_t *first; /* bond of a row's first entry */
  double *entry;
};

/* Threads cost more to wake than a small product. */
static bool worthwhile(const struct dense *g)
{
  enum { ENTRIES = 2000000 };
  return g->threads > 1 && g->begin[g->bonds] > ENTRIES;
}

static void dense_apply(const void *self, const double *x, double *y)
{
  const struct dense *g = self;
#pragma omp parallel for schedule(static) num_threads(g->threads) if (worthwhile(g))
  for (size_t p = 0; p < g->bonds; p++) {
    const double *row = g->entry + g->begin[p], *from = x + g->first[p];
    size_t count = g->begin[p + 1] - g->begin[p];
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < count; k++)
      sum += row[k] * from[k];
    y[p] = sum;
  }
}

/* The same bits for (p, q) and (q, p): the compiler may join a product and a sum, so that the order
 * counts. */
static bool within(const struct bar *bar, size_t p, size_t q, double *distance, double *variance)
{
  size_t low = p < q ? p : q, high = p < q ? q : p;
  double one = bar->spread[low], other = bar->spread[high];
  *distance = bar->place[high] - bar->place[low];
  *variance = 0.5 * (one * one + other * other);
  return *distance * *distance <= reach * reach * *variance;
}

static void row_range(const struct bar *bar, size_t p, double widest, size_t *from, size_t *to)
{
  double d, v, most = reach * sqrt(0.5 * (bar->spread[p] * bar->spread[p] + widest * widest));
  *from = *to = p;
  for (size_t q = p; q-- > 0 && bar->place[p] - bar->place[q] <= most * 1.000001;)
    if (within(bar, p, q, &d, &v))
      *from = q;
  for (size_t q = p + 1; q < bar->bonds && bar->place[q] - bar->place[p] <= most * 1.000001; q++)
    if (within(bar, p, q, &d, &v))
      *to = q;
}

static size_t pair_number(size_t bonds, size_t p, size_t q)
{
  size_t low = p < q ? p : q, high = p < q ? q : p;
  return low * (2 * bonds - low - 1) / 2 + high - low - 1;
}

static void fill_row(const struct bar *bar, const struct dense *g, size_t p, const double *noise)
{
  static const double two_pi = 6.28318530717958647693;
  double *row = g->entry + g->begin[p];
  for (size_t k = 0; k < g->begin[p + 1] - g->begin[p]; k++) {
    size_t q = g->first[p] + k;
    double d, v;
    row[k] = 0.0;
    if (q == p || !within(bar, p, q, &d, &v))
      continue;
    row[k] = exp(-d * d / (2.0 * v)) / sqrt(two_pi * v);
    if (noise)
      row[k] *= 1.0 + noise[pair_number(bar->bonds, p, q)];
  }
}

gamut_status dense_new(struct bar *bar, const double *noise, struct pair_kernel *kernel)
{
  static const char label[] = "dense operator";
  struct gamut_run *run = bar->run;
  size_t n = bar->bonds;
  struct dense *g = gamut_allocate(run, label, sizeof *g);
  double widest = largest(n, bar->spread);
  if (!g)
    return GAMUT_INTERNAL;
  *g = (struct dense){.bonds = n, .threads = bar->threads};
  g->begin = gamut_allocate(run, label, (n + 1) * sizeof *g->begin);
  g->first = gamut_allocate(run, label, n * sizeof *g->first);
  if (!g->begin || !g->first)
    return GAMUT_INTERNAL;
  for (size_t p = 0; p < n; p++) {
    size_t from, to;
    row_range(bar, p, widest, &from, &to);
    g->first[p] = (uint32_t)from;
    g->begin[p + 1] = g->begin[p] + to - from + 1;
  }
  g->entry = gamut_allocate(run, label, g->begin[n] * sizeof *g->entry);
  if (!g->entry)
    return GAMUT_INTERNAL;
#pragma omp parallel for schedule(dynamic, 16) num_threads(g->threads) if (worthwhile(g))
  for (size_t p = 0; p < n; p++)
    fill_row(bar, g, p, noise);
  *kernel = (struct pair_kernel){dense_apply, g};
  return GAMUT_OK;
}
