#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "schedule/schedule_private.h"

struct schedule *schedule_new(const char *const *phase, size_t phases)
{
  struct schedule *schedule = calloc(1, sizeof *schedule);
  if (schedule) {
    schedule->phase = phase;
    schedule->phases = phases;
  }
  return schedule;
}

static void task_free(struct task *task)
{
  if (!task)
    return;
  free(task->name);
  free(task->owner);
  for (size_t i = 0; i < task->clears; i++)
    free(task->clear[i].on_set);
  free(task->clear);
  free(task->offer);
  free(task->use);
  free(task->why);
  free(task);
}

void schedule_free(struct schedule *schedule)
{
  if (!schedule)
    return;
  for (size_t i = 0; i < schedule->tasks; i++)
    task_free(schedule->task[i]);
  for (size_t i = 0; i < schedule->declines; i++) {
    free(schedule->declined[i].owner);
    free(schedule->declined[i].why);
  }
  for (size_t i = 0; i < schedule->wants; i++)
    free(schedule->want[i].why);
  for (size_t i = 0; i < schedule->sweeps; i++) {
    free(schedule->sweep[i].open);
    free(schedule->sweep[i].source);
  }
  free(schedule->task);
  free(schedule->declined);
  free(schedule->want);
  free(schedule->sweep);
  free(schedule->piece);
  free(schedule);
}

bool access_reads(enum gamut_access access)
{
  return !access_writes(access);
}

bool access_writes(enum gamut_access access)
{
  return access == GAMUT_WRITE || access_shares(access);
}

bool access_shares(enum gamut_access access)
{
  return access == GAMUT_ADD || access == GAMUT_SCALE || access == GAMUT_LEAST;
}

bool task_uses_as(const struct task *task, const struct field *field,
                  bool (*test)(enum gamut_access))
{
  for (size_t i = 0; i < task->uses; i++)
    if (task->use[i].field == field && test(task->use[i].access))
      return true;
  return false;
}

bool task_writes(const struct task *task, const struct field *field)
{
  return task_uses_as(task, field, access_writes);
}

bool task_on_set(const struct task *task, size_t set)
{
  if (task->only_set != SIZE_MAX)
    return task->only_set == set;
  return !task->on_set || task->on_set[set];
}

bool tasks_meet(const struct task *one, const struct task *other, size_t sets)
{
  for (size_t s = 0; s < sets; s++)
    if (task_on_set(one, s) && task_on_set(other, s))
      return true;
  return false;
}

static gamut_status find_phase(const struct schedule *schedule, const struct gamut_task *task,
                               const char *owner, size_t *phase, struct trace *trace)
{
  for (*phase = 0; *phase < schedule->phases; ++*phase)
    if (strcmp(schedule->phase[*phase], task->phase) == 0)
      return GAMUT_OK;
  /* An effect may be right and yet not fit this solver: then the scene is wrong. */
  bool of_effect = strncmp(owner, "effect ", 7) == 0;
  return trace_fail(trace, of_effect ? GAMUT_SCENE : GAMUT_PLUGIN,
                    "task '%s' of %s belongs to the phase '%s', which this solver does not have",
                    task->name, owner, task->phase);
}

static gamut_status copy_uses(struct task *to, const struct gamut_task *from, struct fields *fields,
                              struct trace *trace)
{
  to->use = calloc(from->use_count ? from->use_count : 1, sizeof *to->use);
  if (!to->use)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < from->use_count; i++) {
    struct field *field = fields_find(fields, from->uses[i].field);
    if (!field)
      return trace_fail(trace, GAMUT_PLUGIN,
                        "task '%s' of %s names the field '%s', which nobody "
                        "declares",
                        from->name, to->owner, from->uses[i].field);
    const enum gamut_access access = from->uses[i].access;
    if (access_shares(access) && from->extent != GAMUT_PER_CHUNK)
      return trace_fail(trace, GAMUT_PLUGIN,
                        "task '%s' of %s shares the field '%s' with others: only a task "
                        "GAMUT_PER_CHUNK can add, scale or lower",
                        from->name, to->owner, field->name);
    to->use[to->uses++] =
        (struct use){.field = field, .access = access, .optional = access == GAMUT_READ_IF};
  }
  return GAMUT_OK;
}

