/* Many runs of one scene: ask an estimator, run, tell it. The loop owns threads, failures, resuming
 * and the files; the estimator only the mathematics.
 *
 * uncertainty:
 *   estimator: {model: monte_carlo, runs: 30}   any plugin of kind estimator
 *   seed: 1
 *   correlation: [[path, path, 0.4]]            of the normal variables behind the parameters
 *   failures: 0.1                               share of runs that may fail (default 0.1)
 *
 * A run gets row k of a batch: standard normal numbers, one a random parameter. They are correlated
 * by Cholesky, turned into probabilities and through each parameter's quantile function into
 * values. A level is a list of scene overrides (`type: levels` parameter of the estimator: a
 * mapping of scene paths to lists of values, combined as a grid or side by side). Runs of a batch
 * go side by side on threads, each run on one; results are recorded in the order of rows, so tables
 * do not depend on threads.
 *
 * A run's realisation, which random fields hang on, is its number among the runs of its level, so
 * that levels see the same fields. A draw that no plugin takes (range, constraint) is a failed run.
 *
 * Every finished run is appended to study.log in the result folder, so that --resume repeats
 * nothing; it takes only a log of the same scene, seed and plugins. study.csv and /study in
 * results.h5 hold one row a run: parameters, scalar quantities, status, reason. Curves are put on a
 * common axis, that of the run at the means (one more run where there are curves), cut to the
 * overlap of all runs; their mean and variance are taken there. Moments are those of the runs that
 * did not fail. */
#ifndef GAMUT_STUDY_H
#define GAMUT_STUDY_H

#include <signal.h>

#include "registry/registry.h"
#include "run/run.h"
#include "scene/scene.h"
#include "store/store.h"
#include "unit/unit.h"

struct study_options {
  int threads;       /* runs side by side; 0: as many as OpenMP says */
  bool resume;       /* go on with study.log of the folder, where there is one */
  bool force;        /* replace a result that is there */
  bool retry_failed; /* with resume: runs that failed are made again */
  const volatile sig_atomic_t *stop;
  void (*progress)(void *, size_t done, size_t asked, size_t failed);
  void *progress_self;
};

struct study;
/* Whether the scene asks for a study. */
bool study_wanted(const struct scene *);
/* The scene is borrowed; what is varied are copies of it, so its file may change meanwhile.
 * Everything is checked before anything runs. */
gamut_status study_new(struct scene *, struct registry *, const struct units *,
                       const struct study_options *, struct trace *, struct study **);
void study_free(struct study *); /* accepts null */
/* Runs to the estimator's end; folder null: nothing is written. GAMUT_NUMERICS if too many runs
 * failed, GAMUT_STOPPED if told to stop (study.log is then complete: --resume goes on). */
gamut_status study_run(struct study *, const char *folder, struct trace *);
/* What is known of a scene, and of the study that it asks for, before the first step: what a run
 * would begin with, with the status that it would have. */
gamut_status study_check(struct scene *, struct registry *, const struct units *, struct trace *);
/* Where runs stand for themselves, the scene below the levels is no member of the study: the first
 * level that can be planned, to be freed. Else null: the scene itself is what is planned. */
gamut_status study_member(struct study *, struct scene **);
/* How many runs the estimator asks for where it is given nothing, and what they cost in all. Needs
 * a run of the study's, planned, and its forecast. */
struct study_forecast {
  size_t runs;
  bool more;      /* at least so many */
  bool nominal;   /* and the run at the means */
  int threads;    /* runs side by side */
  double seconds; /* 0: not known */
  double bytes;
};
gamut_status study_forecast(struct study *, const struct gamut_run *, const struct run_forecast *,
                            struct study_forecast *);
void study_explain(const struct study *, const struct study_forecast *, FILE *);
/* A JSON object of a run with the member `study` added, to be freed. */
char *study_explain_json(const struct study *, const struct study_forecast *, const char *run);

/* summary.json with mean, variance and their errors, and the `study` entry; to be freed. */
char *study_summary(const struct study *, gamut_status);

#endif
