/* Tasks, the graph, what is live. The scheduler keeps the tasks whose results somebody needs,
 * decides which fields are stored, orders the tasks and joins neighbours that work on points into
 * sweeps. */
#ifndef GAMUT_SCHEDULE_H
#define GAMUT_SCHEDULE_H

#include <gamut/host.h>

#include "base/error.h"
#include "field/field.h"

struct task {
  char *name, *owner;         /* owner: "solver", "material copper", "effect heat" */
  struct place place;         /* of the owner in the scene; no file: none */
  const char *plugin;         /* borrowed: whose code it is; null: the core's */
  size_t phase;
  enum gamut_extent extent;
  struct use {
    struct field *field;
    enum gamut_access access;
    bool optional; /* reads it only where somebody writes it */
    const struct field *offered; /* there for others that use this field; null: its own */
    bool dropped;
  } *use;
  size_t uses;
  struct clear {            /* what it is the first to share in a step */
    size_t component;
    double start;           /* what the component is set to before */
    bool *on_set;           /* one a set: where that is so */
    bool early;             /* set before the first task of its sweep, not right before it */
  } *clear;
  size_t clears;
  struct offer {
    const struct gamut_use *use;
    size_t count;
  } * offer; /* see schedule_offer */
  size_t offers;
  bool essential, live;
  char *why;                  /* why it is live or not, for explain */
  gamut_status (*run)(void *self, const struct gamut_chunk *);
  void *self;
  size_t only_set;            /* SIZE_MAX: every set; else the set's index (material tasks) */
  const bool *on_set; /* borrowed; or null; one a set: whether the task works on it (effects) */
};

/* Tasks that run one after the other on a block while it is in cache; or a single GAMUT_ONCE task.
 */
struct sweep {
  bool once;
  struct task **open, **chunk, **close;
  size_t opens, chunks, closes;
  unsigned char *source;      /* enum source, [set * components + component] */
};

struct schedule;
struct schedule *schedule_new(const char *const *phase, size_t phases);
void schedule_free(struct schedule *);
/* `place` of the owner, copied, or null. */
gamut_status schedule_add(struct schedule *, const char *owner, const struct place *place,
                          const struct gamut_task *, struct fields *, size_t only_set,
                          const bool *on_set, struct trace *);
/* What the task that was added last reads and writes as well where the field of the first use is
 * there when the plan is made, and where a live task reads it or somebody wants it if that use
 * writes it, a live task writes it if that use reads it. Fields at points. Nothing is declared for
 * it. Borrowed. */
void schedule_offer(struct schedule *, const struct gamut_use *, size_t count);
/* Says whose code the task that was added last is. Borrowed. */
void schedule_plugin(struct schedule *, const char *plugin);
/* Records an effect (or task) that is off, with the reason, for explain. */
void schedule_decline(struct schedule *, const char *owner, const char *why);
/* Somebody outside the tasks ("quantity speed") reads this field between steps, on one set or, with
 * SIZE_MAX, on any. `place` of who wants it, copied, or null. `zero`: who wants it takes zero where
 * nobody writes it; else that is an error. */
void schedule_want(struct schedule *, struct field *, size_t set, const char *why,
                   const struct place *place, bool zero);
/* Works the plan out. Errors: nothing provides a field that is read or wanted, unknown phase, a
 * cycle (named). Warns of what is wanted and never changes. */
gamut_status schedule_plan(struct schedule *, struct fields *, size_t sets, struct trace *);
/* Whether it sets or changes the field; whether several tasks may, each on top of the others. */
bool access_writes(enum gamut_access);
bool access_shares(enum gamut_access);

size_t schedule_tasks(const struct schedule *);
/* In order, then the dead. */
const struct task *schedule_task(const struct schedule *, size_t index);
size_t schedule_sweeps(const struct schedule *);
const struct sweep *schedule_sweep(const struct schedule *, size_t index);
size_t schedule_declined(const struct schedule *);
void schedule_declined_at(const struct schedule *, size_t index, const char **owner,
                          const char **why);

/* Runs one step: every sweep in order, sets and blocks in parallel, bits independent of the number
 * of threads. Returns the failure of the lowest block. */
struct step_context { /* what a step works on; borrowed */
  struct point_set *const *set;
  size_t sets;
  struct lane_scratch *const *scratch; /* one a thread */
  double *const *uniform;     /* one a component */
  int threads;
  size_t chunk;
};
gamut_status schedule_step(struct schedule *, const struct step_context *);

#endif
