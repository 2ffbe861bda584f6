/* The inside of a schedule, shared by the files of this room. */
#ifndef GAMUT_SCHEDULE_PRIVATE_H
#define GAMUT_SCHEDULE_PRIVATE_H

#include "schedule/schedule.h"

struct declined {
  char *owner, *why;
};

struct want {
  struct field *field;
  size_t set; /* SIZE_MAX: any */
  char *why;
  bool zero; /* where nobody writes it the value is zero, and that is right */
  struct place place; /* no file: none */
};

struct schedule {
  const char *const *phase;
  size_t phases;
  struct task **task; /* in the order of registration, after planning in running order */
  size_t tasks;
  struct declined *declined;
  size_t declines;
  struct want *want;
  size_t wants;
  struct sweep *sweep;
  size_t sweeps;
  struct piece { size_t set, block; } *piece; /* all blocks of all sets, in order */
  size_t pieces, piece_capacity;
};

/* live.c: marks live tasks and resolves what each reads. */
gamut_status plan_liveness(struct schedule *, struct trace *);
/* order.c: sorts by phase, then by who writes what others read. */
gamut_status plan_order(struct schedule *, struct trace *);
/* Refuses two owners that set one state of the same points in one phase: the later would win. */
gamut_status plan_conflicts(const struct schedule *, size_t sets, struct trace *);
/* shared.c: who starts a field that several tasks change; refuses what does not go together. */
gamut_status plan_shared(struct schedule *, size_t sets, struct trace *);
/* begins.c; after plan_sweeps: refuses who reads the beginning of what is overwritten by then. */
gamut_status plan_begins(const struct schedule *, size_t sets, struct trace *);
/* sweeps.c: joins tasks into sweeps, decides what is stored. */
gamut_status plan_sweeps(struct schedule *, struct fields *, size_t sets, struct trace *);

bool task_writes(const struct task *, const struct field *);
bool task_on_set(const struct task *, size_t set);
/* Whether there is a set that both work on. */
bool tasks_meet(const struct task *, const struct task *, size_t sets);
/* Whether it uses the field in such a way. */
bool task_uses_as(const struct task *, const struct field *, bool (*test)(enum gamut_access));
bool access_reads(enum gamut_access);

#endif
