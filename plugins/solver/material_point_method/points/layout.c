/* The points of the bodies. A body's points lie on a lattice of its own: the number of points along
 * an axis is that of points per cell, rounded so that the lattice fits the body's bounds exactly; a
 * place of the lattice inside the shape is a point. A scene may list the points of a body instead.
 */
#include <math.h>

#include "model.h"

static const double two_pi = 6.28318530717958647692;

/* Points along one axis of a cell, or 0 where `points` is no power of that many axes. */
static int root(long points, unsigned dimension)
{
  for (int n = 1; n <= 16; n++) {
    long power = 1;
    for (unsigned k = 0; k < dimension; k++)
      power *= n;
    if (power == points)
      return n;
  }
  return 0;
}

void layout_place(const struct body *b, unsigned dimension, const long at[3], double x[3])
{
  for (unsigned k = 0; k < 3; k++)
    x[k] = k < dimension ? b->lower[k] + ((double)at[k] + 0.5) * b->spacing[k] : 0.0;
}

/* Next place of a layer of the lattice, x fastest; false past its end. Layers are counted along the
 * last axis, so that the number of the points before a layer is that of its first point. */
static bool layer_next(const struct body *b, unsigned dimension, long at[3])
{
  for (unsigned k = 0; k + 1 < dimension; k++) {
    if (++at[k] < b->count[k])
      return true;
    at[k] = 0;
  }
  return false;
}

static gamut_status check_place(const struct model *m, const struct gamut_values *values,
                                const struct body *b, const double lower[3], const double upper[3])
{
  const char *name = m->host->body_name(b->scene);
  for (unsigned k = 0; k < m->dimension; k++) {
    if (!isfinite(lower[k]) || !isfinite(upper[k]))
      return gamut_fail_at(m->run, m->host->body_values(b->scene), "shape", "a shape with ends",
                           "body '%s' has no end along %c", name, "xyz"[k]);
    if (upper[k] - lower[k] < m->cell * (1.0 - 1e-9))
      return gamut_fail_at(m->run, values, "cell", "a cell no larger than any body",
                           "the cell (%g m) is larger than body '%s' along %c (%g m)", m->cell,
                           name, "xyz"[k], upper[k] - lower[k]);
    const double slack = 1e-9 * m->cell;
    if (m->bounded && (lower[k] < m->lower[k] - slack || upper[k] > m->upper[k] + slack))
      return gamut_fail_at(m->run, values, "domain", "a domain around all bodies",
                           "body '%s' reaches out of the domain along %c", name, "xyz"[k]);
  }
  return GAMUT_OK;
}

/* Points that the scene lists; null and 0 where it does not. */
size_t layout_listed(const struct model *m, const struct body *b, const double **place,
                     const double **volume)
{
  const struct gamut_host *h = m->host;
  *place = *volume = NULL;
  if (h->size < offsetof(struct gamut_host, body_points) + sizeof h->body_points ||
      h->body_points == NULL)
    return 0;
  return h->body_points(b->scene, place, volume);
}

/* A lattice as measures see it: of the bounds and the first point's distance from them. */
static gamut_status lay_listed(struct model *m, struct body *b, const double *place,
                               const double lower[3], const double upper[3])
{
  for (unsigned k = 0; k < 3; k++) {
    double half = HUGE_VAL;
    for (size_t i = 0; i < b->points; i++)
      half = fmin(half, place[3 * i + k] - lower[k]);
    const double length = k < m->dimension ? upper[k] - lower[k] : 0.0;
    b->lower[k] = k < m->dimension ? lower[k] : 0.0;
    b->count[k] = length > 0.0 && half > 0.0 ? (long)fmax(round(0.5 * length / half), 1.0) : 1;
    b->spacing[k] = length / (double)b->count[k];
  }
  b->density = m->host->body_density(m->run, b->scene);
  return gamut_points(m->run, b->scene, b->points, &b->set);
}

/* Whether the points will fit, from the share of the lattice that the shape fills: counting them
 * takes longer than to know that there are too many. */
static gamut_status expect_points(struct model *m, const struct body *b, double places)
{
  enum { POINT_BYTES = 200 }; /* at least */
  const struct gamut_host *h = m->host;
  double box = 1.0, filled = 0.0;
  if (h->size >= offsetof(struct gamut_host, body_volume) + sizeof h->body_volume)
    filled = h->body_volume(b->scene, m->dimension, false);
  for (unsigned k = 0; k < m->dimension; k++)
    box *= b->spacing[k] * (double)b->count[k];
  if (!(filled > 0.0 && box > 0.0))
    return GAMUT_OK;
  const double points = 0.9 * places * fmin(filled / box, 1.0);
  void *room = gamut_allocate(m->run, "points", (size_t)points * POINT_BYTES);
  gamut_release(m->run, room);
  return room != NULL ? GAMUT_OK : GAMUT_INTERNAL;
}

