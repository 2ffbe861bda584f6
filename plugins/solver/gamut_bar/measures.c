/* What quantities may ask of the bar. */
#include "bar.h"

struct fit {
  double n, K;
};

/* Straight line through log(stress) over log(plastic strain) at the first levels. NaN where they
 * were not reached. */
static struct fit fit_levels(const struct bar *bar, bool truly, size_t count, double modulus)
{
  double x[LEVELS_MAX], y[LEVELS_MAX], mean_x = 0.0, mean_y = 0.0, above = 0.0, below = 0.0;
  if (count > bar->levels || count < 2)
    return (struct fit){NAN, NAN};
  for (size_t k = 0; k < count; k++) {
    double strain = bar->level[k].strain, stress = bar->level[k].stress;
    double s = truly ? stress * (1.0 + strain) : stress;
    x[k] = log((truly ? log1p(strain) : strain) - s / modulus);
    y[k] = log(s);
    mean_x += x[k] / (double)count;
    mean_y += y[k] / (double)count;
  }
  for (size_t k = 0; k < count; k++) {
    above += (x[k] - mean_x) * (y[k] - mean_y);
    below += (x[k] - mean_x) * (x[k] - mean_x);
  }
  double slope = above / below;
  return (struct fit){slope, exp(mean_y - slope * mean_x)};
}

/* Slope of nominal stress over strain before anything yields. */
static double initial_modulus(const struct bar *bar)
{
  double sum = 0.0;
  for (size_t i = 0; i < bar->bonds; i++)
    sum += bar->length[i] / (bar->section[i] * bar->stiffness[i]);
  return bar->span / (bar->area * sum);
}

_Static_assert(GAMUT_BAR_N_PRIME_MODULUS_CHOICES == GAMUT_BAR_K_PRIME_MODULUS_CHOICES &&
                   GAMUT_BAR_N_PRIME_MODULUS_CHOICES == GAMUT_BAR_N_PRIME_TRUE_MODULUS_CHOICES &&
                   GAMUT_BAR_N_PRIME_MODULUS_CHOICES == GAMUT_BAR_K_PRIME_TRUE_MODULUS_CHOICES,
               "the four fits have the same arguments");

static struct fit fit(const struct bar *bar, bool truly, const struct gamut_values *given)
{
  const size_t count = (size_t)gamut_integer(given, "levels");
  switch (gamut_bar_n_prime_modulus_of(given)) {
  case GAMUT_BAR_N_PRIME_MODULUS_NOMINAL:
    return fit_levels(bar, truly, count, bar->modulus);
  case GAMUT_BAR_N_PRIME_MODULUS_INITIAL:
    return fit_levels(bar, truly, count, initial_modulus(bar));
  }
  return (struct fit){NAN, NAN};
}

static double strain_measure(const struct bar *bar)
{
  return bar->mean_strain;
}
static double stress_measure(const struct bar *bar)
{
  return bar->nominal_stress;
}
static double force_measure(const struct bar *bar)
{
  return bar->force;
}
static double loop_energy(const struct bar *bar)
{
  return bar->loop.closed ? bar->loop.energy : NAN;
}
static double loop_closure(const struct bar *bar)
{
  return bar->loop.closed ? bar->loop.closure : NAN;
}
static double rupture_stress(const struct bar *bar)
{
  return bar->rupture.broken ? bar->rupture.stress : NAN;
}
static double rupture_strain(const struct bar *bar)
{
  return bar->rupture.broken ? bar->rupture.strain : NAN;
}
static double rupture_bond(const struct bar *bar)
{
  return bar->rupture.broken ? (double)bar->rupture.bond : NAN;
}
static double saturated_families(const struct bar *bar)
{
  return (double)bar->saturated;
}
static double strain_deviation(const struct bar *bar)
{
  double most = 0.0;
  for (size_t i = 0; i < bar->bonds; i++)
    most = fmax(most, fabs(bar->strain[i] - bar->mean_strain));
  return most;
}
static double newton_rounds(const struct bar *bar)
{
  return (double)bar->newton;
}
static double gradient_rounds(const struct bar *bar)
{
  return (double)bar->iterations;
}
static double redraws(const struct bar *bar)
{
  return (double)bar->redraws;
}
static double total(const struct bar *bar, double (*density)(const struct bar *, size_t))
{
  double sum = 0.0;
  for (size_t i = 0; i < bar->bonds; i++)
    sum += bar->volume[i] * density(bar, i);
  return sum;
}
static double total_local(const struct bar *bar)
{
  return total(bar, local_gamut);
}
static double total_nonlocal(const struct bar *bar)
{
  return total(bar, nonlocal_gamut);
}

