/* Points that leave the run: who takes them out, and what they take along. */
#ifndef MATERIAL_POINT_METHOD_REMOVAL_H
#define MATERIAL_POINT_METHOD_REMOVAL_H

#include <gamut/host.h>

/* What points had that left a block. */
enum gone_sum {
  GONE_POINTS,
  GONE_MASS,
  GONE_MOMENTUM,
  GONE_ANGULAR_MOMENTUM = GONE_MOMENTUM + 3,
  GONE_KINETIC = GONE_ANGULAR_MOMENTUM + 3,
  GONE_INTERNAL,
  GONE_SUMS
};

struct taker {
  const char *name;
  const bool *on_body; /* null: of all bodies */
  bool lost, reported;
  double most; /* share of a body's mass; 0: all */
  struct gamut_removed total;
  double angular_momentum[3];
  double *of_body; /* mass taken of each body */
  double *mass_line, *energy_line, *momentum_line[3], *angular_momentum_line[3]; /* or null */
};

/* The first of the points that are nowhere in this step, by set and id. */
struct lost_points {
  size_t count, slot;
  const struct gamut_set *set;
  const char *what;
};

struct removals {
  struct taker **taker; /* a mark is the number of its taker, from 1 */
  size_t takers;
  struct taker *outside; /* takes what leaves the domain; null: the run stops */
  double *body_mass;     /* at the start */
  double *gone;          /* GONE_SUMS a taker, of each block of points */
  size_t room;
  double *sum;           /* the same of a step, a row a body and one of all */
  double now[GONE_SUMS]; /* of the step just taken */
  double second;         /* of affine velocity fields: the mean second moment of the weights, m2 */
  size_t since_sort;     /* points that left */
  bool sort_due;
  struct lost_points lost_points;
};

struct model;
struct locate;

/* The operation `removal` of the solver. */
gamut_status removal_add(void *self, const char *name, const bool *on_body,
                         const struct gamut_removal *, const struct gamut_removed **, double *mark);
/* For what leaves the domain. */
gamut_status removal_open_domain(struct model *);
void removal_destroy(struct model *);
/* After the points are there: what bodies have, and whether all of it is somewhere. */
gamut_status removal_start(struct model *);
/* Room for sums, after blocks of points have changed. */
gamut_status removal_room(struct model *);

/* In a sweep, before a chunk is scattered: points that leave become massless. */
gamut_status removal_take(struct model *, const struct gamut_chunk *);
/* Whether lost points of a body leave, so that nobody need stop for them. */
bool removal_of_lost(const struct model *, size_t body);
/* Where points move in a sweep of their own, after that: those that are then nowhere go. */
void removal_take_moved(struct model *, const struct gamut_chunk *);
/* After a step: adds up what left and takes it out of the sets; says which points are lost. */
gamut_status removal_keep(struct model *);
/* After the ledger: whether somebody took too much. */
gamut_status removal_check(struct model *);

/* Points that lie outside the tile or the domain: the step is finished, then the run stops. */
void lost_point_note(struct model *, const struct gamut_set *, size_t slot, const char *what);
gamut_status lost_point_outside_tile(struct model *, const struct gamut_set *, size_t slot,
                                     const struct locate *, const double *const x[3],
                                     const double *const v[3]);
void lost_point_outside_domain(struct model *, const struct gamut_set *, size_t slot, size_t count,
                               const double *const x[3], const double *mass);
/* Points whose time step has no bound that is a number. */
void lost_point_without_step(struct model *, const struct gamut_chunk *,
                             const double *omega_squared);
gamut_status lost_point_fail(struct model *);

#endif
