/* What planes do to the nodes that find.c found. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "model.h"
#include "planes/planes.h"

/* Adds the image of the node behind to the node before. The mass is line[mass], the momentum begins
 * at `vector`; forces go along where there are any. */
static void fold(const struct plane *p, double *const line[3], int mass, int vector, bool force)
{
  double *before = line[BEFORE], *on = line[ON], *behind = line[BEHIND];
  for (int k = 0; k < 3; k++) {
    const double v = p->given.velocity[k];
    if (p->odd[k]) {
      on[vector + k] = on[mass] * v;
      if (force)
        on[NODE_FORCE + k] = 0.0;
    }
    if (before == NULL || behind == NULL)
      continue;
    const double sign = p->odd[k] ? -1.0 : 1.0, shift = p->odd[k] ? 2.0 * v * behind[mass] : 0.0;
    before[vector + k] += sign * behind[vector + k] + shift;
    behind[vector + k] = 0.0;
    if (force) {
      before[NODE_FORCE + k] += sign * behind[NODE_FORCE + k];
      behind[NODE_FORCE + k] = 0.0;
    }
  }
  if (before != NULL && behind != NULL) {
    before[mass] += behind[mass];
    behind[mass] = 0.0;
  }
}

/* Whether the material at the plane's node, left alone, would go into the plane. */
static bool presses(const struct plane *p, const double *line, double step)
{
  double speed = 0.0;
  for (int k = 0; k < 3; k++)
    speed += p->given.normal[k] *
             ((line[NODE_MOMENTUM + k] + step * line[NODE_FORCE + k]) / line[NODE_MASS] -
              p->given.velocity[k]);
  return speed < 0.0;
}

/* Whether material in contact is still pressed: the sign of the impulse that the plane would give.
 */
static bool pressed(const struct plane *p, double *const line[3], double step)
{
  const double *before = line[BEFORE], *behind = line[BEHIND];
  double impulse = 0.0, mass = 0.0, difference = 0.0;
  for (int k = BEFORE; k <= BEHIND; k++)
    if (line[k] != NULL)
      impulse -= step * p->given.normal[p->axis] * line[k][NODE_FORCE + p->axis];
  if (before != NULL) {
    mass += before[NODE_MASS];
    difference += before[NODE_MASS];
    if (behind != NULL) {
      mass += behind[NODE_MASS];
      difference -= behind[NODE_MASS];
    }
    const double force =
        before[NODE_FORCE + p->axis] - (behind != NULL ? behind[NODE_FORCE + p->axis] : 0.0);
    if (mass > 0.0)
      impulse += step * p->given.normal[p->axis] * force * difference / mass;
  }
  return impulse >= 0.0;
}

/* Whether the column holds the plane in this step. */
static bool in_contact(const struct model *m, const struct plane *p, const struct column *c,
                       double *const line[3], double step)
{
  if (!p->given.unilateral)
    return line[ON][NODE_MASS] > 0.0;
  if (!(line[ON][NODE_MASS] > m->grid.empty))
    return false;
  return c->arrives ? presses(p, line[ON], step) : pressed(p, line, step);
}

void planes_before_update(struct model *m)
{
  struct planes *ps = &m->planes;
  const double step = gamut_time_step(m->run);
  for (size_t i = 0; i < ps->touches; i++) {
    struct touched *t = &ps->touched[i];
    double *line = touched_line(m, (int32_t)i);
    t->mass = line[NODE_MASS];
    memcpy(t->momentum, line + NODE_MOMENTUM, sizeof t->momentum);
    memcpy(t->force, line + NODE_FORCE, sizeof t->force);
    /* A mark for the update: below zero, as no sum of squares is in any rounding mode. */
    line[NODE_SQUARE] = -fmax(fabs(line[NODE_SQUARE]), DBL_MIN);
  }
  for (size_t i = 0; i < ps->count; i++) {
    struct plane *p = ps->plane[i];
    for (size_t c = 0; c < p->columns; c++) {
      struct column *column = &p->column[c];
      double *line[3];
      for (int k = 0; k < 3; k++)
        line[k] = touched_line(m, column->touched[k]);
      column->arrives = places_find(p->held, column->node) < 0;
      column->contact = in_contact(m, p, column, line, step);
      if (column->contact)
        fold(p, line, NODE_MASS, NODE_MOMENTUM, true);
    }
  }
}

