/* What planes did in a step: impulses, work, area, and which nodes they hold. */
#include <math.h>
#include <string.h>

#include "planes/planes.h"
#include "model.h"

/* Area of a plane that a node at x stands for. */
static double node_area(const struct model *m, const struct plane *p, const double x[3])
{
  const double h = m->cell, pi = 3.14159265358979323846;
  switch (m->geometry) {
  case GEOMETRY_1D:
    return 1.0;
  case GEOMETRY_PLANE_STRAIN:
    return h;
  case GEOMETRY_AXISYMMETRIC:
    if (p->axis == 1 && fabs(x[0]) < 1e-6 * h)
      return 0.25 * pi * h * h;
    return 2.0 * pi * fabs(x[0]) * h;
  case GEOMETRY_3D:
    break;
  }
  return h * h;
}

/* Numbers in a row of sums: of all planes, and of each. */
static size_t columns_of(const struct model *m)
{
  return PLANE_SUMS + EACH_PLANE_SUMS * m->planes.count;
}

static double *row_of(const struct model *m, const struct touched *t)
{
  return m->planes.row + (size_t)t->row * columns_of(m);
}

static size_t rows_of(const struct model *m)
{
  return m->planes.of_nodes / m->grid.block_nodes;
}

void planes_begin_sums(struct model *m)
{
  memset(m->planes.row, 0, rows_of(m) * columns_of(m) * sizeof *m->planes.row);
}

void contact_begin(struct plane *p)
{
  p->area = p->contact_mass = p->densest = p->axis_area = 0.0;
}

static bool on_axis(const struct model *m, const struct plane *p, const struct touched *t)
{
  return m->geometry == GEOMETRY_AXISYMMETRIC && p->axis == 1 && fabs(t->x[0]) < 1e-6 * m->cell;
}

/* A full node on the axis has between once and twice the mass that its area holds. */
void contact_see(const struct model *m, struct plane *p, const struct touched *t)
{
  const double share = on_axis(m, p, t) ? 0.5 : 1.0;
  p->densest = fmax(p->densest, share * t->mass / node_area(m, p, t->x));
}

/* At its edge a body gives nodes less mass than inside. So the area is the mass of all nodes in
 * contact over that of a node, by its area, that is full, as the heaviest of the plane is taken to
 * be, in contact or not; a node on the axis counts with its own area. Not for an oblique plane,
 * whose nodes lie at different depths: there as many count as do on average. */
void contact_add(struct model *m, size_t plane, const struct touched *t)
{
  struct plane *p = m->planes.plane[plane];
  const double area = node_area(m, p, t->x);
  double *row = row_of(m, t) + PLANE_SUMS + EACH_PLANE_SUMS * plane;
  row[EACH_AREA] += area;
  if (on_axis(m, p, t))
    p->axis_area = area;
  else
    row[EACH_MASS] += t->mass;
}

static double contact_area(const struct plane *p)
{
  if (p->axis < 0)
    return p->area;
  return p->axis_area + (p->densest > 0.0 ? p->contact_mass / p->densest : 0.0);
}

/* Books what planes did at the nodes they touch. */
static void book_nodes(struct model *m, double step)
{
  struct planes *ps = &m->planes;
  for (size_t i = 0; i < ps->touches; i++) {
    struct touched *t = &ps->touched[i];
    const double *line = touched_line(m, (int32_t)i);
    double after[3], *row = row_of(m, t), *each = row + PLANE_SUMS;
    memset(t->given, 0, sizeof t->given);
    if (t->mass == 0.0)
      continue;
    for (int k = 0; k < 3; k++) {
      const double v = line[NODE_VELOCITY + k], whole = line[NODE_CHANGE + k];
      const double change = whole - t->rest[k], old = v - change, mean = v - 0.5 * change;
      const double own = t->mass * whole - step * t->force[k];
      const struct plane *p = ps->plane[t->owner[k]];
      row[PLANE_NODES + TOTAL_BEFORE] += 0.5 * t->mass * old * old;
      row[PLANE_NODES + TOTAL_AFTER] += 0.5 * t->mass * v * v;
      row[PLANE_NODES + TOTAL_WORK] += (step * t->force[k] - t->mass * t->rest[k]) * mean;
      row[PLANE_WORK] += own * p->given.velocity[k];
      row[PLANE_LOSS] += own * (p->given.velocity[k] - mean);
      each[EACH_PLANE_SUMS * (size_t)t->owner[k] + EACH_WORK] += own * p->given.velocity[k];
      t->given[k] = own + m->pic * (t->mass * old - t->momentum[k]);
      after[k] = t->momentum[k] + t->mass * whole;
      m->nodes.speed = fmax(m->nodes.speed, fabs(v));
    }
    for (int k = 0; k < 3; k++) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      const double moment = t->x[a] * (after[b] - t->momentum[b] - step * t->force[b]) -
                            t->x[b] * (after[a] - t->momentum[a] - step * t->force[a]);
      row[PLANE_ROUND + k] += fmax(moment, 0.0);
      row[PLANE_BACK_ROUND + k] += fmin(moment, 0.0);
      row[PLANE_NODES + TOTAL_ANGULAR_MOMENTUM + k] += t->x[a] * after[b] - t->x[b] * after[a];
    }
  }
}

