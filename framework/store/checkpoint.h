/* The file of a checkpoint: named arrays in FOLDER/checkpoint.h5, the one before it in
 * checkpoint.previous.h5.
 *
 * A checkpoint is written under another name, synced to the disk and renamed, so that the last
 * whole one is never lost. Behind HDF5's own bytes stands a checksum over all of them; a reader of
 * HDF5 does not see it. */
#ifndef GAMUT_CHECKPOINT_H
#define GAMUT_CHECKPOINT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

#define CHECKPOINT_FILE "checkpoint.h5"
#define CHECKPOINT_PREVIOUS "checkpoint.previous.h5"
#define CHECKPOINT_PARTIAL "checkpoint.partial.h5"

struct checkpoint;

enum checkpoint_kind {
  CHECKPOINT_BYTES, /* unsigned char; texts carry no zero at their end */
  CHECKPOINT_WHOLE, /* int64_t */
  CHECKPOINT_REAL   /* double */
};

/* Begins a checkpoint of about so many bytes, for which room is made on the disk. */
gamut_status checkpoint_begin(const char *folder, size_t bytes, struct trace *,
                              struct checkpoint **);
/* Adds an array at a path such as "bodies/bar/id"; groups on the way are made. */
gamut_status checkpoint_put(struct checkpoint *, const char *path, enum checkpoint_kind,
                            const void *data, size_t count, struct trace *);
/* Puts it in place; the one that was there becomes the previous one. Frees it, done or failed. */
gamut_status checkpoint_end(struct checkpoint *, struct trace *);

/* Opens the last whole checkpoint of a folder; *opened is null with GAMUT_OK where there is none. A
 * broken file is warned of and gives way to the previous one, which takes its name. GAMUT_OUTPUT
 * where no whole one is left. */
gamut_status checkpoint_open(const char *folder, struct trace *, struct checkpoint **opened);
bool checkpoint_has(const struct checkpoint *, const char *path);
/* The array at a path, allocated, with a zero byte behind it. GAMUT_OUTPUT where it is not there or
 * of another kind. */
gamut_status checkpoint_get(const struct checkpoint *, const char *path, enum checkpoint_kind,
                            void **data, size_t *count, struct trace *);
/* The same into an array of just so many. */
gamut_status checkpoint_fill(const struct checkpoint *, const char *path, enum checkpoint_kind,
                             void *data, size_t count, struct trace *);

/* Closes it; one that was not ended is thrown away. Accepts null. */
void checkpoint_close(struct checkpoint *);

#endif
