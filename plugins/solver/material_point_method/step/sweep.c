/* What a sweep does with the chunks of a block of points: gathers from the tile, moves the points,
 * scatters into it. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "step/step.h"

size_t real_points(const struct gamut_set *set, size_t slot, size_t count)
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

/* What a point keeps of its velocity, and what the nodes give it. */
static void advance_velocity(const struct model *m, const struct work *w, unsigned k, size_t count,
                             const double *restrict from, double *restrict to)
{
  const double *restrict velocity_from_grid = w->value[3 + k];
  const double keep = 1.0 - m->pic;
  if (keep == 0.0) {
    memcpy(to, velocity_from_grid, count * sizeof *to);
    return;
  }
#pragma omp simd
  for (size_t i = 0; i < count; i++)
    to[i] = keep * from[i] + velocity_from_grid[i];
}

/* The points' new velocity, and its slope where they carry one, from what was gathered. */
static void renew_velocity(struct model *m, const struct gamut_chunk *chunk)
{
  struct work *w = m->work[chunk->thread];
  for (unsigned k = 0; k < m->dimension; k++)
    advance_velocity(m, w, k, chunk->count, gamut_begin(chunk, m->field.velocity, k),
                     gamut_end(chunk, m->field.velocity, k));
  if (m->rule != RULE_APIC)
    return;
  double *affine[9];
  for (unsigned k = 0; k < 9; k++)
    affine[k] = gamut_end(chunk, m->field.affine_velocity, k);
  m->transfer.gather_affine(w, chunk->count, m->cell, affine);
}

static void move(struct model *m, const struct gamut_chunk *chunk, const double *const carry[3])
{
  const double step = gamut_time_step(m->run);
  double most = m->work[chunk->thread]->speed;
  for (unsigned k = 0; k < m->dimension; k++) {
    const double *restrict from = gamut_begin(chunk, m->field.position, k);
    const double *restrict v = carry[k];
    double *restrict to = gamut_end(chunk, m->field.position, k);
#pragma omp simd reduction(max : most)
    for (size_t i = 0; i < chunk->count; i++) {
      const double speed = fabs(v[i]);
      to[i] = from[i] + step * v[i];
      most = speed > most ? speed : most;
    }
  }
  m->work[chunk->thread]->speed = most;
}

/* The chunk's domains as they were when the step began. */
static void find_domains(const struct model *m, const struct gamut_chunk *chunk, struct locate *l)
{
  for (unsigned k = 0; m->shape == SHAPE_GIMP && k < m->dimension; k++)
    l->length[k] = gamut_begin(chunk, m->field.domain_length, k);
}

gamut_status renew_momentum(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  struct work *w = m->work[chunk->thread];
  const bool moves = m->stress_update == UPDATE_USF;
  struct point_view view = {.count = chunk->count};
  view.real = real_points(chunk->set, chunk->slot, chunk->count);
  components(chunk, m->field.position, 3, false, view.position);
  components(chunk, m->field.velocity, 3, true, view.velocity);
  components(chunk, m->field.mass, 1, false, &view.mass);
  struct locate l = locate_in(m, chunk->serial, view.position, chunk->count);
  find_domains(m, chunk, &l);
  if (!m->transfer.locate(w, &l, !moves))
    return find_lost_point(m, chunk->set, chunk->slot, &l, view.position, view.velocity);
  m->transfer.gather(w, chunk->count, moves);
  renew_velocity(m, chunk);
  if (m->rule == RULE_APIC)
    components(chunk, m->field.affine_velocity, 9, true, view.affine);
  if (moves) {
    const double *const carry[3] = {w->value[0], w->value[1], w->value[2]};
    move(m, chunk, carry);
    removal_take_moved(m, chunk);
    components(chunk, m->field.position, 3, true, view.position);
    l = locate_in(m, chunk->serial, view.position, chunk->count);
    find_domains(m, chunk, &l);
    if (!m->transfer.locate(w, &l, true))
      return lost_point_outside_tile(m, chunk->set, chunk->slot, &l, view.position, view.velocity);
  }
  m->transfer.scatter_momentum(w, &view, m->cell);
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

/* The edges of the points' domains follow the stretch along their axes, as volumes follow that of
 * all: so that the domains of a bar in one dimension are its volumes. */
static void stretch_domains(struct model *m, const struct gamut_chunk *chunk)
{
  const double step = gamut_time_step(m->run), cell = m->cell * (1.0 + 1e-9);
  int beyond = 0, out = 0;
  for (unsigned k = 0; k < m->dimension; k++) {
    const double *restrict from = gamut_begin(chunk, m->field.domain_length, k);
    const double *restrict rate = gamut_end(chunk, m->field.velocity_gradient, 4 * k);
    double *restrict to = gamut_end(chunk, m->field.domain_length, k);
#pragma omp simd reduction(| : beyond, out)
    for (size_t i = 0; i < chunk->count; i++) {
      to[i] = from[i] + step * rate[i] * from[i];
      beyond |= to[i] > cell;
      out |= !(to[i] > 0.0);
    }
  }
  m->work[chunk->thread]->beyond |= beyond;
  if (out != 0 && removal_of_lost(m, chunk->set->index))
    return;
  for (size_t i = 0; out != 0 && i < chunk->count; i++)
    for (unsigned k = 0; k < m->dimension && chunk->set->id[chunk->slot + i] >= 0; k++)
      if (!(gamut_end(chunk, m->field.domain_length, k)[i] > 0.0))
        lost_point_note(m, chunk->set, chunk->slot + i,
                        "an edge of its domain was turned round: the time step is too long");
}

gamut_status gather_points(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  struct work *w = m->work[chunk->thread];
  const size_t count = chunk->count;
  const bool moved = m->stress_update == UPDATE_USF;
  const double *x[3], *v[3];
  double *gradient[9];
  components(chunk, m->field.position, 3, moved, x);
  components(chunk, m->field.velocity, 3, m->stress_update != UPDATE_USL, v);
  for (unsigned k = 0; k < 9; k++)
    gradient[k] = gamut_end(chunk, m->field.velocity_gradient, k);
  struct locate l = locate_in(m, chunk->serial, x, count);
  find_domains(m, chunk, &l);
  if (!m->transfer.locate(w, &l, false))
    return find_lost_point(m, chunk->set, chunk->slot, &l, x, v);
  m->transfer.gather_gradient(w, count, m->grid.inverse_cell, gradient);
  finish_gradient(m, w, x[0], count, gradient);
  if (m->stress_update == UPDATE_USL)
    renew_velocity(m, chunk);
  if (!moved) {
    /* in the second pass of MUSL the velocity that moves points stands in the place of its change
     */
    const int at = m->stress_update == UPDATE_MUSL ? 3 : 0;
    const double *const carry[3] = {w->value[at], w->value[at + 1], w->value[at + 2]};
    move(m, chunk, carry);
  }
  if (m->contiguous)
    stretch_domains(m, chunk);
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
    omega[i] += sound[i] >= 0.0 ? scale * speed * speed : NAN;
  }
  return GAMUT_OK;
}

