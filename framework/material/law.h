/* A strength or eos kernel bound as a callee: its argument and result arrays, and its evaluation at
 * all points or at a list of them. */
#ifndef GAMUT_LAW_H
#define GAMUT_LAW_H

#include "material/block_image.h"

struct law {
  struct gamut_strength_law strength; /* what the caller sees, by the kind of the kernel */
  struct gamut_eos_law eos;
  const struct kernel *kernel;
  struct image *image;   /* all points */
  struct image *compact; /* listed points */
  size_t rows, stride;
  size_t *row; /* slots that have a row: arguments first, then results */
  size_t arguments, results;
  size_t *scaled; /* slots of the flow stress, its slopes and its derivatives */
  size_t scales;
  const double *factor; /* of the block at work, multiplied into these; null: nobody changes it */
  uint64_t evaluated; /* points, so far */
  double *memory;        /* arguments, results, sinks: one row a slot that is not uniform */
  double *gathered;      /* the same rows for listed points */
};

/* Two users: a run (linked to fields) and a bench (alone). `rows` is the most points. */
gamut_status law_new(const struct kernel *, struct arena *, size_t rows, struct law **);
void law_free(struct law *, struct arena *);
/* Row of a slot by its name, or null. */
double *law_row(const struct law *, const char *name);
/* Whether who calls the material's strength gives it all that it reads, and takes what it gives. */
gamut_status strength_fits(const struct material *, const struct descriptor *caller,
                           struct trace *);
/* How many points the next evaluations have, and their statuses cleared. */
void law_begin(struct law *, size_t count);
/* Zeros in all rows, as when it was new. */
void law_clear(struct law *);
/* As kernel_try, of an elasticity's stress and start with the laws that it calls. */
gamut_status elasticity_try(const struct kernel *, struct law *strength, struct law *eos,
                            struct trace *);

#endif
