/* One time step as tasks. The step is turned round so that it needs one sweep over the points: the
 * grid is updated from the boxes that the last sweep left, then each block of points is gathered,
 * strained and scattered while it is in cache. */
#include <math.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "model.h"

static int thread_number(void)
{
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

/* ---- blocks and chunks -------------------------------------------------------------------------
 */

static gamut_status load_block(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  grid_load(&m->grid, &m->grid.source[chunk->serial], m->work[chunk->thread]->tile);
  return GAMUT_OK;
}

static gamut_status leave_box(struct model *m, struct work *w, size_t serial)
{
  struct source *s = &m->grid.source[serial];
  if (m->transfer.finish != NULL)
    m->transfer.finish(w);
  for (unsigned k = 0; k < m->dimension; k++) {
    s->lower[k] = w->lower[k];
    s->upper[k] = w->upper[k];
    w->lower[k] = m->grid.tile;
    w->upper[k] = 0;
  }
  return grid_leave(&m->grid, serial, w->sums);
}

static gamut_status leave_momentum(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  return leave_box(m, m->work[chunk->thread], chunk->serial);
}

static gamut_status leave_sums(struct model *m, struct work *w, size_t serial)
{
  const gamut_status status = leave_box(m, w, serial);
  for (size_t q = 0; q < POINT_SUMS; q++) {
    double sum = 0.0;
    for (size_t l = 0; l < GAMUT_LANES; l++)
      sum += w->point_sum[q * GAMUT_LANES + l];
    m->block_sum[serial * POINT_SUMS + q] = sum;
  }
  memset(w->point_sum, 0, POINT_SUMS * GAMUT_LANES * sizeof *w->point_sum);
  m->block_omega[serial] = w->omega_squared;
  w->omega_squared = 0.0;
  return status;
}

static gamut_status leave_block(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  return leave_sums(m, m->work[chunk->thread], chunk->serial);
}

static size_t real_points(const struct gamut_set *set, size_t slot, size_t count)
{
  while (count > 0 && set->id[slot + count - 1] < 0)
    count--;
  return count;
}

static struct locate locate_in(const struct model *m, size_t serial, const double *const x[3],
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

/* Names the point that left the tile of its block. */
static gamut_status find_stray(const struct model *m, const struct gamut_set *set, size_t slot,
                               const struct locate *l, const double *const x[3],
                               const double *const v[3])
{
  for (size_t i = 0; i < l->count; i++)
    for (unsigned k = 0; k < m->dimension; k++) {
      const double at = x[k][i] * l->inverse_cell - l->origin[k];
      if (at >= 0.0 && at < m->grid.side + 2)
        continue;
      const double place[3] = {x[0][i], x[1][i], x[2][i]}, speed[3] = {v[0][i], v[1][i], v[2][i]};
      return point_failed(
          (struct model *)m, set, slot + i, place, speed,
          isfinite(x[k][i]) && isfinite(v[k][i])
              ? "it went farther than a cell in a step or two: the time step is too "
                "long or the run is unstable"
              : "its position or velocity is not a number: the time step is too long "
                "or the material failed");
    }
  return gamut_fail(m->run, GAMUT_INTERNAL, "a point left its block, but none is outside");
}

static gamut_status check_domain(const struct model *m, const struct gamut_set *set, size_t slot,
                                 size_t count, const double *const x[3], const double *const v[3])
{
  for (size_t i = 0; i < count; i++) {
    bool inside = true;
    for (unsigned k = 0; k < m->dimension; k++)
      inside = inside && x[k][i] >= m->lower[k] && x[k][i] <= m->upper[k];
    if (inside && (m->geometry != GEOMETRY_AXISYMMETRIC || x[0][i] > 0.0))
      continue;
    const double place[3] = {x[0][i], x[1][i], x[2][i]}, speed[3] = {v[0][i], v[1][i], v[2][i]};
    return point_failed((struct model *)m, set, slot + i, place, speed,
                        inside ? "it crossed the axis: the time step is too long or the cell too "
                                 "large"
                               : "it left the domain; a larger solver.domain lets it go on");
  }
  return GAMUT_OK;
}

/* ---- tasks of chunks ---------------------------------------------------------------------------
 */

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

/* First pass of MUSL: new velocities of the points, and their momentum back to the grid. */
static gamut_status renew_momentum(void *self, const struct gamut_chunk *chunk)
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

static gamut_status gather_points(void *self, const struct gamut_chunk *chunk)
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

static gamut_status bound_step(void *self, const struct gamut_chunk *chunk)
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

/* ---- scatter -----------------------------------------------------------------------------------
 */

static gamut_status scatter_view(struct model *m, struct work *w, const struct gamut_set *set,
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

static gamut_status scatter_points(void *self, const struct gamut_chunk *chunk)
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

static gamut_status first_block(struct model *m, const struct body *body, size_t block,
                                size_t serial, struct work *w)
{
  const struct gamut_set *set = body->set;
  const size_t slot = set->first[block], end = set->first[block + 1];
  for (size_t at = slot; at < end; at += GAMUT_CHUNK_MAX) {
    struct point_view view = {.count = end - at < GAMUT_CHUNK_MAX ? end - at : GAMUT_CHUNK_MAX};
    for (unsigned k = 0; k < 3; k++) {
      view.position[k] = m->host->stored(set, m->field.position, k) + at;
      view.velocity[k] = m->host->stored(set, m->field.velocity, k) + at;
    }
    for (unsigned k = 0; k < 6; k++)
      view.stress[k] = m->host->stored(set, m->field.stress, k) + at;
    view.mass = m->host->stored(set, m->field.mass, 0) + at;
    view.volume_ratio = m->host->stored(set, m->field.volume_ratio, 0) + at;
    const double *energy = m->host->stored(set, m->field.energy, 0);
    const gamut_status status =
        scatter_view(m, w, set, serial, at, &view, energy == NULL ? NULL : energy + at);
    if (status != GAMUT_OK)
      return status;
  }
  return leave_sums(m, w, serial);
}

gamut_status step_first_scatter(struct model *m)
{
  size_t serial = 0;
  for (size_t b = 0; b < m->bodies; b++) {
    const size_t blocks = m->body[b].set->blocks;
    gamut_status worst = GAMUT_OK;
#pragma omp parallel for schedule(dynamic) num_threads(m->threads)
    for (size_t k = 0; k < blocks; k++) {
      const gamut_status status =
          first_block(m, &m->body[b], k, serial + k, m->work[thread_number()]);
      if (status != GAMUT_OK) {
#pragma omp atomic write
        worst = status;
      }
    }
    if (worst != GAMUT_OK)
      return worst;
    serial += blocks;
  }
  return GAMUT_OK;
}

/* ---- registration ------------------------------------------------------------------------------
 */

static gamut_status add(struct model *m, const char *name, const char *phase,
                        enum gamut_extent extent,
                        gamut_status (*run)(void *, const struct gamut_chunk *),
                        const struct gamut_use *uses, size_t count)
{
  const struct gamut_task task = {.name = name,
                                  .phase = phase,
                                  .extent = extent,
                                  .uses = uses,
                                  .use_count = count,
                                  .essential = true,
                                  .run = run,
                                  .self = m};
  return gamut_add_task(m->run, &task);
}

#define USES(array) (array), sizeof(array) / sizeof *(array)

gamut_status step_register(struct model *m)
{
  static const struct gamut_use renew[] = {{"position", GAMUT_READ_BEGIN},
                                           {"mass", GAMUT_READ_BEGIN},
                                           {"velocity", GAMUT_READ_BEGIN},
                                           {"velocity", GAMUT_WRITE}};
  static const struct gamut_use gather_once[] = {{"position", GAMUT_READ_BEGIN},
                                                 {"velocity", GAMUT_READ_BEGIN},
                                                 {"position", GAMUT_WRITE},
                                                 {"velocity", GAMUT_WRITE},
                                                 {"velocity_gradient", GAMUT_WRITE}};
  static const struct gamut_use gather_again[] = {{"position", GAMUT_READ_BEGIN},
                                                  {"velocity", GAMUT_READ},
                                                  {"position", GAMUT_WRITE},
                                                  {"velocity_gradient", GAMUT_WRITE}};
  static const struct gamut_use bound[] = {
      {"sound_speed", GAMUT_READ}, {"velocity", GAMUT_READ}, {"omega_squared", GAMUT_ADD}};
  static const struct gamut_use scatter[] = {
      {"position", GAMUT_READ},          {"velocity", GAMUT_READ},     {"mass", GAMUT_READ_BEGIN},
      {"volume_ratio", GAMUT_READ},      {"stress", GAMUT_READ},       {"energy", GAMUT_READ_IF},
      {"external_force", GAMUT_READ_IF}, {"omega_squared", GAMUT_READ}};
  gamut_status status = add(m, "update grid", "grid", GAMUT_ONCE, step_update_grid, NULL, 0);
  if (status == GAMUT_OK && m->second_pass) {
    status = add(m, "load velocity change", "momentum", GAMUT_OPEN_BLOCK, load_block, NULL, 0);
    if (status == GAMUT_OK)
      status = add(m, "renew momentum", "momentum", GAMUT_PER_CHUNK, renew_momentum, USES(renew));
    if (status == GAMUT_OK)
      status = add(m, "leave momentum", "momentum", GAMUT_CLOSE_BLOCK, leave_momentum, NULL, 0);
    if (status == GAMUT_OK)
      status = add(m, "update grid again", "second grid", GAMUT_ONCE, step_update_again, NULL, 0);
  }
  if (status == GAMUT_OK)
    status = add(m, "load velocity", "gather", GAMUT_OPEN_BLOCK, load_block, NULL, 0);
  if (status == GAMUT_OK)
    status = m->second_pass
                 ? add(m, "gather", "gather", GAMUT_PER_CHUNK, gather_points, USES(gather_again))
                 : add(m, "gather", "gather", GAMUT_PER_CHUNK, gather_points, USES(gather_once));
  if (status == GAMUT_OK)
    status = add(m, "bound step", "bound", GAMUT_PER_CHUNK, bound_step, USES(bound));
  if (status == GAMUT_OK)
    status = add(m, "scatter", "scatter", GAMUT_PER_CHUNK, scatter_points, USES(scatter));
  if (status == GAMUT_OK)
    status = add(m, "leave block", "scatter", GAMUT_CLOSE_BLOCK, leave_block, NULL, 0);
  return status;
}
