/* Shapes as a scene gives them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static bool part_read(struct reading *, const struct tree *, const char *what, struct shape *);

static unsigned axes_of(const struct reading *reading)
{
  return reading->axes ? reading->axes : 3;
}

static bool in_plane(const struct reading *reading)
{
  return reading->axes == 2 && !reading->axisymmetric;
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

bool length_read(struct reading *reading, const struct tree *mapping, const char *key,
                 bool required, bool zero, double *length)
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
  if (*length > 0 || (zero && *length == 0))
    return true;
  blame_value(reading, node, zero ? "it must be at least 0 m" : "it must be greater than 0 m",
              "%s = %.6g m is not possible", key, *length);
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
  bool plane = in_plane(reading);
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

/* What cylinder, tube and cone have in common. */
static bool round_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  bool plane = in_plane(reading);
  shape->length = INFINITY;
  bool fine = length_read(reading, node, "radius", true, false, &shape->radius);
  fine = length_read(reading, node, "length", !plane, false, &shape->length) && fine;
  fine = axis_read(reading, node, shape) && fine;
  fine = place_read(reading, node, "base", false, shape->centre) && fine;
  if (plane)
    shape->length = INFINITY;
  return fine && on_axis(reading, node, "base", shape->centre);
}

static bool cylinder_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "length", "axis", "base"};
  expect_keys(reading, node, known, COUNT_OF(known), "a cylinder");
  return round_read(reading, node, shape);
}

static bool tube_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "inner_radius", "length", "axis", "base"};
  expect_keys(reading, node, known, COUNT_OF(known), "a tube");
  bool fine = length_read(reading, node, "inner_radius", true, false, &shape->inner_radius);
  if (!round_read(reading, node, shape) || !fine)
    return false;
  if (shape->inner_radius < shape->radius)
    return true;
  blame_value(reading, tree_get(node, "inner_radius"), "less than 'radius'",
              "inner_radius = %.6g m leaves nothing of radius = %.6g m", shape->inner_radius,
              shape->radius);
  return false;
}

static bool cone_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "top_radius", "length", "axis", "base"};
  expect_keys(reading, node, known, COUNT_OF(known), "a cone");
  if (in_plane(reading)) {
    blame_key(reading, node, "a cylinder or tube along z, or a box", "plane strain has no cone");
    return false;
  }
  bool fine = length_read(reading, node, "top_radius", false, true, &shape->top_radius);
  return round_read(reading, node, shape) && fine;
}

static bool sphere_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "centre"};
  expect_keys(reading, node, known, COUNT_OF(known), "a sphere");
  if (in_plane(reading)) {
    blame_key(reading, node, "a cylinder along z", "plane strain has no sphere");
    return false;
  }
  bool fine = length_read(reading, node, "radius", true, false, &shape->radius);
  return place_read(reading, node, "centre", false, shape->centre) && fine &&
         on_axis(reading, node, "centre", shape->centre);
}

/* Points that are listed are no lattice that could be cut. */
static bool no_points(struct reading *reading, const struct tree *node)
{
  if (!tree_get(node, "points"))
    return true;
  blame_key(reading, tree_get(node, "points"), "a body whose whole shape is 'points'",
            "points from a file stand alone");
  return false;
}

/* A list of shapes; each is put behind those that the shape has. */
static bool parts_read(struct reading *reading, const struct tree *node, const char *what,
                       struct shape *shape)
{
  if (node->kind != TREE_SEQUENCE || node->children == 0) {
    blame_value(reading, node, "a list, such as [{box: ...}, {cylinder: ...}]",
                "%s is %s where a list of shapes is due", what,
                node->kind == TREE_MAPPING    ? "a mapping"
                : node->kind == TREE_SEQUENCE ? "an empty list"
                                              : "a plain value");
    return false;
  }
  bool fine = true;
  for (size_t i = 0; i < node->children; i++) {
    struct shape *part = &shape->part[shape->parts++];
    fine = no_points(reading, node->child[i]) && part_read(reading, node->child[i], what, part) &&
           fine;
  }
  return fine;
}

