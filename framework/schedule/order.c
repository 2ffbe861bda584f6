#include <stdlib.h>
#include <string.h>

#include "schedule/schedule_private.h"

static bool reads_end(enum gamut_access access)
{
  return access == GAMUT_READ || access == GAMUT_READ_IF;
}

static bool reads_last(enum gamut_access access)
{
  return access == GAMUT_READ_LAST;
}

/* Whether `one` must run before `other`, both of one phase. A block is opened before and closed
 * after everything else; otherwise writers come before readers, and readers of what the last step
 * left come before writers. Two that write and read the same keep the order in which they were
 * registered. */
static bool must_precede(const struct task *one, const struct task *other)
{
  if (one->extent != other->extent &&
      (one->extent == GAMUT_OPEN_BLOCK || other->extent == GAMUT_CLOSE_BLOCK))
    return other->extent != GAMUT_ONCE && one->extent != GAMUT_ONCE;
  for (size_t u = 0; u < one->uses; u++) {
    const struct field *field = one->use[u].field;
    enum gamut_access access = one->use[u].access;
    if (access_writes(access) && task_uses_as(other, field, reads_end) &&
        !(task_uses_as(other, field, access_writes) && task_uses_as(one, field, access_reads)))
      return true;
    if (reads_last(access) && !field->history && task_uses_as(other, field, access_writes) &&
        !task_uses_as(one, field, access_writes) && !task_uses_as(other, field, reads_last))
      return true;
  }
  return false;
}

static bool comes_first(const struct schedule *schedule, size_t candidate, const bool *placed)
{
  const struct task *task = schedule->task[candidate];
  for (size_t i = 0; i < schedule->tasks; i++) {
    const struct task *other = schedule->task[i];
    if (i == candidate || placed[i] || !other->live)
      continue;
    if (other->phase < task->phase)
      return false;
    if (other->phase == task->phase && must_precede(other, task))
      return false;
  }
  return true;
}

static gamut_status report_cycle(const struct schedule *schedule, const bool *placed,
                                 struct trace *trace)
{
  char text[512] = "";
  for (size_t i = 0; i < schedule->tasks; i++)
    if (schedule->task[i]->live && !placed[i] && strlen(text) < 400) {
      strcat(text, *text ? ", " : "");
      strncat(text, schedule->task[i]->name, 60);
    }
  return trace_fail(trace, GAMUT_PLUGIN,
                    "these tasks wait for each other, each reads what another writes: %s", text);
}

gamut_status plan_order(struct schedule *schedule, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  size_t tasks = schedule->tasks, done = 0, live = 0;
  struct task **order = calloc(tasks + 1, sizeof(*order));
  bool *placed = calloc(tasks + 1, sizeof *placed);
  if (!order || !placed) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  for (size_t i = 0; i < tasks; i++)
    live += schedule->task[i]->live;
  while (done < live) {
    size_t next = 0;
    while (next < tasks && (placed[next] || !schedule->task[next]->live ||
                            !comes_first(schedule, next, placed)))
      next++;
    if (next == tasks) {
      status = report_cycle(schedule, placed, trace);
      goto done;
    }
    placed[next] = true;
    order[done++] = schedule->task[next];
  }
  for (size_t i = 0; i < tasks; i++)
    if (!schedule->task[i]->live)
      order[done++] = schedule->task[i];
  memcpy(schedule->task, order, tasks * sizeof(*order));
done:
  free(order);
  free(placed);
  return status;
}

/* The state that both set from its beginning, so that one of them would be lost; null if none. */
static const struct field *lost_between(const struct task *one, const struct task *other)
{
  for (size_t u = 0; u < one->uses; u++) {
    const struct field *field = one->use[u].field;
    if (!field->history || one->use[u].access != GAMUT_WRITE || task_uses_as(one, field, reads_end))
      continue;
    for (size_t k = 0; k < other->uses; k++)
      if (other->use[k].field == field && other->use[k].access == GAMUT_WRITE &&
          !task_uses_as(other, field, reads_end))
        return field;
  }
  return NULL;
}

gamut_status plan_conflicts(const struct schedule *schedule, size_t sets, struct trace *trace)
{
  for (size_t i = 0; i < schedule->tasks; i++)
    for (size_t k = i + 1; k < schedule->tasks; k++) {
      const struct task *one = schedule->task[i], *other = schedule->task[k];
      if (!one->live || !other->live || one->phase != other->phase ||
          strcmp(one->owner, other->owner) == 0 || !tasks_meet(one, other, sets))
        continue;
      const struct field *field = lost_between(one, other);
      if (field)
        return trace_fail_at(trace, GAMUT_SCENE, NULL, NULL,
                             "one of them, or `bodies:` that they do not share",
                             "%s and %s both set %s of the same points", one->owner, other->owner,
                             field->name);
    }
  return GAMUT_OK;
}
