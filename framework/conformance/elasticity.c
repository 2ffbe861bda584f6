/* elasticity: indifference to rotation, dissipation, energy, convergence in the step, volume kept,
 * a stress that effects set. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/path.h"

static void prove_rotations(struct path *path)
{
  struct checks *checks = &path->suite->proof->checks;
  matrix plain, seen, q, due;
  check_begin(checks, "rotations");
  matrix_rotation(0.7, q);
  path_follow(path, 64, false, matrix_unity, 0);
  path_stress(path, plain);
  path_follow(path, 64, false, q, 0);
  path_stress(path, seen);
  matrix_turned(q, plain, due);
  check_figure(checks, matrix_distance(due, seen), 1e-10,
               "the same path in a turned frame, stress relative");
  path_follow(path, 64, false, matrix_unity, 0);
  for (int i = 0; i < 100; i++) {
    matrix_rotation(0.06, q);
    path_advance(path, q, path_duration / 100);
  }
  path_stress(path, seen);
  matrix_rotation(6.0, q);
  matrix_turned(q, plain, due);
  check_figure(checks, matrix_distance(due, seen), 1e-9,
               "rigid rotation by 344 degrees turns the stress and nothing else, relative");
  double error[2];
  for (int k = 0; k < 2; k++) {
    path_follow(path, k ? 512 : 256, false, matrix_unity, 0);
    path_stress(path, plain);
    path_follow(path, k ? 512 : 256, false, matrix_unity, 1.5);
    path_stress(path, seen);
    matrix_rotation(1.5, q);
    matrix_turned(q, plain, due);
    error[k] = matrix_distance(due, seen);
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
  path_follow(path, 64, false, matrix_unity, 0);
  double *before = calloc(proof->slots + 1, sizeof *before);
  for (size_t s = 0; before && s < proof->slots; s++)
    if (proof->slot[s].kind == SLOT_STATE_BEGIN)
      before[s] = *path_value(path, s);
  path_advance(path, matrix_unity, path_duration);
  for (size_t s = 0; before && s < proof->slots; s++)
    if (proof->slot[s].kind == SLOT_STATE_BEGIN)
      worst = fmax(worst, fabs(*path_value(path, s) - before[s]) / fmax(fabs(before[s]), 1));
  free(before);
  check_figure(&path->suite->proof->checks, worst, 1e-9,
               "a step without motion leaves the state, relative");
}

static void prove_dissipation(struct path *path)
{
  struct checks *checks = &path->suite->proof->checks;
  check_begin(checks, "dissipation");
  path_follow(path, 200, true, matrix_unity, 0);
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
    path_follow(path, (size_t)(400 << k), true, matrix_unity, 0);
    if (energy != SIZE_MAX)
      off[k] = fabs(*path_value(path, energy) - path->work) / path->gross;
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
  path_follow(path, 200, false, matrix_unity, 0);
  path_deformation(1, false, f);
  check_figure(&proof->checks, fabs(*path_value(path, slot) / matrix_determinant(f) - 1), 1e-12,
               "volume_ratio against the determinant of the deformation, relative");
}

static void prove_order(struct path *path)
{
  struct checks *checks = &path->suite->proof->checks;
  matrix stress[3];
  check_begin(checks, "step halving");
  for (int k = 0; k < 3; k++) {
    path_follow(path, (size_t)(200 << k), false, matrix_unity, 0);
    path_stress(path, stress[k]);
  }
  double coarse = matrix_distance(stress[1], stress[0]);
  double fine = matrix_distance(stress[2], stress[1]);
  if (fine < 1e-10)
    check_figure(checks, fine, 1e-10, "halving the step changes nothing, stress relative");
  else
    check_least(checks, log2(coarse / fine), 0.8,
                "order of convergence when the step is halved (last change %.1e)", fine);
}

static double mean_stress(const struct path *path)
{
  return (*path_value(path, path->stress) + *path_value(path, path->stress + 1) +
          *path_value(path, path->stress + 2)) /
         3;
}

/* An effect halves the deviator between two steps; the next one must begin with that. */
static void prove_imposed(struct path *path)
{
  const struct proof *proof = path->suite->proof;
  double worst = 0, scale = 0, due[6];
  if (!descriptor_provides(proof->descriptor, "imposed_stress"))
    return;
  check_begin(&path->suite->proof->checks, "imposed stress");
  path_follow(path, 64, false, matrix_unity, 0);
  const double before = mean_stress(path);
  for (size_t k = 0; k < 6; k++) {
    due[k] = 0.5 * (*path_value(path, path->stress + k) - (k < 3 ? before : 0));
    *path_value(path, path->stress - 6 + k) -= due[k];
  }
  path_advance(path, matrix_unity, path_duration);
  const double after = mean_stress(path);
  for (size_t k = 0; k < 6; k++) {
    worst = fmax(worst, fabs(*path_value(path, path->stress + k) - (k < 3 ? after : 0) - due[k]));
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
