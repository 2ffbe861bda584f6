/* What makes a distribution: a new one is such a struct in distribution_types.c. */
#ifndef GAMUT_DISTRIBUTION_TYPES_H
#define GAMUT_DISTRIBUTION_TYPES_H

#include "random/distribution.h"

/* Parameters of the untruncated law as GSL wants them. */
struct law {
  double first, second, lower, upper; /* lower and upper: the support */
};

/* What the scene states of it besides the ends. */
enum distribution_states { DISTRIBUTION_MEAN_AND_SPREAD, DISTRIBUTION_MEAN, DISTRIBUTION_ENDS };

struct distribution_type {
  const char *name;
  bool bounded;  /* has ends of its own, which `lower` and `upper` state */
  bool positive; /* its mean must be above 0 */
  enum distribution_states states;
  /* Fills in what follows from what is stated. Why there is no such distribution, and what there
   * would be; null: there is. A null function: nothing follows, any will do. */
  const char *(*complete)(struct distribution *, const char **expected);
  struct law (*law)(const struct distribution *);
  /* Probability below x, or above it, within the support: each is exact in its own tail. */
  double (*tail)(const struct law *, double x, bool above);
  /* Where the tail is p; null: by halving. */
  double (*inverse)(const struct law *, double p, bool above);
  /* The value of a standard normal variable; null: by the tails. */
  double (*of_normal)(const struct law *, double z);
};

#endif
