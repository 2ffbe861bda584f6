/* eos: pressure and its slopes, a real sound speed, no pressure of nothing. */
#include <math.h>

#include "base/array.h"
#include "conformance/suite.h"

/* Points that are fine must have a sound speed above zero. */
static void prove_sound_speed(struct proof *proof, struct block *block, kernel_function function)
{
  size_t bad = 0, fine = 0, slot = slot_named(proof, SLOT_OUTPUT, "sound_speed");
  check_begin(&proof->checks, "sound speed");
  if (!check_that(&proof->checks,
                  slot != SIZE_MAX && slot_named(proof, SLOT_OUTPUT, "pressure") != SIZE_MAX,
                  "pressure and sound_speed are among the outputs"))
    return;
  for (size_t round = 0; round < 3; round++) {
    block_draw(block, round);
    block_mark(block);
    bench_call(block->bench, function, BLOCK_POINTS);
    for (size_t i = 0; i < BLOCK_POINTS; i++) {
      if (status_severity(bench_status(block->bench)[i]) >= GAMUT_WARN)
        continue;
      fine++;
      bad += !(block->array[slot][i] >= 0);
    }
  }
  check_figure(&proof->checks, (double)bad, 0,
               "points without a real sound speed, of %zu that the law takes as fine", fine);
}

/* The speed that follows from the slopes: rho0 c^2 = dp/dmu + dp/de p / (1 + mu)^2. A lower one
 * makes steps too long; a higher one costs steps, and a law may want that. */
static void prove_wave(struct proof *proof, struct block *block, kernel_function function)
{
  size_t speed = slot_named(proof, SLOT_OUTPUT, "sound_speed");
  size_t pressure = slot_named(proof, SLOT_OUTPUT, "pressure");
  size_t by_mu = slot_named(proof, SLOT_OUTPUT, "pressure_slope_compression");
  size_t by_e = slot_named(proof, SLOT_OUTPUT, "pressure_slope_energy");
  size_t mu = slot_named(proof, SLOT_INPUT, "compression");
  size_t density = slot_named(proof, SLOT_INPUT, "reference_density");
  double least = INFINITY, most = 0;
  size_t tried = 0;
  check_begin(&proof->checks, "sound speed of the slopes");
  if (speed == SIZE_MAX || by_mu == SIZE_MAX || density == SIZE_MAX || pressure == SIZE_MAX)
    return;
  block_draw(block, 1);
  block_mark(block);
  bench_call(block->bench, function, BLOCK_POINTS);
  for (size_t i = 0; i < BLOCK_POINTS; i++) {
    double volume = mu == SIZE_MAX ? 1 : 1 + block->array[mu][i];
    double of_energy = by_e == SIZE_MAX ? 0 : block->array[by_e][i];
    double square = (block->array[by_mu][i] +
                     of_energy * block->array[pressure][i] / (volume * volume)) /
                    block->array[density][i];
    if (bench_status(block->bench)[i] != 0 || !(square > 0))
      continue;
    tried++;
    least = fmin(least, block->array[speed][i] / sqrt(square));
    most = fmax(most, block->array[speed][i] / sqrt(square));
  }
  if (tried == 0)
    return;
  check_least(&proof->checks, least, 1 - 1e-6, "sound speed over that of the slopes, %zu points",
              tried);
  if (most > 1 + 1e-6)
    check_say(&proof->checks,
              "note: the sound speed is up to %.3g times that of the slopes: steps are as much "
              "shorter, and waves in artificial viscosity as much faster, than the law needs",
              most);
}

/* There is no material at a compression of -1 or below: no number there is right. */
static void prove_vacuum(struct proof *proof, struct block *block, kernel_function function)
{
  static const double compression[] = {-1.0, -1.0 - 1e-15, -1.5, -1e3};
  const size_t kinds = ARRAY_SIZE(compression);
  size_t let_go = 0, slot = slot_named(proof, SLOT_INPUT, "compression");
  check_begin(&proof->checks, "vacuum");
  if (slot == SIZE_MAX)
    return;
  block_draw(block, 1);
  for (size_t i = 0; i < BLOCK_ROOM; i++)
    block->array[slot][i] = compression[i % kinds];
  block_mark(block);
  bench_call(block->bench, function, BLOCK_POINTS);
  for (size_t i = 0; i < BLOCK_POINTS; i++)
    let_go += status_severity(bench_status(block->bench)[i]) < GAMUT_STOP;
  check_figure(&proof->checks, (double)let_go, 0,
               "points at a compression of -1 or below, of %d, that the law does not stop",
               (int)BLOCK_POINTS);
}

void prove_eos(struct proof *proof)
{
  struct suite suite;
  if (suite_new(&suite, proof)) {
    kernel_function function = kernel_operation(suite.specimen.kernel, 0);
    suite_work(&suite, 0, "pressure");
    suite_variants(&suite);
    prove_sound_speed(proof, &suite.block, function);
    prove_vacuum(proof, &suite.block, function);
    prove_slopes(proof, &suite.block, function);
    prove_wave(proof, &suite.block, function);
    prove_dependence(&suite);
    prove_threads(&suite, function);
    suite_derivatives(&suite, 1);
  }
  suite_free(&suite);
}
