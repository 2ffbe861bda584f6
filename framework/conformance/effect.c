/* effect: its kernels on blocks of points, and its scene. */
#include "conformance/suite.h"

void prove_effect(struct proof *proof)
{
  const struct descriptor *d = proof->descriptor;
  struct suite suite = {0};
  if (d->tasks > 0 && suite_new(&suite, proof))
    for (size_t i = 0; i < d->tasks; i++) {
      const struct work work = {.function = kernel_named(suite.specimen.kernel, d->task[i].kernel),
                                .label = d->task[i].kernel,
                                .task = &d->task[i]};
      if (work.function)
        prove_work(&suite.block, &work);
      else
        check_that(&proof->checks, false, "the kernel of the task %s is there", work.label);
    }
  suite_free(&suite);
  prove_scene(proof);
}
