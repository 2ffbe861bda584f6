/* The bar's own matrices: weights, the tangent stiffness of every load step, forces as the gradient
 * of the energy. Looks into the plugin's struct; calls nothing of it but the product with the
 * kernel. */
#include <gsl/gsl_eigen.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bar.h"
#include "registry/registry.h"
#include "run/run_private.h"
#include "scene/scene.h"
#include "tests/tap.h"

enum { BONDS = 60, NODES = BONDS + 1, REALISATIONS = 3 };

static const char uneven[] =
    "gamut: 1\n"
    "solver: {model: gamut_bar, bonds: 60, grid: random, rupture: report, noise: {\n"
    "         modulus: {model: white, distribution: weibull},\n"
    "         softness: {model: white, distribution: weibull},\n"
    "         weights: {model: white, distribution: weibull}}}\n"
    "materials: {al: {density: 2810 kg/m3, strength: {model: ramberg_osgood,\n"
    "  youngs_modulus: 71.6 GPa, yield_stress: 538.6 MPa, n: 17.8702,\n"
    "  failure_stress: 665.8 MPa, failure_strain: 0.115}}}\n"
    "bodies: {bar: {material: al, length: 100 mm, area: 100 mm2}}\n"
    "quantities: {stress_strain: {measure: stress_strain}}\n"
    "uncertainty: {seed: 7, estimator: {model: monte_carlo, runs: 3}}\n";

/* Reach and spacing meet: three deviations are four spacings, but for rounding. */
static const char even[] =
    "gamut: 1\n"
    "solver: {model: gamut_bar, bonds: 60, weight_deviation: 2.2222222222222222 mm}\n"
    "materials: {al: {density: 2810 kg/m3, strength: {model: ramberg_osgood,\n"
    "  youngs_modulus: 71.6 GPa, yield_stress: 538.6 MPa, n: 17.8702,\n"
    "  failure_stress: 665.8 MPa, failure_strain: 0.115}}}\n"
    "bodies: {bar: {material: al, length: 100 mm, area: 100 mm2}}\n"
    "quantities: {stress_strain: {measure: stress_strain}}\n";

struct stage {
  struct trace *trace;
  struct units *units;
  struct registry *registry;
  struct scene *scene;
  struct gamut_run *run;
  const struct bar *bar;
};

static double kernel[BONDS][BONDS], weight[BONDS][BONDS], stiffness[NODES][NODES];

/* G and w, column by column. */
static void find_weights(const struct bar *bar)
{
  double x[BONDS + 8], y[BONDS + 8];
  for (size_t q = 0; q < BONDS; q++) {
    for (size_t i = 0; i < BONDS; i++)
      x[i] = i == q;
    bar->kernel.apply(bar->kernel.self, x, y);
    for (size_t p = 0; p < BONDS; p++) {
      kernel[p][q] = y[p];
      weight[p][q] = bar->scale[p] * y[p] * bar->scale[q] * bar->volume[q];
    }
  }
}

static void check_weights(const struct bar *bar, const char *name)
{
  double sums = 0.0, balance = 0.0, own = 0.0;
  size_t one_sided = 0;
  for (size_t p = 0; p < BONDS; p++) {
    double sum = 0.0;
    for (size_t q = 0; q < BONDS; q++) {
      sum += weight[p][q];
      balance = fmax(balance, fabs(bar->volume[p] * weight[p][q] - bar->volume[q] * weight[q][p]) /
                                  bar->volume[p]);
      one_sided += kernel[p][q] != kernel[q][p];
    }
    sums = fmax(sums, fabs(sum - 1.0));
    own = fmax(own, fabs(weight[p][p]));
  }
  tap_ok(sums <= 1e-12, "%s: sums of the weights less 1: %.2g (allowed 1e-12)", name, sums);
  tap_ok(balance <= 1e-15, "%s: V_p w_pq - V_q w_qp over V_p: %.2g (allowed 1e-15)", name, balance);
  tap_ok(one_sided == 0 && own == 0.0,
         "%s: pairs that differ from their mirror image: %zu (allowed 0)", name, one_sided);
}

