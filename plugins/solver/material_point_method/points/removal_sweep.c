/* Takes points out of the run, in a sweep. A point that somebody takes loses its mass before its
 * block is scattered, so that nothing of it reaches the grid; what it had is summed in its block,
 * in the order of slots. */
#include <math.h>

#include "step/step.h"

static const size_t nobody = SIZE_MAX;

/* What the points of a chunk are at the end of the step; null where this sweep does not know it. */
struct state {
  double *x[3], *v[3], *slope[9], *length[3], *stress[6], *force[3];
  double *mass, *ratio, *energy, *omega;
};

static struct state state_of(const struct model *m, const struct gamut_chunk *chunk)
{
  struct state s = {.mass = gamut_end(chunk, m->field.mass, 0),
                    .ratio = gamut_end(chunk, m->field.volume_ratio, 0),
                    .energy = gamut_end(chunk, m->field.energy, 0),
                    .omega = gamut_end(chunk, m->field.omega_squared, 0)};
  for (unsigned k = 0; k < 3; k++) {
    s.x[k] = gamut_end(chunk, m->field.position, k);
    s.v[k] = gamut_end(chunk, m->field.velocity, k);
    s.force[k] = gamut_end(chunk, m->field.external_force, k);
    s.length[k] = gamut_end(chunk, m->field.domain_length, k);
  }
  for (unsigned k = 0; k < 6; k++)
    s.stress[k] = gamut_end(chunk, m->field.stress, k);
  for (unsigned k = 0; k < 9; k++)
    s.slope[k] = gamut_end(chunk, m->field.affine_velocity, k);
  return s;
}

static bool in_tile(const struct model *m, const struct locate *l, const struct state *s, size_t i)
{
  for (unsigned k = 0; k < m->dimension; k++) {
    const double at = s->x[k][i] * l->inverse_cell - l->origin[k];
    if (!(at >= 0.0 && at < m->grid.side + 2))
      return false;
  }
  return true;
}

/* Zero, or no number where the value is none. */
static double nought(const double *value, size_t i)
{
  return value != NULL ? 0.0 * value[i] : 0.0;
}

/* Whether the point is in its tile, and its state is made of numbers. */
static bool is_sound(const struct model *m, const struct locate *l, const struct state *s, size_t i)
{
  double zero = nought(s->ratio, i) + nought(s->energy, i) + nought(s->omega, i);
  for (unsigned k = 0; k < 3; k++)
    zero += nought(s->v[k], i) + nought(s->force[k], i);
  for (unsigned k = 0; k < 6; k++)
    zero += nought(s->stress[k], i);
  return zero == 0.0 && in_tile(m, l, s, i);
}

static bool is_lost(const struct model *m, const struct locate *l, const struct state *s, size_t i)
{
  if (!is_sound(m, l, s, i))
    return true;
  for (unsigned k = 0; k < m->dimension; k++)
    if (fabs(s->x[k][i] - m->grid.origin[k]) * l->inverse_cell > GRID_REACH - 2 * m->grid.side ||
        (s->length[k] != NULL && !(s->length[k][i] > 0.0)))
      return true;
  return m->geometry == GEOMETRY_AXISYMMETRIC && !(s->x[0][i] > 0.0);
}

static bool is_outside(const struct model *m, const struct state *s, size_t i)
{
  for (unsigned k = 0; k < m->dimension; k++)
    if (s->x[k][i] < m->lower[k] || s->x[k][i] > m->upper[k])
      return true;
  return false;
}

static double number(double value)
{
  return isfinite(value) ? value : 0.0;
}

/* What a point moves and spins in itself, where it carries an affine velocity field. The spin is
 * exact, the energy where the second moment of the weights is the same everywhere: for splines. */
static void add_affine(const struct model *m, const struct state *s, size_t i, double *sum)
{
  const double mass = s->mass[i] * m->removal.second;
  double square = 0.0, slope[9] = {0.0};
  for (unsigned c = 0; c < m->dimension; c++)
    for (unsigned k = 0; k < m->dimension; k++) {
      slope[3 * c + k] = number(s->slope[3 * c + k][i]);
      square += slope[3 * c + k] * slope[3 * c + k];
    }
  for (unsigned k = 0; k < 3; k++) {
    const unsigned a = (k + 1) % 3, b = (k + 2) % 3;
    sum[GONE_ANGULAR_MOMENTUM + k] += mass * (slope[3 * b + a] - slope[3 * a + b]);
  }
  sum[GONE_KINETIC] += 0.5 * mass * square;
}

