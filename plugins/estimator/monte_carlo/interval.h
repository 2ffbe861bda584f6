/* Moments of a sample, and where those of what it was drawn from lie with a confidence of 95 %. */
#ifndef MONTE_CARLO_INTERVAL_H
#define MONTE_CARLO_INTERVAL_H

/* Sums of the powers 1 to 4 of one quantity, about its first value so that no digits are lost. */
struct sums {
  double runs, origin, power[4];
};
void sums_add(struct sums *, double value); /* a run that gave none (NaN) is left out */

/* `third` and `fourth` about the mean, by n; `variance` by n - 1. */
struct sample {
  double runs, mean, variance, third, fourth;
};
struct sample sample_of(const struct sums *);

/* NaN where there are too few runs: 3 for the mean, 4 for the variance. */
struct interval {
  double lower, upper;
};
struct interval mean_interval(const struct sample *);
struct interval variance_interval(const struct sample *);
/* The kurtosis, where it says that the interval of the variance may cover less than it should; else
 * 0. */
double heavy_tail(const struct sample *);

#endif
