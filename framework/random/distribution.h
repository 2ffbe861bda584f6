/* Distributions of random parameters (GSL). */
#ifndef GAMUT_DISTRIBUTION_H
#define GAMUT_DISTRIBUTION_H

#include <stdbool.h>
#include <stddef.h>

/* A kind of distribution; see distribution_types.h. */
struct distribution_type;
/* By the name in a scene; null: the one that is meant where none is named. Null if unknown. */
const struct distribution_type *distribution_named(const char *name);
/* The names of all; how many there are. */
enum { DISTRIBUTIONS_MAX = 32 };
size_t distribution_names(const char *name[DISTRIBUTIONS_MAX]);

/* A random parameter as the scene states it, SI. `mean` and `deviation` are those of the
 * untruncated distribution; lower and upper the ends of a uniform, beta or triangular one (mode =
 * the mean's complement for triangular is derived), and of the truncation. */
struct distribution {
  const struct distribution_type *type;
  double mean, deviation;
  double lower, upper; /* -inf, inf where open */
  bool truncated;
  bool conforms; /* truncated to what is possible: also drawn again where a constraint is broken */
};

/* Quantile at probability u in (0, 1). */
double distribution_quantile(const struct distribution *, double u);
/* The value that belongs to a standard normal variable z: the quantile at z's probability, exact in
 * both tails. */
double distribution_of_normal(const struct distribution *, double z);
/* Probability that truncation cuts off. */
double distribution_cut(const struct distribution *);
/* Probability below x. */
double distribution_below(const struct distribution *, double x);

#endif
