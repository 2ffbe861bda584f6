#include "planes/planes.h"

#include <math.h>
#include <string.h>

#include "model.h"

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double plane_distance(const struct plane *p, const double x[3], double time)
{
  double d = 0.0;
  for (int k = 0; k < 3; k++)
    d += (x[k] - p->given.point[k]) * p->given.normal[k];
  return d - time * dot(p->given.velocity, p->given.normal);
}

double *touched_line(const struct model *m, int32_t touched)
{
  if (touched < 0)
    return NULL;
  const struct touched *t = &m->planes.touched[touched];
  return m->grid.block[t->block].line + (size_t)t->index * NODE_SIZE;
}

gamut_status planes_add(struct model *m, const struct gamut_plane *given,
                        const struct gamut_reaction **reaction)
{
  struct planes *ps = &m->planes;
  if (ps->count == PLANES_MAX)
    return gamut_fail(m->run, GAMUT_SCENE, "more than %d planes", PLANES_MAX);
  for (unsigned k = m->dimension; k < 3; k++)
    if (fabs(given->normal[k]) > 1e-12)
      return gamut_fail(
          m->run, GAMUT_SCENE,
          "the normal of a plane has a component along %c, which this geometry has not", "xyz"[k]);
  struct plane *p = gamut_allocate(m->run, "planes", sizeof *p);
  struct gamut_reaction *r = gamut_allocate(m->run, "planes", sizeof *r);
  if (p == NULL || r == NULL)
    return GAMUT_INTERNAL;
  p->given = *given;
  p->reaction = r;
  p->axis = -1;
  for (int k = 0; k < 3; k++)
    if (fabs(fabs(given->normal[k]) - 1.0) < 1e-12) {
      p->axis = k;
      p->sign = given->normal[k] > 0.0 ? 1 : -1;
    }
  p->moves = dot(given->velocity, given->normal) != 0.0;
  p->images = m->shape != SHAPE_LINEAR && p->axis >= 0 && !p->moves;
  for (int k = 0; k < 3; k++)
    p->odd[k] = (k == p->axis ? given->normal_rule != GAMUT_PLANE_FREE
                              : given->tangential_rule == GAMUT_PLANE_PRESCRIBED);
  ps->any_moves |= p->moves;
  ps->fastest = fmax(ps->fastest, fabs(dot(given->velocity, given->normal)));
  /* planes that material cannot leave come first: what they fold away, a wall then does not see */
  size_t at = ps->count++;
  while (at > 0 && !given->unilateral && ps->plane[at - 1]->given.unilateral) {
    ps->plane[at] = ps->plane[at - 1];
    at--;
  }
  ps->plane[at] = p;
  if (reaction != NULL)
    *reaction = r;
  return GAMUT_OK;
}

void planes_destroy(struct model *m)
{
  struct planes *ps = &m->planes;
  for (size_t i = 0; i < ps->count; i++) {
    gamut_release(m->run, ps->plane[i]->column);
    gamut_release(m->run, ps->plane[i]->node);
    places_free(m->run, ps->plane[i]->held);
    gamut_release(m->run, ps->plane[i]->reaction);
    gamut_release(m->run, ps->plane[i]);
  }
  gamut_release(m->run, ps->touched);
  gamut_release(m->run, ps->of_node);
}

gamut_status planes_fix_origin(struct model *m)
{
  for (size_t i = 0; i < m->planes.count; i++) {
    struct plane *p = m->planes.plane[i];
    if (p->axis < 0)
      continue;
    const int k = p->axis;
    const double at = p->given.point[k];
    if (!m->origin_fixed[k]) {
      m->grid.origin[k] = at;
      m->origin_fixed[k] = true;
    }
    const double apart = fabs(at - m->grid.origin[k]), cells = apart / m->cell;
    p->level = (int32_t)lround((at - m->grid.origin[k]) / m->cell);
    if (!p->moves && fabs(cells - round(cells)) > 1e-6)
      return m->host->fail_plane(
          m->run, p->reaction, GAMUT_SCENE,
          "planes at %c = %g m and %g m are %g cells apart, but planes must fall on nodes; "
          "solver.cell = %.9g m does it",
          "xyz"[k], m->grid.origin[k], at, cells, apart / ceil(cells));
  }
  return GAMUT_OK;
}

