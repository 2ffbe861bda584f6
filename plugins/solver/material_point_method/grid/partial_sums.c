/* The boxes of nodal sums that blocks of points leave, and their way to and from the grid. Boxes
 * are as large as what they hold; they lie in one pool, in the order in which threads come to leave
 * them, which no sum depends on. */
#include <assert.h>
#include <string.h>

#include "grid/grid.h"

static const char box_label[] = "boxes of blocks";

/* A box that the pool had no room for. */
struct spill {
  struct spill *next;
  double line[] __attribute__((aligned(64)));
};

static void drop_spills(struct grid *g)
{
  while (g->spill != NULL) {
    struct spill *next = g->spill->next;
    gamut_release(g->run, g->spill);
    g->spill = next;
  }
}

void boxes_destroy(struct grid *g)
{
  drop_spills(g);
  grid_take_back(g);
  gamut_release(g->run, g->box);
  g->box = NULL;
}

static gamut_status new_pool(struct grid *g, size_t lines)
{
  gamut_release(g->run, g->box);
  g->box = gamut_allocate(g->run, box_label, lines * NODE_SIZE * sizeof *g->box);
  g->box_capacity = g->box != NULL ? lines : 0;
  return g->box != NULL ? GAMUT_OK : GAMUT_INTERNAL;
}

/* As large as before the sort; at first, when all points are freshly sorted, a full block touches
 * side + nodes - 1 nodes along each axis. */
gamut_status boxes_create(struct grid *g)
{
  size_t nodes = 1;
  for (unsigned k = 0; k < g->dimension; k++)
    nodes *= (size_t)(g->side + g->nodes - 1);
  return new_pool(g, g->box_before > 0 ? g->box_before : g->sources * nodes + 1);
}

void *grid_lend(struct grid *g, size_t bytes, size_t kept)
{
  assert(g->box_used == 0 && g->spill == NULL);
  if (g->box != NULL) {
    gamut_release(g->run, g->box);
    g->box_before = g->box_capacity;
    g->box = NULL;
    g->box_capacity = 0;
  }
  void *memory = gamut_allocate(g->run, "sort", bytes + 1);
  if (memory != NULL && kept > 0)
    memcpy(memory, g->lent, kept);
  gamut_release(g->run, g->lent);
  g->lent = memory;
  return memory;
}

void grid_take_back(struct grid *g)
{
  gamut_release(g->run, g->lent);
  g->lent = NULL;
}

gamut_status grid_forget_boxes(struct grid *g)
{
  const size_t used = g->box_used;
  g->box_lines += used;
  drop_spills(g);
  g->box_used = 0;
  if (used <= g->box_capacity)
    return GAMUT_OK;
  return new_pool(g, used + used / 64);
}

/* Room for a box of so many nodes. */
static double *take_box(struct grid *g, size_t nodes)
{
  size_t at;
#pragma omp atomic capture
  {
    at = g->box_used;
    g->box_used += nodes;
  }
  if (at + nodes <= g->box_capacity)
    return g->box + at * NODE_SIZE;
  struct spill *spill;
#pragma omp critical(material_point_method_spill)
  {
    spill = gamut_allocate(g->run, box_label, sizeof *spill + nodes * NODE_SIZE * sizeof(double));
    if (spill != NULL) {
      spill->next = g->spill;
      g->spill = spill;
    }
  }
  return spill != NULL ? spill->line : NULL;
}

/* What of a source's box lies in the block of nodes that is neighbour o of the source's own. */
struct overlap {
  int lower[3], upper[3]; /* in nodes of the tile */
  int offset[3];          /* the tile's node that is the block's node 0 */
};

static bool overlap_of(const struct grid *g, const struct point_block *s, unsigned o,
                       struct overlap *v)
{
  for (unsigned k = 0; k < 3; k++) {
    const bool real = k < g->dimension;
    const int step = real ? (int)(o % 3) - 1 : 0;
    o /= 3;
    v->offset[k] = real ? 1 + g->side * step : 0;
    const int end = v->offset[k] + (real ? g->side : 1);
    v->lower[k] = s->lower[k] > v->offset[k] ? s->lower[k] : v->offset[k];
    v->upper[k] = s->upper[k] < end ? s->upper[k] : end;
    if (v->lower[k] >= v->upper[k])
      return false;
  }
  return true;
}

