/* The memory image of a block struct, and how its pointers are led to the arrays of a chunk. */
#ifndef GAMUT_BLOCK_IMAGE_H
#define GAMUT_BLOCK_IMAGE_H

#include <gamut/plugin.h>

#include "descriptor/descriptor.h"
#include "field/field.h"
#include "material/material.h"

/* Every generated block struct has this shape. */
struct image {
  size_t count;
  int64_t *status;
  void *pointer[];
};

/* A pointer of the image that follows the chunk. */
struct link {
  size_t slot;
  size_t component; /* of the run's fields */
  bool begin;       /* leads to the value at the beginning of the step */
  bool written;     /* the kernel writes there: a null chunk pointer means a sink, not zeros */
  double *absent;   /* what a null chunk pointer means; null: zeros */
};

struct kernel {
  const struct instance *instance;
  const struct descriptor *descriptor;
  const struct gamut_plugin *plugin;
  struct slot *slot;
  size_t slots;
  struct arena *arena;
  const struct values *extra; /* material parameters of plugins, or null */
  double **uniform; /* one a slot: array of equal values, or null */
  double **absent;  /* one a slot: what an optional input reads where it is absent; null: zeros */
  char **path;      /* one a slot: scene path of a parameter with a random field, or null */
  kernel_function main;
  void *data; /* what `prepare` made */
  bool prepared;
  char variant[160];
};

struct image *image_new(const struct kernel *, struct arena *, size_t rows, const char *label);
/* What a slot leads to wherever the block is: uniform parameters, the data; else null. */
void *slot_constant(const struct kernel *, size_t slot);
/* kernel_prepare.c: the plugin's own data, made of the values of its instance; nothing where its
 * descriptor has no `prepare`. */
gamut_status kernel_prepare(struct kernel *, struct gamut_run *, struct trace *);
void kernel_release(struct kernel *);
/* Whether it leads to an array of the points, and not to a law or data. */
bool slot_is_array(const struct kernel *, size_t slot);
/* Whether a parameter differs from point to point: it then follows the chunk as a field does. */
bool slot_varies(const struct kernel *, size_t slot);
/* What an optional input reads where it is absent; 0 of all else. */
double slot_absent(const struct kernel *, size_t slot);
/* Its mean. */
double kernel_mean(const struct kernel *, size_t slot);
/* Points the linked slots at the chunk. zero and sink are arrays of the chunk's length. */
void image_follow(struct image *, const struct link *, size_t links, const struct gamut_chunk *,
                  double *zero, double *sink);

/* Links of the slots of one kind (input, output, state) to fields, which are declared on the way.
 */
struct links {
  struct link *link;
  size_t count;
};
gamut_status links_new(const struct kernel *, struct fields *, struct trace *, struct links *);
void links_free(struct links *);
/* After planning: a plain input means the end of the step unless the plan says that the task reads
 * its beginning, or that it is not written yet by then. */
void links_resolve(const struct kernel *, struct links *, const struct task *);
/* Declares the field of a slot that follows the chunk; null and a message on failure. */
struct field *slot_field(const struct kernel *, size_t slot, struct fields *, struct trace *);

/* As kernel_try, of the kernels of all tasks of an effect's descriptor: each may write what it
 * says, and only that. */
gamut_status effect_try(const struct kernel *, struct trace *);

/* Counts of flagged points, one a thread and plugin. */
enum { TALLY_MESSAGES = FLAG_COUNTS };
struct tally {
  uint64_t count[TALLY_MESSAGES];
  const struct spare *spare; /* or null */
  bool stopped;
  size_t set;
  int64_t id;
  size_t message;
};
/* Where the marks of flagged points go that leave the run; null where it stops for them. */
double *tally_spared(const struct tally *, const struct gamut_chunk *);
void tally_block(struct tally *, const int64_t *status, const struct gamut_chunk *);
/* Sums the counts of message m over the threads' tallies; whether any is above zero. */
bool tally_report(const struct tally *, size_t tallies, size_t stride,
                  const struct descriptor *, size_t *index, struct flag_report *);
bool tally_stopped(struct tally *, size_t tallies, size_t stride, const struct descriptor *,
                   struct flag_stop *);
/* The counts over all threads, and counts that another run came to (kept by the first thread). */
void tally_counts(const struct tally *, size_t tallies, size_t stride, int64_t *count);
void tally_go_on(struct tally *, size_t tallies, size_t stride, const int64_t *count);

#endif
