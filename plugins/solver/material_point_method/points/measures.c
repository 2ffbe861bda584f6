/* Measures of bodies. A point stands for the material around it: for half its spacing at the start,
 * made longer or shorter as the body is along that axis near the point, which is not known, so as
 * the cube (in two dimensions the square) root of its volume ratio says. */
#include <math.h>
#include <string.h>

#include "model.h"

/* Below so many slots threads cost more than they give. */
enum { FEW_SLOTS = 1 << 14 };

GAMUT_CHOICE_IS_AXIS(MATERIAL_POINT_METHOD_EXTENT_AXIS);
GAMUT_CHOICE_IS_AXIS(MATERIAL_POINT_METHOD_DIAMETER_ALONG);
GAMUT_CHOICE_IS_AXIS(MATERIAL_POINT_METHOD_FRONT_AXIS);
GAMUT_CHOICE_IS_AXIS(MATERIAL_POINT_METHOD_MOMENTUM_AXIS);
GAMUT_CHOICE_IS_AXIS(MATERIAL_POINT_METHOD_MEAN_VELOCITY_AXIS);

/* The points of a body with what measures need of them. */
struct cloud {
  const struct body *body;
  const struct gamut_set *set;
  const double *x[3], *v[3], *mass, *ratio, *energy, *stress[6];
};

static struct cloud cloud_of(const struct model *m, const struct gamut_body *wanted)
{
  struct cloud c = {0};
  for (size_t i = 0; i < m->bodies; i++)
    if (m->body[i].scene == wanted)
      c.body = &m->body[i];
  c.set = c.body->set;
  for (unsigned k = 0; k < 3; k++) {
    c.x[k] = m->host->stored(c.set, m->field.position, k);
    c.v[k] = m->host->stored(c.set, m->field.velocity, k);
  }
  for (unsigned k = 0; k < 6; k++)
    c.stress[k] = m->host->stored(c.set, m->field.stress, k);
  c.mass = m->host->stored(c.set, m->field.mass, 0);
  c.ratio = m->host->stored(c.set, m->field.volume_ratio, 0);
  c.energy = m->host->stored(c.set, m->field.energy, 0);
  return c;
}

/* Half the present size of a point over half its size at the start. */
static double growth(const struct model *m, double ratio)
{
  return m->dimension == 1 ? ratio : m->dimension == 2 ? sqrt(ratio) : cbrt(ratio);
}

/* Whether some of GAMUT_LANES points may reach beyond low and high; without taking a root. */
static bool may_reach(const double *x, const double *ratio, double start, double low, double high)
{
  int beyond = 0;
#pragma omp simd reduction(| : beyond)
  for (size_t l = 0; l < GAMUT_LANES; l++) {
    const double most = start * (ratio[l] > 1.0 ? ratio[l] : 1.0);
    beyond |= !(x[l] - most >= low) | !(x[l] + most <= high);
  }
  return beyond != 0;
}

/* Edges along an axis, of the points with lower <= x[along] <= upper. */
struct edges {
  int axis, along;
  double lower, upper;
  bool any;
  double low, high;
};

static void edges_of(const struct model *m, const struct cloud *c, size_t slot, size_t end,
                     struct edges *e)
{
  const double start = 0.5 * c->body->spacing[e->axis];
  for (size_t i = slot; i < end; i++) {
    while (e->any && i % GAMUT_LANES == 0 && i < end &&
           !may_reach(c->x[e->axis] + i, c->ratio + i, start, e->low, e->high))
      i += GAMUT_LANES;
    if (i >= end)
      break;
    if (c->set->id[i] < 0 ||
        (e->along >= 0 && !(c->x[e->along][i] >= e->lower && c->x[e->along][i] <= e->upper)))
      continue;
    const double ratio = c->ratio[i], most = start * (ratio > 1.0 ? ratio : 1.0);
    const double x = c->x[e->axis][i];
    if (e->any && x - most >= e->low && x + most <= e->high)
      continue;
    const double half = start * growth(m, ratio);
    e->low = e->any && e->low < x - half ? e->low : x - half;
    e->high = e->any && e->high > x + half ? e->high : x + half;
    e->any = true;
  }
}

