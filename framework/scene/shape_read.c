/* Shapes as a scene gives them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static bool part_read(struct scene_reader *, const struct tree *, const char *what, struct shape *);

static unsigned axes_of(const struct scene_reader *reader)
{
  return reader->axes ? reader->axes : 3;
}

static bool in_plane(const struct scene_reader *reader)
{
  return reader->axes == 2 && !reader->axisymmetric;
}

/* A place; components of directions that the geometry lacks are 0. */
static bool place_read(struct scene_reader *reader, const struct tree *mapping, const char *key,
                       bool required, double x[3])
{
  const struct tree *node = tree_get(mapping, key);
  unsigned axes = axes_of(reader);
  size_t count;
  x[0] = x[1] = x[2] = 0;
  if (!node) {
    if (required && !is_typo_of(reader, mapping, key))
      error_at_key(reader, mapping, NULL, "'%s' is missing in '%s'", key, mapping->key);
    return !required;
  }
  double *number = vector_read(reader, node, key, "m", axes, axes, &count);
  if (!number)
    return false;
  memcpy(x, number, count * sizeof *number);
  free(number);
  return true;
}

bool length_read(struct scene_reader *reader, const struct tree *mapping, const char *key,
                 bool required, bool zero, double *length)
{
  const struct tree *node = tree_get(mapping, key);
  if (!node) {
    if (required && !is_typo_of(reader, mapping, key))
      error_at_key(reader, mapping, "a length with its unit, such as '5 mm'",
                   "'%s' is missing in '%s'", key, mapping->key);
    return !required;
  }
  if (!amount_read(reader, node, key, "m", length))
    return false;
  if (*length > 0 || (zero && *length == 0))
    return true;
  error_at_value(reader, node, zero ? "it must be at least 0 m" : "it must be greater than 0 m",
                 "%s = %.6g m is not possible", key, *length);
  return false;
}

static bool box_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"min", "max", "size", "centre"};
  bool centred = tree_get(node, "size") || tree_get(node, "centre");
  double size[3];
  expect_keys(reader, node, known, ARRAY_SIZE(known), "a box");
  if (centred && (tree_get(node, "min") || tree_get(node, "max"))) {
    error_at_key(reader, node, "{min:, max:} or {size:, centre:}", "the box is given in two ways");
    return false;
  }
  bool one =
      place_read(reader, node, centred ? "size" : "min", true, centred ? size : shape->lower);
  bool two = place_read(reader, node, centred ? "centre" : "max", !centred,
                        centred ? shape->centre : shape->upper);
  for (unsigned k = 0; k < 3 && one && two; k++) {
    if (centred) {
      shape->lower[k] = shape->centre[k] - 0.5 * size[k];
      shape->upper[k] = shape->centre[k] + 0.5 * size[k];
    }
    if (k >= axes_of(reader)) {
      shape->lower[k] = -INFINITY;
      shape->upper[k] = INFINITY;
    }
    if (!(shape->lower[k] < shape->upper[k])) {
      error_at_value(reader, tree_get(node, centred ? "size" : "max"),
                     centred ? "sizes greater than 0"
                             : "'max' greater than 'min' in every direction",
                     "the box has no extent along %c", "xyz"[k]);
      return false;
    }
  }
  return one && two;
}

static bool axis_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  const struct tree *axis = tree_get(node, "axis");
  bool plane = in_plane(reader);
  shape->axis = plane ? 2 : 1;
  if (!axis)
    return true;
  const char *text = text_read(reader, axis, "axis");
  if (!text)
    return false;
  const char *found = strlen(text) == 1 ? strchr("xyz", text[0]) : NULL;
  if (!found) {
    error_at_value(reader, axis, "x, y or z", "unknown axis '%.20s'", text);
    return false;
  }
  shape->axis = text[0] - 'x';
  if (reader->axisymmetric && shape->axis != 1)
    error_at_value(reader, axis, "axis: y", "an axisymmetric scene turns about y");
  else if (plane && shape->axis != 2)
    error_at_value(reader, axis, "axis: z, or a box", "in plane strain a cylinder lies along z");
  else
    return true;
  return false;
}

static bool on_axis(struct scene_reader *reader, const struct tree *node, const char *key,
                    const double x[3])
{
  if (!reader->axisymmetric || x[0] == 0)
    return true;
  error_at_value(reader, tree_get(node, key), "x = 0", "an axisymmetric %s stands on the axis",
                 node->key);
  return false;
}

/* What cylinder, tube and cone have in common. */
static bool round_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  bool plane = in_plane(reader);
  shape->length = INFINITY;
  bool fine = length_read(reader, node, "radius", true, false, &shape->radius);
  fine = length_read(reader, node, "length", !plane, false, &shape->length) && fine;
  fine = axis_read(reader, node, shape) && fine;
  fine = place_read(reader, node, "base", false, shape->centre) && fine;
  if (plane)
    shape->length = INFINITY;
  return fine && on_axis(reader, node, "base", shape->centre);
}

static bool cylinder_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "length", "axis", "base"};
  expect_keys(reader, node, known, ARRAY_SIZE(known), "a cylinder");
  return round_read(reader, node, shape);
}

static bool tube_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "inner_radius", "length", "axis", "base"};
  expect_keys(reader, node, known, ARRAY_SIZE(known), "a tube");
  bool fine = length_read(reader, node, "inner_radius", true, false, &shape->inner_radius);
  if (!round_read(reader, node, shape) || !fine)
    return false;
  if (shape->inner_radius < shape->radius)
    return true;
  error_at_value(reader, tree_get(node, "inner_radius"), "less than 'radius'",
                 "inner_radius = %.6g m leaves nothing of radius = %.6g m", shape->inner_radius,
                 shape->radius);
  return false;
}

