/* What the store keeps while it is open. */
#ifndef GAMUT_STORE_PRIVATE_H
#define GAMUT_STORE_PRIVATE_H

#include <stdio.h>

#include <hdf5.h>

#include "store/result.h"
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
  int lock;            /* of the folder; -1: none */
  hid_t file;
  char run[33];        /* id of the run: a random number */
  bool partial; /* it still has its other name */
  bool broken;  /* HDF5 failed: closing would fail too */
  size_t frames;
  double last_time;
  uint64_t last_step;
  uint64_t checksum; /* sum of those of the frames */
  double *buffer; /* a field of one body, row by row */
  size_t buffer_size;
  struct text xdmf; /* the frames of results.xdmf so far */
};

/* An open result. */
struct result {
  char *path;
  hid_t file;
  size_t frames;
};

/* Names of the files of a result. */
#define RESULT_HDF5 "results.h5"
#define RESULT_PARTIAL "results.partial.h5"
#define RESULT_XDMF "results.xdmf"
#define RESULT_HISTORY "history.csv"
#define RESULT_SUMMARY "summary.json"
#define RESULT_SCENE "scene.yaml"
#define RESULT_STUDY "study.csv"
#define RESULT_PICTURES "pictures"

/* Records why HDF5 failed; the file is then left as it is. */
gamut_status store_broken(struct store *, struct trace *);

/* folder.c: what lies in a folder. Makes way for a new result; removes what a killed run left half
 * written; removes a file. */
gamut_status folder_make_way(const char *folder, bool force, struct trace *);
gamut_status folder_tidy(const char *folder, struct trace *);
gamut_status folder_remove_file(const char *folder, const char *name, struct trace *);

/* A new results.h5 under another name, with its marks; and under its own. */
gamut_status results_make(struct store *, struct trace *);
gamut_status results_place(struct store *, struct trace *);
/* GAMUT_OUTPUT where the open results.h5 is no longer in the folder. */
gamut_status results_there(struct store *, struct trace *);
#define FRAMES_GROUP "frames"
#define CURVES_NAME "quantities" /* in checksums, of histories and of a study's curves */
void frame_name(size_t frame, char *name, size_t size); /* within that group */
herr_t vertices_write(struct store *, size_t count);     /* unless they are there */
bool buffer_reserve(struct store *, size_t size);

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
