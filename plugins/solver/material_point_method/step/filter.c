/* XPIC(m): what the points keep of their old velocity is v* = (1 - (1 - A)^m) v, where A takes a
 * velocity of the nodes to the points and back, by mass: all that the nodes can see of it, and of
 * what they cannot see less and less as m grows. As sum_r (-1)^(r-1) binomial(m, r) u_r with u_1
 * the nodes' velocity before the step and u_r = A u_(r-1). Hammerquist and Nairn, Comput. Methods
 * Appl. Mech. Eng. 318 (2017), Eqs. 27 to 30. */
#include <string.h>

#include "step/step.h"

/* In the lines of the filter: u in the place of the velocity, v* in that of its change. */
gamut_status step_filter_room(struct model *m)
{
  if (m->filter_capacity >= m->grid.capacity)
    return GAMUT_OK;
  gamut_release(m->run, m->filter_line);
  m->filter_capacity = 0;
  m->filter_line =
      gamut_allocate(m->run, "filter of velocities",
                     m->grid.capacity * m->grid.block_nodes * NODE_SIZE * sizeof *m->filter_line);
  if (m->filter_line == NULL)
    return GAMUT_INTERNAL;
  m->filter_capacity = m->grid.capacity;
  return GAMUT_OK;
}

/* A block that the filter's boxes are the first to reach has no line of its own: they reach into it
 * with a corner that no point touches. It keeps the line, clear. */
void step_swap_lines(struct model *m)
{
  for (size_t b = 0; b < m->grid.blocks; b++) {
    struct node_block *block = &m->grid.block[b];
    double *line = block->line;
    if (line == NULL)
      block->filter = NULL;
    else if (block->filter == NULL)
      memset(line, 0, m->grid.block_nodes * NODE_SIZE * sizeof *line);
    else {
      block->line = block->filter;
      block->filter = line;
    }
  }
}

/* The touched node that node `index` of a block is, or null. */
static struct touched *touched_of(const struct model *m, const struct node_block *b,
                                        size_t index)
{
  const struct planes *ps = &m->planes;
  const int32_t touched =
      ps->count > 0 && b->planes >= 0 ? ps->of_node[(size_t)b->planes + index] : -1;
  return touched < 0 ? NULL : &ps->touched[touched];
}

/* Component k of a node's velocity before the step; `line` is the node's after the update. */
static double velocity_before(const double *line, const struct touched *t, size_t k)
{
  const double change = line[NODE_CHANGE + k];
  return line[NODE_VELOCITY + k] - (t == NULL ? change * line[NODE_SLOW] : change - t->rest[k]);
}

static void begin(struct model *m)
{
  const size_t nodes = m->grid.block_nodes;
  for (size_t b = 0; b < m->grid.blocks; b++) {
    struct node_block *block = &m->grid.block[b];
    block->filter = m->filter_line + b * nodes * NODE_SIZE;
    for (size_t i = 0; i < nodes && block->line != NULL; i++) {
      const double *from = block->line + i * NODE_SIZE;
      struct touched *t = touched_of(m, block, i);
      double *to = block->filter + i * NODE_SIZE;
      memset(to, 0, NODE_SIZE * sizeof *to);
      to[NODE_FRACTION] = from[NODE_FRACTION];
      for (size_t k = 0; k < 3; k++) {
        const double before = velocity_before(from, t, k);
        to[NODE_VELOCITY + k] = to[NODE_FRACTION] * before;
        if (t != NULL)
          t->passed[k] = t->mass * before;
      }
    }
  }
}

/* The nodes' velocity to the points of a block, and back as momentum. */
static gamut_status pass_block(struct model *m, const struct body *body, size_t block,
                               size_t serial, struct work *w)
{
  const struct gamut_set *set = body->set;
  const size_t end = set->first[block + 1];
  grid_load(&m->grid, &m->grid.source[serial], w->tile);
  for (size_t at = set->first[block]; at < end; at += GAMUT_CHUNK_MAX) {
    struct point_view view = {.count = end - at < GAMUT_CHUNK_MAX ? end - at : GAMUT_CHUNK_MAX};
    view.real = real_points(set, at, view.count);
    view.mass = m->host->stored(set, m->field.mass, 0) + at;
    for (unsigned k = 0; k < 3; k++) {
      view.position[k] = m->host->stored(set, m->field.position, k) + at;
      view.velocity[k] = w->value[k];
    }
    struct locate l = locate_in(m, serial, view.position, view.count);
    for (unsigned k = 0; m->shape == SHAPE_GIMP && k < m->dimension; k++)
      l.length[k] = m->host->stored(set, m->field.domain_length, k) + at;
    if (!m->transfer.locate(w, &l, true))
      return find_lost_point(m, set, at, &l, view.position, view.velocity);
    m->transfer.gather(w, view.count, true);
    m->transfer.scatter_momentum(w, &view, m->cell);
  }
  return flush_box(m, w, serial);
}

static gamut_status pass(struct model *m)
{
  const gamut_status status = each_block(m, pass_block);
  return status != GAMUT_OK ? status : step_project(m, false);
}

/* What the nodes have of u, as momentum, becomes velocity; what planes did to it they give the
 * points by as much as this pass and those that begin from it stand for in v*. */
static void settle(struct model *m, double weight)
{
  step_settle(m);
  planes_book_pass(m, weight);
}

static void add_fraction(struct model *m, double fraction)
{
  for (size_t b = 0; b < m->grid.blocks; b++) {
    double *line = m->grid.block[b].line;
    for (size_t i = 0; i < m->grid.block_nodes && line != NULL; i++, line += NODE_SIZE)
      for (size_t k = 0; k < 3; k++)
        line[NODE_CHANGE + k] += fraction * line[NODE_VELOCITY + k];
  }
}

/* The nodes take over what was filtered. */
static void finish(struct model *m)
{
  for (size_t b = 0; b < m->grid.blocks; b++) {
    const struct node_block *block = &m->grid.block[b];
    for (size_t i = 0; i < m->grid.block_nodes && block->filter != NULL; i++) {
      double *line = block->line + i * NODE_SIZE;
      const double *filtered = block->filter + i * NODE_SIZE + NODE_CHANGE;
      for (size_t k = 0; k < 3; k++)
        line[NODE_CHANGE + k] += filtered[k];
    }
  }
}

gamut_status step_filter(struct model *m)
{
  if (step_filter_room(m) != GAMUT_OK)
    return GAMUT_INTERNAL;
  begin(m);
  step_swap_lines(m);
  gamut_status status = GAMUT_OK;
  double fraction = m->filter,
         left = 1.0; /* of all fractions, those of this pass and of later ones */
  settle(m, left);
  add_fraction(m, fraction);
  for (int r = 2; r <= m->filter && status == GAMUT_OK; r++) {
    status = pass(m);
    if (status != GAMUT_OK)
      break;
    left -= fraction;
    fraction *= -(double)(m->filter - r + 1) / r;
    planes_before_pass(m);
    settle(m, left);
    add_fraction(m, fraction);
  }
  step_swap_lines(m);
  if (status == GAMUT_OK)
    finish(m);
  return status;
}
