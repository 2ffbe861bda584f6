/* What writing and reading a checkpoint of a run have in common. */
#ifndef GAMUT_RUN_RESTART_H
#define GAMUT_RUN_RESTART_H

#include "run/run_private.h"

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

/* compare.c: whether a run may go on as this one. Only solver.end and outputs may differ; the first
 * difference is named. */
gamut_status restart_same_scene(const struct tree *was, const struct tree *now, const char *folder,
                                struct trace *);
gamut_status restart_same_plugins(const struct gamut_run *, const char *was, const char *folder);

#endif
