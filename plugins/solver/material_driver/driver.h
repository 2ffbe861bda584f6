/* The driver's inside, shared by its files. Matrices are row by row: xx xy xz yx yy yz zx zy zz. */
#ifndef DRIVER_H
#define DRIVER_H

#include "material_driver.gamut.h"

/* motion.c. */

/* exp(A) - I. */
void exponential_less_one(const double A[9], double G[9]);
/* From H = F - I and the step's G to H at its end: (I + G)(I + H) - I. */
void compose(const double G[9], const double H[9], double out[9]);
/* J - 1 of F = I + H. */
double volume_change(const double H[9]);
/* ln sqrt(F F') of F = I + H, components xx yy zz xy yz zx. */
void log_strain(const double H[9], double strain[6]);

/* control.c. */

enum control { CONTROL_NONE, CONTROL_RATE, CONTROL_LOG_STRAIN, CONTROL_STRAIN, CONTROL_STRESS };

/* What is prescribed for one component: rows of time and value. */
struct curve {
  enum control control;
  const char *name;
  const double *row; /* borrowed from the scene's values */
  size_t rows;
  double *owned; /* or made here: a ramp */
};

enum { NORMALS = 3, SYMMETRIC = 6, COMPONENTS = 9 };

struct path {
  struct curve curve[COMPONENTS]; /* xx yy zz xy yz zx, then yx zy xz */
  bool symmetric[COMPONENTS];     /* moves its mirror image too */
};

gamut_status path_read(struct gamut_run *, const struct gamut_values *, struct path *);
void path_free(struct path *);
/* What the prescribed components add to A in a step. */
void path_increment(const struct path *, double from, double step, double A[9]);
/* The components whose stress is prescribed, and the stresses at `time`; returns how many. */
size_t path_stresses(const struct path *, double time, size_t component[SYMMETRIC],
                     double stress[SYMMETRIC]);
/* Adds to A what component k (and its mirror image) moves by. */
void path_move(const struct path *, size_t component, double by, double A[9]);

/* solve.c. */

/* The point of one body. */
struct point {
  const char *body;
  double H[9], H_end[9];  /* F - I at the beginning and the end of the step */
  double rate[SYMMETRIC]; /* of stress-controlled components in the step before */
  bool moved;             /* there was one */
  double A[9];            /* of the step */
  double work_step, energy;
  double work;
  /* Set where the wanted stress was not reached. */
  const char *failed; /* component */
  double left, wanted;
  bool finite;
};

struct driver {
  struct gamut_run *run;
  const struct gamut_values *values;
  struct path path;
  double step;
  size_t points;
  struct point *point; /* one a body */
  struct gamut_set **set;
  struct gamut_field velocity_gradient, stress, energy, cell_size;
  double *internal, *supplied, *lost; /* ledger */
};

/* The step of one point: finds A, updates the material. */
gamut_status drive(void *driver, const struct gamut_chunk *);

#endif
