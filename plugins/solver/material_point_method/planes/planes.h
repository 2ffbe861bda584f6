/* Planes: what walls, symmetry and prescribed velocities do to the grid.
 *
 * A plane at rest whose normal lies along an axis falls on a plane of nodes. With shapes
 * that reach beyond a cell (all but linear) it is then made by images: material behind it is the
 * mirror image of the material before it, so the sums of the node one behind are added to those of
 * the node one before (what is odd with its sign turned), and after the update the node behind gets
 * the image of the velocity. With linear shapes, for a plane that moves along its normal and for an
 * oblique one the condition holds node by node, at the nodes on or behind the plane. */
#ifndef MATERIAL_POINT_METHOD_PLANES_H
#define MATERIAL_POINT_METHOD_PLANES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/host.h>

#include "grid/grid.h"

struct model;

enum { PLANES_MAX = 64, BEFORE = 0, ON = 1, BEHIND = 2 };

/* Sums over the touched nodes of a block, which are left out of its other sums. */
enum plane_sum {
  PLANE_NODES, /* what updates sum at all others */
  PLANE_WORK = PLANE_NODES + TOTAL_SUMS,
  PLANE_LOSS,
  PLANE_ROUND,
  PLANE_BACK_ROUND = PLANE_ROUND + 3,
  PLANE_SUMS = PLANE_BACK_ROUND + 3
};

/* After these, for each plane. */
enum each_plane_sum { EACH_WORK, EACH_AREA, EACH_MASS, EACH_PLANE_SUMS };

/* Nodes across a plane that is made by images; -1 where there is none. */
struct column {
  int32_t node[3];    /* the one on the plane */
  int32_t touched[3]; /* BEFORE, ON, BEHIND */
  bool contact;       /* in this step */
  bool arrives;       /* and not in the step before */
};

/* A node with the condition at itself. */
struct held_node {
  int32_t node[3];
  int32_t touched;
  bool contact;
};

/* A node that some plane acts on, as it was before planes acted. */
struct touched {
  int32_t block; /* of nodes */
  int32_t index; /* in the block */
  int32_t row;   /* of the block's sums */
  double x[3];
  double mass;
  union {
    double momentum[3];
    double all_mass; /* when planes report: with that of the images of this node */
  };
  union {
    double force[3];
    double passed[3];    /* then; xpic: momentum that a pass left here, before planes */
    double all_given[3]; /* when planes report: momentum given, with the images */
  };
  union {
    double rest[3]; /* change of velocity that only the points' velocity gets */
    double back[3]; /* then: velocity that walls give back */
  };
  double given[3]; /* momentum that planes gave the points here in this step */
  int8_t owner[3]; /* plane that its impulse is booked to, by component */
  int8_t first;    /* the first plane that touches it */
  bool image;      /* of another node, by a plane that material cannot leave */
};

struct plane {
  struct gamut_plane given;
  struct gamut_reaction *reaction;
  int axis, sign; /* of the normal; axis -1: oblique */
  bool moves, images;
  bool odd[3];   /* by component: the velocity's difference from the plane's turns its sign */
  int32_t level; /* node number of the plane along its axis */
  double impulse[3], area;
  double contact_mass, axis_area; /* of nodes in contact: mass, area of the axis of revolution */
  double densest;                 /* of all its nodes: largest mass an area */
  struct column *column;
  size_t columns, column_capacity;
  struct held_node *node; /* with the condition node by node */
  size_t nodes, node_capacity;
  struct place_table *held; /* nodes in contact in the last step */
};

struct planes {
  struct plane *plane[PLANES_MAX];
  size_t count;
  bool any_moves;
  double fastest; /* speed of a plane along its normal */
  struct touched *touched;
  size_t touches, touched_capacity;
  int32_t *of_node; /* numbers of touched nodes, or -1, of the blocks that have some */
  size_t of_nodes, of_node_capacity;
  double *row; /* sums of the blocks that have touched nodes */
  size_t row_capacity;
  double work,
      loss; /* by moving planes on the material, and by impact and friction, in this step */
  /* what planes gave in this step, and moments of it about the origin, by the sign: the material of
   * a box at rest is pushed from both sides, and the sum of that is all rounding */
  double forward[3], backward[3], round[3], back_round[3];
};

gamut_status planes_add(struct model *, const struct gamut_plane *, const struct gamut_reaction **);
void planes_destroy(struct model *);
/* Puts the grid's origin so that planes fall on nodes; an error where that cannot be. */
gamut_status planes_fix_origin(struct model *);
/* Finds the nodes that planes act on; after a sort, and in each step where a plane moves. */
gamut_status planes_find(struct model *);
/* Between the sums and the update of the grid, and after it. */
void planes_before_update(struct model *);
gamut_status planes_after_update(struct model *, double step);
/* The same for the second pass of MUSL: momentum and mass, then velocity. */
void planes_before_second(struct model *);
void planes_after_second(struct model *);
/* reaction.c: sums over touched nodes begin anew. */
void planes_begin_sums(struct model *);
/* Books momentum given and work of the step, remembers contact. */
gamut_status planes_book(struct model *, double step);
/* xpic: the nodes' momentum as a pass left it; and, when planes have acted on it, what of that the
 * points get by `weight`. */
void planes_before_pass(struct model *);
void planes_book_pass(struct model *, double weight);
/* When all is given: a wall that material may leave takes back what it pulled; then each plane's
 * reaction. */
void planes_report(struct model *, double step);
/* reaction.c: the area in contact, begun anew in each step, by the nodes that are. */
void contact_begin(struct plane *);
void contact_see(const struct model *, struct plane *, const struct touched *);
void contact_add(struct model *, size_t plane, const struct touched *);
/* Line of the touched node of that number; null for -1. */
double *touched_line(const struct model *, int32_t touched);
/* Signed distance of a place from a plane, positive where material may be. */
double plane_distance(const struct plane *, const double x[3], double time);

#endif
