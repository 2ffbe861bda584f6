#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/reading.h"

static const char *const shape_names[] = {"box", "cylinder", "sphere"};

bool shape_inside(const struct shape *shape, const double x[3], double margin)
{
  double radial = 0, along;
  switch (shape->kind) {
  case SHAPE_NONE:
    return false;
  case SHAPE_BOX:
    for (int k = 0; k < 3; k++)
      if (x[k] < shape->lower[k] + margin || x[k] > shape->upper[k] - margin)
        return false;
    return true;
  case SHAPE_CYLINDER:
    for (int k = 0; k < 3; k++)
      if (k != shape->axis)
        radial = hypot(radial, x[k] - shape->centre[k]);
    along = x[shape->axis] - shape->centre[shape->axis];
    return radial <= shape->radius - margin &&
           (isinf(shape->length) || (along >= margin && along <= shape->length - margin));
  case SHAPE_SPHERE:
    for (int k = 0; k < 3; k++)
      radial = hypot(radial, x[k] - shape->centre[k]);
    return radial <= shape->radius - margin;
  }
  return false;
}

bool shape_contains(const struct shape *shape, const double x[3])
{
  return shape_inside(shape, x, 0);
}

void shape_bounds(const struct shape *shape, double lower[3], double upper[3])
{
  for (int k = 0; k < 3; k++) {
    lower[k] = shape->centre[k] - shape->radius;
    upper[k] = shape->centre[k] + shape->radius;
    if (shape->kind == SHAPE_BOX) {
      lower[k] = shape->lower[k];
      upper[k] = shape->upper[k];
    }
  }
  if (shape->kind != SHAPE_CYLINDER)
    return;
  bool endless = isinf(shape->length);
  lower[shape->axis] = endless ? -INFINITY : shape->centre[shape->axis];
  upper[shape->axis] = endless ? INFINITY : shape->centre[shape->axis] + shape->length;
}

void shape_extent(const struct reading *reading, const struct shape *shape, double lower[3],
                  double upper[3])
{
  shape_bounds(shape, lower, upper);
  if (reading->axisymmetric)
    lower[0] = fmax(lower[0], 0);
}

static unsigned axes_of(const struct reading *reading)
{
  return reading->axes ? reading->axes : 3;
}

/* A place; components of directions that the geometry lacks are 0. */
static bool place_read(struct reading *reading, const struct tree *mapping, const char *key,
                       bool required, double x[3])
{
  const struct tree *node = tree_get(mapping, key);
  unsigned axes = axes_of(reading);
  size_t count;
  x[0] = x[1] = x[2] = 0;
  if (!node) {
    if (required && !was_meant(reading, mapping, key))
      blame_key(reading, mapping, NULL, "'%s' is missing in '%s'", key, mapping->key);
    return !required;
  }
  double *number = vector_read(reading, node, key, "m", axes, axes, &count);
  if (!number)
    return false;
  memcpy(x, number, count * sizeof *number);
  free(number);
  return true;
}

static bool length_read(struct reading *reading, const struct tree *mapping, const char *key,
                        bool required, double *length)
{
  const struct tree *node = tree_get(mapping, key);
  if (!node) {
    if (required && !was_meant(reading, mapping, key))
      blame_key(reading, mapping, "a length with its unit, such as '5 mm'",
                "'%s' is missing in '%s'", key, mapping->key);
    return !required;
  }
  if (!amount_read(reading, node, key, "m", length))
    return false;
  if (*length > 0)
    return true;
  blame_value(reading, node, "it must be greater than 0 m", "%s = %.6g m is not possible", key,
              *length);
  return false;
}

static bool box_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"min", "max", "size", "centre"};
  bool centred = tree_get(node, "size") || tree_get(node, "centre");
  double size[3];
  expect_keys(reading, node, known, COUNT_OF(known), "a box");
  if (centred && (tree_get(node, "min") || tree_get(node, "max"))) {
    blame_key(reading, node, "{min:, max:} or {size:, centre:}", "the box is given in two ways");
    return false;
  }
  bool one =
      place_read(reading, node, centred ? "size" : "min", true, centred ? size : shape->lower);
  bool two = place_read(reading, node, centred ? "centre" : "max", !centred,
                        centred ? shape->centre : shape->upper);
  for (unsigned k = 0; k < 3 && one && two; k++) {
    if (centred) {
      shape->lower[k] = shape->centre[k] - 0.5 * size[k];
      shape->upper[k] = shape->centre[k] + 0.5 * size[k];
    }
    if (k >= axes_of(reading)) {
      shape->lower[k] = -INFINITY;
      shape->upper[k] = INFINITY;
    }
    if (!(shape->lower[k] < shape->upper[k])) {
      blame_value(reading, tree_get(node, centred ? "size" : "max"),
                  centred ? "sizes greater than 0" : "'max' greater than 'min' in every direction",
                  "the box has no extent along %c", "xyz"[k]);
      return false;
    }
  }
  return one && two;
}

