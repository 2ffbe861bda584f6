/* Shape functions of one axis for eight points at once. x is 0 to 1 from the lowest node touched
 * (for the quadratic spline: from half a cell above it); weight[k] belongs to the node k above it.
 */
#ifndef MATERIAL_POINT_METHOD_SHAPES_H
#define MATERIAL_POINT_METHOD_SHAPES_H

#include <gamut/run.h>

static inline void shape_linear(const double *restrict x, double scale,
                                double weight[restrict][GAMUT_LANES],
                                double slope[restrict][GAMUT_LANES])
{
#pragma omp simd
  for (int l = 0; l < GAMUT_LANES; l++) {
    weight[0][l] = 1.0 - x[l];
    weight[1][l] = x[l];
    slope[0][l] = -scale;
    slope[1][l] = scale;
  }
}

static inline void shape_quadratic(const double *restrict x, double scale,
                                   double weight[restrict][GAMUT_LANES],
                                   double slope[restrict][GAMUT_LANES])
{
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

#endif
