/* Derivatives by differences, extrapolated to step zero (Ridders' table). */
#ifndef GAMUT_DIFFERENCE_H
#define GAMUT_DIFFERENCE_H

/* A function near a point: its value where the two arguments are moved by x and y. */
struct difference {
  double (*value)(void *self, double x, double y);
  void *self;
  double step_x, step_y; /* the first, largest steps */
};

/* The derivatives at (0, 0), with the error that the table shows. */
double difference_first(const struct difference *, double *error);
double difference_second(const struct difference *, double *error); /* twice by x */
double difference_mixed(const struct difference *, double *error);  /* by x and y */
/* One-sided, forward for side +1, backward for -1: where a function has a kink or an end. */
double difference_sided(const struct difference *, int side, double *error);

#endif