static size_t points_of_layer(const struct model *m, const struct body *b, long layer)
{
  long at[3] = {0, 0, 0};
  at[m->dimension - 1] = layer;
  size_t points = 0;
  do {
    double x[3];
    layout_place(b, m->dimension, at, x);
    points += m->host->body_contains(b->scene, x);
  } while (layer_next(b, m->dimension, at));
  return points;
}

/* Points of all layers, and before each. */
static bool count_layers(struct model *m, struct body *b)
{
  const size_t layers = (size_t)b->count[m->dimension - 1];
  b->before = gamut_allocate(m->run, "solver", layers * sizeof *b->before);
  for (size_t l = 0; b->before != NULL && l < layers; l++) {
    b->before[l] = b->points;
    b->points += points_of_layer(m, b, (long)l);
  }
  return b->before != NULL;
}

static gamut_status lay_lattice(struct model *m, const struct gamut_values *values, struct body *b)
{
  const char *name = m->host->body_name(b->scene);
  const struct gamut_values *own = m->host->body_values(b->scene);
  double lower[3], upper[3];
  int along = 2;
  if (!m->host->body_bounds(b->scene, lower, upper))
    return gamut_fail_at(m->run, own, "shape", "a shape",
                         "body '%s' has no shape to lay points in", name);
  if (own != NULL && gamut_given(own, "points_per_cell")) {
    along = root(gamut_integer(own, "points_per_cell"), m->dimension);
    if (along == 0)
      return gamut_fail_at(m->run, own, "points_per_cell",
                           m->dimension == 3   ? "1, 8, 27, 64 ..."
                           : m->dimension == 2 ? "1, 4, 9, 16 ..."
                                               : "1, 2, 3 ... 16",
                           "the points of a cell must make a square lattice");
  }
  if (m->geometry == GEOMETRY_AXISYMMETRIC)
    lower[0] = fmax(lower[0], 0.0); /* a shape around the axis: its half */
  gamut_status status = check_place(m, values, b, lower, upper);
  if (status != GAMUT_OK)
    return status;
  const double *place, *volume;
  b->points = layout_listed(m, b, &place, &volume);
  if (b->points > 0)
    return lay_listed(m, b, place, lower, upper);
  double places = 1.0;
  for (unsigned k = 0; k < 3; k++) {
    b->lower[k] = k < m->dimension ? lower[k] : 0.0;
    b->count[k] = 1;
    b->spacing[k] = 0.0;
    if (k >= m->dimension)
      continue;
    const double wanted = round((upper[k] - lower[k]) * along / m->cell);
    places *= wanted;
    if (!(places < 2e9))
      return gamut_fail_at(m->run, values, "cell", "a larger cell",
                           "body '%s' would take more than 2e9 points", name);
    b->count[k] = (long)wanted < 1 ? 1 : (long)wanted;
    b->spacing[k] = (upper[k] - lower[k]) / (double)b->count[k];
  }
  b->density = m->host->body_density(m->run, b->scene);
  status = expect_points(m, b, places);
  if (status != GAMUT_OK)
    return status;
  if (!count_layers(m, b))
    return GAMUT_INTERNAL;
  if (b->points == 0)
    return gamut_fail_at(m->run, values, "cell", "a smaller cell", "body '%s' holds no point",
                         name);
  return gamut_points(m->run, b->scene, b->points, &b->set);
}

gamut_status layout_bodies(struct model *m, const struct gamut_values *values)
{
  m->bodies = gamut_bodies(m->run);
  if (m->bodies == 0)
    return gamut_fail(m->run, GAMUT_SCENE, "the scene has no body");
  m->body = gamut_allocate(m->run, "solver", m->bodies * sizeof *m->body);
  if (m->body == NULL)
    return GAMUT_INTERNAL;
  for (size_t i = 0; i < m->bodies; i++) {
    m->body[i].scene = gamut_body_at(m->run, i);
    const gamut_status status = lay_lattice(m, values, &m->body[i]);
    if (status != GAMUT_OK)
      return status;
  }
  return GAMUT_OK;
}

/* A body that is a whole number of cells long starts on a node; another is centred on one. */
void layout_origin(struct model *m)
{
  for (unsigned k = 0; k < m->dimension; k++) {
    if (m->origin_fixed[k])
      continue;
    const struct body *b = &m->body[0];
    const double length = b->spacing[k] * (double)b->count[k], cells = length / m->cell;
    m->grid.origin[k] =
        fabs(cells - round(cells)) < 1e-6 ? b->lower[k] : b->lower[k] + 0.5 * length;
    m->origin_fixed[k] = true;
  }
}

static double place_volume(const struct model *m, const struct body *b, const double x[3])
{
  double volume = 1.0;
  for (unsigned k = 0; k < m->dimension; k++)
    volume *= b->spacing[k];
  return m->geometry == GEOMETRY_AXISYMMETRIC ? volume * two_pi * x[0] : volume;
}

