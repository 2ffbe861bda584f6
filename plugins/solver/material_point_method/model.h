/* What the files of this solver share: the model that is marched, and who does what. */
#ifndef MATERIAL_POINT_METHOD_MODEL_H
#define MATERIAL_POINT_METHOD_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "material_point_method.gamut.h"

#include "planes/planes.h"
#include "grid/grid.h"
#include "points/removal.h"
#include "transfer/transfer.h"

enum geometry { GEOMETRY_1D, GEOMETRY_PLANE_STRAIN, GEOMETRY_AXISYMMETRIC, GEOMETRY_3D };

/* When the velocity gradient is taken: from the updated velocity; from that of the momentum which
 * the points give back before they move, or after. */
enum stress_update { UPDATE_USL, UPDATE_MUSL, UPDATE_USF };

/* What the points' new velocity is made of. */
enum rule { RULE_FLIP, RULE_PIC, RULE_APIC, RULE_XPIC };

/* Sums over the points of a block, one line of GAMUT_LANES partial sums each: lane = slot mod
 * lanes, so that the size of a chunk cannot matter. */
enum point_sum {
  SUM_MASS,
  SUM_MOMENTUM,
  SUM_FORWARD = SUM_MOMENTUM + 3,         /* the positive parts of it */
  SUM_ANGULAR_MOMENTUM = SUM_FORWARD + 3, /* moment of momentum about the origin */
  SUM_ROUND = SUM_ANGULAR_MOMENTUM + 3,   /* the positive parts of it */
  SUM_KINETIC = SUM_ROUND + 3,
  SUM_INTERNAL,
  SUM_FORCE, /* external */
  SUM_TORQUE = SUM_FORCE + 3,
  SUM_POWER = SUM_TORQUE + 3, /* external force times velocity */
  SUM_MOBILITY,               /* half the external force squared over the mass */
  SUM_HEAT,                   /* that points were given */
  POINT_SUMS
};

/* Most numbers a point that a measure adds up. */
enum { MEASURED = 2 };

/* Room for rows of sums, by numbers. */
struct totals {
  double *measured; /* a row a block of points, of one measure */
  size_t measured_capacity, most_capacity, sum_capacity, node_capacity, speed_capacity;
};

struct body {
  const struct gamut_body *scene;
  struct gamut_set *set;
  double density;
  double lower[3], spacing[3]; /* of the lattice that its points are laid on */
  long count[3];
  size_t points;
  size_t *before; /* points before each layer of the lattice, while they are laid */
};

/* Lines of the ledger and the running totals behind them. */
struct ledger {
  double now[POINT_SUMS]; /* sums over all points at the end of the last step */
  double *mass, *kinetic, *internal, *stagger;
  double *forward[3], *backward[3], *round[3], *back_round[3];
  double *external_work, *plane_work, *impact_loss, *scatter_loss, *gather_loss, *remainder, *heat;
  double *external_impulse[3], *plane_forward[3], *plane_backward[3];
  double *external_torque[3], *plane_round[3], *plane_back_round[3], *angular_momentum_loss[3];
};

struct fields {
  struct gamut_field position, velocity, mass, volume_ratio, stress, energy, velocity_gradient,
      external_force, sound_speed, omega_squared, cell_size, reference_volume, domain_length,
      affine_velocity, viscous_pressure, removal, transfer_heat;
};

/* The most that the points of a block have. */
struct block_most {
  double omega_squared, speed;
};

/* Counts of work for the summary. */
struct work_counts {
  uint64_t *slots, *node_lines, *box_lines, *sorts;
};

struct model {
  struct gamut_run *run;
  const struct gamut_host *host;
  enum geometry geometry;
  unsigned dimension;
  enum shape shape;
  enum stress_update stress_update;
  enum rule rule;
  bool limited;    /* one pass with linear functions: forces on nearly empty nodes are kept down */
  int filter;      /* m of XPIC(m) */
  bool contiguous; /* gimp: domains follow the stretch */
  double cell, courant, fixed_step;
  double pic;      /* share of the nodes' velocity itself in the points' new one */
  double give_old; /* share of their velocity before the step that goes with its change: pic, but
                      with xpic none, which filters it first */
  bool bounded;
  double lower[3], upper[3]; /* domain */
  int points_per_cell;       /* by default, along one axis */

  struct fields field;
  struct body *body;
  size_t bodies;
  struct grid grid;
  bool origin_fixed[3];
  struct planes planes;
  struct removals removal;
  struct transfer transfer;
  struct work **work; /* one a thread */
  int threads;

