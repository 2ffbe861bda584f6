/* A pass of others over the grid: the means of what points have, at the nodes, and back. The boxes
 * and lines are those of the step, between its update of the grid and its sweep over the points. */
#include <string.h>

#include "step/step.h"

static const double zeros[GAMUT_CHUNK_MAX];

static struct locate places_of(struct model *m, const struct gamut_set *set, size_t serial,
                               size_t at, size_t count, const double *x[3])
{
  for (unsigned k = 0; k < 3; k++)
    x[k] = m->host->stored(set, m->field.position, k) + at;
  struct locate l = locate_in(m, serial, x, count);
  for (unsigned k = 0; m->shape == SHAPE_GIMP && k < m->dimension; k++)
    l.length[k] = m->host->stored(set, m->field.domain_length, k) + at;
  return l;
}

static gamut_status lost(struct model *m, const struct gamut_set *set, size_t at,
                         const struct locate *l, const double *const x[3])
{
  const double *v[3];
  for (unsigned k = 0; k < 3; k++)
    v[k] = m->host->stored(set, m->field.velocity, k) + at;
  return find_lost_point(m, set, at, l, x, v);
}

/* The value as velocity along x; the flux as minus the stresses that push along x, on volumes that
 * are the weights. */
static void show_points(const struct model *m, const struct gamut_set *set,
                        const struct gamut_grid_pass *pass, size_t at, struct work *w,
                        struct point_view *view)
{
  static const int of_flux[3] = {0, 3, 5};
  view->real = real_points(set, at, view->count);
  view->mass = pass->weight + at;
  view->density = -1.0;
  for (size_t i = 0; i < view->count; i++)
    w->value[0][i] = 1.0;
  view->volume_ratio = w->value[0];
  for (unsigned k = 0; k < 3; k++)
    view->velocity[k] = zeros;
  if (pass->value != NULL)
    view->velocity[0] = pass->value + at;
  for (unsigned k = 0; k < 6; k++)
    view->stress[k] = zeros;
  for (unsigned k = 0; k < m->dimension; k++)
    if (pass->flux[k] != NULL)
      view->stress[of_flux[k]] = pass->flux[k] + at;
}

static gamut_status scatter_block(struct model *m, const struct body *body, size_t block,
                                  size_t serial, struct work *w)
{
  const struct gamut_set *set = body->set;
  const struct gamut_grid_pass *pass = &m->pass[set->index];
  const size_t end = set->first[block + 1];
  const bool fluxes = pass->flux[0] != NULL || pass->flux[1] != NULL || pass->flux[2] != NULL;
  for (size_t at = set->first[block]; at < end && pass->weight != NULL; at += GAMUT_CHUNK_MAX) {
    struct point_view view = {.count = end - at < GAMUT_CHUNK_MAX ? end - at : GAMUT_CHUNK_MAX};
    const struct locate l = places_of(m, set, serial, at, view.count, view.position);
    if (!m->transfer.locate(w, &l, true))
      return lost(m, set, at, &l, view.position);
    show_points(m, set, pass, at, w, &view);
    (fluxes ? m->transfer.scatter : m->transfer.scatter_momentum)(w, &view, m->cell);
  }
  return flush_box(m, w, serial);
}

/* The mean in the place of the sums. */
static void take_means(const struct grid *g, double *line)
{
  for (size_t i = 0; i < g->block_nodes; i++, line += NODE_SIZE) {
    const double weight = line[NODE_MASS], sum = line[NODE_MOMENTUM] + line[NODE_FORCE];
    memset(line, 0, NODE_SIZE * sizeof *line);
    line[0] = weight > 0.0 ? sum / weight : 0.0;
  }
}

static gamut_status gather_block(struct model *m, const struct body *body, size_t block,
                                 size_t serial, struct work *w)
{
  const struct gamut_set *set = body->set;
  const struct gamut_grid_pass *pass = &m->pass[set->index];
  const size_t end = set->first[block + 1];
  if (pass->weight == NULL)
    return GAMUT_OK;
  grid_load(&m->grid, &m->grid.source[serial], w->tile);
  for (size_t at = set->first[block]; at < end; at += GAMUT_CHUNK_MAX) {
    const size_t count = end - at < GAMUT_CHUNK_MAX ? end - at : GAMUT_CHUNK_MAX;
    const double *x[3];
    double *gradient[9];
    const struct locate l = places_of(m, set, serial, at, count, x);
    if (!m->transfer.locate(w, &l, false))
      return lost(m, set, at, &l, x);
    for (unsigned k = 0; k < 9; k++)
      gradient[k] = w->prepared[k];
    m->transfer.gather_gradient(w, count, m->grid.inverse_cell, gradient);
    if (pass->result != NULL)
      memcpy(pass->result + at, w->value[0], count * sizeof *pass->result);
    for (unsigned k = 0; k < 3; k++)
      if (pass->gradient[k] != NULL)
        memcpy(pass->gradient[k] + at, k < m->dimension ? gradient[k] : zeros,
               count * sizeof *pass->gradient[k]);
  }
  return GAMUT_OK;
}

gamut_status step_pass(struct model *m, const struct gamut_grid_pass *pass)
{
  if (m->grid.box_used > 0)
    return gamut_fail(m->run, GAMUT_PLUGIN,
                      "a pass over the grid is due in a task GAMUT_ONCE of the phase 'grid': now "
                      "the grid holds what points have left for its next update");
  if (step_filter_room(m) != GAMUT_OK)
    return GAMUT_INTERNAL;
  for (size_t b = 0; b < m->grid.blocks; b++)
    m->grid.block[b].filter = m->filter_line + b * m->grid.block_nodes * NODE_SIZE;
  step_swap_lines(m);
  m->pass = pass;
  gamut_status status = each_block(m, scatter_block);
  if (status == GAMUT_OK)
    status = step_collect(m);
  for (size_t b = 0; b < m->grid.blocks && status == GAMUT_OK; b++)
    if (m->grid.block[b].line != NULL)
      take_means(&m->grid, m->grid.block[b].line);
  if (status == GAMUT_OK)
    status = each_block(m, gather_block);
  m->pass = NULL;
  step_swap_lines(m);
  return status;
}