/* The image of the node before, at the node behind: the velocity at `vector`, its change where
 * there is one. */
static void unfold(const struct plane *p, double *const line[3], bool change)
{
  if (line[BEHIND] == NULL || line[BEFORE] == NULL)
    return;
  for (int k = 0; k < 3; k++) {
    const double v = line[BEFORE][NODE_VELOCITY + k];
    line[BEHIND][NODE_VELOCITY + k] = p->odd[k] ? 2.0 * p->given.velocity[k] - v : v;
    if (change)
      line[BEHIND][NODE_CHANGE + k] =
          p->odd[k] ? -line[BEFORE][NODE_CHANGE + k] : line[BEFORE][NODE_CHANGE + k];
  }
}

/* Takes the tangential velocity down by at most friction times the normal impulse. */
static void rub(const struct plane *p, double *v, double mass, double normal_impulse)
{
  const double *n = p->given.normal;
  double slip[3], along = 0.0, speed = 0.0;
  for (int k = 0; k < 3; k++)
    along += (v[k] - p->given.velocity[k]) * n[k];
  for (int k = 0; k < 3; k++) {
    slip[k] = v[k] - p->given.velocity[k] - along * n[k];
    speed += slip[k] * slip[k];
  }
  speed = sqrt(speed);
  const double most = p->given.friction * normal_impulse / mass;
  if (!(speed > 0.0) || !(most > 0.0))
    return;
  const double part = most < speed ? most / speed : 1.0;
  for (int k = 0; k < 3; k++)
    v[k] -= part * slip[k];
}

/* Component along the plane's normal of a velocity relative to the plane. */
static double along_normal(const struct plane *p, const double v[3])
{
  double sum = 0.0;
  for (int k = 0; k < 3; k++)
    sum += (v[k] - p->given.velocity[k]) * p->given.normal[k];
  return sum;
}

static double press_of(const struct plane *p, const double force[3], double step)
{
  double sum = 0.0;
  for (int k = 0; k < 3; k++)
    sum -= step * force[k] * p->given.normal[k];
  return sum;
}

/* A velocity with what the plane forbids taken away. */
static void fit(const struct plane *p, double v[3])
{
  const double into = along_normal(p, v);
  for (int k = 0; k < 3; k++) {
    const double n = p->given.normal[k], wall = p->given.velocity[k];
    if (p->given.tangential_rule == GAMUT_PLANE_PRESCRIBED)
      v[k] = wall + into * n;
    if (p->given.normal_rule != GAMUT_PLANE_FREE)
      v[k] -= into * n;
  }
}

/* The condition at one node, on the velocity after the step, and on that before it unless material
 * just arrives. True in contact. */
static bool hold(const struct plane *p, double *line, const double force[3], double step,
                 bool arrives)
{
  double *v = line + NODE_VELOCITY, *change = line + NODE_CHANGE, old[3];
  const double press = press_of(p, force, step);
  if (p->given.unilateral && (arrives ? along_normal(p, v) >= 0.0 : press < 0.0))
    return false;
  for (int k = 0; k < 3; k++)
    old[k] = v[k] - change[k];
  fit(p, v);
  if (!arrives)
    fit(p, old);
  if (p->given.friction > 0.0)
    rub(p, v, line[NODE_FRACTION], press);
  for (int k = 0; k < 3; k++)
    change[k] = v[k] - old[k];
  return true;
}

/* Material that arrives is stopped: the velocity before the step is what it was without the plane.
 * At a plane that always holds, only if the material really flies at it; velocity that grows from
 * the plane on is in order. */
