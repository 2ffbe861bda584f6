/* Shapes: what lies inside, how far they reach, how large they are. */
#include <math.h>

#include "scene/scene_private.h"

static const double pi = 3.14159265358979323846;

static double box_depth(const struct shape *shape, const double x[3])
{
  double depth = INFINITY;
  for (int k = 0; k < 3; k++)
    depth = fmin(depth, fmin(x[k] - shape->lower[k], shape->upper[k] - x[k]));
  return depth;
}

static double round_depth(const struct shape *shape, const double x[3])
{
  double radial = 0, along = x[shape->axis] - shape->centre[shape->axis];
  for (int k = 0; k < 3; k++)
    if (k != shape->axis)
      radial = hypot(radial, x[k] - shape->centre[k]);
  double depth = shape->radius - radial;
  if (shape->kind == SHAPE_CONE) {
    double growth = shape->top_radius - shape->radius;
    double side = shape->radius + growth * (along / shape->length) - radial;
    depth = side * shape->length / hypot(shape->length, growth);
  } else if (shape->kind == SHAPE_TUBE) {
    depth = fmin(depth, radial - shape->inner_radius);
  }
  return isinf(shape->length) ? depth : fmin(depth, fmin(along, shape->length - along));
}

static double sphere_depth(const struct shape *shape, const double x[3])
{
  double radial = 0;
  for (int k = 0; k < 3; k++)
    radial = hypot(radial, x[k] - shape->centre[k]);
  return shape->radius - radial;
}

static double points_depth(const struct shape_points *points, const double x[3])
{
  double depth = -INFINITY;
  for (size_t i = 0; i < points->count; i++) {
    double far = 0;
    for (int k = 0; k < 3; k++)
      far = fmax(far, fabs(x[k] - points->place[3 * i + (size_t)k]));
    depth = fmax(depth, points->half[i] - far);
  }
  return depth;
}

double shape_depth(const struct shape *shape, const double x[3])
{
  double depth = -INFINITY;
  if (shape->index)
    return shape_index_depth(shape, x);
  switch (shape->kind) {
  case SHAPE_NONE:
    return depth;
  case SHAPE_BOX:
    return box_depth(shape, x);
  case SHAPE_CYLINDER:
  case SHAPE_TUBE:
  case SHAPE_CONE:
    return round_depth(shape, x);
  case SHAPE_SPHERE:
    return sphere_depth(shape, x);
  case SHAPE_UNION:
    for (size_t i = 0; i < shape->parts; i++)
      depth = fmax(depth, shape_depth(&shape->part[i], x));
    return depth;
  case SHAPE_DIFFERENCE:
    depth = shape_depth(&shape->part[0], x);
    for (size_t i = 1; i < shape->parts; i++)
      depth = fmin(depth, -shape_depth(&shape->part[i], x));
    return depth;
  case SHAPE_POINTS:
    return points_depth(&shape->points, x);
  }
  return depth;
}

bool shape_inside(const struct shape *shape, const double x[3], double margin)
{
  return shape_depth(shape, x) >= margin;
}

bool shape_contains(const struct shape *shape, const double x[3])
{
  return shape_depth(shape, x) >= 0;
}

static void round_bounds(const struct shape *shape, double lower[3], double upper[3])
{
  double radius =
      shape->kind == SHAPE_CONE ? fmax(shape->radius, shape->top_radius) : shape->radius;
  bool endless = isinf(shape->length);
  for (int k = 0; k < 3; k++) {
    lower[k] = shape->centre[k] - radius;
    upper[k] = shape->centre[k] + radius;
  }
  if (shape->kind != SHAPE_SPHERE) {
    lower[shape->axis] = endless ? -INFINITY : shape->centre[shape->axis];
    upper[shape->axis] = endless ? INFINITY : shape->centre[shape->axis] + shape->length;
  }
  if (shape->kind == SHAPE_TUBE && shape->revolved)
    lower[0] = shape->inner_radius;
}