/* An array with room for one more. */
static gamut_status room(struct model *m, void **array, size_t item, size_t used, size_t *capacity)
{
  if (used < *capacity)
    return GAMUT_OK;
  const size_t wanted = used + used / 8 + 64;
  void *larger = gamut_allocate(m->run, "planes", wanted * item);
  if (larger == NULL)
    return GAMUT_INTERNAL;
  if (used > 0)
    memcpy(larger, *array, used * item);
  gamut_release(m->run, *array);
  *array = larger;
  *capacity = wanted;
  return GAMUT_OK;
}

static void node_place(const struct model *m, const int32_t node[3], double x[3])
{
  for (unsigned k = 0; k < 3; k++)
    x[k] = k < m->dimension ? m->grid.origin[k] + m->cell * node[k] : 0.0;
}

/* Room for the numbers of a block's nodes. */
static gamut_status numbers_of(struct model *m, struct node_block *b)
{
  struct planes *ps = &m->planes;
  if (b->planes >= 0)
    return GAMUT_OK;
  const size_t nodes = m->grid.block_nodes, used = ps->of_nodes / nodes;
  size_t capacity = ps->of_node_capacity / nodes;
  void *array = ps->of_node;
  if (room(m, &array, nodes * sizeof *ps->of_node, used, &capacity) != GAMUT_OK)
    return GAMUT_INTERNAL;
  ps->of_node = array;
  ps->of_node_capacity = capacity * nodes;
  b->planes = (int32_t)ps->of_nodes;
  ps->of_nodes += nodes;
  for (size_t i = 0; i < nodes; i++)
    ps->of_node[(size_t)b->planes + i] = -1;
  return GAMUT_OK;
}

/* The number of the touched node, entered for plane number `plane`; -1 where the grid has no node.
 */
static gamut_status touch(struct model *m, const int32_t node[3], size_t plane, int32_t *number)
{
  struct planes *ps = &m->planes;
  size_t index;
  *number = -1;
  struct node_block *b = grid_block_at(&m->grid, node, &index);
  if (b == NULL)
    return GAMUT_OK;
  if (grid_open(&m->grid, b) != GAMUT_OK || numbers_of(m, b) != GAMUT_OK)
    return GAMUT_INTERNAL;
  int32_t *known = &ps->of_node[(size_t)b->planes + index];
  if (*known < 0) {
    void *array = ps->touched;
    if (room(m, &array, sizeof *ps->touched, ps->touches, &ps->touched_capacity) != GAMUT_OK)
      return GAMUT_INTERNAL;
    ps->touched = array;
    struct touched *t = &ps->touched[ps->touches];
    memset(t, 0, sizeof *t);
    t->block = (int32_t)(b - m->grid.block);
    t->index = (int32_t)index;
    t->row = b->planes / (int32_t)m->grid.block_nodes;
    t->first = (int8_t)plane;
    t->owner[0] = t->owner[1] = t->owner[2] = -1;
    node_place(m, node, t->x);
    *known = (int32_t)ps->touches++;
  }
  *number = *known;
  const struct plane *p = ps->plane[plane];
  for (int k = 0; k < 3; k++)
    if ((p->axis < 0 || p->odd[k]) && ps->touched[*number].owner[k] < 0)
      ps->touched[*number].owner[k] = (int8_t)plane;
  return GAMUT_OK;
}

