/* Where the points of a chunk lie in the tile of their block, and those that lie nowhere. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "step/step.h"

struct locate locate_in(const struct model *m, size_t serial, const double *const x[3],
                        size_t count)
{
  const struct grid *g = &m->grid;
  const struct node_block *b = &g->block[g->source[serial].block];
  struct locate l = {.count = count, .inverse_cell = g->inverse_cell};
  for (unsigned k = 0; k < m->dimension; k++) {
    l.position[k] = x[k];
    l.origin[k] = g->origin[k] * g->inverse_cell + g->shift + (double)b->at[k] * g->side - 1.0;
  }
  return l;
}

static bool within_tile(const struct model *m, const struct locate *l, double x, unsigned axis)
{
  const double at = x * l->inverse_cell - l->origin[axis];
  return at >= 0.0 && at < m->grid.side + 2;
}

static const char *why_outside(double x, double v)
{
  return isfinite(x) && isfinite(v)
             ? "it went farther than a cell in a step or two: the time step is too long or the run "
               "is unstable"
             : "its position or velocity is not a number: the time step is too long or the "
               "material failed";
}

gamut_status find_lost_point(const struct model *m, const struct gamut_set *set, size_t slot,
                             const struct locate *l, const double *const x[3],
                             const double *const v[3])
{
  for (size_t i = 0; i < l->count; i++)
    for (unsigned k = 0; k < m->dimension; k++) {
      if (within_tile(m, l, x[k][i], k))
        continue;
      const double place[3] = {x[0][i], x[1][i], x[2][i]}, speed[3] = {v[0][i], v[1][i], v[2][i]};
      return point_failed((struct model *)m, set, slot + i, place, speed,
                          why_outside(x[k][i], v[k][i]));
    }
  return gamut_fail(m->run, GAMUT_INTERNAL, "a point left its block, but none is outside");
}

void lost_point_note(struct model *m, const struct gamut_set *set, size_t slot, const char *what)
{
  struct lost_points *first = &m->removal.lost_points;
#pragma omp critical(material_point_method_lost_points)
  {
    const bool before = first->count == 0 || set->index < first->set->index ||
                        (set == first->set && set->id[slot] < set->id[first->slot]);
    if (before) {
      first->set = set;
      first->slot = slot;
      first->what = what;
    }
    first->count++;
  }
}

gamut_status lost_point_outside_tile(struct model *m, const struct gamut_set *set, size_t slot,
                                     const struct locate *l, const double *const x[3],
                                     const double *const v[3])
{
  bool any = false;
  for (size_t i = 0; i < l->count; i++)
    for (unsigned k = 0; k < m->dimension && set->id[slot + i] >= 0; k++) {
      if (within_tile(m, l, x[k][i], k))
        continue;
      lost_point_note(m, set, slot + i, why_outside(x[k][i], v[k][i]));
      any = true;
      break;
    }
  return any ? GAMUT_OK
             : gamut_fail(m->run, GAMUT_INTERNAL, "a point left its block, but none is outside");
}

void lost_point_outside_domain(struct model *m, const struct gamut_set *set, size_t slot,
                               size_t count, const double *const x[3], const double *mass)
{
  for (size_t i = 0; i < count; i++) {
    bool inside = true;
    for (unsigned k = 0; k < m->dimension; k++)
      inside = inside && x[k][i] >= m->lower[k] && x[k][i] <= m->upper[k];
    if (mass[i] == 0.0 || (inside && (m->geometry != GEOMETRY_AXISYMMETRIC || x[0][i] > 0.0)))
      continue;
    lost_point_note(
        m, set, slot + i,
        inside ? "it crossed the axis: the time step is too long or the cell too large"
               : "it left the domain; a larger solver.domain lets it go on, outside: remove takes "
                 "such points out of the run");
  }
}

void lost_point_without_step(struct model *m, const struct gamut_chunk *chunk, const double *omega)
{
  const double *sound = gamut_end(chunk, m->field.sound_speed, 0);
  for (size_t i = 0; i < chunk->count; i++)
    if (chunk->set->id[chunk->slot + i] >= 0 && !(omega[i] <= DBL_MAX))
      lost_point_note(
          m, chunk->set, chunk->slot + i,
          sound[i] >= 0.0 && sound[i] <= DBL_MAX
              ? "no time step is short enough for it: what bounds the step there "
                "(omega_squared) is no number, or beyond any"
              : "its sound speed is no number, without end, or negative: the material has "
                "none in this state, so that no time step is known");
}

gamut_status lost_point_fail(struct model *m)
{
  const struct lost_points *first = &m->removal.lost_points;
  double x[3], v[3];
  char what[400], more[64] = "";
  for (unsigned k = 0; k < 3; k++) {
    x[k] = m->host->stored(first->set, m->field.position, k)[first->slot];
    v[k] = m->host->stored(first->set, m->field.velocity, k)[first->slot];
  }
  if (first->count > 1)
    snprintf(more, sizeof more, " (and %zu more in this step)", first->count - 1);
  snprintf(what, sizeof what, "%s%s", first->what, more);
  return point_failed(m, first->set, first->slot, x, v, what);
}
