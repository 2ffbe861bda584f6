/* Arrays over points: which fields there are, which are stored, sets and their chunks. */
#ifndef GAMUT_FIELD_ROOM_H
#define GAMUT_FIELD_ROOM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/host.h>

#include "base/error.h"

/* Who gives a field its values where no task writes it. */
enum given {
  GIVEN_BY_NOBODY,
  GIVEN_AT_START,  /* a state of the solver: its own tasks may read it */
  GIVEN_BY_SOLVER, /* at the start, or in its own way between steps */
  GIVEN_BY_CORE,   /* at the start, from other fields */
  GIVEN_BY_BODY    /* one value a body, from the scene */
};

/* A field known in a run. Components are numbered through: component k of the field is number
 * handle.first + k, the index into a chunk's begin and end tables. */
struct field {
  const char *name, *unit, *meaning; /* borrowed from catalogue or descriptor */
  enum gamut_where where;
  struct gamut_field handle;
  double initial;
  enum given given;
  bool drawn;     /* a parameter that differs from point to point, under its scene path */
  bool used;      /* some live task or output touches it */
  bool history;   /* keeps a begin and an end value */
  bool stored;    /* has arrays; otherwise it lives in a thread's scratch during a sweep */
};

/* All fields of a run. */
struct fields;
struct fields *fields_new(void);
void fields_free(struct fields *);
/* Adds a field, or finds it; null and a message if the name stands for something else. */
struct field *fields_add(struct fields *, const char *name, enum gamut_where, unsigned components,
                         const char *unit, const char *meaning, struct trace *);
struct field *fields_find(const struct fields *, const char *name);
size_t fields_count(const struct fields *);
struct field *fields_at(const struct fields *, size_t index);
size_t fields_components(const struct fields *);
/* The field of a component number. */
struct field *fields_of_component(const struct fields *, size_t component);
/* "velocity_y" or "stress_xx" or "pressure": field and component; null if there is none. */
struct field *fields_component(const struct fields *, const char *name, unsigned *component);

/* Memory that counts. Every array of a run comes from here, so `explain` shows what is allocated.
 */
struct arena;
struct arena *arena_new(void);
void arena_free(struct arena *); /* and everything in it */
/* Whether so much more would fit into the memory of this machine. */
bool arena_has_room(const struct arena *, size_t bytes);
size_t arena_room(const struct arena *); /* how much */
/* Zeroed, 64-byte aligned; null where it does not fit. */
void *arena_take(struct arena *, const char *label, size_t bytes);
void arena_give(struct arena *, void *);
size_t arena_bytes(const struct arena *);  /* now */
size_t arena_peak(const struct arena *);
/* Sum of what is now held under labels, in order of first use; false past the end. */
bool arena_label(const struct arena *, size_t index, const char **label, size_t *bytes);

/* A set of points with its stored arrays. The public part comes first. */
struct point_set {
  struct gamut_set open;
  struct arena *arena;
  const struct fields *fields;
  size_t capacity;
  int64_t *id;
  size_t *first;
  size_t blocks_capacity;
  double **array;     /* one a component: stored array or null */
  double *spare;      /* only while points are rearranged */
  int threads;        /* that arrange may use; 0 and 1: no others */
  size_t material;
  double *derived;    /* of the measure of points that is asked for now; null, or one a slot */
  size_t derived_capacity;
};
/* A measure of points as a field of one component: what set_derive() has worked out. */
enum { SET_DERIVED = 0x7fffffff };
/* The whole set of its public part, and the number of its material. */
struct point_set *set_inside(const struct gamut_set *);
size_t set_material(const struct gamut_set *);
struct point_set *set_new(struct arena *, const char *body, size_t index, size_t material,
                          size_t points);
void set_free(struct point_set *);
/* Allocates the stored fields with their initial values; every component's array starts at another
 * offset within a page so that equal addresses do not alias in cache. */
gamut_status set_allocate(struct point_set *, const struct fields *, struct trace *);
/* gamut_host.arrange */
gamut_status set_arrange(struct point_set *, const uint32_t *source, size_t slots,
                         const size_t *first, size_t blocks, struct trace *);
/* Gives a set the slots and blocks that it had in another run: `points` real ones, ids one a slot.
 * The values of its arrays are then the caller's to set. */
gamut_status set_reshape(struct point_set *, size_t points, const int64_t *id, size_t slots,
                         const size_t *first, size_t blocks, struct trace *);
/* Room for a derived value of each slot; null where there is no memory. */
double *set_derive(struct point_set *);
/* gamut_host.drop */
void set_drop(struct point_set *, const uint32_t *slot, size_t count);
double *set_stored(const struct point_set *, struct gamut_field, unsigned component);
/* Slot that holds the point `id`, or SIZE_MAX. */
size_t set_find(const struct point_set *, int64_t id);

/* The scratch and pointer tables of one thread. */
struct lane_scratch;
struct lane_scratch *scratch_new(struct arena *, const struct fields *, size_t chunk);

/* Where a component of a chunk's tables leads in one sweep, for one set. */
enum source {
  SOURCE_NONE,    /* null: nobody touches it here */
  SOURCE_ARRAY,   /* begin and end: the stored array */
  SOURCE_FRESH,   /* history written in this sweep: begin the stored array, end scratch */
  SOURCE_SCRATCH, /* begin and end: scratch */
  SOURCE_ZERO,    /* zeros: read, but nobody writes it on this set */
  SOURCE_UNIFORM  /* one value a run */
};
/* Points a chunk's tables at slots slot .. slot + count - 1 of the set. `source` has one entry a
 * component; `uniform` one array a component (for SOURCE_UNIFORM). */
void scratch_bind(struct lane_scratch *, const struct point_set *, const unsigned char *source,
                  double *const *uniform, size_t slot, size_t count, struct gamut_chunk *chunk);
/* Copies the end values of SOURCE_FRESH components over their beginnings. */
void scratch_commit(const struct lane_scratch *, const unsigned char *source,
                    const struct gamut_chunk *);
/* Bytes of one thread's scratch. */
size_t scratch_bytes(const struct fields *, size_t chunk);

#endif
