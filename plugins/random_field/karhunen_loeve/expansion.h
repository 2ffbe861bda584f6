/* Inside karhunen_loeve: a field from modes of its covariance along each axis, from an ensemble of
 * samples, or from a table. */
#ifndef GAMUT_EXPANSION_H
#define GAMUT_EXPANSION_H

#include "../noise.h"

enum covariance { EXPONENTIAL, GAUSSIAN, MATERN_1_2, MATERN_3_2, MATERN_5_2 };

/* Modes along one axis (modes.c). */

/* Eigenfunctions of a covariance on an interval, by falling eigenvalue. Mode j is even about the
 * middle for even j, else odd; it is positive, or rises, just right of the middle. */
struct axis {
  double centre, half; /* of the interval, m */
  double ratio;        /* half over correlation length */
  enum covariance covariance;
  size_t modes;  /* known; their eigenvalues are above rounding */
  double *share; /* eigenvalue over the length of the interval; all that exist add to 1 */
  double *frequency, *size; /* exponential: cos or sin of frequency * xi, times size */
  size_t nodes;             /* others: nodes in the right half */
  double *node, *weight;    /* weight[j * nodes + q]: Nystrom's coefficients of mode j */
};
/* `most`: modes that could be wanted. False when out of memory. */
bool axis_new(struct axis *, enum covariance, double lower, double upper, double length,
              size_t most);
void axis_free(struct axis *);
/* value[j] = sqrt(eigenvalue) * eigenfunction of the first `count` modes at x; `room` has two
 * arrays of `nodes` numbers. The squares of all modes add to 1, the variance. */
void axis_modes(const struct axis *, double x, size_t count, double *room, double *value);

/* Products of modes along up to three axes (expansion.c). */

enum { AXES = 3, MODES_OF_AXIS = 4096 };
struct mode {
  size_t index[AXES]; /* along each axis: also what its random number is keyed by */
  double share;       /* of the variance */
};
struct expansion {
  struct axis axis[AXES];
  size_t along[AXES]; /* modes in use along each axis */
  struct mode *mode;
  size_t modes;
  double held; /* share of the variance that the modes hold */
  bool unit_variance;
};
/* The fewest modes that hold `energy`, or as many as may be; axes of no extent have none. False
 * when out of memory. */
bool expansion_new(struct expansion *, enum covariance, const double lower[AXES],
                   const double upper[AXES], const double length[AXES], double energy,
                   size_t modes_max);
void expansion_free(struct expansion *);
bool expansion_sample(const struct expansion *, const struct gamut_stream *, size_t count,
                      const double *const position[AXES], double *value);

/* An ensemble of samples (ensemble.c). */

struct ensemble {
  struct noise noise;
  size_t samples, points; /* points 0: those that are asked for */
  double energy;
};
struct ensemble_report {
  size_t modes;
  double held;
  int64_t twice; /* a point that came twice, or -1 */
};
/* Values of realisation `stream->realisation`, a row of the ensemble. False when out of memory or
 * when a point came twice. */
bool ensemble_sample(const struct ensemble *, const struct gamut_stream *, size_t count,
                     const int64_t *id, double *value, struct ensemble_report *);

/* A table (table.c). */

struct table {
  size_t count[AXES];
  double *line[AXES]; /* coordinates along each axis, rising */
  double *value;      /* x fastest */
};
/* Rows of x, y, z, value that make a full grid. Null, or what is wrong with them. */
const char *table_new(struct table *, const double *row, size_t rows);
void table_free(struct table *);
double table_at(const struct table *, const double x[AXES]);

#endif
