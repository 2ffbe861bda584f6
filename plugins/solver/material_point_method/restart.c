/* What the solver keeps between two steps beside the points: where their blocks are, the boxes that
 * the last sweep left, and who was in contact. All by place, so that nothing depends on threads or
 * on how memory is laid out. One list serves saving and restoring. */
#include <string.h>

#include "model.h"
#include "restart.h"

/* Bytes that go out (`to`), come in (`from`), or are only counted (neither). */
struct archive {
  unsigned char *to;
  const unsigned char *from;
  size_t at, size;
  bool failed;
};

static void pass(struct archive *a, void *data, size_t bytes)
{
  if (a->from != NULL) {
    if (a->failed || bytes > a->size - a->at) {
      a->failed = true;
      return;
    }
    memcpy(data, a->from + a->at, bytes);
  } else if (a->to != NULL && bytes > 0) {
    memcpy(a->to + a->at, data, bytes);
  }
  a->at += bytes;
}

/* What is counted below must be counted the same way by who reads it. */
static void pass_layout(const struct model *m, struct archive *a)
{
  const uint64_t own[] = {POINT_SUMS,          NODE_SIZE,       m->grid.tile_nodes,
                          m->grid.block_nodes, m->planes.count, m->removal.takers};
  uint64_t found[sizeof own / sizeof *own];
  memcpy(found, own, sizeof own);
  pass(a, found, sizeof found);
  a->failed |= memcmp(found, own, sizeof own) != 0;
}

/* Puts a box's lines into a tile, as a sweep leaves them, and from there into the box. */
static void restore_box(struct model *m, size_t index, struct archive *a)
{
  struct grid *g = &m->grid;
  const struct point_block *s = &g->source[index];
  double *tile = m->work[0]->sums;
  const size_t row = (size_t)(s->upper[0] - s->lower[0]) * NODE_SIZE * sizeof *tile;
  for (int z = s->lower[2]; z < s->upper[2]; z++)
    for (int y = s->lower[1]; y < s->upper[1]; y++)
      pass(a, tile + NODE_SIZE * (s->lower[0] + g->tile * (y + g->tile * z)), row);
  if (!a->failed)
    a->failed = grid_leave(g, index, tile) != GAMUT_OK;
}

/* The box of one block of points; its nodes must lie in a tile. */
static void pass_box(struct model *m, size_t index, struct archive *a)
{
  const struct grid *g = &m->grid;
  struct point_block *s = &g->source[index];
  pass(a, s->lower, sizeof s->lower);
  pass(a, s->upper, sizeof s->upper);
  size_t nodes = 1;
  for (unsigned k = 0; k < 3 && !a->failed; k++) {
    const int end = k < g->dimension ? g->tile : 1;
    a->failed = s->lower[k] < 0 || s->upper[k] > end;
    nodes *= s->upper[k] > s->lower[k] ? (size_t)(s->upper[k] - s->lower[k]) : 0;
  }
  if (a->failed || nodes == 0) /* none where all points have left */
    return;
  if (a->from != NULL)
    restore_box(m, index, a);
  else
    pass(a, s->box, nodes * NODE_SIZE * sizeof *s->box);
}

/* The places of the blocks of points, from which the grid is built as a sort builds it. */
static void pass_places(struct model *m, struct archive *a)
{
  struct grid *g = &m->grid;
  uint64_t sources = g->sources;
  pass(a, &sources, sizeof sources);
  if (a->from == NULL) {
    for (size_t i = 0; i < sources; i++)
      pass(a, g->block[g->source[i].block].at, sizeof g->block->at);
    return;
  }
  const size_t begin = a->at, size = sizeof g->block->at;
  if (a->failed || sources > (a->size - begin) / size) {
    a->failed = true;
    return;
  }
  a->failed = grid_forget_boxes(g) != GAMUT_OK;
  g->sources = 0;
  a->failed = a->failed || grid_begin(g) != GAMUT_OK;
  int32_t at[3], number;
  for (size_t i = 0; i < sources && !a->failed; i++) {
    pass(a, at, size);
    for (int k = 0; k < 3; k++)
      a->failed |= at[k] < -GRID_REACH || at[k] > GRID_REACH;
    a->failed = a->failed || grid_block(g, at, &number) != GAMUT_OK;
  }
  a->failed = a->failed || grid_finish(g) != GAMUT_OK || grid_sources(g, sources) != GAMUT_OK;
  for (size_t i = 0; i < sources && !a->failed; i++) {
    memcpy(at, a->from + begin + i * size, size);
    grid_source(g, i, places_find(g->table, at));
  }
}

