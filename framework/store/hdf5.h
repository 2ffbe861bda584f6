/* The few things that the store does with HDF5, each with the reason when it fails. */
#ifndef GAMUT_STORE_HDF5_H
#define GAMUT_STORE_HDF5_H

#include <stdbool.h>
#include <stddef.h>

#include <hdf5.h>

#include "base/error.h"

/* Records GAMUT_OUTPUT with the innermost reason of HDF5's error stack ("No space left on device").
 */
gamut_status hdf5_fault(const char *file, const char *what, struct trace *);

/* Opens a file for reading, never through a link; negative on failure. */
hid_t hdf5_open(const char *path);
/* Makes a new file; what had its name is gone. Its metadata carry HDF5's own checksums. */
gamut_status hdf5_create(const char *path, struct trace *, hid_t *file);

/* Makes room on the disk for `bytes` more before HDF5 writes them, and gives back what is left
 * after a flush. HDF5 cannot recover from a disk that fills up while it writes: closing such a file
 * crashes. */
gamut_status hdf5_reserve(hid_t file, size_t bytes, const char *path, struct trace *);
gamut_status hdf5_flush(hid_t file, const char *path, struct trace *);
/* Closes a file that was written. Both: where memory ends on the way, the file is made whole first.
 */
bool hdf5_close(hid_t file);
/* Waits until everything is on the disk. */
gamut_status hdf5_sync(hid_t file, const char *path, struct trace *);
/* Whether the path still leads to the open file. */
bool hdf5_is_at(hid_t file, const char *path);

/* These return a negative value on failure; the caller asks hdf5_fault for the reason. */
herr_t hdf5_text_attribute(hid_t at, const char *name, const char *text);
herr_t hdf5_real_attribute(hid_t at, const char *name, double value);
herr_t hdf5_reals_attribute(hid_t at, const char *name, const double *value, size_t count);
herr_t hdf5_whole_attribute(hid_t at, const char *name, long long value);
herr_t hdf5_text_dataset(hid_t at, const char *name, const char *text);
/* How datasets of a type are made: laid out at once, never filled (texts of any length must be),
 * without times, so that the same contents are the same bytes, whoever writes them and in whatever
 * order. The caller closes it. */
hid_t hdf5_plain_dataset(hid_t stored);
/* rows x columns; columns 1 gives one dimension. Returns the open dataset. */
hid_t hdf5_dataset(hid_t at, const char *name, hid_t stored, hid_t memory, size_t rows,
                   size_t columns, const void *data);

/* Name of a link of a group, in order of name; allocated. */
char *hdf5_link_name(hid_t group, size_t index);
/* An attribute of one value, opened; negative if it is absent or a list, which would be read past
 * the end of what waits for one. */
hid_t hdf5_open_single(hid_t at, const char *name);
/* Allocated; null if absent or of another type. */
char *hdf5_read_text_attribute(hid_t at, const char *name);
/* `otherwise` if absent. */
double hdf5_read_real_attribute(hid_t at, const char *name, double otherwise);
/* A dataset of reals of one or two dimensions, row by row, allocated. Null on failure. */
double *hdf5_read_reals(hid_t at, const char *name, size_t *rows, size_t *columns);

#endif
