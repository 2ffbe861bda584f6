/* Estimators: moments of quantities under random parameters. An estimator never runs a solver: it
 * is asked which runs are to be made, and told the results that came back.
 *
 * A row of a batch is one run: its sample is what the random parameters take, its results are the
 * numbers that the quantities of the scene came to, one of a scalar, one a place along a curve. */
#ifndef GAMUT_ESTIMATOR_H
#define GAMUT_ESTIMATOR_H

#include <gamut/host.h>

/* A batch of runs to make. The estimator fixes its size; decisions fall only between batches, so a
 * study gives the same tables for any number of threads. Arrays are owned by the core. */
struct gamut_batch {
  size_t parameters; /* random parameters, independent standard normal variables here */
  size_t results;    /* numbers that come back from each run */
  size_t capacity;   /* rows there is room for */
  size_t rows;       /* out of ask: runs wanted; 0 ends the study */
  double *sample;    /* out of ask: rows x parameters, in units of standard deviations; NaN: the
                        parameter stays at its mean */
  int *level;        /* out of ask: which of the study's levels (lists of scene overrides); 0 where
                        there are none */
  const double *result; /* into tell: rows x results; NaN where the run failed */
};

/* What an estimator is told when it is made. */
struct gamut_study_shape {
  size_t parameters; /* random parameters */
  size_t results;    /* numbers that a run gives */
  size_t levels;     /* lists of scene overrides; 0: none */
  struct gamut_stream stream; /* of the study's seed; number realisations as you like */
};

/* What a study is after. Owned by the core, `results` entries each. */
struct gamut_moments {
  double *mean, *variance;             /* of each result */
  double *mean_error, *variance_error; /* one standard error, or the estimator's own bound;
                                          infinite where the estimator knows none */
  /* Where mean and variance lie with a confidence of 95 %. The core sets these to NaN before it
   * asks: what an estimator does not state is printed as unknown. */
  double *mean_lower, *mean_upper, *variance_lower, *variance_upper;
  double *heavy_tail; /* kurtosis of the sample, where it is so large that the interval of the
                         variance is not to be relied on */
};

#define GAMUT_ESTIMATOR_OPS(B)                                                                     \
  /* required. What the study has; the struct is borrowed for the call, its stream may be copied.  \
   */                                                                                              \
  gamut_status (*create)(struct gamut_run *, const struct gamut_values *,                          \
                         const struct gamut_study_shape *, void **self);                           \
  void (*destroy)(void *self);                                                                     \
  gamut_status (*ask)(void *self, struct gamut_batch *);                                           \
  gamut_status (*tell)(void *self, const struct gamut_batch *);                                    \
  /* Required, unless the descriptor says `yields: table`: then runs are no sample. */             \
  gamut_status (*report)(const void *self, struct gamut_moments *);                                \
  /* required: the whole state as bytes; called with null bytes to learn the size. restore makes   \
   * a fresh estimator go on exactly where the saved one stood. */                                 \
  size_t (*save)(const void *self, void *bytes);                                                   \
  gamut_status (*restore)(void *self, const void *bytes, size_t size);

#endif
