/* Into how many fragments the grid sees a body fall: groups of points of which none shares a node
 * with a point of another group. More than one is fracture, real or numerical. */
#include <math.h>

#include "model.h"

/* Cells that hold points, numbered as they come. */
struct cells {
  struct place_table *table;
  int32_t (*at)[3];
  int32_t *parent; /* of a forest: cells of one piece have one root */
  size_t count;
};

static int32_t root_of(const struct cells *c, int32_t cell)
{
  while (c->parent[cell] != cell) {
    c->parent[cell] = c->parent[c->parent[cell]];
    cell = c->parent[cell];
  }
  return cell;
}

static void enter_points(const struct model *m, const struct gamut_set *set, struct cells *c)
{
  const double *x[3];
  for (unsigned k = 0; k < m->dimension; k++)
    x[k] = m->host->stored(set, m->field.position, k);
  for (size_t i = 0; i < set->slots; i++) {
    int32_t at[3] = {0, 0, 0};
    if (set->id[i] < 0)
      continue;
    for (unsigned k = 0; k < m->dimension; k++)
      at[k] = (int32_t)floor((x[k][i] - m->grid.origin[k]) * m->grid.inverse_cell - m->grid.shift);
    if (places_find(c->table, at) >= 0)
      continue;
    for (unsigned k = 0; k < 3; k++)
      c->at[c->count][k] = at[k];
    c->parent[c->count] = (int32_t)c->count;
    places_put(c->table, at, (int32_t)c->count++);
  }
}

/* Joins a cell with those that share nodes with it: lowest nodes no farther apart than a point
 * reaches. */
static void join(const struct model *m, const struct cells *c, int32_t cell)
{
  const int reach = m->grid.nodes - 1, wide = 2 * reach + 1;
  int places = 1;
  for (unsigned k = 0; k < m->dimension; k++)
    places *= wide;
  for (int p = 0; p < places; p++) {
    int32_t at[3] = {0, 0, 0};
    int rest = p;
    for (unsigned k = 0; k < m->dimension; k++) {
      at[k] = c->at[cell][k] + rest % wide - reach;
      rest /= wide;
    }
    const int32_t other = places_find(c->table, at);
    if (other >= 0)
      c->parent[root_of(c, other)] = root_of(c, cell);
  }
}

gamut_status body_fragments(struct model *m, const struct gamut_set *set, double *fragments)
{
  struct cells c = {0};
  *fragments = 0.0;
  if (set->points == 0)
    return GAMUT_OK;
  gamut_status status = places_clear(m->run, &c.table, set->points);
  c.at = gamut_allocate(m->run, "fragments", set->points * sizeof *c.at);
  c.parent = gamut_allocate(m->run, "fragments", set->points * sizeof *c.parent);
  if (status == GAMUT_OK && c.at != NULL && c.parent != NULL) {
    enter_points(m, set, &c);
    for (size_t i = 0; i < c.count; i++)
      join(m, &c, (int32_t)i);
    for (size_t i = 0; i < c.count; i++)
      *fragments += c.parent[i] == (int32_t)i;
  } else {
    status = GAMUT_INTERNAL;
  }
  places_free(m->run, c.table);
  gamut_release(m->run, c.at);
  gamut_release(m->run, c.parent);
  return status;
}
