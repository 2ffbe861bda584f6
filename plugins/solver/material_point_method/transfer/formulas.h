/* The shape functions of one axis, for a vector of points. x, reach, weight and slope are those of
 * shapes.h.
 *
 * Sources: linear: Sulsky, Chen and Schreyer (1994); gimp: Bardenhagen and Kober (2004), Eqs. 33
 * and 34; splines: Steffen, Kirby and Berzins (2008), Eqs. 18 to 21. */
#ifndef MATERIAL_POINT_METHOD_FORMULAS_H
#define MATERIAL_POINT_METHOD_FORMULAS_H

#include "transfer/line.h"
#include "transfer/shapes.h"

INLINE void weights_linear(vector x, vector reach, double scale, vector weight[NODES_MAX],
                           vector slope[NODES_MAX])
{
  (void)reach;
  weight[0] = 1.0 - x;
  weight[1] = x;
  slope[0] = (vector){0} - scale;
  slope[1] = (vector){0} + scale;
}

/* With the distance d from the middle node, and c = d held between -reach and reach:
 * upper (reach + c)^2 / (4 reach) + (d - c where d > c), lower the same of -d, middle the rest. */
INLINE void weights_gimp(vector x, vector reach, double scale, vector weight[NODES_MAX],
                         vector slope[NODES_MAX])
{
  const vector none = {0}, d = x - 0.5, over = 0.5 / reach;
  const vector below = vector_lower(d, reach), c = vector_higher(below, -reach);
  const vector up = reach + c, down = reach - c;
  weight[2] = 0.5 * over * up * up + vector_higher(d - c, none);
  weight[0] = 0.5 * over * down * down + vector_higher(c - d, none);
  weight[1] = 1.0 - weight[0] - weight[2];
  slope[0] = -over * down * scale;
  slope[1] = -2.0 * over * c * scale;
  slope[2] = over * up * scale;
}

INLINE void weights_quadratic(vector x, vector reach, double scale, vector weight[NODES_MAX],
                              vector slope[NODES_MAX])
{
  (void)reach;
  const vector y = 1.0 - x;
  weight[0] = 0.5 * y * y;
  weight[1] = 0.5 + x * y;
  weight[2] = 0.5 * x * x;
  slope[0] = -y * scale;
  slope[1] = (y - x) * scale;
  slope[2] = x * scale;
}

INLINE void weights_cubic(vector x, vector reach, double scale, vector weight[NODES_MAX],
                          vector slope[NODES_MAX])
{
  (void)reach;
  const double third = 1.0 / 3.0, sixth = 1.0 / 6.0;
  const vector y = 1.0 - x, xx = x * x, yy = y * y;
  weight[0] = sixth * yy * y;
  weight[1] = 2.0 * third - xx + 0.5 * xx * x;
  weight[2] = 2.0 * third - yy + 0.5 * yy * y;
  weight[3] = sixth * xx * x;
  slope[0] = -0.5 * yy * scale;
  slope[1] = (1.5 * xx - 2.0 * x) * scale;
  slope[2] = (2.0 * y - 1.5 * yy) * scale;
  slope[3] = 0.5 * xx * scale;
}

/* shape_NAME: the same of GAMUT_LANES points, node by node. */
#define SHAPE_OF_LANES(name)                                                                       \
  INLINE void shape_##name(const double *x, const double *reach, double scale,                     \
                           double weight[][GAMUT_LANES], double slope[][GAMUT_LANES])              \
  {                                                                                                \
    for (int l = 0; l < GAMUT_LANES; l += WIDTH) {                                                 \
      vector w[NODES_MAX], s[NODES_MAX];                                                           \
      weights_##name(vector_read(x + l), vector_read(reach + l), scale, w, s);                     \
      for (int k = 0; k < NODES_##name; k++) {                                                     \
        vector_write(weight[k] + l, w[k]);                                                         \
        vector_write(slope[k] + l, s[k]);                                                          \
      }                                                                                            \
    }                                                                                              \
  }

SHAPE_OF_LANES(linear)
SHAPE_OF_LANES(gimp)
SHAPE_OF_LANES(quadratic)
SHAPE_OF_LANES(cubic)

#undef SHAPE_OF_LANES

#endif
