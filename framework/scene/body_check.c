/* What bodies must be to each other, to the domain and to the grid. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static unsigned axes_of(const struct scene_reader *reader)
{
  return reader->axes ? reader->axes : 3;
}

struct extent {
  double lower[3], upper[3];
};

/* Common part of the bounds of two bodies; false where there is none. Bodies that touch share none:
 * round-off of their places is allowed for. */
static bool common_bounds(const struct scene_reader *reader, const struct extent *one,
                          const struct extent *two, double lower[3], double upper[3])
{
  for (unsigned k = 0; k < axes_of(reader); k++) {
    double scale = fmin(one->upper[k] - one->lower[k], two->upper[k] - two->lower[k]);
    lower[k] = fmax(one->lower[k], two->lower[k]);
    upper[k] = fmin(one->upper[k], two->upper[k]);
    if (!(upper[k] - lower[k] > 1e-9 * scale))
      return false;
  }
  return true;
}

/* A shape of points overlaps another where one of its points lies in it. */
static bool points_overlap(const struct shape *points, const struct shape *other, double where[3])
{
  for (size_t i = 0; i < points->points.count; i++) {
    for (size_t k = 0; k < 3; k++)
      where[k] = points->points.place[3 * i + k];
    if (shape_inside(other, where, 1e-6 * points->points.half[i]))
      return true;
  }
  return false;
}

/* Boxes overlap where their bounds do. Other shapes are tried on a lattice of up to 10^5 points. */
static bool overlap(const struct scene_reader *reader, const struct gamut_body *one,
                    const struct gamut_body *two, double lower[3], double upper[3], double where[3])
{
  double step[3] = {0};
  static const size_t fineness[] = {0, 20000, 250, 44};
  unsigned axes = axes_of(reader);
  size_t points = 1, n = fineness[axes];
  bool boxes = one->shape.kind == SHAPE_BOX && two->shape.kind == SHAPE_BOX;
  double margin = INFINITY;
  for (unsigned k = 0; k < 3; k++) {
    where[k] = k < axes ? 0.5 * (lower[k] + upper[k]) : 0;
    if (k >= axes)
      continue;
    step[k] = (upper[k] - lower[k]) / (double)n;
    margin = fmin(margin, 1e-6 * step[k]);
    points *= n;
  }
  if (boxes)
    return true;
  if (one->shape.kind == SHAPE_POINTS)
    return points_overlap(&one->shape, &two->shape, where);
  if (two->shape.kind == SHAPE_POINTS)
    return points_overlap(&two->shape, &one->shape, where);
  for (size_t i = 0; i < points;) {
    size_t rest = i;
    for (unsigned k = 0; k < axes; k++, rest /= n)
      where[k] = lower[k] + step[k] * ((double)(rest % n) + 0.5);
    const double depth = fmin(shape_depth(&one->shape, where), shape_depth(&two->shape, where));
    if (depth >= margin)
      return true;
    /* Depth changes by no more than the way, so that what is too near along x is passed over. */
    const double far = (margin - depth) / step[0] * (1 - 1e-9);
    const size_t row = n - i % n;
    i += far < 1 ? 1 : far < (double)row ? (size_t)far : row;
  }
  return false;
}

static const struct tree *shape_node(const struct gamut_body *body)
{
  return tree_get(body->node, "shape");
}

static void overlaps_check(struct scene_reader *reader)
{
  const struct scene *scene = reader->scene;
  struct extent *extent = scene_take(scene->bodies, sizeof *extent);
  for (size_t i = 0; i < scene->bodies; i++)
    if (scene->body[i].shape.kind != SHAPE_NONE)
      shape_extent(reader, &scene->body[i].shape, extent[i].lower, extent[i].upper);
  for (size_t i = 0; i < scene->bodies; i++)
    for (size_t k = i + 1; k < scene->bodies; k++) {
      const struct gamut_body *one = &scene->body[i], *two = &scene->body[k];
      double x[3], lower[3], upper[3];
      char where[128] = "";
      if (one->shape.kind == SHAPE_NONE || two->shape.kind == SHAPE_NONE ||
          !common_bounds(reader, &extent[i], &extent[k], lower, upper) ||
          !overlap(reader, one, two, lower, upper, x))
        continue;
      size_t length = 0;
      for (unsigned c = 0; c < axes_of(reader); c++)
        length +=
            (size_t)snprintf(where + length, sizeof where - length, "%s%.4g", c ? ", " : "", x[c]);
      error_at_key(reader, shape_node(two), "bodies may touch, not overlap",
                   "bodies '%s' and '%s' overlap, for example at (%s) m", one->name, two->name,
                   where);
    }
  free(extent);
}

static void domain_check(struct scene_reader *reader, const struct gamut_body *body)
{
  const struct values *solver = reader->scene->solver.values;
  const struct value *domain = values_find(solver, "domain");
  const struct value *min = values_find(solver, "domain.min");
  const struct value *max = values_find(solver, "domain.max");
  double lower[3], upper[3];
  char expected[160];
  if (!domain || !domain->given || !min || !max)
    return;
  shape_extent(reader, &body->shape, lower, upper);
  for (unsigned k = 0; k < axes_of(reader); k++) {
    double from = k < min->numbers ? min->number[k] : -INFINITY;
    double to = k < max->numbers ? max->number[k] : INFINITY;
    double slack = 1e-9 * (upper[k] - lower[k]);
    if (lower[k] >= from - slack && upper[k] <= to + slack)
      continue;
    snprintf(expected, sizeof expected, "solver.domain goes from %c = %.6g m to %.6g m", "xyz"[k],
             from, to);
    error_at_key(reader, shape_node(body), expected,
                 "body '%s' is outside the domain: it goes from %c = %.6g m to %.6g m", body->name,
                 "xyz"[k], lower[k], upper[k]);
  }
}

static void cell_check(struct scene_reader *reader, const struct gamut_body *body)
{
  const struct value *cell = values_find(reader->scene->solver.values, "cell");
  double lower[3], upper[3], smallest = INFINITY;
  char axis = 'x', expected[160];
  if (!cell || !cell->present || cell->parameter->type != VALUE_REAL ||
      !unit_alike(reader->units, cell->parameter->unit, "m"))
    return;
  shape_extent(reader, &body->shape, lower, upper);
  for (unsigned k = 0; k < axes_of(reader); k++)
    if (upper[k] - lower[k] < smallest) {
      smallest = upper[k] - lower[k];
      axis = "xyz"[k];
    }
  if (!(cell->real > smallest))
    return;
  snprintf(expected, sizeof expected, "at most %.6g m, better a tenth of it", smallest);
  error_at_value(reader, cell->node, expected,
                 "cell = %.6g m is larger than body '%s', which has %.6g m along %c", cell->real,
                 body->name, smallest, axis);
}

void bodies_check(struct scene_reader *reader)
{
  const struct scene *scene = reader->scene;
  for (size_t i = 0; i < scene->bodies; i++) {
    if (scene->body[i].shape.kind == SHAPE_NONE)
      continue;
    domain_check(reader, &scene->body[i]);
    cell_check(reader, &scene->body[i]);
  }
  overlaps_check(reader);
}
