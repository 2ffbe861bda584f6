/* Transfers between the points of a block and the tile of nodes around it, one set of functions for
 * each dimension and order of the shape functions. */
#ifndef MATERIAL_POINT_METHOD_TRANSFER_H
#define MATERIAL_POINT_METHOD_TRANSFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/host.h>

#include "transfer/shapes.h"

enum { STRIDE = GAMUT_CHUNK_MAX + 24 }; /* no multiple of a page: arrays must not alias in cache */

enum {
  PREPARED = 12, /* momentum, external force, minus volume times stress over the cell */
  PENDING = 17
};

/* What one thread works on a block with. */
struct work {
  double place[3][STRIDE]; /* 0 to 1, see shapes.h */
  double reach[3][STRIDE]; /* gimp: half the length of the point's domain, in cells */
  int32_t node[STRIDE];    /* number of that node in the tile */
  double value[6][STRIDE]; /* gathered: velocity and its change */
  double second[3][STRIDE]; /* second moments of the weights, m2, if points carry an affine field */
  double mean_second;       /* what their affine field is found from */
  double *tile;          /* nodes' lines, from the grid */
  double *sums;          /* nodes' lines, to the grid; clear between blocks */
  double prepared[PREPARED][STRIDE];
  double pending[PENDING][8]; /* sums of the cell that was scattered last, by node */
  int32_t pending_node;       /* -1: none */
  double *point_sum;          /* lanes of POINT_SUMS */
  double omega_squared;
  double speed; /* fastest component that a point was moved with */
  int beyond; /* gimp: some point's domain is longer than a cell */
  int lower[3], upper[3]; /* nodes that were added to; empty between blocks */
};

/* Points as a transfer sees them; `count` is a multiple of GAMUT_LANES, `real` of them are no
 * padding. */
struct point_view {
  size_t count, real;
  const double *position[3], *velocity[3], *mass, *volume_ratio, *stress[6];
  const double *length[3]; /* gimp: of the points' domains, m; or null */
  const double *affine[9]; /* gradient of the affine part of the velocity, by component; or null */
  const double *force[3];  /* external */
  double density;          /* reference */
  bool axisymmetric;
  bool squares; /* sums of squared mass are wanted */
};

struct locate {
  const double *position[3];
  const double *length[3]; /* gimp: of the points' domains, m; else null */
  size_t count;
  double inverse_cell;
  double origin[3]; /* in cells: of the tile's node 0, shape's shift included */
};

struct transfer {
  /* Fills place and node; widens lower and upper where `grow`. False if some point lies outside the
   * tile (or nowhere at all); then node is not to be used. */
  bool (*locate)(struct work *, const struct locate *, bool grow);
  /* Values of a line at the points: components 3 to 5, and where `velocity` 0 to 2; with gradient
   * all. */
  void (*gather)(struct work *, size_t count, bool velocity);
  void (*gather_gradient)(struct work *, size_t count, double inverse_cell,
                          double *const gradient[9]);
  /* The affine field of the velocity, components 0 to 2 of a line, around each point (apic): its
   * slope where the second moment of the weights is their mean one. */
  void (*gather_affine)(struct work *, size_t count, double cell, double *const affine[9]);
  /* Mass, momentum and forces into `sums`; or mass and momentum alone. What is still to come after
   * the last chunk of a block `finish` adds; it may be null. */
  void (*scatter)(struct work *, const struct point_view *, double cell);
  void (*scatter_momentum)(struct work *, const struct point_view *, double cell);
  void (*finish)(struct work *);
};

/* Dimension 1 to 3; `affine`: points carry an affine field. */
struct transfer transfer_of(unsigned dimension, enum shape, bool affine);

/* One table a shape, by dimension less one. */
extern const struct transfer transfers_linear[3], transfers_gimp[3], transfers_quadratic[3],
    transfers_cubic[3];
/* gather_cell.c, scatter_cell.c: put faster functions for three dimensions in their places; the
 * latter for linear shapes. */
void gather_by_cell(struct transfer *, enum shape);
void scatter_by_cell(struct transfer *);

#define TRANSFER_ENTRY(shape, dimension)                                                           \
  {                                                                                                \
    .locate = locate_##shape##_##dimension, .gather = gather_##shape##_##dimension,                \
    .gather_gradient = gather_gradient_##shape##_##dimension,                                      \
    .gather_affine = gather_affine_##shape##_##dimension,                                          \
    .scatter = scatter_##shape##_##dimension,                                                      \
    .scatter_momentum = scatter_momentum_##shape##_##dimension                                     \
  }

#endif
