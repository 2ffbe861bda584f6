/* Results on disk: HDF5 with an XDMF sidecar, history.csv, summary.json, the scene as run. */
#ifndef GAMUT_STORE_H
#define GAMUT_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "quantity/quantity.h"
#include "tree/tree.h"

struct store;

/* Makes DIR (and its parents) and takes it: another process is refused with GAMUT_OUTPUT until the
 * store is closed or this process ends. Nothing is in it yet. */
gamut_status store_hold(const char *folder, struct trace *, struct store **);
/* Begins a result in a folder that is held. An existing one is refused with GAMUT_OUTPUT unless
 * `force`, which removes only files of a former result: results.h5, results.xdmf, history.csv,
 * summary.json, scene.yaml, study.csv, study.log, checkpoints and what `gamut plot` made in
 * pictures/, and only where one of results.h5, study.log and checkpoints is ours. results.h5 is
 * born whole: it is written aside and renamed. */
gamut_status store_begin(struct store *, bool force, struct trace *);
/* Both. Nothing is made when the scene was wrong: call this late. */
gamut_status store_open(const char *folder, bool force, struct trace *, struct store **);
/* Closes results.h5, so that whatever ends the program leaves it whole; the folder stays held. */
void store_rest(struct store *);
/* Makes the results of a study anew whose study.log, which stays, says what has been run. */
gamut_status store_renew(struct store *, struct trace *);
void store_close(struct store *); /* accepts null */

/* How far the frames of a result have come; texts are borrowed from the store. */
struct store_place {
  size_t frames;
  double last_time;
  uint64_t last_step;
  uint64_t checksum; /* sum of those of the frames */
  const char *run;   /* which run's they are: its id */
  const char *xdmf;
};
struct store_place store_place_of(const struct store *);
/* Waits until the frames are on the disk, before a checkpoint counts on them. */
gamut_status store_sync(struct store *, struct trace *);
/* Goes on with the result in a folder that is held from a place where it has been: frames up to
 * there are checked and copied aside. GAMUT_OUTPUT where results.h5 is not there, is another run's,
 * or, which sets *damaged, is broken or lacks frames. Nothing has changed in the folder until
 * store_join puts the copy in place. */
gamut_status store_reopen(struct store *, const struct store_place *, struct trace *,
                          bool *damaged);
gamut_status store_join(struct store *, struct trace *);
/* Whether the folder holds some file of a result; whether it holds no more than what stands there
 * before the first run or frame, so that nothing is lost with it. */
bool store_there(const char *folder);
bool store_is_bare(const char *folder);

/* One set of points in a frame: `count` real points. */
struct frame_set {
  const char *body;
  size_t count;
  const int64_t *id;
  const double *position[3]; /* missing axes null: written as 0 */
  int axes;                  /* 1, 2, 3: which of position are real */
};
struct frame_field {
  const char *name, *unit, *meaning;
  unsigned components;       /* 1, 3, 6 or 9: scalar, vector, symmetric tensor, tensor */
  const double *const *data; /* [set * components + component], count of that set each */
};
/* N rows of components. A symmetric tensor is stored whole, nine columns row by row, since the two
 * XDMF readers of ParaView disagree about six; the attribute `components` of a dataset names its
 * columns. A field called position is left out: the position is always there, N x 3. A frame at the
 * time and step of the last one is not written again.
 *
 * Writes group /frames/NNNNNNNN with /BODY/position, /BODY/id and one dataset a field, attributes
 * with units, and a checksum of all that; flushes; then rewrites results.xdmf by rename, so that a
 * viewer may look during a run. */
gamut_status store_frame(struct store *, double time, uint64_t step, const struct frame_set *,
                         size_t sets, const struct frame_field *, size_t fields, struct trace *);
/* Writes every history to history.csv (own time column each, long form: quantity,unit,time,value)
 * and to /quantities/NAME/{time,value} in the HDF5 file. An axis that is not time has its own name
 * in both. */
gamut_status store_histories(struct store *, struct history *const *, size_t count, struct trace *);
/* scene.yaml and summary.json; the same texts as datasets /scene and /summary (an attribute holds
 * no more than 64 kB). */
gamut_status store_scene(struct store *, const struct tree *, struct trace *);
gamut_status store_summary(struct store *, const char *json, struct trace *);
/* The last look: closes results.h5, opens it again and checks that it is the one that was written,
 * with all its frames. GAMUT_OUTPUT where somebody removed or replaced it meanwhile. */
gamut_status store_finish(struct store *, struct trace *);

/* What a study leaves. The log of finished runs is the study's own file in the folder. */
#define RESULT_LOG "study.log"
#define RESULT_LOG_MARK "gamut-study "
/* What an estimator reports: numbers of quantities, and table_NAME.csv. */
#define RESULT_ESTIMATES "estimates.csv"
#define RESULT_TABLE "table_"
struct table_column {
  const char *group;                 /* below the table's in results.h5; null: there itself */
  const char *name, *unit, *meaning; /* unit null: none */
  const double *value;               /* one a row; NaN: nothing there; or */
  const char *const *text;           /* one a row */
};
/* FILE (CSV) in the folder, and one dataset a column in GROUP of results.h5, without the first
 * `above` rows: those are for people and part of no sample. */
gamut_status store_table(struct store *, const char *file, const char *group,
                         const struct table_column *, size_t columns, size_t rows, size_t above,
                         struct trace *);
/* Moments of a curve over the runs. */
struct table_curve {
  const char *name, *unit, *axis, *axis_unit, *meaning;
  size_t count;
  const double *at, *mean, *variance, *mean_error, *variance_error; /* count each */
  const double *mean_interval[2], *variance_interval[2];            /* lower and upper ends */
  const double *nominal;                                            /* the run at the means */
  const double *run; /* runs x count: the curves themselves */
  size_t runs;       /* 0: they are not kept */
};
/* history.csv, and GROUP/NAME/{AXIS, mean, variance, mean_error, variance_error, mean_lower,
 * mean_upper, variance_lower, variance_upper, nominal, runs}. */
gamut_status store_curves(struct store *, const char *group, const struct table_curve *,
                          size_t curves, struct trace *);
/* The curve of one run among several that are no sample. */
struct table_member {
  const char *name, *unit, *axis, *axis_unit, *meaning;
  const char *label; /* what sets it apart */
  size_t run, count;
  const double *at, *value;
};
/* history.csv, and GROUP/NAME/RUN/{AXIS, value}; those of one name follow one another. */
gamut_status store_members(struct store *, const char *group, const struct table_member *,
                           size_t members, struct trace *);
const char *store_folder(const struct store *);

#endif
