/* Who reads what a field was at the beginning of a step must come before it is overwritten. */
#include "schedule/schedule_private.h"

/* Number of the sweep that a task is part of. */
static size_t sweep_of(const struct schedule *schedule, const struct task *task)
{
  for (size_t s = 0; s < schedule->sweeps; s++) {
    const struct sweep *sweep = &schedule->sweep[s];
    struct task *const *group[] = {sweep->open, sweep->chunk, sweep->close};
    const size_t count[] = {sweep->opens, sweep->chunks, sweep->closes};
    for (int g = 0; g < 3; g++)
      for (size_t i = 0; i < count[g]; i++)
        if (group[g][i] == task)
          return s;
  }
  return schedule->sweeps;
}

/* The task before number `reader` that leaves nothing of the field's beginning; or null. A field
 * with history keeps it to the end of the sweep. Without one a task that writes the field as well
 * goes on with what it finds. */
static const struct task *overwritten_by(const struct schedule *schedule, size_t reader,
                                         const struct field *field, size_t sets)
{
  const struct task *task = schedule->task[reader];
  if (!field->history && task_writes(task, field))
    return NULL;
  for (size_t i = 0; i < reader; i++) {
    const struct task *writer = schedule->task[i];
    if (task_writes(writer, field) && tasks_meet(writer, task, sets) &&
        (!field->history || sweep_of(schedule, writer) < sweep_of(schedule, task)))
      return writer;
  }
  return NULL;
}

gamut_status plan_begins(const struct schedule *schedule, size_t sets, struct trace *trace)
{
  for (size_t i = 0; i < schedule->tasks && schedule->task[i]->live; i++) {
    const struct task *task = schedule->task[i];
    for (size_t u = 0; u < task->uses; u++) {
      const enum gamut_access access = task->use[u].access;
      const struct field *field = task->use[u].field;
      if (access != GAMUT_READ_BEGIN && access != GAMUT_READ_LAST)
        continue;
      const struct task *writer = overwritten_by(schedule, i, field, sets);
      if (writer)
        return trace_fail_at(trace, GAMUT_SCENE, task->place.file ? &task->place : NULL, NULL,
                             "an earlier phase, or the value at the end of the step",
                             "task '%s' of %s reads '%s' as it was at the beginning of the step, "
                             "when task '%s' of %s has overwritten it",
                             task->name, task->owner, field->name, writer->name, writer->owner);
    }
  }
  return GAMUT_OK;
}
