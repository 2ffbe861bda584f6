/* Shape functions of one axis, for eight points at once; the formulas are in formulas.h.
 *
 * A point touches NODES nodes along an axis. x is 0 to 1, from `shape_shift` cells above the lowest
 * of them; weight[k] belongs to the node k above it, slope[k] is its slope times `scale`.
 * `reach` is half the length of the point's domain in cells, for gimp: at most a half, so that
 * three nodes hold all of it (the quadratic spline is gimp with a half).
 */
#ifndef MATERIAL_POINT_METHOD_SHAPES_H
#define MATERIAL_POINT_METHOD_SHAPES_H

#include <gamut/host.h>

enum shape { SHAPE_LINEAR, SHAPE_GIMP, SHAPE_QUADRATIC, SHAPE_CUBIC, SHAPES };

/* Nodes that a point touches along an axis. */
enum { NODES_linear = 2, NODES_gimp = 3, NODES_quadratic = 3, NODES_cubic = 4, NODES_MAX = 4 };

static inline int shape_nodes(enum shape shape)
{
  static const int nodes[SHAPES] = {NODES_linear, NODES_gimp, NODES_quadratic, NODES_cubic};
  return nodes[shape];
}

/* From the lowest node that is touched to where x begins, in cells. */
static inline double shape_shift(enum shape shape)
{
  return 0.5 * (shape_nodes(shape) - 2);
}

#endif
