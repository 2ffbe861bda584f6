/* The ledger. Energy of the points goes to the grid in the scatter (and some is lost there), is
 * worked on at the nodes, and comes back in the gather (and some is lost there). Each of these is
 * summed where it happens and on its own, so that the balance is a check and not a definition. The
 * remainder of the stress update is what internal forces took from the grid and the material's
 * energy does not show.
 *
 * Velocities stand half a step before stresses, so the energy of one time is the kinetic energy
 * with the internal energy of half a step ago: a line takes back half of what the last step added.
 *
 * Momentum is stored as what goes forward and what goes backward, so that the balance of a body at
 * rest as a whole has a scale to be measured by. */
#include <string.h>

#include "model.h"

/* Components of momentum and of its moment that the geometry conserves. */
static bool keeps_momentum(const struct model *m, unsigned k)
{
  return m->geometry == GEOMETRY_AXISYMMETRIC ? k == 1 : k < m->dimension;
}

static bool keeps_angular_momentum(const struct model *m, unsigned k)
{
  return m->geometry == GEOMETRY_3D || (m->geometry == GEOMETRY_PLANE_STRAIN && k == 2);
}

static gamut_status line(struct model *m, const char *account, const char *name, const char *unit,
                         enum gamut_ledger_role role, double **value)
{
  return m->host->ledger(m->run, account, name, unit, role, value);
}

