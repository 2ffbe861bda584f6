/* effect: its kernels on blocks of points, and its scene. */
#include "conformance/suite.h"

#include <math.h>
#include <string.h>

#include "catalogue/catalogue.h"

/* Fills what the task shares with others, and calls it. */
static void call_from(struct suite *suite, const struct work *work, const char *const *name,
                      size_t count, double start)
{
  struct block *block = &suite->block;
  block_mark(block);
  for (size_t s = 0; s < block->proof->slots; s++)
    for (size_t k = 0; k < count; k++)
      for (size_t i = 0; strcmp(block->proof->slot[s].name, name[k]) == 0 && i < BLOCK_ROOM; i++)
        block->array[s][i] = start;
  bench_call(suite->bench, work->function, BLOCK_POINTS);
}

/* A product doubles with what was there, the lesser of two is either: whatever other effects do,
 * and in which order. */
static void prove_shared(struct suite *suite, const struct work *work, enum gamut_access access,
                         const char *const *name, size_t count)
{
  struct block *block = &suite->block;
  const bool scales = access == GAMUT_SCALE;
  for (size_t k = 0; k < count; k++) {
    const size_t slot = slot_named(block->proof, SLOT_OUTPUT, name[k]);
    double alone[BLOCK_POINTS];
    size_t wrong = 0;
    check_begin(&block->proof->checks, "%s of others", name[k]);
    block_draw(block, 1);
    call_from(suite, work, name, count, access_neutral(access));
    memcpy(alone, block->array[slot], sizeof alone);
    for (size_t i = 0; i < BLOCK_POINTS && !scales; i++)
      alone[i] = fmin(alone[i], 0.25);
    call_from(suite, work, name, count, 0.25);
    for (size_t i = 0; i < BLOCK_POINTS; i++)
      wrong += bench_status(suite->bench)[i] == 0 &&
               block->array[slot][i] != (scales ? 0.25 * alone[i] : alone[i]);
    check_figure(&block->proof->checks, (double)wrong, 0,
                 "%s: points at which it does not %s %s that others have left", work->label,
                 scales ? "multiply the" : "take the lesser of its own and the", name[k]);
  }
}

void prove_effect(struct proof *proof)
{
  const struct descriptor *d = proof->descriptor;
  struct suite suite = {0};
  if (d->tasks > 0 && suite_new(&suite, proof))
    for (size_t i = 0; i < d->tasks; i++) {
      const struct work work = {.function = kernel_named(suite.specimen.kernel, d->task[i].kernel),
                                .label = d->task[i].kernel,
                                .task = &d->task[i]};
      if (work.function) {
        prove_work(&suite.block, &work);
        prove_shared(&suite, &work, GAMUT_SCALE, d->task[i].scale, d->task[i].scales);
        prove_shared(&suite, &work, GAMUT_LEAST, d->task[i].lower, d->task[i].lowers);
      } else {
        check_that(&proof->checks, false, "the kernel of the task %s is there", work.label);
      }
    }
  suite_free(&suite);
  prove_scene(proof);
}