static void add_gone(const struct model *m, const struct state *s, size_t i, double density,
                     double *sum)
{
  double x[3], push[3], square = 0.0;
  for (unsigned k = 0; k < 3; k++) {
    const double v = number(s->v[k][i]);
    x[k] = number(s->x[k][i]);
    push[k] = s->mass[i] * v;
    square += v * v;
    sum[GONE_MOMENTUM + k] += push[k];
  }
  for (unsigned k = 0; k < 3; k++) {
    const unsigned a = (k + 1) % 3, b = (k + 2) % 3;
    sum[GONE_ANGULAR_MOMENTUM + k] += x[a] * push[b] - x[b] * push[a];
  }
  sum[GONE_POINTS] += 1.0;
  sum[GONE_MASS] += s->mass[i];
  sum[GONE_KINETIC] += 0.5 * s->mass[i] * square;
  if (s->slope[0] != NULL)
    add_affine(m, s, i, sum);
  if (s->energy != NULL)
    sum[GONE_INTERNAL] += s->mass[i] / density * number(s->energy[i]);
}

static void put(double *array, size_t i, double value)
{
  if (array != NULL && array[i] != value)
    array[i] = value;
}

/* A slot without material: whatever made the point leave must not reach the grid as nothing times
 * something that is no number. */
static void make_nothing(const struct model *m, const struct locate *l, const struct state *s,
                         size_t i)
{
  if (!in_tile(m, l, s, i))
    for (unsigned k = 0; k < m->dimension; k++)
      s->x[k][i] = (l->origin[k] + 0.5 * (m->grid.side + 2)) / l->inverse_cell;
  for (unsigned k = 0; k < 3; k++) {
    put(s->v[k], i, 0.0);
    put(s->force[k], i, 0.0);
    put(s->length[k], i, m->cell);
  }
  for (unsigned k = 0; k < 6; k++)
    put(s->stress[k], i, 0.0);
  for (unsigned k = 0; k < 9; k++)
    put(s->slope[k], i, 0.0);
  put(s->mass, i, 0.0);
  put(s->ratio, i, 1.0);
  put(s->omega, i, 0.0);
  put(s->energy, i, 0.0);
}

/* Padding is a copy of the last point, which may be leaving. */
static void pad(const struct model *m, const struct locate *l, const struct state *s, size_t i)
{
  if (!is_sound(m, l, s, i))
    make_nothing(m, l, s, i);
}

static size_t taker_of_lost(const struct model *m, size_t body)
{
  for (size_t t = 0; t < m->removal.takers; t++) {
    const struct taker *taker = m->removal.taker[t];
    if (taker->lost && (taker->on_body == NULL || taker->on_body[body]))
      return t;
  }
  return nobody;
}

bool removal_of_lost(const struct model *m, size_t body)
{
  return taker_of_lost(m, body) != nobody;
}

/* Who takes point i, apart from effects that mark points. */
static size_t taker_of(const struct model *m, size_t lost, const struct locate *l,
                       const struct state *s, size_t i)
{
  if (lost != nobody && is_lost(m, l, s, i))
    return lost;
  return m->removal.outside != NULL && is_outside(m, s, i) ? 0 : nobody;
}

static int any_beyond(const double *restrict value, double least, double largest, size_t count)
{
  int any = 0;
#pragma omp simd reduction(| : any)
  for (size_t i = 0; i < count; i++)
    any |= !(value[i] >= least) | !(value[i] <= largest);
  return any;
}

static int any_no_number(const double *restrict value, size_t count)
{
  int any = 0;
  for (size_t i = 0; value != NULL && i < count; i++)
    any |= 0.0 * value[i] != 0.0;
  return any;
}