static gamut_status open_motion(struct model *m, unsigned k)
{
  static const char *const momentum[3] = {"momentum_x", "momentum_y", "momentum_z"};
  static const char *const angular_momentum[3] = {"angular_momentum_x", "angular_momentum_y",
                                                  "angular_momentum_z"};
  struct ledger *l = &m->ledger;
  gamut_status status = GAMUT_OK;
  if (keeps_momentum(m, k)) {
    const char *a = momentum[k], *unit = "kg m/s";
    status = line(m, a, "forward", unit, GAMUT_STORED, &l->forward[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "backward", unit, GAMUT_STORED, &l->backward[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "external forces", unit, GAMUT_SUPPLIED, &l->external_impulse[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "planes, forward", unit, GAMUT_SUPPLIED, &l->plane_forward[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "planes, backward", unit, GAMUT_SUPPLIED, &l->plane_backward[k]);
  }
  if (keeps_angular_momentum(m, k) && status == GAMUT_OK) {
    const char *a = angular_momentum[k], *unit = "kg m2/s";
    status = line(m, a, "forward", unit, GAMUT_STORED, &l->round[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "backward", unit, GAMUT_STORED, &l->back_round[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "external forces", unit, GAMUT_SUPPLIED, &l->external_torque[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "planes, forward", unit, GAMUT_SUPPLIED, &l->plane_round[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "planes, backward", unit, GAMUT_SUPPLIED, &l->plane_back_round[k]);
    if (status == GAMUT_OK)
      status = line(m, a, "gather loss", unit, GAMUT_LOST, &l->angular_momentum_loss[k]);
  }
  return status;
}

gamut_status ledger_open(struct model *m)
{
  struct ledger *l = &m->ledger;
  const struct {
    const char *account, *name, *unit;
    enum gamut_ledger_role role;
    double **value;
  } lines[] = {{"mass", "points", "kg", GAMUT_STORED, &l->mass},
               {"energy", "kinetic", "J", GAMUT_STORED, &l->kinetic},
               {"energy", "internal", "J", GAMUT_STORED, &l->internal},
               {"energy", "internal, half a step back", "J", GAMUT_STORED, &l->stagger},
               {"energy", "external forces", "J", GAMUT_SUPPLIED, &l->external_work},
               {"energy", "planes", "J", GAMUT_SUPPLIED, &l->plane_work},
               {"energy", "heat", "J", GAMUT_SUPPLIED, &l->heat},
               {"energy", "impact and friction at planes", "J", GAMUT_LOST, &l->impact_loss},
               {"energy", "scatter loss", "J", GAMUT_LOST, &l->scatter_loss},
               {"energy", "gather loss", "J", GAMUT_LOST, &l->gather_loss},
               {"energy", "stress remainder", "J", GAMUT_LOST, &l->remainder}};
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < sizeof lines / sizeof *lines && status == GAMUT_OK; i++)
    status = line(m, lines[i].account, lines[i].name, lines[i].unit, lines[i].role, lines[i].value);
  for (unsigned k = 0; k < 3 && status == GAMUT_OK; k++)
    status = open_motion(m, k);
  return status;
}

gamut_status ledger_open_taker(struct model *m, struct taker *t)
{
  static const char *const momentum[3] = {"momentum_x", "momentum_y", "momentum_z"};
  static const char *const angular_momentum[3] = {"angular_momentum_x", "angular_momentum_y",
                                                  "angular_momentum_z"};
  gamut_status status = line(m, "mass", t->name, "kg", GAMUT_LOST, &t->mass_line);
  if (status == GAMUT_OK)
    status = line(m, "energy", t->name, "J", GAMUT_LOST, &t->energy_line);
  for (unsigned k = 0; k < 3; k++) {
    if (keeps_momentum(m, k) && status == GAMUT_OK)
      status = line(m, momentum[k], t->name, "kg m/s", GAMUT_LOST, &t->momentum_line[k]);
    if (keeps_angular_momentum(m, k) && status == GAMUT_OK)
      status = line(m, angular_momentum[k], t->name, "kg m2/s", GAMUT_LOST,
                    &t->angular_momentum_line[k]);
  }
  return status;
}

/* What left the run since the start. */
static void show_taken(const struct model *m)
{
  for (size_t i = 0; i < m->removal.takers; i++) {
    const struct taker *t = m->removal.taker[i];
    *t->mass_line = t->total.mass;
    *t->energy_line = t->total.kinetic + t->total.internal;
    for (unsigned k = 0; k < 3; k++) {
      if (t->momentum_line[k] != NULL)
        *t->momentum_line[k] = t->total.momentum[k];
      if (t->angular_momentum_line[k] != NULL)
        *t->angular_momentum_line[k] = t->angular_momentum[k];
    }
  }
}

void ledger_add_up(const struct model *m, double total[POINT_SUMS])
{
  gamut_sum(m->run, m->block_sum, m->grid.sources, POINT_SUMS, total);
}

static void show_stored(struct model *m)
{
  struct ledger *l = &m->ledger;
  *l->mass = l->now[SUM_MASS];
  *l->kinetic = l->now[SUM_KINETIC];
  *l->internal = l->now[SUM_INTERNAL];
  for (unsigned k = 0; k < 3; k++) {
    if (l->forward[k] != NULL) {
      *l->forward[k] = l->now[SUM_FORWARD + k];
      *l->backward[k] = l->now[SUM_MOMENTUM + k] - l->now[SUM_FORWARD + k];
    }
    if (l->round[k] != NULL) {
      *l->round[k] = l->now[SUM_ROUND + k];
      *l->back_round[k] = l->now[SUM_ANGULAR_MOMENTUM + k] - l->now[SUM_ROUND + k];
    }
  }
}

void ledger_start(struct model *m)
{
  ledger_add_up(m, m->ledger.now);
  show_stored(m);
}

void ledger_keep(struct model *m, double step)
{
  struct ledger *l = &m->ledger;
  const double *gone = m->removal.now; /* came back from the grid, and then left */
  double was[POINT_SUMS];
  memcpy(was, l->now, sizeof was);
  ledger_add_up(m, l->now);
  show_stored(m);
  show_taken(m);
  /* the force stood at its place during the step while the velocity changed by force / mass */
  const double external = step * (was[SUM_POWER] + step * was[SUM_MOBILITY]);
  *l->external_work += external;
  *l->plane_work += m->planes.work;
  *l->impact_loss += m->planes.loss;
  *l->scatter_loss += was[SUM_KINETIC] - m->nodes.sum[TOTAL_BEFORE];
  *l->gather_loss += m->nodes.sum[TOTAL_AFTER] - (l->now[SUM_KINETIC] + gone[GONE_KINETIC]);
  *l->heat += l->now[SUM_HEAT];
  const double gain =
      l->now[SUM_INTERNAL] + gone[GONE_INTERNAL] - was[SUM_INTERNAL] - l->now[SUM_HEAT];
  const double stagger = *l->stagger;
  *l->stagger = -0.5 * gain;
  *l->remainder += external - m->nodes.sum[TOTAL_WORK] - gain - (*l->stagger - stagger);
  for (unsigned k = 0; k < 3; k++) {
    if (l->forward[k] != NULL) {
      *l->external_impulse[k] += step * was[SUM_FORCE + k];
      *l->plane_forward[k] += m->planes.forward[k];
      *l->plane_backward[k] += m->planes.backward[k];
    }
    if (l->round[k] != NULL) {
      *l->external_torque[k] += step * was[SUM_TORQUE + k];
      *l->plane_round[k] += m->planes.round[k];
      *l->plane_back_round[k] += m->planes.back_round[k];
      const double back = l->now[SUM_ANGULAR_MOMENTUM + k] + gone[GONE_ANGULAR_MOMENTUM + k];
      *l->angular_momentum_loss[k] += m->nodes.sum[TOTAL_ANGULAR_MOMENTUM + k] - back;
    }
  }
}
