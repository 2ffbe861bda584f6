/* The tasks of a step, as step.c strings them together. All take the model as `self`. */
#ifndef MATERIAL_POINT_METHOD_STEP_H
#define MATERIAL_POINT_METHOD_STEP_H

#include "model.h"

/* Below so many blocks threads cost more than they give. */
enum { FEW_BLOCKS = 64 };

/* block.c */
/* Work on a block of points, number `block` of its body and `serial` of all. */
typedef gamut_status block_work(struct model *, const struct body *, size_t block, size_t serial,
                                struct work *);
/* Does it for all blocks, by all threads, outside the sweeps of the core. */
gamut_status each_block(struct model *, block_work *);
/* The box of a block of points, from the tile of its sums. */
gamut_status flush_box(struct model *, struct work *, size_t serial);
gamut_status flush_sums(struct model *, struct work *, size_t serial);
gamut_status load_block(void *self, const struct gamut_chunk *);
gamut_status flush_momentum(void *self, const struct gamut_chunk *);
gamut_status flush_block(void *self, const struct gamut_chunk *);

/* sweep.c: of `count` points from a slot on, those before the padding at the end. */
size_t real_points(const struct gamut_set *, size_t slot, size_t count);
/* First pass of MUSL: new velocities of the points, and their momentum back to the grid. */
gamut_status renew_momentum(void *self, const struct gamut_chunk *);
gamut_status gather_points(void *self, const struct gamut_chunk *);
gamut_status bound_step(void *self, const struct gamut_chunk *);
gamut_status scatter_points(void *self, const struct gamut_chunk *);
/* Scatters points of block `serial` that begin in `slot` and adds to the sums of the ledger. */
gamut_status scatter_view(struct model *, struct work *, const struct gamut_set *, size_t serial,
                          size_t slot, struct point_view *, const double *energy);

/* lost_points.c: `x` and `v` are the position and the velocity of the points. */
struct locate locate_in(const struct model *, size_t serial, const double *const x[3],
                        size_t count);
/* Names a point that left the tile of its block. */
gamut_status find_lost_point(const struct model *, const struct gamut_set *, size_t slot,
                             const struct locate *, const double *const x[3],
                             const double *const v[3]);
#endif