  double *filter_line; /* as grid.line, for what XPIC filters and for passes of others */
  size_t filter_capacity;
  const struct gamut_grid_pass *pass; /* the one under way */

  double *block_sum; /* POINT_SUMS a block of points */
  struct block_most *block_most;
  double *node_sum;   /* TOTAL_SUMS a block of nodes */
  double *node_speed; /* one a block of nodes */
  struct totals totals;
  struct nodes nodes; /* of the last update */

  bool collected;       /* the grid holds this step's sums already */
  double moved;         /* farthest that a point can have gone since the sort, cells */
  double omega_squared; /* largest of all points */
  double speed;         /* fastest component that a point was moved with */
  double last_step;
  uint64_t taken; /* steps */
  bool beyond;    /* the user knows of domains longer than a cell */
  struct ledger ledger;
  struct work_counts counts;
};

/* read.c */
gamut_status model_read(struct model *, const struct gamut_values *);
/* Of a scheme that does not converge for these bodies. */
void model_warn(const struct model *);

/* points/layout.c: the points of the bodies. */
gamut_status layout_bodies(struct model *, const struct gamut_values *);
gamut_status layout_fill(struct model *);
/* The place `at` of a body's lattice. */
void layout_place(const struct body *, unsigned dimension, const long at[3], double x[3]);
/* Points that the scene lists; null and 0 where it does not. */
size_t layout_listed(const struct model *, const struct body *, const double **place,
                     const double **volume);
/* Chooses the grid's origin along the axes that no plane has fixed. */
void layout_origin(struct model *);

/* grid/sort.c */
gamut_status sort_points(struct model *);

/* step/ */
gamut_status step_register(struct model *);
gamut_status step_first_scatter(struct model *);

/* step/update.c */
/* The mass that a node's acceleration is taken with where it enters strain and places. A nearly
 * empty node may get a force out of all proportion to its mass: its share in the points' velocity
 * stays what it is, but it must not tear them. With linear functions and one pass that goes for
 * nodes with less than the mean mass of the points that they see (`square`: sum N m^2). */
double step_slow_mass(const struct model *, double mass, double square);
gamut_status step_collect(struct model *);
gamut_status step_update_grid(void *self, const struct gamut_chunk *);
gamut_status step_update_again(void *self, const struct gamut_chunk *);
/* Nodes' momentum in the place of their velocity becomes velocity that heeds the planes. */
void step_settle(struct model *);
/* The boxes' momentum in the place of the nodes' velocity. With `carry` the velocity that stood
 * there moves to the place of its change; without, that place is left alone. */
gamut_status step_project(struct model *, bool carry);

/* step/filter.c: the part of the points' new velocity that comes from their old one, in the place
 * of the nodes' change of velocity, which is added to it. */
gamut_status step_filter(struct model *);
/* Lines beside those of the blocks, and the one in the place of the other; the same to undo it. */
gamut_status step_filter_room(struct model *);
void step_swap_lines(struct model *);

/* step/pass.c: gamut_host.grid_pass */
gamut_status step_pass(struct model *, const struct gamut_grid_pass *);

/* points/sums.c: energy may be null, forces not. */
void sums_motion(struct work *, const struct point_view *, unsigned dimension,
                 const double *energy);
void sums_forces(struct work *, const struct point_view *);

/* ledger.c */
gamut_status ledger_open(struct model *);
/* The lines of who takes points out. */
gamut_status ledger_open_taker(struct model *, struct taker *);
void ledger_start(struct model *);
void ledger_keep(struct model *, double step);
/* Sums over all points. */
void ledger_add_up(const struct model *, double total[POINT_SUMS]);

/* totals.c */
/* Room for sums, after blocks of points and nodes have changed. */
gamut_status totals_room(struct model *);
/* The same for what planes sum, after they have found their nodes. */
gamut_status totals_planes_room(struct model *);
void totals_destroy(struct model *);

/* points/measures.c */
gamut_status measure_value(struct model *, const char *name, const struct gamut_body *,
                           const struct gamut_values *, double *value);

/* points/pairs.c: warns, once a pair, of bodies so close that they share nodes. */
gamut_status pairs_warn(struct model *);

/* points/fragments.c: in how many fragments the grid sees the points of a set. */
gamut_status body_fragments(struct model *, const struct gamut_set *, double *fragments);

/* The model's own error texts about a point. */
gamut_status point_failed(struct model *, const struct gamut_set *, size_t slot, const double x[3],
                          const double v[3], const char *what);

#endif
