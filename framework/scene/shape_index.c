/* Many boxes in a tree of boxes: which part of a large union, or which of many points, a place lies
 * deepest in is found without asking all of them. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

enum { FEW = 8, LEAF = 4 }; /* so many are asked one by one */

struct box {
  double lower[3], upper[3];
  double slope; /* far outside, the depth is at most so much of the distance from the box */
};

struct box_node {
  struct box box;
  size_t first, count; /* of the items; a leaf */
  size_t child[2];     /* 0: a leaf */
};

struct shape_index {
  struct box_node *node;
  size_t nodes;
  size_t *item;
};

struct seat {
  struct box box;
  double key;
  size_t item;
};

/* The slanted side of a cone is nearer to a place than the box around it seems to be. */
static double slope_of(const struct shape *shape)
{
  double slope = 1;
  if (shape->kind == SHAPE_CONE) {
    const double growth = fabs(shape->top_radius - shape->radius);
    slope = shape->length / (hypot(shape->length, growth) + growth);
  }
  const size_t parts = shape->kind == SHAPE_DIFFERENCE ? 1 : shape->parts;
  for (size_t i = 0; i < parts; i++)
    slope = fmin(slope, slope_of(&shape->part[i]));
  return slope;
}

static struct box box_of(const struct shape *shape, size_t item)
{
  struct box box = {.slope = 1};
  if (shape->kind == SHAPE_UNION) {
    shape_bounds(&shape->part[item], box.lower, box.upper);
    box.slope = slope_of(&shape->part[item]);
    return box;
  }
  for (size_t k = 0; k < 3; k++) {
    box.lower[k] = shape->points.place[3 * item + k] - shape->points.half[item];
    box.upper[k] = shape->points.place[3 * item + k] + shape->points.half[item];
  }
  return box;
}

static double depth_of(const struct shape *shape, size_t item, const double x[3])
{
  if (shape->kind == SHAPE_UNION)
    return shape_depth(&shape->part[item], x);
  double far = 0;
  for (size_t k = 0; k < 3; k++)
    far = fmax(far, fabs(x[k] - shape->points.place[3 * item + k]));
  return shape->points.half[item] - far;
}

static double middle(const struct box *box, int axis)
{
  const double sum = box->lower[axis] + box->upper[axis];
  return isfinite(sum) ? 0.5 * sum : 0; /* without end in directions that the geometry lacks */
}

static int by_key(const void *one, const void *other)
{
  const struct seat *a = one, *b = other;
  if (a->key != b->key)
    return a->key < b->key ? -1 : 1;
  return (a->item > b->item) - (a->item < b->item);
}

/* The axis in which the middles are farthest apart. */
static int widest_axis(const struct seat *seat, size_t count)
{
  int widest = 0;
  double most = -1;
  for (int axis = 0; axis < 3; axis++) {
    double least = INFINITY, largest = -INFINITY;
    for (size_t i = 0; i < count; i++) {
      least = fmin(least, middle(&seat[i].box, axis));
      largest = fmax(largest, middle(&seat[i].box, axis));
    }
    if (largest - least > most) {
      most = largest - least;
      widest = axis;
    }
  }
  return widest;
}

static size_t grow(struct shape_index *index, struct seat *seat, size_t first, size_t count)
{
  const size_t number = index->nodes++;
  struct box_node *node = &index->node[number];
  *node = (struct box_node){.box = seat[first].box, .first = first, .count = count};
  for (size_t i = first; i < first + count; i++) {
    for (int k = 0; k < 3; k++) {
      node->box.lower[k] = fmin(node->box.lower[k], seat[i].box.lower[k]);
      node->box.upper[k] = fmax(node->box.upper[k], seat[i].box.upper[k]);
    }
    node->box.slope = fmin(node->box.slope, seat[i].box.slope);
  }
  if (count > LEAF) {
    const int axis = widest_axis(seat + first, count);
    for (size_t i = first; i < first + count; i++)
      seat[i].key = middle(&seat[i].box, axis);
    qsort(seat + first, count, sizeof *seat, by_key);
    const size_t half = count / 2;
    node->child[0] = grow(index, seat, first, half);
    node->child[1] = grow(index, seat, first + half, count - half);
  }
  return number;
}

void shape_index_make(struct scene_reader *reader, struct shape *shape)
{
  const size_t count = shape->kind == SHAPE_UNION ? shape->parts : shape->points.count;
  shape->index = NULL;
  if (count <= FEW)
    return;
  struct shape_index *index = scene_keep(reader, 1, sizeof *index);
  struct seat *seat = scene_take(count, sizeof *seat);
  index->node = scene_keep(reader, 2 * count, sizeof *index->node);
  index->item = scene_keep(reader, count, sizeof *index->item);
  for (size_t i = 0; i < count; i++)
    seat[i] = (struct seat){box_of(shape, i), 0, i};
  grow(index, seat, 0, count);
  for (size_t i = 0; i < count; i++)
    index->item[i] = seat[i].item;
  free(seat);
  shape->index = index;
}

/* Nothing in the box is deeper than this. */
static double bound(const struct box *box, const double x[3])
{
  double depth = INFINITY;
  for (int k = 0; k < 3; k++)
    depth = fmin(depth, fmin(x[k] - box->lower[k], box->upper[k] - x[k]));
  return depth < 0 ? depth * box->slope : depth;
}

static void search(const struct shape *shape, size_t number, const double x[3], double *best)
{
  const struct shape_index *index = shape->index;
  const struct box_node *node = &index->node[number];
  if (node->child[0] == 0) {
    for (size_t i = node->first; i < node->first + node->count; i++)
      *best = fmax(*best, depth_of(shape, index->item[i], x));
    return;
  }
  double reach[2];
  for (int i = 0; i < 2; i++)
    reach[i] = bound(&index->node[node->child[i]].box, x);
  const int nearer = reach[1] > reach[0];
  for (int i = 0; i < 2; i++) {
    const int side = i == 0 ? nearer : !nearer;
    /* Round-off of the bound must not lose what lies on it. */
    if (!(reach[side] < *best - 1e-12 * fabs(*best)))
      search(shape, node->child[side], x, best);
  }
}

double shape_index_depth(const struct shape *shape, const double x[3])
{
  double best = -INFINITY;
  search(shape, 0, x, &best);
  return best;
}

/* Whether the bounds of two parts have something in common. */
static bool meets(const struct box *one, const struct box *other, unsigned dimension)
{
  for (unsigned k = 0; k < dimension; k++)
    if (one->lower[k] >= other->upper[k] || other->lower[k] >= one->upper[k])
      return false;
  return true;
}

bool shape_parts_apart(const struct shape *shape, unsigned dimension)
{
  struct seat *seat = scene_take(shape->parts, sizeof *seat);
  bool apart = true;
  for (size_t i = 0; i < shape->parts; i++)
    seat[i] = (struct seat){box_of(shape, i), 0, i};
  const int axis = widest_axis(seat, shape->parts);
  for (size_t i = 0; i < shape->parts; i++)
    seat[i].key = seat[i].box.lower[axis];
  qsort(seat, shape->parts, sizeof *seat, by_key);
  for (size_t i = 0; i < shape->parts && apart; i++)
    for (size_t k = i + 1; k < shape->parts && seat[k].key < seat[i].box.upper[axis] && apart; k++)
      apart = !meets(&seat[i].box, &seat[k].box, dimension);
  free(seat);
  return apart;
}