/* From the lowest to the highest edge; by ranges of slots, of which no bit depends. */
static bool span(const struct model *m, const struct cloud *c, int axis, int along, double lower,
                 double upper, double *low, double *high)
{
  const size_t slots = c->set->slots, lanes = slots / GAMUT_LANES;
  const size_t ranges = slots >= FEW_SLOTS ? (size_t)m->threads : 1;
  bool any = false;
#pragma omp parallel for schedule(static, 1) num_threads((int)ranges)
  for (size_t r = 0; r < ranges; r++) {
    struct edges e = {.axis = axis, .along = along, .lower = lower, .upper = upper};
    edges_of(m, c, lanes * r / ranges * GAMUT_LANES, lanes * (r + 1) / ranges * GAMUT_LANES, &e);
#pragma omp critical(material_point_method_edges)
    if (e.any) {
      *low = any && *low < e.low ? *low : e.low;
      *high = any && *high > e.high ? *high : e.high;
      any = true;
    }
  }
  return any;
}

static double width(const struct model *m, double low, double high, int axis)
{
  return m->geometry == GEOMETRY_AXISYMMETRIC && axis == 0 ? 2.0 * high : high - low;
}

static gamut_status extent(struct model *m, const struct cloud *c, int axis, double *value)
{
  double low = 0.0, high = 0.0;
  if (axis >= (int)m->dimension)
    return gamut_fail(m->run, GAMUT_SCENE, "there is no axis %c in this geometry", "xyz"[axis]);
  span(m, c, axis, -1, 0.0, 0.0, &low, &high);
  *value = high - low;
  return GAMUT_OK;
}

/* Width across the bar at a height above its foot (the lowest end): of the points no farther than
 * `within` above or below, and half a cell at least; more where there are none. */
static gamut_status diameter(struct model *m, const struct cloud *c,
                             const struct gamut_values *arguments, double *value)
{
  const int along = (int)material_point_method_diameter_along_of(arguments);
  const int axis = along == 0 ? 1 : 0;
  const double part = gamut_real(arguments, "height");
  double low = 0.0, high = 0.0, from = 0.0, to = 0.0;
  if (along >= (int)m->dimension || axis >= (int)m->dimension)
    return gamut_fail(m->run, GAMUT_SCENE, "a diameter needs two axes");
  span(m, c, along, -1, 0.0, 0.0, &low, &high);
  double length = 0.0;
  switch (material_point_method_diameter_of_of(arguments)) {
  case MATERIAL_POINT_METHOD_DIAMETER_OF_INITIAL:
    length = c->body->spacing[along] * (double)c->body->count[along];
    break;
  case MATERIAL_POINT_METHOD_DIAMETER_OF_CURRENT:
    length = high - low;
    break;
  }
  const double place = low + part * length;
  double reach = fmax(gamut_real(arguments, "within") * length, 0.5 * m->cell);
  while (!span(m, c, axis, along, place - reach, place + reach, &from, &to) && reach < length)
    reach *= 2.0;
  *value = width(m, from, to, axis);
  return GAMUT_OK;
}

/* The field of that name; none for a pressure, which follows from the stress, less `part`. */
static gamut_status field_pointer(struct model *m, const struct cloud *c, const char *name,
                                  const double **value, const double **part)
{
  static const char *const stress[6] = {"stress_xx", "stress_yy", "stress_zz",
                                        "stress_xy", "stress_yz", "stress_zx"};
  static const char *const speed[3] = {"velocity_x", "velocity_y", "velocity_z"};
  static const char *const pressure[2] = {"pressure", "total_pressure"};
  *value = *part = NULL;
  for (unsigned k = 0; k < 2; k++)
    if (strcmp(name, pressure[k]) == 0) {
      *part = k == 0 ? m->host->stored(c->set, m->field.viscous_pressure, 0) : NULL;
      return GAMUT_OK;
    }
  for (unsigned k = 0; k < 6; k++)
    if (strcmp(name, stress[k]) == 0)
      *value = c->stress[k];
  for (unsigned k = 0; k < 3; k++)
    if (strcmp(name, speed[k]) == 0)
      *value = c->v[k];
  if (*value != NULL)
    return GAMUT_OK;
  struct gamut_field field;
  if (gamut_field_named(m->run, name, &field) != GAMUT_OK)
    return GAMUT_SCENE;
  *value = m->host->stored(c->set, field, 0);
  return *value != NULL ? GAMUT_OK
                        : gamut_fail(m->run, GAMUT_SCENE,
                                     "the field '%s' is not kept in this scene, so it cannot be "
                                     "measured; list it under outputs.fields",
                                     name);
}