static gamut_status check_planes(const struct model *m, const struct body *b, const double x[3])
{
  for (size_t i = 0; i < m->planes.count; i++) {
    const struct plane *p = m->planes.plane[i];
    const double depth = -plane_distance(p, x, 0.0);
    if (depth > 1e-9 * m->cell)
      return m->host->fail_plane(m->run, p->reaction, GAMUT_SCENE,
                                 "body '%s' reaches behind a plane: its point at (%g, %g, %g) m is "
                                 "%g m behind the plane through (%g, %g, %g) m",
                                 m->host->body_name(b->scene), x[0], x[1], x[2], depth,
                                 p->given.point[0], p->given.point[1], p->given.point[2]);
  }
  return GAMUT_OK;
}

/* The shape's volume over that of the lattice, which fits a curved side only roughly. */
static double volume_correction(const struct model *m, const struct body *b, double volume)
{
  const struct gamut_host *h = m->host;
  if (h->size < offsetof(struct gamut_host, body_volume) + sizeof h->body_volume ||
      h->body_volume == NULL)
    return 1.0;
  const double exact = h->body_volume(b->scene, m->dimension, m->geometry == GEOMETRY_AXISYMMETRIC);
  if (!(exact > 0.0))
    h->note(m->run,
            "body '%s': there is no formula for the volume of its shape; that of its points, %.6g, "
            "is taken",
            h->body_name(b->scene), volume);
  return exact > 0.0 ? exact / volume : 1.0;
}

/* One point in its slot, with its volume for a mass; `length` is that of its domain. */
static gamut_status fill_point(struct model *m, const struct body *b, const double place[3],
                               size_t slot, double volume, const double length[3])
{
  double speed[3] = {0.0, 0.0, 0.0};
  const gamut_status status = check_planes(m, b, place);
  if (status != GAMUT_OK)
    return status;
  m->host->body_velocity(b->scene, place, speed);
  for (unsigned k = 0; k < 3; k++) {
    const double v = k < m->dimension ? speed[k] : 0.0;
    m->host->stored(b->set, m->field.position, k)[slot] = place[k];
    m->host->stored(b->set, m->field.velocity, k)[slot] = v;
    if (m->shape == SHAPE_GIMP)
      m->host->stored(b->set, m->field.domain_length, k)[slot] = length[k];
    m->nodes.speed = fmax(m->nodes.speed, fabs(v));
  }
  m->host->stored(b->set, m->field.mass, 0)[slot] = volume;
  return GAMUT_OK;
}

/* Edge of the square domain that a listed point has. */
static double listed_side(const struct model *m, double volume, double x)
{
  if (m->geometry == GEOMETRY_AXISYMMETRIC)
    return sqrt(volume / (two_pi * x));
  return m->dimension == 1 ? volume : m->dimension == 2 ? sqrt(volume) : cbrt(volume);
}

static gamut_status fill_listed(struct model *m, const struct body *b, const double *place,
                                const double *volume)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < b->points && status == GAMUT_OK; i++) {
    const double side = listed_side(m, volume[i], place[3 * i]);
    const double length[3] = {side, side, side};
    status = fill_point(m, b, &place[3 * i], i, volume[i], length);
  }
  return status;
}

static gamut_status fill_layer(struct model *m, const struct body *b, long layer)
{
  long at[3] = {0, 0, 0};
  at[m->dimension - 1] = layer;
  size_t slot = b->before[layer];
  do {
    double place[3];
    layout_place(b, m->dimension, at, place);
    if (!m->host->body_contains(b->scene, place))
      continue;
    const gamut_status status =
        fill_point(m, b, place, slot++, place_volume(m, b, place), b->spacing);
    if (status != GAMUT_OK)
      return status;
  } while (layer_next(b, m->dimension, at));
  return GAMUT_OK;
}

static gamut_status fill_lattice(struct model *m, struct body *b)
{
  gamut_status status = GAMUT_OK;
  for (long l = 0; l < b->count[m->dimension - 1] && status == GAMUT_OK; l++)
    status = fill_layer(m, b, l);
  gamut_release(m->run, b->before);
  b->before = NULL;
  return status;
}

static gamut_status fill_body(struct model *m, struct body *b)
{
  const struct gamut_host *h = m->host;
  double *mass = h->stored(b->set, m->field.mass, 0);
  double *reference = h->stored(b->set, m->field.reference_volume, 0), whole = 0.0;
  const double *place, *volume;
  const bool given = layout_listed(m, b, &place, &volume) > 0;
  const gamut_status status = given ? fill_listed(m, b, place, volume) : fill_lattice(m, b);
  if (status != GAMUT_OK)
    return status;
  gamut_sum(m->run, mass, b->points, 1, &whole);
  const double correction = given ? 1.0 : volume_correction(m, b, whole);
  for (size_t i = 0; i < b->points; i++) {
    if (reference != NULL)
      reference[i] = mass[i] * correction;
    mass[i] *= correction * b->density;
    m->grid.empty = fmax(m->grid.empty, 1e-12 * mass[i]);
  }
  return GAMUT_OK;
}

gamut_status layout_fill(struct model *m)
{
  for (size_t i = 0; i < m->bodies; i++) {
    const gamut_status status = fill_body(m, &m->body[i]);
    if (status != GAMUT_OK)
      return status;
  }
  return GAMUT_OK;
}