/* Adds up what the blocks with touched nodes have. */
static void add_rows(struct model *m)
{
  struct planes *ps = &m->planes;
  double total[PLANE_SUMS + EACH_PLANE_SUMS * PLANES_MAX];
  gamut_sum(m->run, ps->row, rows_of(m), columns_of(m), total);
  for (int q = 0; q < TOTAL_SUMS; q++)
    m->nodes.sum[q] += total[PLANE_NODES + q];
  ps->work = total[PLANE_WORK];
  ps->loss = total[PLANE_LOSS];
  memcpy(ps->round, total + PLANE_ROUND, sizeof ps->round);
  memcpy(ps->back_round, total + PLANE_BACK_ROUND, sizeof ps->back_round);
  for (size_t i = 0; i < ps->count; i++) {
    const double *each = total + PLANE_SUMS + EACH_PLANE_SUMS * i;
    ps->plane[i]->reaction->work += each[EACH_WORK];
    ps->plane[i]->area = each[EACH_AREA];
    ps->plane[i]->contact_mass = each[EACH_MASS];
  }
}

/* Remembers which nodes are in contact. */
static gamut_status remember(struct model *m, struct plane *p)
{
  if (places_clear(m->run, &p->held, p->columns + p->nodes) != GAMUT_OK)
    return GAMUT_INTERNAL;
  for (size_t c = 0; c < p->columns; c++)
    if (p->column[c].contact)
      places_put(p->held, p->column[c].node, 1);
  for (size_t n = 0; n < p->nodes; n++)
    if (p->node[n].contact)
      places_put(p->held, p->node[n].node, 1);
  return GAMUT_OK;
}

gamut_status planes_book(struct model *m, double step)
{
  struct planes *ps = &m->planes;
  book_nodes(m, step);
  add_rows(m);
  for (size_t i = 0; i < ps->count; i++) {
    struct plane *p = ps->plane[i];
    p->reaction->area = p->area = contact_area(p);
    if (remember(m, p) != GAMUT_OK)
      return GAMUT_INTERNAL;
  }
  return GAMUT_OK;
}

void planes_before_pass(struct model *m)
{
  for (size_t i = 0; i < m->planes.touches; i++)
    memcpy(m->planes.touched[i].passed, touched_line(m, (int32_t)i) + NODE_VELOCITY,
           sizeof m->planes.touched[i].passed);
}

void planes_book_pass(struct model *m, double weight)
{
  for (size_t i = 0; i < m->planes.touches; i++) {
    struct touched *t = &m->planes.touched[i];
    const double *velocity = touched_line(m, (int32_t)i) + NODE_VELOCITY;
    for (int k = 0; k < 3; k++)
      t->given[k] += weight * (t->mass * velocity[k] - t->passed[k]);
  }
}

/* Of momentum that plane number `plane` gave at a node and its images, what is along its normal. */
static double push_of(const struct model *m, size_t plane, int32_t touched)
{
  const struct touched *t = &m->planes.touched[touched];
  double push = 0.0;
  for (int k = 0; k < 3; k++)
    if (t->owner[k] == (int8_t)plane)
      push += m->planes.plane[plane]->given.normal[k] * t->all_given[k];
  return push;
}

/* What a wall takes at a node behind a symmetry plane it takes at the node before it: both are one,
 * and would not be if each gave back its own share. */
static void fold_given(struct model *m, const struct plane *p)
{
  for (size_t c = 0; c < p->columns; c++) {
    const int32_t *touched = p->column[c].touched;
    if (!p->column[c].contact || touched[BEFORE] < 0 || touched[BEHIND] < 0)
      continue;
    struct touched *before = &m->planes.touched[touched[BEFORE]];
    struct touched *behind = &m->planes.touched[touched[BEHIND]];
    before->all_mass += behind->all_mass;
    for (int k = 0; k < 3; k++)
      before->all_given[k] += (p->odd[k] ? -1.0 : 1.0) * behind->all_given[k];
    behind->image = true;
  }
}