/* Whether one of the points may be lost: a little more often than one is, because of rounding. */
static int any_lost(const struct model *m, const struct locate *l, const struct state *s)
{
  const size_t count = l->count;
  const double slack = 1e-6 * m->cell, reach = m->cell * (GRID_REACH - 2 * m->grid.side) - slack;
  int any = any_no_number(s->ratio, count) | any_no_number(s->energy, count) |
            any_no_number(s->omega, count);
  for (unsigned k = 0; k < 3; k++)
    any |= any_no_number(s->v[k], count) | any_no_number(s->force[k], count);
  for (unsigned k = 0; k < 6; k++)
    any |= any_no_number(s->stress[k], count);
  for (unsigned k = 0; k < m->dimension; k++) {
    const double tile = l->origin[k] / l->inverse_cell, from = m->grid.origin[k];
    const double end = fmin(tile + m->cell * (m->grid.side + 2) - slack, from + reach);
    double least = fmax(tile + slack, from - reach);
    if (k == 0 && m->geometry == GEOMETRY_AXISYMMETRIC)
      least = fmax(least, slack);
    any |= any_beyond(s->x[k], least, end, count);
    any |= s->length[k] != NULL && any_beyond(s->length[k], 1e-300, HUGE_VAL, count);
  }
  return any;
}

/* Whether some point of a chunk may have to go. In nearly all chunks none has, and a look at each
 * point would cost. */
static bool any_goes(const struct model *m, const struct gamut_chunk *chunk, const double *mark,
                     bool lost, const struct locate *l, const struct state *s)
{
  if (mark != NULL && any_beyond(mark, 0.0, 0.0, chunk->count))
    return true;
  if (!lost && m->removal.outside == NULL)
    return false;
  if (m->stress_update == UPDATE_USF) /* some went already, in the sweep that moved them */
    return true;
  for (unsigned k = 0; k < m->dimension && m->removal.outside != NULL; k++)
    if (any_beyond(s->x[k], m->lower[k], m->upper[k], chunk->count))
      return true;
  return lost && any_lost(m, l, s);
}

gamut_status removal_take(struct model *m, const struct gamut_chunk *chunk)
{
  const struct removals *r = &m->removal;
  const double *mark = gamut_end(chunk, m->field.removal, 0);
  const size_t body = chunk->set->index, lost = taker_of_lost(m, body);
  if (mark == NULL && lost == nobody && r->outside == NULL)
    return GAMUT_OK;
  const struct state s = state_of(m, chunk);
  const struct locate l = locate_in(m, chunk->serial, (const double *const *)s.x, chunk->count);
  double *gone = r->gone + chunk->serial * r->takers * GONE_SUMS;
  if (!any_goes(m, chunk, mark, lost != nobody, &l, &s))
    return GAMUT_OK;
  for (size_t i = 0; i < chunk->count; i++) {
    if (chunk->set->id[chunk->slot + i] < 0) {
      pad(m, &l, &s, i);
      continue;
    }
    size_t taker = mark != NULL && mark[i] > 0.0 ? (size_t)mark[i] - 1 : nobody;
    if (taker == nobody && s.mass[i] > 0.0)
      taker = taker_of(m, lost, &l, &s, i);
    if (taker != nobody && taker >= r->takers)
      return gamut_fail(m->run, GAMUT_PLUGIN,
                        "a point has the mark %g in the field 'removal', which no effect was given",
                        mark[i]);
    if (taker != nobody && s.mass[i] > 0.0)
      add_gone(m, &s, i, m->body[body].density, gone + taker * GONE_SUMS);
    if (taker != nobody || s.mass[i] == 0.0)
      make_nothing(m, &l, &s, i);
  }
  return GAMUT_OK;
}

void removal_take_moved(struct model *m, const struct gamut_chunk *chunk)
{
  const struct removals *r = &m->removal;
  const size_t body = chunk->set->index, lost = taker_of_lost(m, body);
  if (lost == nobody && r->outside == NULL)
    return;
  struct state s = state_of(m, chunk);
  const struct locate l = locate_in(m, chunk->serial, (const double *const *)s.x, chunk->count);
  double *gone = r->gone + chunk->serial * r->takers * GONE_SUMS;
  double *energy = m->host->stored(chunk->set, m->field.energy, 0);
  s.energy = energy != NULL ? energy + chunk->slot : NULL;
  for (size_t i = 0; i < chunk->count; i++) {
    if (chunk->set->id[chunk->slot + i] < 0)
      pad(m, &l, &s, i);
    const size_t taker = s.mass[i] > 0.0 ? taker_of(m, lost, &l, &s, i) : nobody;
    if (taker == nobody)
      continue;
    add_gone(m, &s, i, m->body[body].density, gone + taker * GONE_SUMS);
    make_nothing(m, &l, &s, i);
  }
}