static bool cone_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "top_radius", "length", "axis", "base"};
  expect_keys(reader, node, known, ARRAY_SIZE(known), "a cone");
  if (in_plane(reader)) {
    error_at_key(reader, node, "a cylinder or tube along z, or a box", "plane strain has no cone");
    return false;
  }
  bool fine = length_read(reader, node, "top_radius", false, true, &shape->top_radius);
  return round_read(reader, node, shape) && fine;
}

static bool sphere_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"radius", "centre"};
  expect_keys(reader, node, known, ARRAY_SIZE(known), "a sphere");
  if (in_plane(reader)) {
    error_at_key(reader, node, "a cylinder along z", "plane strain has no sphere");
    return false;
  }
  bool fine = length_read(reader, node, "radius", true, false, &shape->radius);
  return place_read(reader, node, "centre", false, shape->centre) && fine &&
         on_axis(reader, node, "centre", shape->centre);
}

/* Points that are listed are no lattice that could be cut. */
static bool no_points(struct scene_reader *reader, const struct tree *node)
{
  if (!tree_get(node, "points"))
    return true;
  error_at_key(reader, tree_get(node, "points"), "a body whose whole shape is 'points'",
               "points from a file stand alone");
  return false;
}

/* A list of shapes; each is put behind those that the shape has. */
static bool parts_read(struct scene_reader *reader, const struct tree *node, const char *what,
                       struct shape *shape)
{
  if (node->kind != TREE_SEQUENCE || node->children == 0) {
    error_at_value(reader, node, "a list, such as [{box: ...}, {cylinder: ...}]",
                   "%s is %s where a list of shapes is due", what,
                   node->kind == TREE_MAPPING    ? "a mapping"
                   : node->kind == TREE_SEQUENCE ? "an empty list"
                                                 : "a plain value");
    return false;
  }
  bool fine = true;
  for (size_t i = 0; i < node->children; i++) {
    struct shape *part = &shape->part[shape->parts++];
    fine =
        no_points(reader, node->child[i]) && part_read(reader, node->child[i], what, part) && fine;
  }
  return fine;
}

static bool union_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  shape->part = scene_keep(reader, node->children + 1, sizeof *shape->part);
  return parts_read(reader, node, "'union'", shape);
}

static bool difference_read(struct scene_reader *reader, const struct tree *node,
                            struct shape *shape)
{
  static const char *const known[] = {"from", "remove"};
  const struct tree *from = tree_get(node, "from"), *remove = tree_get(node, "remove");
  expect_keys(reader, node, known, ARRAY_SIZE(known), "a difference");
  for (size_t i = 0; i < ARRAY_SIZE(known); i++)
    if (!tree_get(node, known[i]) && !is_typo_of(reader, node, known[i]))
      error_at_key(reader, node, "{from: {cylinder: ...}, remove: [{box: ...}]}",
                   "'%s' is missing in 'difference'", known[i]);
  if (!from || !remove)
    return false;
  shape->part = scene_keep(reader, remove->children + 2, sizeof *shape->part);
  shape->parts = 1;
  bool fine = no_points(reader, from) && part_read(reader, from, "'from'", &shape->part[0]);
  return parts_read(reader, remove, "'remove'", shape) && fine;
}

static const struct {
  enum shape_kind kind;
  const char *name;
  bool (*read)(struct scene_reader *, const struct tree *, struct shape *);
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

static bool form_read(struct scene_reader *reader, const struct tree *child, struct shape *shape)
{
  char expected[WORDS_SIZE];
  size_t faults = reader->faults, i = 0;
  snprintf(expected, sizeof expected, "'%s'", child->key);
  while (strcmp(child->key, forms[i].name) != 0)
    i++;
  if (forms[i].kind != SHAPE_UNION && !expect_mapping(reader, child, expected))
    return false;
  if (reader->axes == 1 && !forms[i].of_lengths) {
    error_at_key(reader, child, "box: {min: [0 mm], max: [5 mm]}", "a 1d scene has no %s",
                 child->key);
    return false;
  }
  *shape = (struct shape){.kind = SHAPE_NONE, .revolved = reader->axisymmetric};
  if (forms[i].read(reader, child, shape) && reader->faults == faults)
    shape->kind = forms[i].kind;
  if (shape->kind == SHAPE_UNION || shape->kind == SHAPE_POINTS)
    shape_index_make(reader, shape);
  return shape->kind != SHAPE_NONE;
}

static bool part_read(struct scene_reader *reader, const struct tree *node, const char *what,
                      struct shape *shape)
{
  const char *name[ARRAY_SIZE(forms)];
  char list[WORDS_SIZE], expected[WORDS_SIZE];
  for (size_t i = 0; i < ARRAY_SIZE(forms); i++)
    name[i] = forms[i].name;
  *shape = (struct shape){.kind = SHAPE_NONE};
  if (!expect_mapping(reader, node, what))
    return false;
  size_t faults = reader->faults;
  expect_keys(reader, node, name, ARRAY_SIZE(name), what);
  if (reader->faults > faults)
    return false;
  if (node->children == 1)
    return form_read(reader, node->child[0], shape);
  snprintf(expected, sizeof expected, "one of: %s",
           list_text(name, ARRAY_SIZE(name), list, sizeof list));
  error_at_key(reader, node, expected, "the shape is %s",
               node->children ? "given more than once" : "empty");
  return false;
}

bool shape_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  return part_read(reader, node, "'shape'", shape);
}
