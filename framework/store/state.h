/* What the store keeps while it is open. */
#ifndef GAMUT_STORE_STATE_H
#define GAMUT_STORE_STATE_H

#include <stdio.h>

#include <hdf5.h>

#include "store/store.h"

/* Text that grows; `failed` when memory ran out. */
struct text {
  char *data;
  size_t size, room;
  bool failed;
};
void text_add(struct text *, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* The shortest of the common forms that reads back to the same number. */
void text_number(struct text *, double value);
/* A cell of a CSV file, in quotes where it must be. */
void text_cell(struct text *, const char *words);

struct store {
  char *folder, *path; /* path of results.h5 */
  hid_t file;
  bool broken; /* HDF5 failed: closing would fail too */
  size_t frames;
  double last_time;
  uint64_t last_step;
  double *buffer; /* a field of one body, row by row */
  size_t buffer_size;
  struct text xdmf; /* the frames of results.xdmf so far */
};

/* Names of the files of a result. */
#define RESULT_HDF5 "results.h5"
#define RESULT_XDMF "results.xdmf"
#define RESULT_HISTORY "history.csv"
#define RESULT_SUMMARY "summary.json"
#define RESULT_SCENE "scene.yaml"
#define RESULT_STUDY "study.csv"
#define RESULT_PICTURES "pictures"

/* Records why HDF5 failed; the file is then left as it is. */
gamut_status store_broken(struct store *, struct trace *);

/* One frame in XDMF, and the whole file by rename. */
void xdmf_frame(struct store *, double time, const struct frame_set *, size_t sets,
                const struct frame_field *, size_t fields);
gamut_status xdmf_write(struct store *, struct trace *);

/* The position is written anyway: a field of that name is left out. */
bool is_position(const struct frame_field *);
/* Columns of a field on disk. */
unsigned stored_components(const struct frame_field *);
/* Path of the list 0 .. count - 1 in the HDF5 file. */
void vertices_name(size_t count, char *name, size_t size);

#endif