/* `field`, or without one the mean stress, positive in compression, less `part` of it. */
static double sample(const struct cloud *c, const double *field, const double *part, size_t i)
{
  if (field)
    return field[i];
  return -(c->stress[0][i] + c->stress[1][i] + c->stress[2][i]) / 3.0 - (part ? part[i] : 0.0);
}

struct sampled {
  const double *field, *part;
};

/* Highest place, along an axis, of a point whose field is beyond the level; where there is none,
 * the body's lowest point. */
static gamut_status front(struct model *m, const struct cloud *c,
                          const struct gamut_values *arguments, double *value)
{
  struct sampled s;
  const gamut_status status =
      field_pointer(m, c, gamut_text(arguments, "field"), &s.field, &s.part);
  if (status != GAMUT_OK)
    return status;
  const double *x = c->x[material_point_method_front_axis_of(arguments)];
  const double level = gamut_given(arguments, "level") ? gamut_real(arguments, "level") : 0.0;
  double most = -INFINITY, lowest = INFINITY;
  for (size_t i = 0; i < c->set->slots; i++) {
    if (c->set->id[i] < 0)
      continue;
    if (sample(c, s.field, s.part, i) >= level && x[i] > most)
      most = x[i];
    lowest = x[i] < lowest ? x[i] : lowest;
  }
  *value = c->set->points == 0 ? NAN : isfinite(most) ? most : lowest;
  return GAMUT_OK;
}

static gamut_status maximum(struct model *m, const struct cloud *c,
                            const struct gamut_values *arguments, double *value)
{
  struct sampled s;
  const gamut_status status =
      field_pointer(m, c, gamut_text(arguments, "field"), &s.field, &s.part);
  double most = -INFINITY;
  if (status != GAMUT_OK)
    return status;
  for (size_t i = 0; i < c->set->slots; i++) {
    const double here = c->set->id[i] >= 0 ? sample(c, s.field, s.part, i) : -INFINITY;
    most = here > most ? here : most;
  }
  *value = c->set->points == 0 ? NAN : most;
  return GAMUT_OK;
}

/* What point i adds to MEASURED sums. */
typedef void add_point(const struct model *, const struct cloud *, const void *how, size_t i,
                       double *sum);

/* Sums over the points of a body: block by block, in the order of slots, then over blocks. */
static void add_up(struct model *m, const struct cloud *c, add_point *add, const void *how,
                   double total[MEASURED])
{
  const struct gamut_set *set = c->set;
  for (size_t b = 0; b < set->blocks; b++) {
    double *row = m->totals.measured + b * MEASURED;
    memset(row, 0, MEASURED * sizeof *row);
    for (size_t i = set->first[b]; i < set->first[b + 1]; i++)
      if (set->id[i] >= 0)
        add(m, c, how, i, row);
  }
  gamut_sum(m->run, m->totals.measured, set->blocks, MEASURED, total);
}

static void add_sample(const struct model *m, const struct cloud *c, const void *how, size_t i,
                       double *sum)
{
  const struct sampled *s = how;
  const double volume = c->mass[i] * c->ratio[i];
  (void)m;
  sum[0] += volume * sample(c, s->field, s->part, i);
  sum[1] += volume;
}