/* V (E - E w C w E) between bonds, then to nodes by differences over lengths. */
static void find_stiffness(const struct bar *bar)
{
  static double between[BONDS][BONDS];
  const double *C = bar->families.trial_slope, *E = bar->stiffness;
  memset(stiffness, 0, sizeof stiffness);
  for (size_t i = 0; i < BONDS; i++)
    for (size_t j = 0; j < BONDS; j++) {
      double sum = 0.0;
      for (size_t p = 0; p < BONDS; p++)
        sum += weight[i][p] * C[p] * weight[p][j];
      between[i][j] = bar->volume[i] * ((i == j ? E[i] : 0.0) - E[i] * sum * E[j]) /
                      (bar->length[i] * bar->length[j]);
    }
  for (size_t i = 0; i < BONDS; i++)
    for (size_t j = 0; j < BONDS; j++)
      for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 2; b++)
          stiffness[i + a][j + b] += (a == b ? 1.0 : -1.0) * between[i][j];
}

struct worst {
  double asymmetry, row_sum, rigid, least;
};

static void look_at_stiffness(struct worst *worst)
{
  double most = 0.0, lowest = INFINITY, second = INFINITY;
  gsl_matrix *matrix = gsl_matrix_alloc(NODES, NODES);
  gsl_vector *value = gsl_vector_alloc(NODES);
  gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(NODES);
  for (size_t i = 0; i < NODES; i++)
    for (size_t j = 0; j < NODES; j++) {
      most = fmax(most, fabs(stiffness[i][j]));
      gsl_matrix_set(matrix, i, j, 0.5 * (stiffness[i][j] + stiffness[j][i]));
    }
  for (size_t i = 0; i < NODES; i++) {
    double sum = 0.0;
    for (size_t j = 0; j < NODES; j++) {
      sum += stiffness[i][j];
      worst->asymmetry = fmax(worst->asymmetry, fabs(stiffness[i][j] - stiffness[j][i]) / most);
    }
    worst->row_sum = fmax(worst->row_sum, fabs(sum) / most);
  }
  gsl_eigen_symm(matrix, value, space);
  for (size_t i = 0; i < NODES; i++) {
    double v = gsl_vector_get(value, i);
    second = v < lowest ? lowest : fmin(second, v);
    lowest = fmin(lowest, v);
  }
  worst->rigid = fmax(worst->rigid, fabs(lowest) / most);
  worst->least = fmin(worst->least, second / most);
  gsl_eigen_symm_free(space);
  gsl_vector_free(value);
  gsl_matrix_free(matrix);
}

/* s + E~ K (s / sy)^n = T by bisection; plastic strain in *plastic. */
static double curve_stress(const struct bar *bar, size_t p, double T, double *plastic)
{
  double low = 0.0, high = T, yield = bar->yield * bar->yield_factor[p];
  for (int round = 0; round < 200; round++) {
    double s = 0.5 * (low + high);
    *plastic = bar->K * pow(s / yield, bar->n);
    if (s + bar->softening[p] * *plastic < T)
      low = s;
    else
      high = s;
  }
  return low;
}

static double energy(const struct bar *bar, const double *strain)
{
  double sum = 0.0;
  for (size_t p = 0; p < BONDS; p++) {
    double T = 0.0, plastic;
    for (size_t q = 0; q < BONDS; q++)
      T += weight[p][q] * bar->stiffness[q] * strain[q];
    double s = curve_stress(bar, p, T, &plastic);
    double shared = s * plastic / (bar->n + 1.0) + 0.5 * bar->softening[p] * plastic * plastic;
    sum += bar->volume[p] * (0.5 * bar->stiffness[p] * strain[p] * strain[p] - shared);
  }
  return sum;
}

