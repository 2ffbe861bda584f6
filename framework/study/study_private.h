/* The inside of a study, shared by the files of this room. */
#ifndef GAMUT_STUDY_PRIVATE_H
#define GAMUT_STUDY_PRIVATE_H

#include <jansson.h>

#include <gamut/plugin.h>

#include "study/study.h"

struct estimator_operations {
  size_t size;
  GAMUT_ESTIMATOR_OPS(void)
};

/* A list of scene overrides: one value of each varied path. */
struct level {
  struct scene_override *override; /* nodes of the study's scene */
};

/* A quantity of the scene among the results of a run: columns first to first + count - 1. */
struct measured {
  const struct quantity *quantity;
  char unit[64];
  size_t first, count;
  bool curve;
  const char *axis, *axis_unit; /* of a curve */
  double *at;                   /* the common axis */
};

/* The curve of one run on its own axis. */
struct own_curve {
  size_t count;
  double *at, *value;
};

/* One run. */
struct outcome {
  size_t level;
  enum gamut_row_mode mode;
  uint64_t realisation;
  bool done;             /* made, or found in the log */
  char *reason;          /* why it failed; null: it did not */
  double *parameter;     /* what was drawn; the mean where nothing was */
  double *result;        /* NaN where there is none */
  struct own_curve *own; /* where runs are no sample: one a quantity */
  size_t owns;
  bool again; /* what was drawn first was not possible */
  uint64_t steps, points;
  double wall, cpu; /* s */
  double work;      /* points times steps */
};

/* Steps that all runs of a level take; none: each takes its own. */
struct common_steps {
  double *step;
  size_t count;
};

/* The run at the means of a level, where runs are a sample; in no statistic. */
struct nominal {
  struct outcome outcome;
  struct common_steps steps;
};

/* What an estimator may ask of the core. */
struct estimator_host {
  struct gamut_run_head head; /* first */
  struct trace *trace;
  const struct tree *node; /* of the estimator in the scene */
};

/* What truncation takes away from the distribution of a parameter, or a constraint from that of all
 * the parameters that are drawn again for it. */
struct cut {
  const struct random_parameter *parameter;
  char constraint[200]; /* empty: the parameter's own ends */
  double share;         /* of the constraint: estimated from trial draws */
};

struct worker {
  struct scene *scene;
  size_t level;
  size_t *parameter; /* which of the study's parameters each of the scene's is */
};

struct study {
  struct scene *scene;
  struct registry *registry;
  const struct units *units;
  struct study_options options;
  struct trace *trace;

  const char **varied; /* paths of the levels' overrides */
  size_t varies;
  struct level *level;
  size_t levels;

  bool table; /* runs are no sample: each has its own curves, and there are no moments */
  size_t parameters;
  struct cut *cut;
  size_t cuts;
  struct worker probe; /* its scene judges what is drawn */
  double *lower;       /* Cholesky's factor; null: independent */

  struct measured *measured; /* one a quantity of the scene */
  size_t quantities, results;

  struct estimator_host host;
  const struct estimator_operations *ops;
  void *self;
  struct gamut_study_parameter *parameter; /* as the estimator sees them */
  struct gamut_study_quantity *quantity;
  struct gamut_batch batch;
  double *batch_result;              /* what batch.result shows */
  struct gamut_row_cost *batch_cost; /* and batch.cost */
  double *moment;                    /* MOMENTS of each result, once reported */
  struct gamut_moments moments;
  struct study_report *report; /* what else was reported */

  struct nominal *nominal; /* one a level; null where runs are no sample. Others than the first
                              are made when their level is first asked for */
  struct outcome *outcome; /* in the order of asking */
  size_t runs, room;
  size_t *asked_on;                  /* runs asked for so far, one a level */
  size_t finished, failed, repeated; /* repeated: taken from the log */
  size_t warned;                     /* runs with warnings */
  char *warning;                     /* the first one's words */
  bool noted;                        /* a note of a level has been printed */
  struct outcome *logged;            /* by number; done where the log has it */
  size_t logs;
  struct store *store; /* of the folder; null: nothing is written */
  int log;             /* -1: none */
  char *log_path;
  char digest[17];
  double wall; /* of this sitting */
  int threads;
};

/* level.c: combines and checks them. */
gamut_status levels_make(struct study *);
void levels_free(struct study *);
gamut_status level_scene(const struct study *, size_t level, struct trace *, struct scene **);
/* "0.4 mm", "[0 m/s, -150 m/s]": a varied value as text, allocated. */
char *level_text(const struct study *, size_t level, size_t varied);
/* "cell: 0.4 mm, velocity: [0 m/s, -150 m/s]": what a level sets, for tables and pictures; by whole
 * paths where two end alike. Allocated. */