static bool axis_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  const struct tree *axis = tree_get(node, "axis");
  bool plane = reading->axes == 2 && !reading->axisymmetric;
  shape->axis = plane ? 2 : 1;
  if (!axis)
    return true;
  const char *text = text_read(reading, axis, "axis");
  if (!text)
    return false;
  const char *found = strlen(text) == 1 ? strchr("xyz", text[0]) : NULL;
  if (!found) {
    blame_value(reading, axis, "x, y or z", "unknown axis '%.20s'", text);
    return false;
  }
  shape->axis = text[0] - 'x';
  if (reading->axisymmetric && shape->axis != 1)
    blame_value(reading, axis, "axis: y", "an axisymmetric scene turns about y");
  else if (plane && shape->axis != 2)
    blame_value(reading, axis, "axis: z, or a box", "in plane strain a cylinder lies along z");
  else
    return true;
  return false;
}

static bool on_axis(struct reading *reading, const struct tree *node, const char *key,
                    const double x[3])
{
  if (!reading->axisymmetric || x[0] == 0)
    return true;
  blame_value(reading, tree_get(node, key), "x = 0", "an axisymmetric %s stands on the axis",
              node->key);
  return false;
}

static bool cylinder_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "length", "axis", "base"};
  expect_keys(reading, node, known, COUNT_OF(known), "a cylinder");
  bool plane = reading->axes == 2 && !reading->axisymmetric;
  shape->length = INFINITY;
  bool fine = length_read(reading, node, "radius", true, &shape->radius);
  fine = length_read(reading, node, "length", !plane, &shape->length) && fine;
  fine = axis_read(reading, node, shape) && fine;
  fine = place_read(reading, node, "base", false, shape->centre) && fine;
  if (plane)
    shape->length = INFINITY;
  return fine && on_axis(reading, node, "base", shape->centre);
}

static bool sphere_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "centre"};
  expect_keys(reading, node, known, COUNT_OF(known), "a sphere");
  if (reading->axes == 2 && !reading->axisymmetric) {
    blame_key(reading, node, "a cylinder along z", "plane strain has no sphere");
    return false;
  }
  bool fine = length_read(reading, node, "radius", true, &shape->radius);
  return place_read(reading, node, "centre", false, shape->centre) && fine &&
         on_axis(reading, node, "centre", shape->centre);
}

bool shape_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  char expected[WORDS_SIZE];
  *shape = (struct shape){.kind = SHAPE_NONE};
  if (!expect_mapping(reading, node, "'shape'"))
    return false;
  size_t faults = reading->faults;
  expect_keys(reading, node, shape_names, COUNT_OF(shape_names), "'shape'");
  if (reading->faults > faults)
    return false;
  if (node->children != 1) {
    blame_key(reading, node, "one of: box, cylinder, sphere", "the shape is %s",
              node->children ? "given more than once" : "empty");
    return false;
  }
  const struct tree *child = node->child[0];
  snprintf(expected, sizeof expected, "'%s'", child->key);
  if (!expect_mapping(reading, child, expected))
    return false;
  bool box = strcmp(child->key, "box") == 0, cylinder = strcmp(child->key, "cylinder") == 0;
  if (reading->axes == 1 && !box) {
    blame_key(reading, child, "box: {min: [0 mm], max: [5 mm]}", "a 1d scene has no %s",
              child->key);
    return false;
  }
  bool fine = box        ? box_read(reading, child, shape)
              : cylinder ? cylinder_read(reading, child, shape)
                         : sphere_read(reading, child, shape);
  if (fine && reading->faults == faults)
    shape->kind = box ? SHAPE_BOX : cylinder ? SHAPE_CYLINDER : SHAPE_SPHERE;
  return shape->kind != SHAPE_NONE;
}