static void check_gradient(const struct bar *bar)
{
  double strain[BONDS], worst = 0.0;
  memcpy(strain, bar->strain, sizeof strain);
  for (size_t i = 0; i < BONDS; i += 7) {
    double step = 1e-5 * strain[i], at = strain[i];
    strain[i] = at + step;
    double above = energy(bar, strain);
    strain[i] = at - step;
    double below = energy(bar, strain);
    strain[i] = at;
    double stress = (above - below) / (2.0 * step * bar->volume[i]);
    worst = fmax(worst, fabs(stress / bar->stress[i] - 1.0));
  }
  tap_ok(worst <= 1e-5,
         "stress of the bonds as the gradient of the energy, relative: %.2g (allowed "
         "1e-05)",
         worst);
}

static bool stage_open(struct stage *stage, const char *text, uint64_t realisation)
{
  char why[200], file[] = "bar-XXXXXX";
  const struct registry_options options = {.plugin_path = getenv("builddir")};
  const struct run_options how = {.threads = 1, .realisation = realisation};
  int opened = mkstemp(file);
  *stage = (struct stage){.trace = trace_new(), .units = units_new(why, sizeof why)};
  bool good = opened >= 0 && write(opened, text, strlen(text)) == (ssize_t)strlen(text);
  if (opened >= 0)
    close(opened);
  good = good && registry_new(&options, stage->units, stage->trace, &stage->registry) == GAMUT_OK &&
         scene_read(file, NULL, 0, stage->registry, stage->units, stage->trace, &stage->scene) ==
             GAMUT_OK &&
         run_new(stage->scene, stage->registry, &how, stage->trace, &stage->run) == GAMUT_OK &&
         advance_start(stage->run) == GAMUT_OK;
  unlink(file);
  if (!good) {
    tap_ok(false, "the scene starts");
    trace_print(stage->trace, stderr);
    return false;
  }
  stage->bar = stage->run->solver_self;
  return true;
}

static void stage_close(struct stage *stage)
{
  run_free(stage->run);
  scene_free(stage->scene);
  registry_free(stage->registry);
  units_free(stage->units);
  trace_free(stage->trace);
}

static void check_realisation(uint64_t realisation)
{
  struct stage stage;
  struct worst worst = {.least = INFINITY};
  char name[40];
  size_t steps = 0;
  bool more = true;
  snprintf(name, sizeof name, "realisation %d", (int)realisation);
  if (stage_open(&stage, uneven, realisation)) {
    find_weights(stage.bar);
    check_weights(stage.bar, name);
    while (more && advance_step(stage.run, &more) == GAMUT_OK && more) {
      steps++;
      find_stiffness(stage.bar);
      look_at_stiffness(&worst);
      if (realisation == 0 && (steps == 20 || steps == 80))
        check_gradient(stage.bar);
    }
    tap_ok(steps > 90, "%s: %zu load steps", name, steps);
    tap_ok(worst.asymmetry <= 1e-13, "%s: K_NL less its mirror image: %.2g (allowed 1e-13)", name,
           worst.asymmetry);
    tap_ok(worst.row_sum <= 1e-13, "%s: row sums of K_NL: %.2g (allowed 1e-13)", name,
           worst.row_sum);
    tap_ok(worst.rigid <= 1e-13, "%s: eigenvalue of the rigid mode: %.2g (allowed 1e-13)", name,
           worst.rigid);
    tap_ok(worst.least >= 1e-9,
           "%s: least other eigenvalue over the largest entry: %.2g (at least "
           "1e-09)",
           name, worst.least);
  }
  stage_close(&stage);
}

static void check_reach(void)
{
  struct stage stage;
  size_t within = 0;
  if (stage_open(&stage, even, 0)) {
    find_weights(stage.bar);
    check_weights(stage.bar, "reach of four spacings");
    for (size_t q = 0; q < BONDS; q++)
      within += kernel[30][q] > 0.0;
    tap_ok(within == 6 || within == 8, "reach of four spacings: %zu bonds within it (6 or 8)",
           within);
  }
  stage_close(&stage);
}

int main(void)
{
  if (!getenv("builddir")) {
    tap_skip("the bar's matrices", "the environment names no builddir");
    return tap_done();
  }
  for (uint64_t k = 0; k < REALISATIONS; k++)
    check_realisation(k);
  check_reach();
  return tap_done();
}