static void unfold_back(struct model *m, const struct plane *p)
{
  for (size_t c = 0; c < p->columns; c++) {
    const int32_t *touched = p->column[c].touched;
    if (!p->column[c].contact || touched[BEFORE] < 0 || touched[BEHIND] < 0)
      continue;
    for (int k = 0; k < 3; k++)
      m->planes.touched[touched[BEHIND]].back[k] =
          (p->odd[k] ? -1.0 : 1.0) * m->planes.touched[touched[BEFORE]].back[k];
  }
}

/* The points at these nodes get back, at one velocity, what the plane took from them against its
 * normal. The transfer may ask for that where the points' velocity is not that of the nodes: what
 * it damps at a wall would be damped by a pull. */
static void find_back(struct model *m, size_t plane, const int32_t *touched, int nodes)
{
  const double *normal = m->planes.plane[plane]->given.normal;
  double push = 0.0, mass = 0.0;
  for (int n = 0; n < nodes; n++)
    if (touched[n] >= 0 && !m->planes.touched[touched[n]].image) {
      push += push_of(m, plane, touched[n]);
      mass += m->planes.touched[touched[n]].all_mass;
    }
  if (!(push < 0.0) || !(mass > 0.0))
    return;
  for (int n = 0; n < nodes; n++)
    for (int k = 0; k < 3 && touched[n] >= 0; k++)
      m->planes.touched[touched[n]].back[k] -= push / mass * normal[k];
}

static void give_back(struct model *m)
{
  struct planes *ps = &m->planes;
  for (size_t i = 0; i < ps->touches; i++) {
    struct touched *t = &ps->touched[i];
    t->all_mass = t->mass;
    t->image = false;
    memcpy(t->all_given, t->given, sizeof t->all_given);
    memset(t->back, 0, sizeof t->back);
  }
  for (size_t i = 0; i < ps->count; i++)
    if (!ps->plane[i]->given.unilateral)
      fold_given(m, ps->plane[i]);
  for (size_t i = 0; i < ps->count; i++) {
    const struct plane *p = ps->plane[i];
    for (size_t c = 0; c < p->columns && p->given.unilateral; c++)
      find_back(m, i, p->column[c].touched, 3);
    for (size_t n = 0; n < p->nodes && p->given.unilateral; n++)
      find_back(m, i, &p->node[n].touched, 1);
  }
  for (size_t i = ps->count; i-- > 0;)
    if (!ps->plane[i]->given.unilateral)
      unfold_back(m, ps->plane[i]);
  for (size_t i = 0; i < ps->touches; i++)
    for (int k = 0; k < 3; k++) {
      struct touched *t = &ps->touched[i];
      t->given[k] += t->mass * t->back[k];
      touched_line(m, (int32_t)i)[NODE_CHANGE + k] += t->back[k];
    }
}

/* A row a block of touched nodes, of three numbers a plane. */
static void add_impulses(struct model *m)
{
  struct planes *ps = &m->planes;
  const size_t columns = 3 * ps->count;
  double total[3 * PLANES_MAX];
  memset(ps->row, 0, rows_of(m) * columns * sizeof *ps->row);
  for (size_t i = 0; i < ps->touches; i++) {
    const struct touched *t = &ps->touched[i];
    double *row = ps->row + (size_t)t->row * columns;
    for (size_t k = 0; k < 3; k++)
      row[3 * (size_t)t->owner[k] + k] += t->given[k];
  }
  gamut_sum(m->run, ps->row, rows_of(m), columns, total);
  for (size_t i = 0; i < ps->count; i++)
    memcpy(ps->plane[i]->impulse, total + 3 * i, sizeof ps->plane[i]->impulse);
}

void planes_report(struct model *m, double step)
{
  struct planes *ps = &m->planes;
  give_back(m);
  memset(ps->forward, 0, sizeof ps->forward);
  memset(ps->backward, 0, sizeof ps->backward);
  add_impulses(m);
  for (size_t i = 0; i < ps->count; i++)
    for (int k = 0; k < 3; k++) {
      struct plane *p = ps->plane[i];
      ps->forward[k] += fmax(p->impulse[k], 0.0);
      ps->backward[k] += fmin(p->impulse[k], 0.0);
      p->reaction->force[k] = -p->impulse[k] / step;
      p->reaction->impulse[k] -= p->impulse[k];
    }
}
