/* Lengths of the bonds, their midpoints, areas and volumes. */
#include "bar.h"

/* A grid with a bond shorter than this share of the mean is thrown away. */
static const double shortest_share = 0.05;

static void draw(struct bar *bar, double range, uint64_t attempt)
{
  const struct gamut_stream stream = GAMUT_HOST(bar->run)->stream(bar->run, "solver.grid");
  double mean = bar->span / (double)bar->bonds;
  for (size_t i = 0; i < bar->bonds; i++) {
    double u = stream.uniform(&stream, attempt * bar->bonds + i);
    bar->length[i] = mean * (1.0 + range * (2.0 * u - 1.0));
  }
}

static double shortest(const struct bar *bar)
{
  double least = HUGE_VAL;
  for (size_t i = 0; i < bar->bonds; i++)
    least = fmin(least, bar->length[i]);
  return least;
}

/* Lengths are shares: together they are the bar. */
static gamut_status fit(struct bar *bar)
{
  double sum = 0.0;
  for (size_t i = 0; i < bar->bonds; i++)
    sum += bar->length[i];
  for (size_t i = 0; i < bar->bonds; i++)
    bar->length[i] *= bar->span / sum;
  return shortest(bar) > 0.0 && sum < HUGE_VAL ? GAMUT_OK : GAMUT_SCENE;
}

static gamut_status random_grid(struct bar *bar)
{
  enum { ATTEMPTS = 1000 };
  double range = gamut_real(bar->values, "grid_range");
  double least = shortest_share * bar->span / (double)bar->bonds;
  if (!GAMUT_HOST(bar->run)->stream)
    return gamut_fail_at(bar->run, bar->values, "grid", "uniform", "no random numbers are at hand");
  for (uint64_t attempt = 0; attempt < ATTEMPTS; attempt++) {
    draw(bar, range, attempt);
    if (fit(bar) == GAMUT_OK && shortest(bar) > least) {
      bar->redraws = attempt;
      return GAMUT_OK;
    }
  }
  return gamut_fail_at(bar->run, bar->values, "grid_range", "a smaller range",
                       "no grid of %zu bonds without a bond shorter than %g of the mean in %d "
                       "attempts",
                       bar->bonds, shortest_share, ATTEMPTS);
}

/* A table has one row a bond: its length as a share, its area over that of the bar, and factors. */
static gamut_status from_table(struct bar *bar, const double *row, size_t rows, size_t columns)
{
  if (rows != bar->bonds)
    return gamut_fail_at(bar->run, bar->values, "bond_table", "one row a bond",
                         "the table has %zu rows for %zu bonds", rows, bar->bonds);
  for (size_t i = 0; i < bar->bonds; i++) {
    const double *r = row + columns * i;
    if (!(r[0] > 0.0 && r[1] > 0.0 && r[2] > 0.0 && r[4] > 0.0))
      return gamut_fail_at(bar->run, bar->values, "bond_table", "greater than 0",
                           "length, area, modulus or density of row %zu is not positive", i + 1);
    bar->length[i] = r[0];
    bar->section[i] = bar->area * r[1];
    bar->stiffness[i] = r[2];
    bar->softness[i] = r[3];
    bar->mass_density[i] = r[4];
  }
  return fit(bar);
}

static gamut_status lay_out(struct bar *bar)
{
  const double *row;
  size_t rows, n = bar->bonds;
  row = gamut_table(bar->values, "bond_table", &rows);
  for (size_t i = 0; i < n; i++) {
    bar->length[i] = bar->span / (double)n;
    bar->section[i] = bar->area;
    bar->stiffness[i] = 1.0;
    bar->softness[i] = 0.0;
    bar->mass_density[i] = 1.0;
  }
  if (rows)
    return from_table(bar, row, rows, 5);
  switch (gamut_bar_grid_of(bar->values)) {
  case GAMUT_BAR_GRID_UNIFORM:
    return GAMUT_OK;
  case GAMUT_BAR_GRID_RANDOM:
    return random_grid(bar);
  }
  return gamut_fail(bar->run, GAMUT_PLUGIN, "gamut_bar does not know this grid");
}

gamut_status grid_new(struct bar *bar)
{
  gamut_status status = lay_out(bar);
  double x = 0.0, volume = 0.0;
  for (size_t i = 0; status == GAMUT_OK && i < bar->bonds; i++) {
    bar->place[i] = x + 0.5 * bar->length[i];
    x += bar->length[i];
    if (i && !(bar->place[i] > bar->place[i - 1]))
      return gamut_fail_at(bar->run, bar->values, "bond_table", "longer bonds",
                           "bonds %zu and %zu lie at the same place", i - 1, i);
    bar->volume[i] = bar->section[i] * bar->length[i];
    volume += bar->volume[i];
  }
  bar->area = volume / bar->span;
  return status;
}