/* Measures without arguments. */
static double (*const scalar[])(const struct bar *) = {
    [GAMUT_BAR_MEASURE_STRAIN] = strain_measure,
    [GAMUT_BAR_MEASURE_STRESS_STRAIN] = stress_measure,
    [GAMUT_BAR_MEASURE_STRESS] = stress_measure,
    [GAMUT_BAR_MEASURE_FORCE] = force_measure,
    [GAMUT_BAR_MEASURE_INITIAL_MODULUS] = initial_modulus,
    [GAMUT_BAR_MEASURE_LOOP_ENERGY] = loop_energy,
    [GAMUT_BAR_MEASURE_LOOP_CLOSURE] = loop_closure,
    [GAMUT_BAR_MEASURE_RUPTURE_STRESS] = rupture_stress,
    [GAMUT_BAR_MEASURE_RUPTURE_STRAIN] = rupture_strain,
    [GAMUT_BAR_MEASURE_RUPTURE_BOND] = rupture_bond,
    [GAMUT_BAR_MEASURE_SATURATED_FAMILIES] = saturated_families,
    [GAMUT_BAR_MEASURE_STRAIN_DEVIATION] = strain_deviation,
    [GAMUT_BAR_MEASURE_NEWTON_ROUNDS] = newton_rounds,
    [GAMUT_BAR_MEASURE_GRADIENT_ROUNDS] = gradient_rounds,
    [GAMUT_BAR_MEASURE_GRID_REDRAWS] = redraws,
    [GAMUT_BAR_MEASURE_TOTAL_LOCAL_GAMUT] = total_local,
    [GAMUT_BAR_MEASURE_TOTAL_NONLOCAL_GAMUT] = total_nonlocal,
};

static double level_value(const struct bar *bar, bool strain, long level)
{
  if (level < 0 || (size_t)level >= bar->levels)
    return NAN;
  return strain ? bar->level[level].strain : bar->level[level].stress;
}

/* Measures with arguments; false for others. */
static bool argued(const struct bar *bar, enum gamut_bar_measure which,
                   const struct gamut_values *given, double *value)
{
  if (which == GAMUT_BAR_MEASURE_LEVEL_STRAIN)
    *value = level_value(bar, true, gamut_integer(given, "level"));
  else if (which == GAMUT_BAR_MEASURE_LEVEL_STRESS)
    *value = level_value(bar, false, gamut_integer(given, "level"));
  else if (which == GAMUT_BAR_MEASURE_N_PRIME)
    *value = fit(bar, false, given).n;
  else if (which == GAMUT_BAR_MEASURE_N_PRIME_TRUE)
    *value = fit(bar, true, given).n;
  else if (which == GAMUT_BAR_MEASURE_K_PRIME)
    *value = fit(bar, false, given).K;
  else if (which == GAMUT_BAR_MEASURE_K_PRIME_TRUE)
    *value = fit(bar, true, given).K;
  else
    return false;
  return true;
}

gamut_status measure_bar(void *self, const char *name, const struct gamut_body *body,
                         const struct gamut_values *arguments, double *value)
{
  const struct bar *bar = self;
  const enum gamut_bar_measure which = gamut_bar_measure_of(name);
  (void)body;
  if ((size_t)which < sizeof scalar / sizeof scalar[0] && scalar[which])
    *value = scalar[which](bar);
  else if (!argued(bar, which, arguments, value))
    return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
  return GAMUT_OK;
}