char *level_label(const struct study *, size_t level);

/* draw.c: a row of the estimator as values of the parameters. */
gamut_status draw_prepare(struct study *); /* after levels_make */
/* Draws again, from a stream of the run's realisation, what a constraint forbids. */
gamut_status draw_run(struct study *, const double *normal, struct outcome *);
void draw_row(const struct study *, const double *normal, double *parameter);

/* curve.c: what a run's histories give. */
gamut_status measured_plan(struct study *, const struct gamut_run *);
gamut_status measured_axes(struct study *, const struct gamut_run *);
void measured_place(struct study *); /* columns, once all counts are known */
/* GAMUT_INTERNAL when out of memory. */
gamut_status measured_take(const struct study *, const struct gamut_run *, struct outcome *);
/* Points of the common axis that every run that did not fail has; `kept` gets their numbers. */
size_t curve_overlap(const struct study *, const struct measured *, size_t *kept);

/* nominal.c: plans what is measured, opens plugins and folder, makes the run at the means. */
gamut_status nominal_prepare(struct study *, const char *folder);
/* Makes the run at the means of a level that has none yet. */
gamut_status nominal_of_level(struct study *, size_t level);
/* Those that are done, in the order of levels; null past the last. */
const struct outcome *nominal_done(const struct study *, size_t index);
size_t nominals_done(const struct study *);

/* steps.c: the steps that runs take in place of those that the run at the means took up to `end`:
 * shorter by the share `margin`. False without memory. */
bool steps_make(struct run_steps taken, double end, double margin, struct common_steps *);
struct run_steps steps_of(const struct study *, size_t level);
/* Where runs stand for themselves: what is measured, by the first level that can be planned. */
gamut_status plan_first_level(struct study *);

/* study.c: levels; without any the scene itself is one. */
size_t level_count(const struct study *); /* at least one */
/* More than uncertainty.failures allows; of a table, more than it allows of all its levels. */
bool too_many_fail(const struct study *);
/* Whether the estimator can leave out a run that failed. */
bool may_fail(const struct study *);

/* worker.c */
void worker_clear(struct worker *);
/* Gives it the scene of a level. */
gamut_status worker_take(const struct study *, struct worker *, size_t level, struct trace *);
/* A mistake of the numbers or of a draw is a run's alone; what is wrong with the program, with a
 * plugin or with the machine ends the study. */
bool ends_run_only(gamut_status);
/* Makes one run. GAMUT_OK also where it failed (outcome->reason); GAMUT_STOPPED where it was told
 * to stop; else what ends the study. */
gamut_status work_run(struct study *, struct worker *, struct outcome *);

/* log.c: what has been run, line by line. log_read.c reads it. */
#define LOG_VERSION "3 "
enum { LOG_SUM_LENGTH = 10 }; /* " ~" and eight digits, behind each line */
uint32_t log_sum(const char *line, size_t size);
gamut_status log_read(struct study *, const char *path, FILE *);
void log_digest(struct study *); /* after plugins have been opened */
/* Reads and goes on with a log that is there, where the options say so; `there`: there is
 * one. */
gamut_status log_resume(struct study *, const char *folder, bool *there);
gamut_status log_begin(struct study *, const char *folder);
bool log_has_axes(const struct study *);
gamut_status log_axes(struct study *);
gamut_status log_nominal(struct study *, size_t level); /* with its common steps */
gamut_status log_run(struct study *, size_t number, const struct outcome *);
/* Whether the log is still in the folder: what is written to a removed file is lost. */
gamut_status log_there(struct study *);
void log_close(struct study *);

/* estimator.c */
gamut_status estimator_new(struct study *);
void estimator_free(struct study *);
/* The next batch; refuses one that cannot be. */
gamut_status estimator_ask(struct study *);

/* report.c */
gamut_status report_new(struct study *);  /* after the moments are there */
gamut_status report_take(struct study *); /* asks the estimator, at the end of the study */
void report_free(struct study *);
/* report_write.c: {NAME: {"unit":, "value" or "values":}} of a quantity, and {NAME: {"columns":
 * {..}}}; null: nothing was reported. */
json_t *report_estimates_json(const struct study *, size_t quantity);
json_t *report_tables_json(const struct study *);
gamut_status report_write(struct study *, struct store *);

/* results.c */
gamut_status results_write(struct study *, struct store *, gamut_status);

enum { MOMENTS = 9 };

bool outcome_room(struct study *, struct outcome *); /* makes its arrays */
void outcome_clear(struct outcome *);

#endif
