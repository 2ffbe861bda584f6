/* Shape functions of one axis for eight points at once.
 *
 * A point touches NODES nodes along an axis. x is 0 to 1, from `shape_shift` cells above the lowest
 * of them; weight[k] belongs to the node k above it, slope[k] is its slope times `scale`.
 * `reach` is half the length of the point's domain in cells, for gimp: at most a half, so that
 * three nodes hold all of it (the quadratic spline is gimp with a half).
 *
 * Sources: linear: Sulsky, Chen and Schreyer (1994); gimp: Bardenhagen and Kober (2004), Eqs. 33
 * and 34; splines: Steffen, Kirby and Berzins (2008), Eqs. 18 to 21. */
#ifndef MATERIAL_POINT_METHOD_SHAPES_H
#define MATERIAL_POINT_METHOD_SHAPES_H

#include <gamut/run.h>

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

static inline void shape_linear(const double *restrict x, const double *reach, double scale,
                                double weight[restrict][GAMUT_LANES],
                                double slope[restrict][GAMUT_LANES])
{
  (void)reach;
#pragma omp simd
  for (int l = 0; l < GAMUT_LANES; l++) {
    weight[0][l] = 1.0 - x[l];
    weight[1][l] = x[l];
    slope[0][l] = -scale;
    slope[1][l] = scale;
  }
}

static inline void shape_quadratic(const double *restrict x, const double *reach, double scale,
                                   double weight[restrict][GAMUT_LANES],
                                   double slope[restrict][GAMUT_LANES])
{
  (void)reach;
#pragma omp simd
  for (int l = 0; l < GAMUT_LANES; l++) {
    const double y = 1.0 - x[l];
    weight[0][l] = 0.5 * y * y;
    weight[2][l] = 0.5 * x[l] * x[l];
    weight[1][l] = 0.5 + x[l] * y;
    slope[0][l] = -y * scale;
    slope[2][l] = x[l] * scale;
    slope[1][l] = (y - x[l]) * scale;
  }
}

/* With the distance d from the middle node, and c = d held between -reach and reach:
 * upper (reach + c)^2 / (4 reach) + (d - c where d > c), lower the same of -d, middle the rest. */
static inline void shape_gimp(const double *restrict x, const double *restrict reach, double scale,
                              double weight[restrict][GAMUT_LANES],
                              double slope[restrict][GAMUT_LANES])
{
#pragma omp simd
  for (int l = 0; l < GAMUT_LANES; l++) {
    const double d = x[l] - 0.5, r = reach[l], over = 0.5 / r;
    const double below = d < r ? d : r, c = below > -r ? below : -r;
    const double up = r + c, down = r - c, beyond = d - c;
    const double upper = 0.5 * over * up * up + (beyond > 0.0 ? beyond : 0.0);
    const double lower = 0.5 * over * down * down - (beyond < 0.0 ? beyond : 0.0);
    weight[0][l] = lower;
    weight[1][l] = 1.0 - lower - upper;
    weight[2][l] = upper;
    slope[0][l] = -over * down * scale;
    slope[1][l] = -2.0 * over * c * scale;
    slope[2][l] = over * up * scale;
  }
}

static inline void shape_cubic(const double *restrict x, const double *reach, double scale,
                               double weight[restrict][GAMUT_LANES],
                               double slope[restrict][GAMUT_LANES])
{
  (void)reach;
  const double third = 1.0 / 3.0, sixth = 1.0 / 6.0;
#pragma omp simd
  for (int l = 0; l < GAMUT_LANES; l++) {
    const double a = x[l], b = 1.0 - a, aa = a * a, bb = b * b;
    weight[0][l] = sixth * bb * b;
    weight[1][l] = 2.0 * third - aa + 0.5 * aa * a;
    weight[2][l] = 2.0 * third - bb + 0.5 * bb * b;
    weight[3][l] = sixth * aa * a;
    slope[0][l] = -0.5 * bb * scale;
    slope[1][l] = (1.5 * aa - 2.0 * a) * scale;
    slope[2][l] = (2.0 * b - 1.5 * bb) * scale;
    slope[3][l] = 0.5 * aa * scale;
  }
}

#endif