static size_t block_row(const struct grid *g, const struct overlap *v, int y, int z)
{
  const int i = v->lower[0] - v->offset[0];
  return (size_t)(i + g->side * ((y - v->offset[1]) + g->side * (z - v->offset[2])));
}

static size_t tile_row(const struct grid *g, int x, int y, int z)
{
  return (size_t)(x + g->tile * (y + g->tile * z));
}

static size_t box_row(const struct point_block *s, int x, int y, int z)
{
  const int nx = s->upper[0] - s->lower[0], ny = s->upper[1] - s->lower[1];
  return (size_t)((x - s->lower[0]) + nx * ((y - s->lower[1]) + ny * (z - s->lower[2])));
}

void grid_load(const struct grid *g, const struct point_block *s, double *tile)
{
  const struct node_block *b = &g->block[s->block];
  for (unsigned o = 0; o < g->neighbours; o++) {
    struct overlap v;
    if (!overlap_of(g, s, o, &v))
      continue;
    const double *line = g->block[b->neighbour[o]].line;
    const size_t bytes = (size_t)(v.upper[0] - v.lower[0]) * NODE_SIZE * sizeof *line;
    for (int z = v.lower[2]; z < v.upper[2]; z++)
      for (int y = v.lower[1]; y < v.upper[1]; y++)
        if (line != NULL)
          memcpy(tile + NODE_SIZE * tile_row(g, v.lower[0], y, z),
                 line + NODE_SIZE * block_row(g, &v, y, z), bytes);
        else
          memset(tile + NODE_SIZE * tile_row(g, v.lower[0], y, z), 0, bytes);
  }
}

static uint32_t reach_of(const struct grid *g, const struct point_block *s)
{
  uint32_t reach = 0;
  struct overlap v;
  for (unsigned o = 0; o < g->neighbours; o++)
    if (overlap_of(g, s, o, &v))
      reach |= UINT32_C(1) << o;
  return reach;
}

gamut_status grid_leave(struct grid *g, size_t source, double *tile)
{
  struct point_block *s = &g->source[source];
  const int nx = s->upper[0] - s->lower[0], ny = s->upper[1] - s->lower[1],
            nz = s->upper[2] - s->lower[2];
  s->reach = reach_of(g, s);
  if (nx <= 0 || ny <= 0 || nz <= 0)
    return GAMUT_OK;
  s->box = take_box(g, (size_t)nx * (size_t)ny * (size_t)nz);
  if (s->box == NULL)
    return GAMUT_INTERNAL;
  const size_t bytes = (size_t)nx * NODE_SIZE * sizeof *s->box;
  for (int z = s->lower[2]; z < s->upper[2]; z++)
    for (int y = s->lower[1]; y < s->upper[1]; y++) {
      double *row = tile + NODE_SIZE * tile_row(g, s->lower[0], y, z);
      memcpy(s->box + NODE_SIZE * box_row(s, s->lower[0], y, z), row, bytes);
      memset(row, 0, bytes);
    }
  return GAMUT_OK;
}

static void add_box(const struct grid *g, const struct point_block *s, unsigned o, double *lines)
{
  struct overlap v;
  if (!overlap_of(g, s, o, &v))
    return;
  const double *box = s->box;
  const size_t doubles = (size_t)(v.upper[0] - v.lower[0]) * NODE_SIZE;
  for (int z = v.lower[2]; z < v.upper[2]; z++)
    for (int y = v.lower[1]; y < v.upper[1]; y++) {
      const double *restrict from = box + NODE_SIZE * box_row(s, v.lower[0], y, z);
      double *restrict to = lines + NODE_SIZE * block_row(g, &v, y, z);
#pragma omp simd
      for (size_t i = 0; i < doubles; i++)
        to[i] += from[i];
    }
}

void grid_collect(const struct grid *g, const struct node_block *b, double *lines)
{
  memset(lines, 0, g->block_nodes * NODE_SIZE * sizeof *lines);
  for (unsigned o = 0; o < g->neighbours; o++) {
    if (b->neighbour[o] < 0)
      continue;
    /* seen from the neighbour, this block lies in the opposite direction */
    const unsigned opposite = g->neighbours - 1 - o;
    for (int32_t s = g->block[b->neighbour[o]].source; s >= 0; s = g->source[s].next)
      if ((g->source[s].reach >> opposite & 1) != 0)
        add_box(g, &g->source[s], opposite, lines);
  }
}