static void pass_grid(struct model *m, struct archive *a)
{
  pass_places(m, a);
  for (size_t s = 0; s < m->grid.sources && !a->failed; s++)
    pass_box(m, s, a);
}

/* What left the run so far; sums of single steps are empty between two of them. */
static void pass_removal(struct model *m, struct archive *a)
{
  struct removals *r = &m->removal;
  pass(a, &r->since_sort, sizeof r->since_sort);
  pass(a, &r->sort_due, sizeof r->sort_due);
  for (size_t i = 0; i < r->takers; i++) {
    struct taker *t = r->taker[i];
    pass(a, &t->reported, sizeof t->reported);
    pass(a, &t->total, sizeof t->total);
    pass(a, t->angular_momentum, sizeof t->angular_momentum);
    pass(a, t->of_body, m->bodies * sizeof *t->of_body);
  }
}

/* Nodes that a plane held in the last step. */
static void pass_held(struct model *m, struct plane *p, struct archive *a)
{
  size_t held = 0;
  if (a->from == NULL) {
    for (size_t c = 0; c < p->columns; c++)
      held += p->column[c].contact;
    for (size_t n = 0; n < p->nodes; n++)
      held += p->node[n].contact;
  }
  pass(a, &held, sizeof held);
  if (a->from != NULL) {
    if (a->failed || held > a->size / sizeof(int32_t[3]) ||
        places_clear(m->run, &p->held, held) != GAMUT_OK) {
      a->failed = true;
      return;
    }
    for (int32_t at[3]; held > 0 && !a->failed; held--) {
      pass(a, at, sizeof at);
      if (!a->failed)
        places_put(p->held, at, 1);
    }
    return;
  }
  for (size_t c = 0; c < p->columns; c++)
    if (p->column[c].contact)
      pass(a, p->column[c].node, sizeof p->column[c].node);
  for (size_t n = 0; n < p->nodes; n++)
    if (p->node[n].contact)
      pass(a, p->node[n].node, sizeof p->node[n].node);
}

static void pass_planes(struct model *m, struct archive *a)
{
  struct planes *ps = &m->planes;
  if (a->from != NULL && !a->failed)
    a->failed = planes_find(m) != GAMUT_OK;
  for (size_t i = 0; i < ps->count && !a->failed; i++) {
    pass(a, ps->plane[i]->reaction, sizeof *ps->plane[i]->reaction);
    pass(a, &ps->plane[i]->area, sizeof ps->plane[i]->area);
    pass_held(m, ps->plane[i], a);
  }
}

static void pass_model(struct model *m, struct archive *a)
{
  pass_layout(m, a);
  pass(a, &m->moved, sizeof m->moved);
  pass(a, &m->omega_squared, sizeof m->omega_squared);
  pass(a, &m->speed, sizeof m->speed);
  pass(a, &m->last_step, sizeof m->last_step);
  pass(a, &m->taken, sizeof m->taken);
  pass(a, &m->beyond, sizeof m->beyond);
  pass(a, &m->nodes, sizeof m->nodes);
  pass(a, m->ledger.now, sizeof m->ledger.now);
  pass(a, m->grid.origin, sizeof m->grid.origin);
  pass(a, &m->grid.empty, sizeof m->grid.empty);
  pass_grid(m, a);
  if (a->from != NULL && !a->failed)
    a->failed = totals_room(m) != GAMUT_OK;
  if (a->failed)
    return;
  pass(a, m->block_sum, m->grid.sources * POINT_SUMS * sizeof *m->block_sum);
  pass(a, m->block_most, m->grid.sources * sizeof *m->block_most);
  pass_planes(m, a);
  pass_removal(m, a);
}

size_t model_save(const void *self, void *bytes)
{
  struct archive a = {.to = bytes};
  pass_model((struct model *)(size_t)self, &a);
  return a.at;
}

gamut_status model_restore(void *self, const void *bytes, size_t size)
{
  struct model *m = self;
  struct archive a = {.from = bytes, .size = size};
  pass_model(m, &a);
  m->collected = false;
  if (!a.failed && a.at == size)
    return GAMUT_OK;
  return gamut_fail(m->run, GAMUT_OUTPUT,
                    "the state of the grid in the checkpoint does not fit this solver");
}
