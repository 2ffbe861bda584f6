/* What writing and reading a checkpoint of a run have in common. */
#ifndef GAMUT_RUN_RESTART_H
#define GAMUT_RUN_RESTART_H

#include "run/run_private.h"
#include "store/checkpoint.h"

/* Arrays "clock" (time, last step, time of the last frame) and "counts" (steps, frames, step of the
 * last frame, bodies, checksum of the frames); "run" is the id of the result that they are in. */
enum { RESTART_REALS = 3, RESTART_WHOLES = 5, RESTART_PATH = 512 };

/* "bodies/bar/id"; returns `path`. */
const char *restart_path(char path[RESTART_PATH], const char *group, const char *name,
                         const char *what);
/* "velocity_0"; returns `text`. */
const char *restart_component(char text[RESTART_PATH], const struct field *, unsigned component);
/* The scene as run. Allocated; null without memory. */
char *restart_scene_text(const struct tree *);
/* A line "id version digest level" for each open plugin. Allocated; null without memory. */
char *restart_plugins_text(const struct gamut_run *);

/* packed.c: rows are what a checkpoint has of a set: its points, block by block, without padding,
 * so that nothing in it depends on how a machine lays them out. */
struct packed {
  size_t blocks, rows;
  size_t *first;  /* slot of each block, and past the last */
  int64_t *count; /* rows of each block */
};
gamut_status packed_of(const struct gamut_set *, struct packed *, struct trace *);
/* The same from the rows of each block; blocks are padded anew. 0 blocks: slots are rows. */
gamut_status packed_from(const int64_t *count, size_t blocks, size_t rows, struct packed *,
                         struct trace *);
void packed_free(struct packed *);
/* Slots to rows and back, values of 64 bits. Padding gets the block's last row. */
void pack(const struct packed *, const void *slots, void *rows);
void unpack(const struct packed *, const void *rows, void *slots);

/* resume.c: a checkpoint that is read back; arrays of it into memory of `count` values, or into new
 * memory that is the caller's. */
struct reading_back {
  struct gamut_run *run;
  const struct checkpoint *file;
  const char *folder;
};
gamut_status resume_fill(const struct reading_back *, const char *path, enum checkpoint_kind,
                         void *data, size_t count);
gamut_status resume_get(const struct reading_back *, const char *path, enum checkpoint_kind,
                        void **data, size_t *count);
/* resume_sets.c: blocks, ids and stored fields of a set. */
gamut_status resume_set(const struct reading_back *, struct point_set *);

/* A line "digest key" for each file of the scene. Allocated; null without memory. */
char *restart_files_text(const struct scene *);
/* input_files.c: whether the files are those that these lines are of. */
gamut_status restart_same_files(const struct scene *, const char *was, const char *folder,
                                struct trace *);
/* The same by the summary in the folder of a run that ended. */
gamut_status restart_same_summary(const struct scene *, const char *folder, struct trace *);

/* compare.c: whether a run may go on as this one. Only solver.end and outputs may differ; the first
 * difference is named. */
gamut_status restart_same_scene(const struct tree *was, const struct tree *now, const char *folder,
                                struct trace *);
gamut_status restart_same_plugins(const struct gamut_run *, const char *was, const char *folder);

#endif
