/* What a sweep does with the chunks of a block of points: gathers from the tile, moves the points,
 * scatters into it. */
#include <math.h>
#include <string.h>

#include "step/step.h"

static size_t real_points(const struct gamut_set *set, size_t slot, size_t count)
{
  while (count > 0 && set->id[slot + count - 1] < 0)
    count--;
  return count;
}

static void components(const struct gamut_chunk *chunk, struct gamut_field f, unsigned count,
                       bool end, const double **out)
{
  for (unsigned k = 0; k < count; k++)
    out[k] = end ? gamut_end(chunk, f, k) : gamut_begin(chunk, f, k);
}

static void advance_velocity(const struct model *m, const struct work *w, unsigned k, size_t count,
                             const double *from, double *to)
{
  const double *v = w->value[k], *change = w->value[3 + k], pic = m->pic;
  if (pic == 0.0) {
#pragma omp simd
    for (size_t i = 0; i < count; i++)
      to[i] = from[i] + change[i];
  } else {
#pragma omp simd
    for (size_t i = 0; i < count; i++)
      to[i] = (1.0 - pic) * (from[i] + change[i]) + pic * v[i];
  }
}

gamut_status renew_momentum(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  struct work *w = m->work[chunk->thread];
  struct point_view view = {.count = chunk->count};
  view.real = real_points(chunk->set, chunk->slot, chunk->count);
  components(chunk, m->field.position, 3, false, view.position);
  components(chunk, m->field.velocity, 3, true, view.velocity);
  components(chunk, m->field.mass, 1, false, &view.mass);
  const struct locate l = locate_in(m, chunk->serial, view.position, chunk->count);
  if (!m->transfer.locate(w, &l, true))
    return find_stray(m, chunk->set, chunk->slot, &l, view.position, view.velocity);
  m->transfer.gather(w, chunk->count, m->pic != 0.0);
  for (unsigned k = 0; k < m->dimension; k++)
    advance_velocity(m, w, k, chunk->count, gamut_begin(chunk, m->field.velocity, k),
                     gamut_end(chunk, m->field.velocity, k));
  m->transfer.scatter_momentum(w, &view);
  return GAMUT_OK;
}

static void finish_gradient(const struct model *m, const struct work *w, const double *radius,
                            size_t count, double *const gradient[9])
{
  for (unsigned c = 0; c < 3; c++)
    for (unsigned k = 0; k < 3; k++)
      if (c >= m->dimension || k >= m->dimension)
        memset(gradient[3 * c + k], 0, count * sizeof **gradient);
  if (m->geometry != GEOMETRY_AXISYMMETRIC)
    return;
  const double *restrict v = w->value[0];
  double *restrict hoop = gradient[8];
#pragma omp simd
  for (size_t i = 0; i < count; i++)
    hoop[i] = v[i] / radius[i];
}

gamut_status gather_points(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  struct work *w = m->work[chunk->thread];
  const size_t count = chunk->count;
  const double step = gamut_time_step(m->run);
  const double *x[3], *v[3];
  double *gradient[9];
  components(chunk, m->field.position, 3, false, x);
  components(chunk, m->field.velocity, 3, false, v);
  for (unsigned k = 0; k < 9; k++)
    gradient[k] = gamut_end(chunk, m->field.velocity_gradient, k);
  const struct locate l = locate_in(m, chunk->serial, x, count);
  if (!m->transfer.locate(w, &l, false))
    return find_stray(m, chunk->set, chunk->slot, &l, x, v);
  m->transfer.gather_gradient(w, count, m->grid.inverse_cell, gradient);
  finish_gradient(m, w, x[0], count, gradient);
  for (unsigned k = 0; k < m->dimension; k++) {
    const double *carry = w->value[m->second_pass ? 3 + k : k], *from = x[k];
    double *to = gamut_end(chunk, m->field.position, k);
    if (!m->second_pass)
      advance_velocity(m, w, k, count, v[k], gamut_end(chunk, m->field.velocity, k));
#pragma omp simd
    for (size_t i = 0; i < count; i++)
      to[i] = from[i] + step * carry[i];
  }
  return GAMUT_OK;
}

gamut_status bound_step(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  const double *sound = gamut_end(chunk, m->field.sound_speed, 0), *v[3];
  double *omega = gamut_end(chunk, m->field.omega_squared, 0);
  const double scale = 4.0 * m->grid.inverse_cell * m->grid.inverse_cell;
  components(chunk, m->field.velocity, 3, true, v);
#pragma omp simd
  for (size_t i = 0; i < chunk->count; i++) {
    const double speed = sound[i] + sqrt(v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i]);
    omega[i] += scale * speed * speed;
  }
  return GAMUT_OK;
}

gamut_status scatter_view(struct model *m, struct work *w, const struct gamut_set *set,
                                 size_t serial, size_t slot, struct point_view *view,
                                 const double *energy)
{
  view->real = real_points(set, slot, view->count);
  view->density = m->body[set->index].density;
  view->axisymmetric = m->geometry == GEOMETRY_AXISYMMETRIC;
  const struct locate l = locate_in(m, serial, view->position, view->count);
  if (!m->transfer.locate(w, &l, true))
    return find_stray(m, set, slot, &l, view->position, view->velocity);
  m->transfer.scatter(w, view, m->grid.inverse_cell);
  sums_motion(w, view, energy);
  if (view->force[0] != NULL)
    sums_forces(w, view);
  if (m->bounded || m->geometry == GEOMETRY_AXISYMMETRIC)
    return check_domain(m, set, slot, view->real, view->position, view->velocity);
  return GAMUT_OK;
}

gamut_status scatter_points(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  struct work *w = m->work[chunk->thread];
  struct point_view view = {.count = chunk->count};
  components(chunk, m->field.position, 3, true, view.position);
  components(chunk, m->field.velocity, 3, true, view.velocity);
  components(chunk, m->field.mass, 1, true, &view.mass);
  components(chunk, m->field.volume_ratio, 1, true, &view.volume_ratio);
  components(chunk, m->field.stress, 6, true, view.stress);
  components(chunk, m->field.external_force, 3, true, view.force);
  const double *omega = gamut_end(chunk, m->field.omega_squared, 0);
  double most = w->omega_squared;
#pragma omp simd reduction(max : most)
  for (size_t i = 0; i < chunk->count; i++)
    most = omega[i] > most ? omega[i] : most;
  w->omega_squared = most;
  return scatter_view(m, w, chunk->set, chunk->serial, chunk->slot, &view,
                      gamut_end(chunk, m->field.energy, 0));
}
