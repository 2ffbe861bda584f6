/* A path of deformation that an elasticity kernel is led along, seen in any frame; and the 3x3
 * matrices that it takes. */
#ifndef GAMUT_CONFORMANCE_PATH_H
#define GAMUT_CONFORMANCE_PATH_H

#include "conformance/suite.h"

/* Row by row, as velocity_gradient is stored. */
typedef double matrix[9];
extern const matrix matrix_unity;

double matrix_determinant(const matrix);
/* By `angle` about the axis (1, 2, 2) / 3. */
void matrix_rotation(double angle, matrix r);
/* The largest difference of two entries over the largest entry of `a`. */
double matrix_distance(const matrix a, const matrix b);
/* r a r' */
void matrix_turned(const matrix r, const matrix a, matrix out);

struct path {
  struct suite *suite;
  struct block *block;
  kernel_function function;
  size_t gradient, step, deformation, stress, begin; /* slots */
  matrix F;
  double ratio; /* of the volume, by the deformation */
  bool stopped;
  double least_growth, least_dissipation; /* of plastic strain and of its work, over all steps */
  double work, gross;      /* of the stress, and the sum of its sizes */
  double dissipated, flow; /* said by the law; flow stress times plastic strain */
};

/* Seconds that a path takes. */
extern const double path_duration;

/* False where the kernel lacks what a path needs. */
bool path_new(struct path *, struct suite *);
/* What stands in a slot for the point. */
double *path_value(const struct path *, size_t slot);
/* One step by the increment f: F at its end is f times F at its beginning. */
void path_advance(struct path *, const matrix f, double step);
void path_stress(const struct path *, matrix stress);
/* F at a share of the path: stretch, shear and volume change, well into plastic flow; back again
 * after the middle where `back`. */
void path_deformation(double share, bool back, matrix f);
/* Follows the path in n steps from the start, in a frame turned by q and rotating by `turn` over
 * its length. */
void path_follow(struct path *, size_t n, bool back, const matrix q, double turn);

#endif