static void stop_arrival(struct model *m, const struct plane *p, const struct column *c)
{
  const struct touched *on = &m->planes.touched[c->touched[ON]];
  for (int k = 0; k < 3; k++) {
    if (!p->odd[k])
      continue;
    if (!p->given.unilateral) {
      if (c->touched[BEFORE] < 0 || !(on->mass > 0.0))
        continue;
      const struct touched *before = &m->planes.touched[c->touched[BEFORE]];
      const double v = p->given.velocity[k];
      if (!(before->mass > 0.0) || fabs(on->momentum[k] / on->mass - v) <=
                                       0.7 * fabs(before->momentum[k] / before->mass - v))
        continue;
    }
    for (int n = BEFORE; n <= BEHIND; n++) {
      double *line = touched_line(m, c->touched[n]);
      if (line == NULL || !(m->planes.touched[c->touched[n]].mass > m->grid.empty))
        continue;
      const struct touched *t = &m->planes.touched[c->touched[n]];
      line[NODE_CHANGE + k] = line[NODE_VELOCITY + k] - t->momentum[k] / t->mass;
    }
  }
}

static void column_friction(struct model *m, const struct plane *p, const struct column *c,
                            double step)
{
  double normal = 0.0;
  for (int k = 0; k < 3; k++) {
    const double *line = touched_line(m, c->touched[k]);
    if (line == NULL)
      continue;
    const struct touched *t = &m->planes.touched[c->touched[k]];
    for (int i = 0; i < 3; i++)
      normal += p->given.normal[i] * (t->mass * line[NODE_CHANGE + i] - step * t->force[i]);
  }
  double *line = touched_line(m, c->touched[ON]);
  double before[3];
  memcpy(before, line + NODE_VELOCITY, sizeof before);
  rub(p, line + NODE_VELOCITY, line[NODE_FRACTION], normal);
  for (int k = 0; k < 3; k++)
    line[NODE_CHANGE + k] += line[NODE_VELOCITY + k] - before[k];
}

/* What the limit of a nearly empty node's acceleration keeps from strain and places; the points'
 * velocity gets it none the less. Before planes act on the nodes' change. */
static void find_rest(struct model *m)
{
  for (size_t i = 0; i < m->planes.touches; i++) {
    const double *line = touched_line(m, (int32_t)i);
    const double slow = line[NODE_SLOW];
    const bool slowed = slow > 0.0 && (m->limited || !(line[NODE_FRACTION] > m->grid.empty));
    for (int k = 0; k < 3; k++)
      m->planes.touched[i].rest[k] = slowed ? line[NODE_CHANGE + k] * (1.0 / slow - 1.0) : 0.0;
  }
}

/* The rest at the node behind a plane, which is an image. */
static void unfold_rest(struct model *m, const struct plane *p, const struct column *c)
{
  if (c->touched[BEFORE] < 0 || c->touched[BEHIND] < 0)
    return;
  const double *before = m->planes.touched[c->touched[BEFORE]].rest;
  double *behind = m->planes.touched[c->touched[BEHIND]].rest;
  for (int k = 0; k < 3; k++)
    behind[k] = p->odd[k] ? -before[k] : before[k];
}

/* Gives it, along what planes leave free. */
static void give_rest(struct model *m)
{
  struct planes *ps = &m->planes;
  for (size_t i = 0; i < ps->count; i++) {
    const struct plane *p = ps->plane[i];
    for (size_t n = 0; n < p->nodes; n++) {
      double *rest = ps->touched[p->node[n].touched].rest, along = 0.0;
      if (!p->node[n].contact)
        continue;
      for (int k = 0; k < 3; k++)
        along += rest[k] * p->given.normal[k];
      for (int k = 0; k < 3; k++) {
        const double normal = along * p->given.normal[k];
        if (p->given.tangential_rule == GAMUT_PLANE_PRESCRIBED)
          rest[k] = normal;
        if (p->given.normal_rule != GAMUT_PLANE_FREE)
          rest[k] -= normal;
      }
    }
  }
  for (size_t i = 0; i < ps->touches; i++)
    for (int k = 0; k < 3; k++)
      touched_line(m, (int32_t)i)[NODE_CHANGE + k] += ps->touched[i].rest[k];
}