static void box_around(double lower[3], double upper[3], const double low[3], const double high[3])
{
  for (int k = 0; k < 3; k++) {
    lower[k] = fmin(lower[k], low[k]);
    upper[k] = fmax(upper[k], high[k]);
  }
}

static void points_bounds(const struct shape_points *points, double lower[3], double upper[3])
{
  for (size_t i = 0; i < points->count; i++) {
    double low[3], high[3];
    for (size_t k = 0; k < 3; k++) {
      low[k] = points->place[3 * i + k] - points->half[i];
      high[k] = points->place[3 * i + k] + points->half[i];
    }
    box_around(lower, upper, low, high);
  }
}

void shape_bounds(const struct shape *shape, double lower[3], double upper[3])
{
  if (shape->kind == SHAPE_DIFFERENCE) {
    shape_bounds(&shape->part[0], lower, upper);
    return;
  }
  if (shape->kind == SHAPE_UNION || shape->kind == SHAPE_POINTS) {
    for (int k = 0; k < 3; k++) {
      lower[k] = INFINITY;
      upper[k] = -INFINITY;
    }
    for (size_t i = 0; i < shape->parts; i++) {
      double low[3], high[3];
      shape_bounds(&shape->part[i], low, high);
      box_around(lower, upper, low, high);
    }
    points_bounds(&shape->points, lower, upper);
    return;
  }
  round_bounds(shape, lower, upper);
  for (int k = 0; k < 3 && shape->kind == SHAPE_BOX; k++) {
    lower[k] = shape->lower[k];
    upper[k] = shape->upper[k];
  }
}

void shape_extent(const struct scene_reader *reader, const struct shape *shape, double lower[3],
                  double upper[3])
{
  shape_bounds(shape, lower, upper);
  if (reader->axisymmetric)
    lower[0] = fmax(lower[0], 0);
}

/* The sum of the parts where their bounds have nothing in common. */
static double union_volume(const struct shape *shape, unsigned dimension, bool revolved)
{
  double sum = 0;
  for (size_t i = 0; i < shape->parts; i++) {
    double volume = shape_volume(&shape->part[i], dimension, revolved);
    if (!(volume > 0))
      return 0;
    sum += volume;
  }
  return shape_parts_apart(shape, dimension) ? sum : 0;
}

static double box_volume(const struct shape *shape, unsigned dimension, bool revolved)
{
  double volume = 1, inner = fmax(shape->lower[0], 0);
  for (unsigned k = 0; k < dimension; k++)
    volume *= revolved && k == 0 ? pi * (shape->upper[0] * shape->upper[0] - inner * inner)
                                 : shape->upper[k] - shape->lower[k];
  return volume;
}

double shape_volume(const struct shape *shape, unsigned dimension, bool revolved)
{
  bool whole = dimension == 3 || revolved;
  double r = shape->radius, top = shape->top_radius, inner = shape->inner_radius, sum = 0;
  double length = whole ? shape->length : 1;
  switch (shape->kind) {
  case SHAPE_NONE:
  case SHAPE_DIFFERENCE:
    return 0;
  case SHAPE_BOX:
    return box_volume(shape, dimension, revolved);
  case SHAPE_SPHERE:
    return whole ? 4.0 / 3.0 * pi * r * r * r : dimension == 2 ? pi * r * r : 2 * r;
  case SHAPE_CYLINDER:
    return pi * r * r * length;
  case SHAPE_TUBE:
    return pi * (r - inner) * (r + inner) * length;
  case SHAPE_CONE:
    return pi * (r * r + r * top + top * top) / 3.0 * length;
  case SHAPE_UNION:
    return union_volume(shape, dimension, revolved);
  case SHAPE_POINTS:
    for (size_t i = 0; i < shape->points.count; i++)
      sum += shape->points.volume[i];
    return sum;
  }
  return 0;
}
