/* What quantities may ask of the bar. */
#include <string.h>

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

static double hardening(const struct bar *bar, const char *name, const struct gamut_values *given)
{
  bool initial = strcmp(gamut_text(given, "modulus"), "initial") == 0;
  bool truly = strstr(name, "_true") != NULL;
  struct fit fit = fit_levels(bar, truly, (size_t)gamut_integer(given, "levels"),
                              initial ? initial_modulus(bar) : bar->modulus);
  return name[0] == 'n' ? fit.n : fit.K;
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

static const struct scalar {
  const char *name;
  double (*value)(const struct bar *);
} scalar[] = {{"strain", strain_measure},
              {"stress_strain", stress_measure},
              {"stress", stress_measure},
              {"force", force_measure},
              {"initial_modulus", initial_modulus},
              {"loop_energy", loop_energy},
              {"loop_closure", loop_closure},
              {"rupture_stress", rupture_stress},
              {"rupture_strain", rupture_strain},
              {"rupture_bond", rupture_bond},
              {"saturated_families", saturated_families},
              {"strain_deviation", strain_deviation},
              {"newton_rounds", newton_rounds},
              {"gradient_rounds", gradient_rounds},
              {"grid_redraws", redraws},
              {"total_local_gamut", total_local},
              {"total_nonlocal_gamut", total_nonlocal}};

static double level_value(const struct bar *bar, bool strain, long level)
{
  if (level < 0 || (size_t)level >= bar->levels)
    return NAN;
  return strain ? bar->level[level].strain : bar->level[level].stress;
}

gamut_status measure_bar(void *self, const char *name, const struct gamut_body *body,
                         const struct gamut_values *arguments, double *value)
{
  const struct bar *bar = self;
  (void)body;
  for (size_t k = 0; k < sizeof scalar / sizeof scalar[0]; k++)
    if (strcmp(name, scalar[k].name) == 0) {
      *value = scalar[k].value(bar);
      return GAMUT_OK;
    }
  if (strcmp(name, "level_strain") == 0 || strcmp(name, "level_stress") == 0)
    *value = level_value(bar, strcmp(name, "level_strain") == 0, gamut_integer(arguments, "level"));
  else if (strcmp(name, "n_prime") == 0 || strcmp(name, "n_prime_true") == 0 ||
           strcmp(name, "K_prime") == 0 || strcmp(name, "K_prime_true") == 0)
    *value = hardening(bar, name, arguments);
  else
    return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
  return GAMUT_OK;
}
