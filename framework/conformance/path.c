/* The path of a material point that the proofs of an elasticity follow. */
#include "conformance/path.h"

#include <math.h>
#include <string.h>

static void matrix_multiply(const matrix a, const matrix b, matrix c)
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

static void matrix_transpose(const matrix a, matrix b)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      b[3 * i + j] = a[3 * j + i];
}

double matrix_determinant(const matrix a)
{
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
         a[2] * (a[3] * a[7] - a[4] * a[6]);
}

static void matrix_invert(const matrix a, matrix b)
{
  double d = matrix_determinant(a);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
      b[3 * i + j] = (a[3 * p + r] * a[3 * q + s] - a[3 * p + s] * a[3 * q + r]) / d;
    }
}

/* Rotation by `angle` about the axis (1, 2, 2) / 3. */
void matrix_rotation(double angle, matrix r)
{
  const double n[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3}, c = cos(angle), s = sin(angle);
  const double cross[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[3 * i + j] = (i == j ? c : 0) + (1 - c) * n[i] * n[j] + s * cross[3 * i + j];
}


const double path_duration = 1e-6;

bool path_new(struct path *path, struct suite *suite)
{
  const struct proof *proof = suite->proof;
  *path = (struct path){.suite = suite, .block = &suite->block};
  path->function = kernel_operation(suite->specimen.kernel, 0);
  path->gradient = slot_named(proof, SLOT_INPUT, "velocity_gradient");
  path->step = slot_named(proof, SLOT_INPUT, "time_step");
  path->deformation = slot_named(proof, SLOT_INPUT, "deformation_gradient");
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

double *path_value(const struct path *path, size_t slot)
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
  memcpy(path->F, matrix_unity, sizeof path->F);
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
  matrix_invert(middle, back);
  matrix_multiply(increment, back, d);
  for (int k = 0; k < 6; k++)
    after[k] = 0.5 * (before[k] + *path_value(path, path->stress + (size_t)k));
  const double work = work_of(after, d, ratio * matrix_determinant(middle));
  path->work += work;
  path->gross += fabs(work);
}

/* Of the law that laws_new takes. */
static double standard_flow_stress(double plastic_strain)
{
  return 90e6 + 300e6 * plastic_strain;
}

/* One step by the increment f: F at its end is f times F at its beginning. */
void path_advance(struct path *path, const matrix f, double step)
{
  const struct proof *proof = path->suite->proof;
  size_t strain = slot_named(proof, SLOT_STATE_END, "plastic_strain");
  size_t work = slot_named(proof, SLOT_OUTPUT, "plastic_dissipation");
  double before[6], grown = 0;
  for (size_t k = 0; k < 6; k++)
    before[k] = *path_value(path, path->begin + k);
  for (size_t k = 0; k < 9; k++)
    *path_value(path, path->gradient + k) = (f[k] - (k % 4 == 0)) / step;
  if (path->step != SIZE_MAX)
    *path_value(path, path->step) = step;
  matrix_multiply(f, path->F, path->F);
  for (size_t k = 0; path->deformation != SIZE_MAX && k < 9; k++)
    *path_value(path, path->deformation + k) = path->F[k];
  bench_call(path->suite->bench, path->function, 1);
  add_work(path, before, f, path->ratio);
  path->ratio *= matrix_determinant(f);
  path->stopped |= status_severity(bench_status(path->suite->bench)[0]) == GAMUT_STOP;
  for (size_t s = 0; s < proof->slots; s++) {
    const struct slot *slot = &proof->slot[s];
    if (slot->kind != SLOT_STATE_BEGIN)
      continue;
    size_t end = s + slot->components;
    if (end == strain)
      grown = *path_value(path, end) - *path_value(path, s);
    *path_value(path, s) = *path_value(path, end);
  }
  if (work != SIZE_MAX)
    path->least_dissipation = fmin(path->least_dissipation, *path_value(path, work));
  if (strain != SIZE_MAX)
    path->least_growth = fmin(path->least_growth, grown);
  if (strain != SIZE_MAX)
    path->flow += path->ratio * standard_flow_stress(*path_value(path, strain)) * grown;
  if (work != SIZE_MAX)
    path->dissipated += *path_value(path, work);
}

void path_stress(const struct path *path, matrix stress)
{
  static const int place[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
  for (int k = 0; k < 9; k++)
    stress[k] = *path_value(path, path->stress + (size_t)place[k]);
}

/* F at a share of the path: stretch, shear and volume change, well into plastic flow; back again
 * after the middle where `back`. */
void path_deformation(double share, bool back, matrix f)
{
  static const double slope[9] = {0.03, 0.02, -0.01, 0.005, -0.02, 0.015, 0.0, 0.01, -0.004};
  double s = back && share > 0.5 ? 1 - share : share;
  for (int k = 0; k < 9; k++)
    f[k] = (k % 4 == 0) + s * slope[k] + (k == 1 ? 0.02 * s * s : 0);
}

/* Follows the path in n steps, seen in a frame turned by q and rotating by `turn` over its length.
 */
void path_follow(struct path *path, size_t n, bool back, const matrix q, double turn)
{
  path_reset(path);
  for (size_t i = 0; i < n; i++) {
    matrix from, to, inverse, f, r0, r1, t;
    path_deformation((double)i / (double)n, back, from);
    path_deformation((double)(i + 1) / (double)n, back, to);
    matrix_invert(from, inverse);
    matrix_multiply(to, inverse, f);
    matrix_rotation(turn * (double)i / (double)n, r0);
    matrix_rotation(turn * (double)(i + 1) / (double)n, r1);
    matrix_multiply(q, r0, r0);
    matrix_multiply(q, r1, r1);
    matrix_transpose(r0, t);
    matrix_multiply(f, t, f);
    matrix_multiply(r1, f, f);
    path_advance(path, f, path_duration / (double)n);
  }
}

const matrix matrix_unity = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static double matrix_largest(const matrix a)
{
  double most = 0;
  for (int k = 0; k < 9; k++)
    most = fmax(most, fabs(a[k]));
  return most;
}

double matrix_distance(const matrix a, const matrix b)
{
  matrix difference;
  for (int k = 0; k < 9; k++)
    difference[k] = a[k] - b[k];
  return matrix_largest(difference) / fmax(matrix_largest(a), 1e-300);
}

/* r a r' */
void matrix_turned(const matrix r, const matrix a, matrix out)
{
  matrix t;
  matrix_transpose(r, t);
  matrix_multiply(a, t, t);
  matrix_multiply(r, t, out);
}
