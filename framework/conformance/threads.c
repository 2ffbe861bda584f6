/* Two threads in one kernel, each with its own block: no array of the plugin may be shared. */
#include <stdlib.h>
#include <string.h>

#include "conformance/suite.h"

enum { ROUNDS = 300 };

struct side {
  struct bench *bench;
  double **array, *due;
  size_t wrong;
};

static bool side_new(struct side *side, struct suite *suite, bool turned)
{
  const struct proof *proof = suite->proof;
  struct trace *trace = trace_new();
  bool made = bench_new(suite->specimen.kernel, suite->laws.eos.kernel, suite->laws.strength.kernel,
                        BLOCK_ROOM, trace, &side->bench) == GAMUT_OK;
  trace_free(trace);
  side->array = calloc(proof->slots + 1, sizeof *side->array);
  side->due = calloc((proof->slots + 1) * BLOCK_POINTS, sizeof *side->due);
  if (!made || !side->array || !side->due)
    return false;
  for (size_t s = 0; s < proof->slots; s++) {
    char label[96];
    if (!suite->block.array[s])
      continue;
    side->array[s] = bench_array(side->bench, slot_label(&proof->slot[s], label, sizeof label));
    for (size_t i = 0; suite->block.kept[s] && i < BLOCK_POINTS; i++)
      side->array[s][i] = suite->block.kept[s][turned ? BLOCK_POINTS - 1 - i : i];
  }
  return true;
}

static void side_free(struct side *side)
{
  bench_free(side->bench);
  free(side->array);
  free(side->due);
}

static void keep(struct side *side, const struct proof *proof)
{
  for (size_t s = 0; s < proof->slots; s++)
    if (slot_is_output(&proof->slot[s]))
      memcpy(side->due + s * BLOCK_POINTS, side->array[s], BLOCK_POINTS * sizeof(double));
}

static void compare(struct side *side, const struct proof *proof)
{
  for (size_t s = 0; s < proof->slots; s++)
    if (slot_is_output(&proof->slot[s]) &&
        memcmp(side->due + s * BLOCK_POINTS, side->array[s], BLOCK_POINTS * sizeof(double)) != 0)
      side->wrong++;
}

void prove_threads(struct suite *suite, kernel_function function)
{
  struct proof *proof = suite->proof;
  struct side side[2] = {{0}};
  check_begin(&proof->checks, "two threads in one kernel");
  block_draw(&suite->block, 1);
  if (side_new(&side[0], suite, false) && side_new(&side[1], suite, true)) {
    for (int k = 0; k < 2; k++) {
      bench_call(side[k].bench, function, BLOCK_POINTS);
      keep(&side[k], proof);
    }
#pragma omp parallel for num_threads(2) schedule(static, 1)
    for (int k = 0; k < 2; k++)
      for (int round = 0; round < ROUNDS; round++) {
        bench_call(side[k].bench, function, BLOCK_POINTS);
        compare(&side[k], proof);
      }
  }
  check_figure(&proof->checks, (double)(side[0].wrong + side[1].wrong), 0,
               "results with other bits when two threads are in one kernel, of %d calls",
               2 * ROUNDS);
  side_free(&side[0]);
  side_free(&side[1]);
}
