/* elasticity: indifference to rotation, dissipation, convergence in the step, volume kept. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/suite.h"

/* 3x3 matrices row by row, as velocity_gradient is stored. */
typedef double matrix[9];

static void multiply(const matrix a, const matrix b, matrix c)
{
  matrix result;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      result[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        result[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    }
  memcpy(c, result, sizeof result);
}

static void transpose(const matrix a, matrix b)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      b[3 * i + j] = a[3 * j + i];
}

static double determinant(const matrix a)
{
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
         a[2] * (a[3] * a[7] - a[4] * a[6]);
}

static void invert(const matrix a, matrix b)
{
  double d = determinant(a);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
      b[3 * i + j] = (a[3 * p + r] * a[3 * q + s] - a[3 * p + s] * a[3 * q + r]) / d;
    }
}

/* Rotation by `angle` about the axis (1, 2, 2) / 3. */
static void rotation(double angle, matrix r)
{
  const double n[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3}, c = cos(angle), s = sin(angle);
  const double cross[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[3 * i + j] = (i == j ? c : 0) + (1 - c) * n[i] * n[j] + s * cross[3 * i + j];
}

struct path {
  struct suite *suite;
  struct block *block;
  kernel_function function;
  size_t gradient, step, stress, begin; /* slots */
  double ratio; /* of the volume, by the deformation */
  bool stopped;
  double least_growth, least_dissipation; /* of plastic strain and of its work, over all steps */
  double work, gross;      /* of the stress, and the sum of its sizes */
  double dissipated, flow; /* said by the law; flow stress times plastic strain */
};

static const double duration = 1e-6;

static bool path_new(struct path *path, struct suite *suite)
{
  const struct proof *proof = suite->proof;
  *path = (struct path){.suite = suite, .block = &suite->block};
  path->function = kernel_operation(suite->specimen.kernel, 0);
  path->gradient = slot_named(proof, SLOT_INPUT, "velocity_gradient");
  path->step = slot_named(proof, SLOT_INPUT, "time_step");
  path->stress = slot_named(proof, SLOT_STATE_END, "stress");
  path->begin = path->stress - 6;
  return path->function && path->gradient != SIZE_MAX && path->stress != SIZE_MAX;
}

static double input_start(const struct proof *proof, const struct slot *slot,
                          const struct suite *suite)
{
  if (slot->kind == SLOT_STATE_BEGIN)
    return proof->descriptor->state[slot->index].initial;
  if (slot->kind == SLOT_PARAMETER || slot->kind == SLOT_MATERIAL_PARAMETER) {
    const struct values *values =
        slot->kind == SLOT_PARAMETER ? suite->specimen.values : suite->specimen.extra;
    return values->value[slot->index].present ? values->value[slot->index].real : NAN;
  }
  if (strcmp(slot->name, "reference_density") == 0)
    return 8000;
  return strcmp(slot->name, "temperature") == 0 ? 298 : 0;
}

static double *value_of(const struct path *path, size_t slot)
{
  return &path->block->array[slot][0];
}

static void path_reset(struct path *path)
{
  const struct proof *proof = path->suite->proof;
  for (size_t s = 0; s < proof->slots; s++)
    if (path->block->kept[s] && path->block->array[s])
      path->block->array[s][0] = input_start(proof, &proof->slot[s], path->suite);
  path->stopped = false;
  path->least_growth = path->least_dissipation = INFINITY;
  path->work = path->gross = path->dissipated = path->flow = 0;
  path->ratio = 1;
}

/* Work of a stress over an increment of the deformation, per reference volume: J stress : d. */
static double work_of(const double stress[6], const matrix d, double ratio)
{
  static const int place[6] = {0, 4, 8, 1, 5, 6}, mirror[6] = {0, 4, 8, 3, 7, 2};
  double sum = 0;
  for (int k = 0; k < 6; k++)
    sum += stress[k] * (k < 3 ? d[place[k]] : d[place[k]] + d[mirror[k]]);
  return ratio * sum;
}

/* Adds the step's works: of the mean stress over the strain of the mid-configuration. */
static void add_work(struct path *path, const double before[6], const matrix f, double ratio)
{
  matrix middle, back, d;
  double after[6], increment[9];
  for (int k = 0; k < 9; k++) {
    increment[k] = f[k] - (k % 4 == 0);
    middle[k] = 0.5 * (f[k] + (k % 4 == 0));
  }
  invert(middle, back);
  multiply(increment, back, d);
  for (int k = 0; k < 6; k++)
    after[k] = 0.5 * (before[k] + *value_of(path, path->stress + (size_t)k));
  const double work = work_of(after, d, ratio * determinant(middle));
  path->work += work;
  path->gross += fabs(work);
}

/* Of the law that laws_new takes. */
static double standard_flow_stress(double plastic_strain)
{
  return 90e6 + 300e6 * plastic_strain;
}

/* One step by the increment f: F at its end is f times F at its beginning. */
static void path_step(struct path *path, const matrix f, double step)
{
  const struct proof *proof = path->suite->proof;
  size_t strain = slot_named(proof, SLOT_STATE_END, "plastic_strain");
  size_t work = slot_named(proof, SLOT_OUTPUT, "plastic_dissipation");
  double before[6], grown = 0;
  for (size_t k = 0; k < 6; k++)
    before[k] = *value_of(path, path->begin + k);
  for (size_t k = 0; k < 9; k++)
    *value_of(path, path->gradient + k) = (f[k] - (k % 4 == 0)) / step;
  if (path->step != SIZE_MAX)
    *value_of(path, path->step) = step;
  bench_call(path->suite->bench, path->function, 1);
  add_work(path, before, f, path->ratio);
  path->ratio *= determinant(f);
  path->stopped |= status_severity(bench_status(path->suite->bench)[0]) == GAMUT_STOP;
  for (size_t s = 0; s < proof->slots; s++) {
    const struct slot *slot = &proof->slot[s];
    if (slot->kind != SLOT_STATE_BEGIN)
      continue;
    size_t end = s + slot->components;
    if (end == strain)
      grown = *value_of(path, end) - *value_of(path, s);
    *value_of(path, s) = *value_of(path, end);
  }
  if (work != SIZE_MAX)
    path->least_dissipation = fmin(path->least_dissipation, *value_of(path, work));
  if (strain != SIZE_MAX)
    path->least_growth = fmin(path->least_growth, grown);
  if (strain != SIZE_MAX)
    path->flow += path->ratio * standard_flow_stress(*value_of(path, strain)) * grown;
  if (work != SIZE_MAX)
    path->dissipated += *value_of(path, work);
}

static void path_stress(const struct path *path, matrix stress)
{
  static const int place[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  for (int k = 0; k < 9; k++)
    stress[k] = *value_of(path, path->stress + (size_t)place[k]);
}

/* F at a share of the path: stretch, shear and volume change, well into plastic flow; back again
 * after the middle where `back`. */
static void deformation(double share, bool back, matrix f)
{
  static const double slope[9] = {0.03, 0.02, -0.01, 0.005, -0.02, 0.015, 0.0, 0.01, -0.004};
  double s = back && share > 0.5 ? 1 - share : share;
  for (int k = 0; k < 9; k++)
    f[k] = (k % 4 == 0) + s * slope[k] + (k == 1 ? 0.02 * s * s : 0);
}

/* Follows the path in n steps, seen in a frame turned by q and rotating by `turn` over its length.
 */
static void follow(struct path *path, size_t n, bool back, const matrix q, double turn)
{
  path_reset(path);
  for (size_t i = 0; i < n; i++) {
    matrix from, to, inverse, f, r0, r1, t;
    deformation((double)i / (double)n, back, from);
    deformation((double)(i + 1) / (double)n, back, to);
    invert(from, inverse);
    multiply(to, inverse, f);
    rotation(turn * (double)i / (double)n, r0);
    rotation(turn * (double)(i + 1) / (double)n, r1);
    multiply(q, r0, r0);
    multiply(q, r1, r1);
    transpose(r0, t);
    multiply(f, t, f);
    multiply(r1, f, f);
    path_step(path, f, duration / (double)n);
  }
}

static const matrix unity = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static double largest(const matrix a)
{
  double most = 0;
  for (int k = 0; k < 9; k++)
    most = fmax(most, fabs(a[k]));
  return most;
}

static double distance(const matrix a, const matrix b)
{
  matrix difference;
  for (int k = 0; k < 9; k++)
    difference[k] = a[k] - b[k];
  return largest(difference) / fmax(largest(a), 1e-300);
}

/* r a r' */
static void turned(const matrix r, const matrix a, matrix out)
{
  matrix t;
  transpose(r, t);
  multiply(a, t, t);
  multiply(r, t, out);
}

static void prove_rotations(struct path *path)
{
  struct checks *checks = &path->suite->proof->checks;
  matrix plain, seen, q, due;
  check_begin(checks, "rotations");
  rotation(0.7, q);
  follow(path, 64, false, unity, 0);
  path_stress(path, plain);
  follow(path, 64, false, q, 0);
  path_stress(path, seen);
  turned(q, plain, due);
  check_figure(checks, distance(due, seen), 1e-10,
               "the same path in a turned frame, stress relative");
  follow(path, 64, false, unity, 0);
  for (int i = 0; i < 100; i++) {
    rotation(0.06, q);
    path_step(path, q, duration / 100);
  }
  path_stress(path, seen);
  rotation(6.0, q);
  turned(q, plain, due);
  check_figure(checks, distance(due, seen), 1e-9,
               "rigid rotation by 344 degrees turns the stress and nothing else, relative");
  double error[2];
  for (int k = 0; k < 2; k++) {
    follow(path, k ? 512 : 256, false, unity, 0);
    path_stress(path, plain);
    follow(path, k ? 512 : 256, false, unity, 1.5);
    path_stress(path, seen);
    rotation(1.5, q);
    turned(q, plain, due);
    error[k] = distance(due, seen);
  }
  check_figure(checks, error[1], fmax(0.6 * error[0], 1e-9),
               "a superposed rotation by 86 degrees in 512 steps, stress relative; its error falls "
               "with the step");
}

static void prove_still(struct path *path)
{
  const struct proof *proof = path->suite->proof;
  double worst = 0;
  check_begin(&path->suite->proof->checks, "a step without motion");
  follow(path, 64, false, unity, 0);
  double *before = calloc(proof->slots + 1, sizeof *before);
  for (size_t s = 0; before && s < proof->slots; s++)
    if (proof->slot[s].kind == SLOT_STATE_BEGIN)
      before[s] = *value_of(path, s);
  path_step(path, unity, duration);
  for (size_t s = 0; before && s < proof->slots; s++)
    if (proof->slot[s].kind == SLOT_STATE_BEGIN)
      worst = fmax(worst, fabs(*value_of(path, s) - before[s]) / fmax(fabs(before[s]), 1));
  free(before);
  check_figure(&path->suite->proof->checks, worst, 1e-9,
               "a step without motion leaves the state, relative");
}

static void prove_dissipation(struct path *path)
{
  struct checks *checks = &path->suite->proof->checks;
  check_begin(checks, "dissipation");
  follow(path, 200, true, unity, 0);
  check_that(checks, !path->stopped, "a path into plastic flow and back ends without a stop");
  if (isfinite(path->least_growth))
    check_least(checks, path->least_growth, 0, "growth of plastic strain in a step");
  if (isfinite(path->least_dissipation))
    check_least(checks, path->least_dissipation, 0, "plastic work of a step, J/m3");
}

/* The energy grows by the work of the stress, whatever flows: heat stays in the point. What the law
 * calls plastic work is its flow stress over the plastic strain. */
static void prove_energy(struct path *path)
{
  const struct proof *proof = path->suite->proof;
  struct checks *checks = &path->suite->proof->checks;
  size_t energy = slot_named(proof, SLOT_STATE_END, "energy");
  size_t dissipation = slot_named(proof, SLOT_OUTPUT, "plastic_dissipation");
  double off[2] = {0}, plastic[2] = {0};
  check_begin(checks, "energy along a path into plastic flow and back");
  for (int k = 0; k < 2; k++) {
    follow(path, (size_t)(400 << k), true, unity, 0);
    if (energy != SIZE_MAX)
      off[k] = fabs(*value_of(path, energy) - path->work) / path->gross;
    if (dissipation != SIZE_MAX && path->flow > 0)
      plastic[k] = fabs(path->dissipated - path->flow) / path->flow;
  }
  /* Errors of the steps fall with their number; counted twice stays twice. */
  if (energy != SIZE_MAX)
    check_figure(checks, off[1], fmax(0.6 * off[0], 1e-6),
                 "energy less the work of the stress, relative (%.2g in half the steps)", off[0]);
  if (energy != SIZE_MAX)
    check_figure(checks, off[1], 0.01, "energy less the work of the stress, relative");
  if (dissipation != SIZE_MAX && path->flow > 0)
    check_figure(checks, plastic[1], 0.01,
                 "plastic_dissipation less flow stress times plastic strain, relative");
}

static void prove_volume(struct path *path)
{
  struct proof *proof = path->suite->proof;
  size_t slot = slot_named(proof, SLOT_STATE_END, "volume_ratio");
  matrix f;
  if (slot == SIZE_MAX)
    return;
  check_begin(&proof->checks, "volume");
  follow(path, 200, false, unity, 0);
  deformation(1, false, f);
  check_figure(&proof->checks, fabs(*value_of(path, slot) / determinant(f) - 1), 1e-12,
               "volume_ratio against the determinant of the deformation, relative");
}

static void prove_order(struct path *path)
{
  struct checks *checks = &path->suite->proof->checks;
  matrix stress[3];
  check_begin(checks, "step halving");
  for (int k = 0; k < 3; k++) {
    follow(path, (size_t)(200 << k), false, unity, 0);
    path_stress(path, stress[k]);
  }
  double coarse = distance(stress[1], stress[0]), fine = distance(stress[2], stress[1]);
  if (fine < 1e-10)
    check_figure(checks, fine, 1e-10, "halving the step changes nothing, stress relative");
  else
    check_least(checks, log2(coarse / fine), 0.8,
                "order of convergence when the step is halved (last change %.1e)", fine);
}

static bool provides(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->provisions; i++)
    if (strcmp(d->provide[i], name) == 0)
      return true;
  return false;
}

static double mean_stress(const struct path *path)
{
  return (*value_of(path, path->stress) + *value_of(path, path->stress + 1) +
          *value_of(path, path->stress + 2)) /
         3;
}

/* An effect halves the deviator between two steps; the next one must begin with that. */
static void prove_imposed(struct path *path)
{
  const struct proof *proof = path->suite->proof;
  double worst = 0, scale = 0, due[6];
  if (!provides(proof->descriptor, "imposed_stress"))
    return;
  check_begin(&path->suite->proof->checks, "imposed stress");
  follow(path, 64, false, unity, 0);
  const double before = mean_stress(path);
  for (size_t k = 0; k < 6; k++) {
    due[k] = 0.5 * (*value_of(path, path->stress + k) - (k < 3 ? before : 0));
    *value_of(path, path->stress - 6 + k) -= due[k];
  }
  path_step(path, unity, duration);
  const double after = mean_stress(path);
  for (size_t k = 0; k < 6; k++) {
    worst = fmax(worst, fabs(*value_of(path, path->stress + k) - (k < 3 ? after : 0) - due[k]));
    scale = fmax(scale, fabs(due[k]));
  }
  check_figure(&path->suite->proof->checks, worst / fmax(scale, 1e-300), 1e-9,
               "a deviator that an effect has halved is halved after a step without motion, "
               "relative");
}

void prove_elasticity(struct proof *proof)
{
  struct suite suite;
  struct path path;
  if (suite_new(&suite, proof)) {
    suite_work(&suite, 0, "stress");
    prove_threads(&suite, kernel_operation(suite.specimen.kernel, 0));
    if (check_that(&proof->checks, path_new(&path, &suite),
                   "velocity_gradient is an input and stress a state")) {
      prove_rotations(&path);
      prove_still(&path);
      prove_dissipation(&path);
      prove_energy(&path);
      prove_volume(&path);
      prove_order(&path);
      prove_imposed(&path);
    }
  }
  suite_free(&suite);
}
