/* One run of one scene: makes the instances, plans, advances, records. */
#ifndef GAMUT_RUN_ROOM_H
#define GAMUT_RUN_ROOM_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "field/field.h"
#include "quantity/quantity.h"
#include "registry/registry.h"
#include "scene/scene.h"
#include "schedule/schedule.h"
#include "store/store.h"

/* Time steps, one after the other. */
struct run_steps { const double *step; size_t count; };

struct run_options {
  int threads;                   /* 0: what OpenMP says, but no more than there is work for */
  /* Called about ten times a second on a terminal and at every tenth of the run elsewhere; null:
   * silent. */
  void (*progress)(void *, double done, double time, uint64_t step, double rate);
  void *progress_self;
  /* Null, or becomes nonzero when the user wants out: the step is finished, a checkpoint (where a
   * store is open and run_can_stop) and the last frame are written, and run_march returns
   * GAMUT_STOPPED without an error in the trace; the summary then says "status": "interrupted". */
  const volatile sig_atomic_t *stop;
  /* What random numbers of the run depend on: the scene's seed (0: as scene->seed), and which run
   * of a study this is, from 0. */
  uint64_t seed, realisation;
  /* Steps that the run has to take (borrowed); none: it takes its own. It fails where it needs a
   * shorter one. Only where the end of the run is known. */
  struct run_steps given;
  bool keep_steps; /* for run_steps_taken */
};

struct gamut_run;
/* Makes everything and plans; runs nothing. */
gamut_status run_new(struct scene *, struct registry *, const struct run_options *, struct trace *,
                     struct gamut_run **);
void run_free(struct gamut_run *);
/* Where frames go; before run_march (borrowed). Without it nothing is written. It comes after
 * run_new so that a scene whose plugins fail leaves nothing on the disk. */
void run_record(struct gamut_run *, struct store *);
/* The initial state, unless it stands already; run_march does it where nobody did. What only the
 * solver can see of a scene's faults shows here, before a store is opened. */
gamut_status run_start(struct gamut_run *, struct trace *);
/* In place of a run: all that is known of one before its first step, as errors, and a warning where
 * it would take more than an hour. What takes much memory is not started. */
gamut_status run_check(struct gamut_run *, struct trace *);
/* Whether the solver can save its state: the run leaves checkpoints in the folder of its store,
 * when it is stopped and as often as outputs.checkpoint says. Runs without a store, as those of a
 * study, never do. */
bool run_can_stop(const struct gamut_run *);
/* In place of run_start: goes on from the last whole checkpoint in FOLDER, to the same bits as a
 * run that was never stopped, with any number of threads. *store is the folder's result without
 * later frames, for run_record. Where the run was killed or failed before it left anything to go on
 * from, it begins anew. Another scene is refused with GAMUT_SCENE (only solver.end and outputs may
 * differ), another interface or version of a plugin with GAMUT_PLUGIN, by name. */
gamut_status run_resume(struct gamut_run *, const char *folder, struct trace *, struct store **);
/* Whether FOLDER holds the whole run of this scene, up to its end. Another scene is refused. */
gamut_status run_finished(const struct scene *, const char *folder, struct trace *, bool *finished);
/* From start to end of the axis. On a failure the last state is written as a frame where a store is
 * open. */
gamut_status run_march(struct gamut_run *, struct trace *);

/* Warns once of each thing that plugins warned of at points, with its count, and of points that
 * left the run. */
void run_warn(const struct gamut_run *, struct trace *);

/* What came out. Owned by the run. */
struct run_cost {
  uint64_t points, steps; double work /* points of all steps */, wall, cpu;
  size_t bytes, peak; double bytes_per_point;
  size_t resident; /* most of the process so far, with all libraries */
};
const struct schedule *run_schedule(const struct gamut_run *);
const struct fields *run_fields(const struct gamut_run *);
const struct arena *run_arena(const struct gamut_run *);
struct run_cost run_cost_of(const struct gamut_run *);
struct history *const *run_histories(const struct gamut_run *, size_t *count);
double run_time(const struct gamut_run *);
/* The steps of a run that has come to its end, where it was told to keep them; none of a solver
 * whose steps are fixed or whose end is not known. */
struct run_steps run_steps_taken(const struct gamut_run *);
bool run_steps_fixed(const struct gamut_run *);
/* summary.json of architecture.md section 7, as text to be freed. */
char *run_summary(const struct gamut_run *, gamut_status, const struct registry *);
/* `gamut explain`: for people, or JSON. Needs run_new only. */
struct run_forecast { bool known; double steps, seconds; size_t bytes; };
/* `forecast`, which may be null, gets what the run would cost. */
void run_explain(struct gamut_run *, FILE *, struct run_forecast *forecast);
char *run_explain_json(struct gamut_run *, struct run_forecast *forecast);

struct ledger_line {
  char *account, *name, *unit; enum gamut_ledger_role role; double value, start;
  double turnover; /* what it began with, and all its changes from step to step */
  size_t first, alike; /* numbers of the first line of its account, and of its unit */
};
const struct ledger_line *run_ledger(const struct gamut_run *, size_t *count);
/* Residual of an account now, and its scale: the largest turnover of any line of that unit. */
double run_ledger_residual(const struct gamut_run *, const char *account, double *scale);

/* Asks a plugin of the run for a measure of its first body, by any name (for conformance). The run
 * must have started. */
gamut_status run_measure(struct gamut_run *, const struct descriptor *plugin, const char *name,
                         struct values *arguments, double *value, struct trace *);

#endif