/* The share of the velocity before the step that goes to the points with its change. */
static void give_old(struct model *m)
{
  for (size_t i = 0; i < m->planes.touches; i++) {
    double *line = touched_line(m, (int32_t)i);
    for (int k = 0; k < 3; k++) {
      const double change = line[NODE_CHANGE + k] - m->planes.touched[i].rest[k];
      line[NODE_CHANGE + k] += m->give_old * (line[NODE_VELOCITY + k] - change);
    }
  }
}

gamut_status planes_after_update(struct model *m, double step)
{
  struct planes *ps = &m->planes;
  find_rest(m);
  planes_begin_sums(m);
  for (size_t i = 0; i < ps->count; i++) {
    struct plane *p = ps->plane[i];
    contact_begin(p);
    for (size_t n = 0; n < p->nodes; n++) {
      struct held_node *node = &p->node[n];
      const struct touched *t = &ps->touched[node->touched];
      double *line = touched_line(m, node->touched);
      const bool arrives =
          (p->given.unilateral || p->moves) && !p->images && places_find(p->held, node->node) < 0;
      const bool at = plane_distance(p, t->x, gamut_time(m->run)) > -0.999 * m->cell;
      if (at)
        contact_see(m, p, t);
      node->contact = line[NODE_FRACTION] > (p->given.unilateral ? m->grid.empty : 0.0) &&
                      hold(p, line, t->force, step, arrives);
      if (node->contact && at)
        contact_add(m, i, t);
    }
  }
  for (size_t i = ps->count; i-- > 0;) {
    struct plane *p = ps->plane[i];
    for (size_t c = 0; c < p->columns; c++) {
      const struct touched *on = &ps->touched[p->column[c].touched[ON]];
      contact_see(m, p, on);
      if (!p->column[c].contact)
        continue;
      double *line[3];
      for (int k = 0; k < 3; k++)
        line[k] = touched_line(m, p->column[c].touched[k]);
      unfold(p, line, true);
      unfold_rest(m, p, &p->column[c]);
      if (p->column[c].arrives)
        stop_arrival(m, p, &p->column[c]);
      if (p->given.friction > 0.0)
        column_friction(m, p, &p->column[c], step);
      contact_add(m, i, on);
    }
  }
  give_rest(m);
  const gamut_status status = planes_book(m, step);
  if (m->give_old != 0.0)
    give_old(m);
  return status;
}

void planes_before_second(struct model *m)
{
  struct planes *ps = &m->planes;
  for (size_t i = 0; i < ps->count; i++) {
    struct plane *p = ps->plane[i];
    for (size_t c = 0; c < p->columns; c++) {
      double *line[3];
      for (int k = 0; k < 3; k++)
        line[k] = touched_line(m, p->column[c].touched[k]);
      if (p->column[c].contact || !p->given.unilateral)
        fold(p, line, NODE_FRACTION, NODE_VELOCITY, false);
    }
  }
}

void planes_after_second(struct model *m)
{
  struct planes *ps = &m->planes;
  for (size_t i = 0; i < ps->count; i++) {
    struct plane *p = ps->plane[i];
    for (size_t n = 0; n < p->nodes; n++)
      if (p->node[n].contact || !p->given.unilateral)
        fit(p, touched_line(m, p->node[n].touched) + NODE_VELOCITY);
  }
  for (size_t i = ps->count; i-- > 0;) {
    struct plane *p = ps->plane[i];
    for (size_t c = 0; c < p->columns; c++) {
      double *line[3];
      for (int k = 0; k < 3; k++)
        line[k] = touched_line(m, p->column[c].touched[k]);
      if (p->column[c].contact || !p->given.unilateral)
        unfold(p, line, false);
    }
  }
}
