/* Estimators: what quantities are like under random parameters. An estimator never runs a solver:
 * it is asked which runs are to be made, and told the results that came back.
 *
 * Words: a parameter is a random number of the scene, a quantity is what the scene wants to know. A
 * row is one run; its sample is what the parameters take, its results are the numbers that its
 * quantities came to: one of a scalar, one a place along the axis of a curve.
 *
 * All operations of an estimator are called by one thread, in this order: create (then restore,
 * where a study goes on from a saved state), ask and tell in turn, report, destroy; save stands
 * between tell and ask. */
#ifndef GAMUT_ESTIMATOR_H
#define GAMUT_ESTIMATOR_H

#include <gamut/host.h>

/* A random parameter. */
struct gamut_study_parameter {
  const char *name;       /* its path in the scene, "materials.copper.eos.C0" */
  const char *unit;       /* of mean and deviation, SI */
  double mean, deviation; /* of its distribution as the scene states it, before a truncation */
};

/* A quantity: columns first to first + count - 1 of the results. */
struct gamut_study_quantity {
  const char *name, *unit;
  size_t first, count;
  const char *axis, *axis_unit; /* of a curve, "time" and "s"; null: a scalar, with count 1 */
  const double *at;             /* of a curve: count places along its axis */
};

/* What an estimator is told of the study when it is made; its own choices are in the values. All of
 * it is owned by the core and stays until destroy. */
struct gamut_study_shape {
  size_t parameters, quantities;
  size_t results; /* numbers that a run gives, of all quantities */
  size_t levels;  /* lists of scene overrides (a parameter of type levels); 0: none */
  const struct gamut_study_parameter *parameter;
  const struct gamut_study_quantity *quantity;
  /* parameters x parameters, row by row: of the normal variables behind the parameters. Null: they
   * are independent. A sample is independent all the same: the core correlates it. */
  const double *correlation;
  struct gamut_stream stream; /* of the study's seed; number its realisations as you like */
};

/* What is made of a row. A mode that the core does not know ends the study; more may follow. */
enum gamut_row_mode {
  GAMUT_ROW_RUN /* the scene is run with the sample */
};

/* A realisation that the core gives: the number of rows that the level had before. */
#define GAMUT_NEXT_REALISATION UINT64_MAX

/* What a row cost. `work` is steps times material points, the same on every machine and for any
 * number of threads. `seconds` of a processor are measured: who decides by them gives other tables
 * on another machine (though not when a study is resumed: the log has them). */
struct gamut_row_cost {
  double seconds, work;
};

/* A batch of runs to make. The estimator fixes its size; decisions fall only between batches, so a
 * study gives the same tables for any number of threads. Arrays are owned by the core: before ask
 * it sets level and mode to 0, realisation to GAMUT_NEXT_REALISATION. Into tell the batch comes as
 * it was asked, with the realisations that were given. */
struct gamut_batch {
  size_t parameters, results; /* as in gamut_study_shape */
  size_t capacity;            /* rows there is room for */
  size_t rows;                /* out of ask: runs wanted; 0 ends the study */
  double *sample; /* out of ask: rows x parameters, independent standard normal variables; NaN: the
                     parameter stays at its mean */
  int *level;     /* out of ask: which of the study's levels; 0 where there are none */
  int *mode;      /* out of ask: enum gamut_row_mode */
  /* Out of ask: what random fields hang on, and what a sample that is against a constraint of the
   * scene is drawn anew by. Rows that differ in nothing but the level, and are to be compared, have
   * one sample and one realisation. */
  uint64_t *realisation;
  const double *result; /* into tell: rows x results; NaN where a run failed or gave none */
  const struct gamut_row_cost *cost; /* into tell: of each row, of failed ones too */
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

/* A column of a table: either numbers or texts, one a row. A number that is NaN is left out. */
struct gamut_table_column {
  const char *name, *unit; /* unit null: none */
  const char *meaning;     /* null: none */
  const double *number;
  const char *const *text;
};

/* What an estimator has to say. Moments are filled in place; the two functions may be called any
 * number of times, and copy what they are given. Names are words of letters, digits and
 * underscores. They end the study with GAMUT_PLUGIN where a name is none, or is taken. */
struct gamut_report {
  struct gamut_moments moments; /* null where the descriptor says `yields: table` */
  /* A number under a name of the estimator's, beside the mean of the quantity: a Sobol' index, a
   * quantile. `value` has the `count` numbers of that quantity. In summary.json as
   * quantities.QUANTITY.estimates.NAME, in estimates.csv and in results.h5. */
  gamut_status (*number)(struct gamut_report *, size_t quantity, const char *name, const char *unit,
                         const char *meaning, const double *value);
  /* A table: levels with their costs, terms of an expansion. In summary.json as study.tables.NAME,
   * in table_NAME.csv and in results.h5. */
  gamut_status (*table)(struct gamut_report *, const char *name, const char *meaning,
                        const struct gamut_table_column *, size_t columns, size_t rows);
};

#define GAMUT_ESTIMATOR_OPERATIONS(OP, B)                                                          \
  /* required. What the study has. On failure returns a status after gamut_fail; *self then is not \
   * destroyed. */                                                                                 \
  OP(gamut_status, create,                                                                         \
     (struct gamut_run *, const struct gamut_values *, const struct gamut_study_shape *,           \
      void **self))                                                                                \
  /* required. Accepts null. */                                                                    \
  OP(void, destroy, (void *self))                                                                  \
  OP(gamut_status, ask, (void *self, struct gamut_batch *))                                        \
  OP(gamut_status, tell, (void *self, const struct gamut_batch *))                                 \
  /* Required, unless the descriptor says `yields: table`: then runs are no sample and there are   \
   * no moments. */                                                                                \
  OP(gamut_status, report, (const void *self, struct gamut_report *))                              \
  /* required: the whole state as bytes; called with null bytes to learn the size. restore makes   \
   * a fresh estimator go on exactly where the saved one stood. */                                 \
  OP(size_t, save, (const void *self, void *bytes))                                                \
  OP(gamut_status, restore, (void *self, const void *bytes, size_t size))
#define GAMUT_ESTIMATOR_OPS(B) GAMUT_ESTIMATOR_OPERATIONS(GAMUT_OPERATION, B)

#endif
