/* Points that leave the run. A point that somebody takes out loses its mass before its block is
 * scattered, so that nothing of it reaches the grid; what it had is summed block by block, in the
 * order of slots. After the step it is dropped from its set. */
#include "points/removal.h"

#include <math.h>
#include <string.h>

#include "step/step.h"

static const size_t nobody = SIZE_MAX;

gamut_status removal_add(void *self, const char *name, const bool *on_body,
                         const struct gamut_removal *rule, const struct gamut_removed **sum,
                         double *mark)
{
  struct model *m = self;
  struct removals *r = &m->removal;
  struct taker *t = gamut_allocate(m->run, "removal", sizeof *t);
  struct taker **grown = gamut_allocate(m->run, "removal", (r->takers + 1) * sizeof(*grown));
  if (t == NULL || grown == NULL)
    return GAMUT_INTERNAL;
  if (r->takers > 0)
    memcpy(grown, r->taker, r->takers * sizeof(*grown));
  gamut_release(m->run, r->taker);
  r->taker = grown;
  r->taker[r->takers++] = t;
  *t = (struct taker){.name = name, .on_body = on_body, .lost = rule->lost, .most = rule->most};
  t->of_body = gamut_allocate(m->run, "removal", m->bodies * sizeof *t->of_body);
  if (t->of_body == NULL)
    return GAMUT_INTERNAL;
  *sum = &t->total;
  *mark = (double)r->takers;
  return ledger_open_taker(m, t);
}

gamut_status removal_open_domain(struct model *m)
{
  static const struct gamut_removal rule = {.flagged = false};
  const struct gamut_removed *sum;
  double mark;
  const gamut_status status = removal_add(m, "left the domain", NULL, &rule, &sum, &mark);
  if (status == GAMUT_OK)
    m->removal.outside = m->removal.taker[m->removal.takers - 1];
  return status;
}

void removal_destroy(struct model *m)
{
  struct removals *r = &m->removal;
  for (size_t t = 0; t < r->takers; t++) {
    gamut_release(m->run, r->taker[t]->of_body);
    gamut_release(m->run, r->taker[t]);
  }
  gamut_release(m->run, r->taker);
  gamut_release(m->run, r->body_mass);
  gamut_release(m->run, r->gone);
}

gamut_status removal_start(struct model *m)
{
  struct removals *r = &m->removal;
  if (r->stray.count > 0)
    return stray_fail(m);
  if (r->takers == 0)
    return GAMUT_OK;
  r->body_mass = gamut_allocate(m->run, "removal", m->bodies * sizeof *r->body_mass);
  if (r->body_mass == NULL)
    return GAMUT_INTERNAL;
  for (size_t b = 0; b < m->bodies; b++) {
    const double *mass = m->host->stored(m->body[b].set, m->field.mass, 0);
    for (size_t i = 0; i < m->body[b].set->slots; i++)
      r->body_mass[b] += mass[i];
  }
  return GAMUT_OK;
}

gamut_status removal_room(struct model *m)
{
  struct removals *r = &m->removal;
  const size_t wanted = m->grid.sources * r->takers * GONE_SUMS;
  r->sort_due = false;
  r->since_sort = 0;
  if (wanted <= r->room)
    return GAMUT_OK;
  gamut_release(m->run, r->gone);
  r->room = wanted + wanted / 2;
  r->gone = gamut_allocate(m->run, "removal", r->room * sizeof *r->gone);
  return r->gone != NULL ? GAMUT_OK : GAMUT_INTERNAL;
}

/* ---- in a sweep ---------------------------------------------------------------------------- */

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
  double zero = nought(s->ratio, i) + nought(s->energy, i);
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

static void add_gone(const struct state *s, size_t i, double density, double *sum)
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
    sum[GONE_SPIN + k] += x[a] * push[b] - x[b] * push[a];
  }
  sum[GONE_POINTS] += 1.0;
  sum[GONE_MASS] += s->mass[i];
  sum[GONE_KINETIC] += 0.5 * s->mass[i] * square;
  if (s->energy != NULL)
    sum[GONE_INTERNAL] += s->mass[i] / density * number(s->energy[i]);
}

static void put(double *array, size_t i, double value)
{
  if (array != NULL && array[i] != value)
    array[i] = value;
}

/* A slot without matter: whatever made the point leave must not reach the grid as nothing times
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
      add_gone(&s, i, m->body[body].density, gone + taker * GONE_SUMS);
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
    add_gone(&s, i, m->body[body].density, gone + taker * GONE_SUMS);
    make_nothing(m, &l, &s, i);
  }
}

/* ---- after a step -------------------------------------------------------------------------- */

