/* strength: a flow stress that is never negative, its slopes, and the inverse where there is one.
 */
#include <math.h>
#include <string.h>

#include "conformance/suite.h"

static void prove_sign(struct proof *proof, struct block *block, kernel_function function)
{
  double least = INFINITY, stiffness = 0;
  const size_t factor = slot_named(proof, SLOT_OUTPUT, "shear_modulus_factor");
  size_t slot = slot_named(proof, SLOT_OUTPUT, "flow_stress");
  check_begin(&proof->checks, "flow stress");
  if (!check_that(&proof->checks, slot != SIZE_MAX, "flow_stress is among the outputs"))
    return;
  for (size_t round = 0; round < 3; round++) {
    block_draw(block, round);
    block_mark(block);
    bench_call(block->bench, function, BLOCK_POINTS);
    for (size_t i = 0; i < BLOCK_POINTS; i++)
      if (status_severity(bench_status(block->bench)[i]) < GAMUT_STOP)
        least = fmin(least, block->array[slot][i]);
    for (size_t i = 0; factor != SIZE_MAX && i < BLOCK_POINTS; i++)
      if (status_severity(bench_status(block->bench)[i]) < GAMUT_STOP)
        stiffness = fmin(stiffness, block->array[factor][i]);
  }
  check_figure(&proof->checks, isfinite(least) ? fmax(-least, 0) : 0, 0,
               "flow stress below zero, Pa");
  check_figure(&proof->checks, fmax(-stiffness, 0), 0, "shear_modulus_factor below zero");
}

/* From strain to stress and back, where the law hardens. */
static void prove_inverse(struct proof *proof, struct block *block, kernel_function function,
                          kernel_function inverse)
{
  double worst = 0;
  size_t tried = 0, stress = slot_named(proof, SLOT_OUTPUT, "flow_stress");
  size_t strain = slot_named(proof, SLOT_INPUT, "plastic_strain");
  size_t given = slot_named(proof, SLOT_INVERSE_INPUT, "flow_stress_given");
  size_t back = slot_named(proof, SLOT_INVERSE_OUTPUT, "plastic_strain_inverse");
  size_t slope = slot_named(proof, SLOT_OUTPUT, "flow_stress_slope_plastic_strain");
  check_begin(&proof->checks, "inverse");
  if (!check_that(&proof->checks, inverse && strain != SIZE_MAX && slope != SIZE_MAX,
                  "the inverse and what it needs are there"))
    return;
  block_draw(block, 1);
  block_mark(block);
  bench_call(block->bench, function, BLOCK_POINTS);
  memcpy(block->array[given], block->array[stress], BLOCK_POINTS * sizeof(double));
  double hardening[BLOCK_POINTS];
  memcpy(hardening, block->array[slope], sizeof hardening);
  bench_call(block->bench, inverse, BLOCK_POINTS);
  for (size_t i = 0; i < BLOCK_POINTS; i++) {
    double e = block->array[strain][i], s = block->array[given][i];
    if (bench_status(block->bench)[i] != 0 || !(hardening[i] > 1e-6 * s))
      continue;
    tried++;
    /* What rounding of the stress itself makes of the strain is not the inverse's fault. */
    double scale = fmax(fabs(e), s / hardening[i]);
    worst = fmax(worst, fabs(block->array[back][i] - e) / scale);
  }
  check_figure(&proof->checks, tried ? worst : NAN, 1e-9,
               "inverse of the flow stress at %zu points, relative", tried);
}

void prove_strength(struct proof *proof)
{
  struct suite suite;
  if (suite_new(&suite, proof)) {
    kernel_function function = kernel_operation(suite.specimen.kernel, 0);
    suite_work(&suite, 0, "flow_stress");
    suite_variants(&suite);
    prove_sign(proof, &suite.block, function);
    prove_slopes(proof, &suite.block, function);
    if (proof->descriptor->inverse)
      prove_inverse(proof, &suite.block, function, kernel_operation(suite.specimen.kernel, 1));
    prove_dependence(&suite);
    prove_threads(&suite, function);
    suite_derivatives(&suite, 2);
  }
  suite_free(&suite);
}