static bool union_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  shape->part = scene_keep(reading, node->children + 1, sizeof *shape->part);
  return parts_read(reading, node, "'union'", shape);
}

static bool difference_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"from", "remove"};
  const struct tree *from = tree_get(node, "from"), *remove = tree_get(node, "remove");
  expect_keys(reading, node, known, COUNT_OF(known), "a difference");
  for (size_t i = 0; i < COUNT_OF(known); i++)
    if (!tree_get(node, known[i]) && !was_meant(reading, node, known[i]))
      blame_key(reading, node, "{from: {cylinder: ...}, remove: [{box: ...}]}",
                "'%s' is missing in 'difference'", known[i]);
  if (!from || !remove)
    return false;
  shape->part = scene_keep(reading, remove->children + 2, sizeof *shape->part);
  shape->parts = 1;
  bool fine = no_points(reading, from) && part_read(reading, from, "'from'", &shape->part[0]);
  return parts_read(reading, remove, "'remove'", shape) && fine;
}

static const struct {
  enum shape_kind kind;
  const char *name;
  bool (*read)(struct reading *, const struct tree *, struct shape *);
  bool of_lengths; /* there is one in 1d */
} forms[] = {
    {SHAPE_BOX, "box", box_read, true},
    {SHAPE_CYLINDER, "cylinder", cylinder_read, false},
    {SHAPE_SPHERE, "sphere", sphere_read, false},
    {SHAPE_TUBE, "tube", tube_read, false},
    {SHAPE_CONE, "cone", cone_read, false},
    {SHAPE_UNION, "union", union_read, true},
    {SHAPE_DIFFERENCE, "difference", difference_read, true},
    {SHAPE_POINTS, "points", shape_points_read, true},
};

static bool form_read(struct reading *reading, const struct tree *child, struct shape *shape)
{
  char expected[WORDS_SIZE];
  size_t faults = reading->faults, i = 0;
  snprintf(expected, sizeof expected, "'%s'", child->key);
  while (strcmp(child->key, forms[i].name) != 0)
    i++;
  if (forms[i].kind != SHAPE_UNION && !expect_mapping(reading, child, expected))
    return false;
  if (reading->axes == 1 && !forms[i].of_lengths) {
    blame_key(reading, child, "box: {min: [0 mm], max: [5 mm]}", "a 1d scene has no %s",
              child->key);
    return false;
  }
  *shape = (struct shape){.kind = SHAPE_NONE, .revolved = reading->axisymmetric};
  if (forms[i].read(reading, child, shape) && reading->faults == faults)
    shape->kind = forms[i].kind;
  if (shape->kind == SHAPE_UNION || shape->kind == SHAPE_POINTS)
    shape_index_make(reading, shape);
  return shape->kind != SHAPE_NONE;
}

static bool part_read(struct reading *reading, const struct tree *node, const char *what,
                      struct shape *shape)
{
  const char *name[COUNT_OF(forms)];
  char list[WORDS_SIZE], expected[WORDS_SIZE];
  for (size_t i = 0; i < COUNT_OF(forms); i++)
    name[i] = forms[i].name;
  *shape = (struct shape){.kind = SHAPE_NONE};
  if (!expect_mapping(reading, node, what))
    return false;
  size_t faults = reading->faults;
  expect_keys(reading, node, name, COUNT_OF(name), what);
  if (reading->faults > faults)
    return false;
  if (node->children == 1)
    return form_read(reading, node->child[0], shape);
  snprintf(expected, sizeof expected, "one of: %s",
           list_text(name, COUNT_OF(name), list, sizeof list));
  blame_key(reading, node, expected, "the shape is %s",
            node->children ? "given more than once" : "empty");
  return false;
}

bool shape_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  return part_read(reading, node, "'shape'", shape);
}