gamut_status schedule_add(struct schedule *schedule, const char *owner, const struct place *place,
                          const struct gamut_task *task, struct fields *fields, size_t only_set,
                          const bool *on_set, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct task *added = calloc(1, sizeof *added);
  struct task **grown = realloc(schedule->task, (schedule->tasks + 1) * sizeof(*grown));
  if (grown)
    schedule->task = grown;
  if (!added || !grown) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  added->name = memory_copy(task->name);
  added->owner = memory_copy(owner);
  if (place)
    added->place = *place;
  added->extent = task->extent;
  added->essential = task->essential;
  added->run = task->run;
  added->self = task->self;
  added->only_set = only_set;
  added->on_set = on_set;
  TRY(find_phase(schedule, task, owner, &added->phase, trace));
  TRY(copy_uses(added, task, fields, trace));
  schedule->task[schedule->tasks++] = added;
  added = NULL;
done:
  task_free(added);
  return status;
}

void schedule_offer(struct schedule *schedule, const struct gamut_use *offer, size_t count)
{
  struct task *task = schedule->task[schedule->tasks - 1];
  struct offer *grown = realloc(task->offer, (task->offers + 1) * sizeof *grown);
  if (!grown)
    memory_ended();
  task->offer = grown;
  grown[task->offers++] = (struct offer){offer, count};
}

/* Offers become uses where the field is there. */
static void settle_offer(struct task *task, const struct offer *offer, const struct fields *fields)
{
  const struct field *first = fields_find(fields, offer->use[0].field);
  if (!first || first->where != GAMUT_AT_POINT)
    return;
  struct use *grown = realloc(task->use, (task->uses + offer->count) * sizeof *grown);
  if (!grown)
    memory_ended();
  task->use = grown;
  for (size_t i = 0; i < offer->count; i++) {
    const enum gamut_access access = offer->use[i].access;
    task->use[task->uses++] = (struct use){.field = fields_find(fields, offer->use[i].field),
                                           .access = access,
                                           .optional = access == GAMUT_READ_IF,
                                           .offered = first};
  }
}

static void settle_offers(struct task *task, const struct fields *fields)
{
  for (size_t i = 0; i < task->offers; i++)
    settle_offer(task, &task->offer[i], fields);
  task->offers = 0;
}

void schedule_plugin(struct schedule *schedule, const char *plugin)
{
  schedule->task[schedule->tasks - 1]->plugin = plugin;
}

void schedule_decline(struct schedule *schedule, const char *owner, const char *why)
{
  struct declined *grown = realloc(schedule->declined, (schedule->declines + 1) * sizeof *grown);
  if (!grown)
    memory_ended();
  schedule->declined = grown;
  grown[schedule->declines++] = (struct declined){memory_copy(owner), memory_copy(why)};
}

void schedule_want(struct schedule *schedule, struct field *field, size_t set, const char *why,
                   const struct place *place, bool zero)
{
  struct want *grown = realloc(schedule->want, (schedule->wants + 1) * sizeof *grown);
  if (!grown)
    memory_ended();
  schedule->want = grown;
  grown[schedule->wants++] = (struct want){field, set, memory_copy(why), zero, {0}};
  if (place)
    grown[schedule->wants - 1].place = *place;
}

gamut_status schedule_plan(struct schedule *schedule, struct fields *fields, size_t sets,
                           struct trace *trace)
{
  gamut_status status;
  for (size_t i = 0; i < schedule->tasks; i++)
    settle_offers(schedule->task[i], fields);
  TRY(plan_liveness(schedule, trace));
  TRY(plan_order(schedule, trace));
  TRY(plan_conflicts(schedule, sets, trace));
  TRY(plan_shared(schedule, sets, trace));
  TRY(plan_sweeps(schedule, fields, sets, trace));
  TRY(plan_begins(schedule, sets, trace));
done:
  return status;
}

size_t schedule_tasks(const struct schedule *schedule)
{
  return schedule->tasks;
}

const struct task *schedule_task(const struct schedule *schedule, size_t index)
{
  return schedule->task[index];
}

size_t schedule_sweeps(const struct schedule *schedule)
{
  return schedule->sweeps;
}

const struct sweep *schedule_sweep(const struct schedule *schedule, size_t index)
{
  return &schedule->sweep[index];
}

size_t schedule_declined(const struct schedule *schedule)
{
  return schedule->declines;
}

void schedule_declined_at(const struct schedule *schedule, size_t index, const char **owner,
                          const char **why)
{
  *owner = schedule->declined[index].owner;
  *why = schedule->declined[index].why;
}