/* What left one block, to the sums of takers; how many points. */
static size_t keep_block(struct model *m, size_t body, size_t serial)
{
  struct removals *r = &m->removal;
  size_t points = 0;
  for (size_t t = 0; t < r->takers; t++) {
    struct taker *taker = r->taker[t];
    double *gone = r->gone + (serial * r->takers + t) * GONE_SUMS;
    if (gone[GONE_POINTS] == 0.0)
      continue;
    points += (size_t)gone[GONE_POINTS];
    taker->total.points += gone[GONE_POINTS];
    taker->total.mass += gone[GONE_MASS];
    taker->total.kinetic += gone[GONE_KINETIC];
    taker->total.internal += gone[GONE_INTERNAL];
    taker->of_body[body] += gone[GONE_MASS];
    for (unsigned k = 0; k < 3; k++) {
      taker->total.momentum[k] += gone[GONE_MOMENTUM + k];
      taker->spin[k] += gone[GONE_SPIN + k];
    }
    for (int q = 0; q < GONE_SUMS; q++)
      r->now[q] += gone[q];
    memset(gone, 0, GONE_SUMS * sizeof *gone);
  }
  return points;
}

/* Takes the massless points out of a set; blocks that lose all of theirs call for a sort. */
static void drop_points(struct model *m, struct gamut_set *set, const size_t *block, size_t blocks)
{
  enum { MOST = 512 }; /* at once */
  const double *mass = m->host->stored(set, m->field.mass, 0);
  uint32_t slot[MOST];
  for (size_t b = 0, count; b < blocks; b += count < MOST) {
    count = 0;
    for (size_t i = set->first[block[b]]; i < set->first[block[b] + 1] && count < MOST; i++)
      if (set->id[i] >= 0 && mass[i] == 0.0)
        slot[count++] = (uint32_t)i;
    m->host->drop(m->run, set, slot, count);
    m->removal.since_sort += count;
  }
  for (size_t b = 0; b < blocks; b++)
    m->removal.sort_due |= set->id[set->first[block[b]]] < 0;
  m->removal.sort_due |= 8 * m->removal.since_sort > set->slots;
}

gamut_status removal_keep(struct model *m)
{
  enum { FEW = 64 };
  struct removals *r = &m->removal;
  size_t serial = 0, block[FEW];
  if (r->stray.count > 0)
    return stray_fail(m);
  memset(r->now, 0, sizeof r->now);
  for (size_t b = 0; b < m->bodies && r->takers > 0; b++) {
    struct gamut_set *set = m->body[b].set;
    size_t blocks = 0;
    for (size_t k = 0; k < set->blocks; k++) {
      if (keep_block(m, b, serial + k) > 0)
        block[blocks++] = k;
      if (blocks == FEW || (blocks > 0 && k + 1 == set->blocks)) {
        drop_points(m, set, block, blocks);
        blocks = 0;
      }
    }
    serial += set->blocks;
  }
  return GAMUT_OK;
}

gamut_status removal_check(struct model *m)
{
  const struct removals *r = &m->removal;
  struct taker *out = r->outside;
  if (r->now[GONE_POINTS] == 0.0)
    return GAMUT_OK;
  if (out != NULL && out->total.points > 0.0 && !out->told) {
    m->host->warn(m->run,
                  "points leave solver.domain and are taken out of the run, the first %.0f with "
                  "%.6g kg at t = %.6g s; the ledger's lines 'left the domain' have all of them",
                  out->total.points, out->total.mass, gamut_time(m->run));
    out->told = true;
  }
  for (size_t t = 0; t < r->takers; t++)
    for (size_t b = 0; b < m->bodies; b++) {
      const struct taker *taker = r->taker[t];
      if (taker->most > 0.0 && taker->of_body[b] > taker->most * r->body_mass[b])
        return gamut_fail(m->run, GAMUT_NUMERICS,
                          "%s took %.6g kg, %.3g %% of the mass of body '%s', at t = %.6g s, step "
                          "%llu: its limit `most` is %.3g %%",
                          taker->name, taker->of_body[b],
                          100.0 * taker->of_body[b] / r->body_mass[b], m->body[b].set->body,
                          gamut_time(m->run), (unsigned long long)m->host->step(m->run),
                          100.0 * taker->most);
    }
  return GAMUT_OK;
}
