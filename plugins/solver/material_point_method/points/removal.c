/* Points that leave the run: who takes them, and what they took along. A point that lost its mass
 * in a sweep (removal_sweep.c) is dropped from its set after the step. */
#include "points/removal.h"

#include <string.h>

#include "step/step.h"

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
  gamut_release(m->run, r->sum);
}

static double body_mass(const struct model *m, const struct gamut_set *set)
{
  const double *mass = m->host->stored(set, m->field.mass, 0);
  double *row = m->totals.measured, sum;
  for (size_t b = 0; b < set->blocks; b++) {
    row[b] = 0.0;
    for (size_t i = set->first[b]; i < set->first[b + 1]; i++)
      row[b] += mass[i];
  }
  gamut_sum(m->run, row, set->blocks, 1, &sum);
  return sum;
}

gamut_status removal_start(struct model *m)
{
  struct removals *r = &m->removal;
  if (r->lost_points.count > 0)
    return lost_point_fail(m);
  if (r->takers == 0)
    return GAMUT_OK;
  for (int t = 0; t < m->threads; t++)
    r->second = m->work[t]->mean_second > 0.0 ? m->work[t]->mean_second : r->second;
  r->body_mass = gamut_allocate(m->run, "removal", m->bodies * sizeof *r->body_mass);
  if (r->body_mass == NULL)
    return GAMUT_INTERNAL;
  r->sum = gamut_allocate(m->run, "removal",
                          (m->bodies + 1) * r->takers * GONE_SUMS * sizeof *r->sum);
  if (r->sum == NULL)
    return GAMUT_INTERNAL;
  for (size_t b = 0; b < m->bodies; b++)
    r->body_mass[b] = body_mass(m, m->body[b].set);
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

/* What left a block is known: makes it nothing; how many points it was. */
static size_t clear_block(struct model *m, size_t serial)
{
  const struct removals *r = &m->removal;
  size_t points = 0;
  for (size_t t = 0; t < r->takers; t++) {
    double *gone = r->gone + (serial * r->takers + t) * GONE_SUMS;
    if (gone[GONE_POINTS] == 0.0)
      continue;
    points += (size_t)gone[GONE_POINTS];
    memset(gone, 0, GONE_SUMS * sizeof *gone);
  }
  return points;
}

static void add_to_taker(const struct model *m, size_t number)
{
  const struct removals *r = &m->removal;
  struct taker *taker = r->taker[number];
  const size_t columns = r->takers * GONE_SUMS;
  const double *gone = r->sum + m->bodies * columns + number * GONE_SUMS;
  taker->total.points += gone[GONE_POINTS];
  taker->total.mass += gone[GONE_MASS];
  taker->total.kinetic += gone[GONE_KINETIC];
  taker->total.internal += gone[GONE_INTERNAL];
  for (unsigned k = 0; k < 3; k++) {
    taker->total.momentum[k] += gone[GONE_MOMENTUM + k];
    taker->angular_momentum[k] += gone[GONE_ANGULAR_MOMENTUM + k];
  }
  for (size_t b = 0; b < m->bodies; b++)
    taker->of_body[b] += r->sum[b * columns + number * GONE_SUMS + GONE_MASS];
}

/* What left all blocks in this step, to the sums of takers. */
static void add_up(struct model *m)
{
  struct removals *r = &m->removal;
  const size_t columns = r->takers * GONE_SUMS;
  double *all = r->sum + m->bodies * columns;
  const double *gone = r->gone;
  for (size_t b = 0; b < m->bodies; b++) {
    gamut_sum(m->run, gone, m->body[b].set->blocks, columns, r->sum + b * columns);
    gone += m->body[b].set->blocks * columns;
  }
  gamut_sum(m->run, r->sum, m->bodies, columns, all);
  gamut_sum(m->run, all, r->takers, GONE_SUMS, r->now);
  for (size_t t = 0; t < r->takers; t++)
    add_to_taker(m, t);
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
  if (r->lost_points.count > 0)
    return lost_point_fail(m);
  memset(r->now, 0, sizeof r->now);
  if (r->takers == 0)
    return GAMUT_OK;
  add_up(m);
  for (size_t b = 0; b < m->bodies; b++) {
    struct gamut_set *set = m->body[b].set;
    size_t blocks = 0;
    for (size_t k = 0; k < set->blocks; k++) {
      if (clear_block(m, serial + k) > 0)
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
  if (out != NULL && out->total.points > 0.0 && !out->reported) {
    m->host->warn(m->run,
                  "points leave solver.domain and are taken out of the run, the first %.0f with "
                  "%.6g kg at t = %.6g s; the ledger's lines 'left the domain' have all of them",
                  out->total.points, out->total.mass, gamut_time(m->run));
    out->reported = true;
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