static gamut_status find_column(struct model *m, size_t plane, const int32_t node[3])
{
  struct plane *p = m->planes.plane[plane];
  struct column c = {.node = {node[0], node[1], node[2]}};
  for (int k = BEFORE; k <= BEHIND; k++) {
    int32_t at[3] = {node[0], node[1], node[2]};
    at[p->axis] += p->sign * (ON - k);
    if (touch(m, at, plane, &c.touched[k]) != GAMUT_OK)
      return GAMUT_INTERNAL;
  }
  void *array = p->column;
  if (room(m, &array, sizeof c, p->columns, &p->column_capacity) != GAMUT_OK)
    return GAMUT_INTERNAL;
  p->column = array;
  p->column[p->columns++] = c;
  return GAMUT_OK;
}

static gamut_status find_node(struct model *m, size_t plane, const int32_t node[3])
{
  struct plane *p = m->planes.plane[plane];
  struct held_node held = {.node = {node[0], node[1], node[2]}};
  if (touch(m, node, plane, &held.touched) != GAMUT_OK)
    return GAMUT_INTERNAL;
  void *array = p->node;
  if (room(m, &array, sizeof held, p->nodes, &p->node_capacity) != GAMUT_OK)
    return GAMUT_INTERNAL;
  p->node = array;
  p->node[p->nodes++] = held;
  return GAMUT_OK;
}

/* Distance of a node from a plane in cells. */
static double node_distance(const struct model *m, const struct plane *p, const int32_t node[3])
{
  if (p->axis >= 0 && !p->moves)
    return p->sign * (node[p->axis] - p->level);
  double x[3];
  node_place(m, node, x);
  return plane_distance(p, x, gamut_time(m->run)) / m->cell;
}

static gamut_status find_in_block(struct model *m, size_t plane, const struct node_block *b)
{
  const struct plane *p = m->planes.plane[plane];
  int32_t middle[3], node[3];
  int lower[3], upper[3];
  double reach = 0.0;
  for (unsigned k = 0; k < 3; k++) {
    middle[k] = k < m->dimension ? b->at[k] * m->grid.side + m->grid.side / 2 : 0;
    reach += fabs(p->given.normal[k]) * m->grid.side;
  }
  if (node_distance(m, p, middle) > reach || !grid_reachable(&m->grid, b, lower, upper))
    return GAMUT_OK;
  for (size_t i = 0; i < m->grid.block_nodes; i++) {
    grid_node(&m->grid, b, i, node);
    bool reachable = true;
    for (unsigned k = 0; k < m->dimension; k++) {
      const int at = node[k] - b->at[k] * m->grid.side;
      reachable = reachable && at >= lower[k] && at < upper[k];
    }
    if (!reachable)
      continue;
    const double d = node_distance(m, p, node);
    gamut_status status = GAMUT_OK;
    if (p->images && d == 0.0)
      status = find_column(m, plane, node);
    else if (d < (p->images ? -1.5 : 1e-9))
      status = find_node(m, plane, node);
    if (status != GAMUT_OK)
      return status;
  }
  return GAMUT_OK;
}

gamut_status planes_find(struct model *m)
{
  struct planes *ps = &m->planes;
  ps->touches = ps->of_nodes = 0;
  for (size_t b = 0; b < m->grid.blocks; b++)
    m->grid.block[b].planes = -1;
  for (size_t i = 0; i < ps->count; i++) {
    ps->plane[i]->columns = ps->plane[i]->nodes = 0;
    for (size_t b = 0; b < m->grid.blocks; b++)
      if (m->grid.block[b].line != NULL && find_in_block(m, i, &m->grid.block[b]) != GAMUT_OK)
        return GAMUT_INTERNAL;
  }
  for (size_t t = 0; t < ps->touches; t++)
    for (int k = 0; k < 3; k++)
      if (ps->touched[t].owner[k] < 0)
        ps->touched[t].owner[k] = ps->touched[t].first;
  m->grid.opened = false;
  return totals_planes_room(m);
}
