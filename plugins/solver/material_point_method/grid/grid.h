/* The background grid: sparse blocks of nodes, and the boxes of nodal sums that blocks of points
 * leave.
 *
 * Space is cut into blocks of side^d cells. A block of points (of one body) adds its points into a
 * tile of its own, one cell wider than the block on each side so that points may wander between two
 * sorts, and leaves the part of the tile that it touched as a box. A block of nodes adds the boxes
 * of its 3^d neighbours in a fixed order, so no bit depends on threads. */
#ifndef MATERIAL_POINT_METHOD_GRID_H
#define MATERIAL_POINT_METHOD_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/host.h>

enum {
  NODE_SIZE = 8,  /* doubles a node: mass, momentum x y z, force x y z, squared mass */
  NEIGHBOURS = 27 /* at most */
};
/* A line after the sums ... NODE_SQUARE is the sum of N m^2 of the points where the model asks for
 * it, else 0; planes make it negative at nodes that they act on. */
enum { NODE_MASS = 0, NODE_MOMENTUM = 1, NODE_FORCE = 4, NODE_SQUARE = 7 };
/* ... and after the update. NODE_CHANGE is what the points' velocity gets: the step's
 * change of velocity, of which the part NODE_SLOW is in NODE_VELOCITY, and a share of the velocity
 * before. In the second pass of MUSL the first new velocity moves there, and NODE_VELOCITY is the
 * re-projected one. */
enum { NODE_VELOCITY = 0, NODE_CHANGE = 3, NODE_FRACTION = 6, NODE_SLOW = 7 };

/* Sums over the nodes of a block in one grid update. */
enum node_sum {
  TOTAL_BEFORE, /* kinetic energy */
  TOTAL_AFTER,
  TOTAL_WORK,             /* of all forces */
  TOTAL_ANGULAR_MOMENTUM, /* moment of momentum after it */
  TOTAL_SUMS = TOTAL_ANGULAR_MOMENTUM + 3
};

/* All nodes of one grid update. */
struct nodes {
  double sum[TOTAL_SUMS];
  double speed; /* fastest component */
};

struct node_block {
  int32_t at[3]; /* its place, in blocks */
  int32_t
      neighbour[NEIGHBOURS]; /* number of the block there, or -1; x fastest, itself in the middle */
  int32_t source;            /* first block of points here, or -1 */
  bool reached;   /* by a box, before a sort */
  int32_t planes; /* where planes keep what they know of its nodes, or -1 */
  double *line;   /* its nodes' lines; null until a box reaches it */
  double *filter; /* and their lines in a filter of velocities */
};

/* A block of points, seen from the grid. */
struct point_block {
  int32_t block;              /* the block of nodes at its place */
  int32_t next;               /* next block of points at this place, or -1 */
  int32_t lower[3], upper[3]; /* nodes of the tile from lower to upper - 1 hold its sums */
  uint32_t reach;             /* neighbours that the box overlaps, one bit each */
  uint32_t opened;            /* neighbours that are known to have lines */
  double *box;                /* these nodes' lines, x fastest */
};

struct spill;
struct line_page;

/* From places (three whole numbers) to numbers. */
struct place_table;

/* Makes a table for that many places, or clears one that is large enough. */
gamut_status places_clear(struct gamut_run *, struct place_table **, size_t places);
void places_free(struct gamut_run *, struct place_table *);
void places_put(struct place_table *, const int32_t at[3], int32_t number);
int32_t places_find(const struct place_table *, const int32_t at[3]); /* -1: not there */

struct grid {
  struct gamut_run *run;
  unsigned dimension;
  int nodes;      /* that a point touches, along each axis */
  int side, tile; /* cells a block, nodes a tile, along each axis */
  int side_bits;  /* side = 1 << side_bits */
  size_t block_nodes, tile_nodes;
  unsigned neighbours; /* 3^d */
  double cell, inverse_cell;
  double origin[3]; /* a node */
  double shift;     /* from the lowest node that a point touches to its cell, in cells */
  double empty;     /* a node with no more mass than this is nearly empty */

  size_t blocks, capacity;
  struct node_block *block;
  struct place_table *table;
  size_t spare_blocks, spare_capacity; /* what the last sort left, taken by the next */
  struct node_block *spare_block;
  struct place_table *spare_table;
  struct line_page *page; /* where lines of blocks lie */
  double *free_line;      /* first of the lines that no block has */
  bool opened;            /* blocks got lines since planes were found */

  size_t sources, source_capacity;
  struct point_block *source; /* in the order of chunk.serial */
  double *box;           /* pool of boxes */
  size_t box_capacity, box_used; /* in lines */
  size_t box_before;             /* capacity before the sort */
  void *lent;
  uint64_t box_lines;            /* of all boxes that were left so far */
  struct spill *spill;
};

/* `nodes` and `shift` are the shape functions' (shapes.h). */
gamut_status grid_create(struct grid *, struct gamut_run *, unsigned dimension, int nodes,
                         double shift, double cell);
void grid_destroy(struct grid *);

/* Places are good to GRID_REACH cells from the origin. */
enum { GRID_REACH = 1000000 };

/* The block that holds the cell, and the cell's number in it (x fastest). */
static inline int32_t grid_block_of(const struct grid *g, int32_t cell)
{
  return cell >> g->side_bits;
}

/* A new grid of blocks begins: grid_begin, then grid_block for each place of a block of points,
 * then grid_finish, which adds the neighbours and carries over the lines of places that stay. */
gamut_status grid_begin(struct grid *);
gamut_status grid_block(struct grid *, const int32_t at[3], int32_t *number);
gamut_status grid_finish(struct grid *);
/* Room for so many blocks of points. */
gamut_status grid_sources(struct grid *, size_t sources);
/* Enters source number `index` at the block; its box is the whole tile until it leaves another. */
void grid_source(struct grid *, size_t index, int32_t block);

/* The block of a node and its number in it; null where the grid has none. */
struct node_block *grid_block_at(const struct grid *, const int32_t node[3], size_t *index);
/* Gives a block lines, zero, if it has none. */
gamut_status grid_open(struct grid *, struct node_block *);
/* Gives lines to the blocks that boxes reach. */
gamut_status grid_open_reached(struct grid *);
/* Nodes of a block, from lower to upper - 1 along each axis, that points may touch before the next
 * sort; false where there are none. */
bool grid_reachable(const struct grid *, const struct node_block *, int lower[3], int upper[3]);
/* Place of node `index` of a block. */
void grid_node(const struct grid *, const struct node_block *, size_t index, int32_t node[3]);

/* Nodes of a source's box from the grid into a tile, and from a tile into the box (the tile is left
 * clear). */
void grid_load(const struct grid *, const struct point_block *, double *tile);
gamut_status grid_leave(struct grid *, size_t source, double *tile);
/* Adds up the boxes around a block. `lines` has room for block_nodes lines. */
void grid_collect(const struct grid *, const struct node_block *, double *lines);
/* After all blocks of nodes have collected: the boxes are done with. */
gamut_status grid_forget_boxes(struct grid *);
gamut_status boxes_create(struct grid *);
/* Memory for a sort, in which there are no boxes and their pool is away; its first `kept` bytes are
 * those of what was lent before. Null where there is none. */
void *grid_lend(struct grid *, size_t bytes, size_t kept);
void grid_take_back(struct grid *);
void boxes_destroy(struct grid *);

#endif