/* By volume; a body that has lost all its points has none. */
static gamut_status mean(struct model *m, const struct cloud *c,
                         const struct gamut_values *arguments, double *value)
{
  struct sampled s;
  double sum[MEASURED];
  const gamut_status status =
      field_pointer(m, c, gamut_text(arguments, "field"), &s.field, &s.part);
  if (status != GAMUT_OK)
    return status;
  add_up(m, c, add_sample, &s, sum);
  *value = c->set->points == 0 ? NAN : sum[0] / sum[1];
  return GAMUT_OK;
}

static void add_long(const struct model *m, const struct cloud *c, const void *how, size_t i,
                     double *sum)
{
  const double *const *length = how;
  bool beyond = false;
  (void)c;
  for (unsigned k = 0; k < m->dimension; k++)
    beyond |= length[k][i] > m->cell * (1.0 + 1e-9);
  sum[0] += beyond;
}

static gamut_status long_domains(struct model *m, const struct cloud *c, double *value)
{
  const double *length[3];
  double sum[MEASURED];
  if (m->shape != SHAPE_GIMP)
    return gamut_fail(m->run, GAMUT_SCENE, "only with shape gimp have points domains");
  for (unsigned k = 0; k < m->dimension; k++)
    length[k] = m->host->stored(c->set, m->field.domain_length, k);
  add_up(m, c, add_long, length, sum);
  *value = sum[0];
  return GAMUT_OK;
}

/* Mass, and momentum along an axis. */
static void add_momentum(const struct model *m, const struct cloud *c, const void *how, size_t i,
                         double *sum)
{
  const int *axis = how;
  (void)m;
  sum[0] += c->mass[i];
  sum[1] += c->mass[i] * c->v[*axis][i];
}

/* Kinetic and internal. */
static void add_energy(const struct model *m, const struct cloud *c, const void *how, size_t i,
                       double *sum)
{
  const double mass = c->mass[i], u = c->v[0][i], v = c->v[1][i], w = c->v[2][i];
  (void)m;
  (void)how;
  sum[0] += 0.5 * mass * (u * u + v * v + w * w);
  if (c->energy != NULL)
    sum[1] += mass / c->body->density * c->energy[i];
}

gamut_status measure_value(struct model *m, const char *name, const struct gamut_body *body,
                           const struct gamut_values *arguments, double *value)
{
  const struct cloud c = cloud_of(m, body);
  double sum[MEASURED];
  int axis = 0;
  switch (material_point_method_measure_of(name)) {
  case MATERIAL_POINT_METHOD_MEASURE_EXTENT:
    return extent(m, &c, (int)material_point_method_extent_axis_of(arguments), value);
  case MATERIAL_POINT_METHOD_MEASURE_DIAMETER:
    return diameter(m, &c, arguments, value);
  case MATERIAL_POINT_METHOD_MEASURE_FRONT:
    return front(m, &c, arguments, value);
  case MATERIAL_POINT_METHOD_MEASURE_MEAN:
    return mean(m, &c, arguments, value);
  case MATERIAL_POINT_METHOD_MEASURE_MAXIMUM:
    return maximum(m, &c, arguments, value);
  case MATERIAL_POINT_METHOD_MEASURE_FRAGMENTS:
    return body_fragments(m, c.set, value);
  case MATERIAL_POINT_METHOD_MEASURE_LONG_DOMAINS:
    return long_domains(m, &c, value);
  case MATERIAL_POINT_METHOD_MEASURE_BODY_MASS:
    add_up(m, &c, add_momentum, &axis, sum);
    *value = sum[0];
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_MEASURE_MOMENTUM:
    axis = (int)material_point_method_momentum_axis_of(arguments);
    add_up(m, &c, add_momentum, &axis, sum);
    *value = sum[1];
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_MEASURE_MEAN_VELOCITY:
    axis = (int)material_point_method_mean_velocity_axis_of(arguments);
    add_up(m, &c, add_momentum, &axis, sum);
    *value = sum[1] / sum[0];
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_MEASURE_KINETIC_ENERGY:
    add_up(m, &c, add_energy, NULL, sum);
    *value = sum[0];
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_MEASURE_INTERNAL_ENERGY:
    add_up(m, &c, add_energy, NULL, sum);
    *value = sum[1];
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}