gamut_status scatter_view(struct model *m, struct work *w, const struct gamut_set *set,
                          size_t serial, size_t slot, struct point_view *view, const double *energy)
{
  view->real = real_points(set, slot, view->count);
  view->density = m->body[set->index].density;
  view->axisymmetric = m->geometry == GEOMETRY_AXISYMMETRIC;
  view->squares = m->limited;
  struct locate l = locate_in(m, serial, view->position, view->count);
  for (unsigned k = 0; k < m->dimension; k++)
    l.length[k] = view->length[k];
  if (!m->transfer.locate(w, &l, true))
    return lost_point_outside_tile(m, set, slot, &l, view->position, view->velocity);
  m->transfer.scatter(w, view, m->cell);
  sums_motion(w, view, m->dimension, energy);
  if (view->force[0] != NULL)
    sums_forces(w, view);
  if (m->bounded || m->geometry == GEOMETRY_AXISYMMETRIC)
    lost_point_outside_domain(m, set, slot, view->real, view->position, view->mass);
  return GAMUT_OK;
}

/* What effects gave the points in this step goes into their energy. */
static void take_heat(struct model *m, const struct gamut_chunk *chunk)
{
  const double *heat = gamut_end(chunk, m->field.transfer_heat, 0);
  if (heat == NULL)
    return;
  const double *mass = gamut_end(chunk, m->field.mass, 0);
  double *energy = gamut_end(chunk, m->field.energy, 0);
  double *sum = m->work[chunk->thread]->point_sum + SUM_HEAT * GAMUT_LANES;
  const double over = 1.0 / m->body[chunk->set->index].density;
  for (size_t i = 0; i < chunk->count; i += GAMUT_LANES)
    for (size_t l = 0; l < GAMUT_LANES; l++) {
      energy[i + l] += heat[i + l];
      sum[l] += mass[i + l] * over * heat[i + l];
    }
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
  if (m->shape == SHAPE_GIMP)
    components(chunk, m->field.domain_length, 3, true, view.length);
  if (m->rule == RULE_APIC)
    components(chunk, m->field.affine_velocity, 9, true, view.affine);
  const gamut_status taken = removal_take(m, chunk);
  if (taken != GAMUT_OK)
    return taken;
  take_heat(m, chunk);
  const double *omega = gamut_end(chunk, m->field.omega_squared, 0);
  double most = w->omega_squared;
  int unbounded = 0;
#pragma omp simd reduction(max : most) reduction(| : unbounded)
  for (size_t i = 0; i < chunk->count; i++) {
    most = omega[i] > most ? omega[i] : most;
    unbounded |= !(omega[i] <= DBL_MAX);
  }
  w->omega_squared = most;
  if (unbounded)
    lost_point_without_step(m, chunk, omega);
  return scatter_view(m, w, chunk->set, chunk->serial, chunk->slot, &view,
                      gamut_end(chunk, m->field.energy, 0));
}
