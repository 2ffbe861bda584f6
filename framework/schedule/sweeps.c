#include <stdlib.h>
#include <string.h>

#include "schedule/schedule_private.h"

/* Whether a task goes on the sweep or begins a new one. */
static bool joins(const struct sweep *sweep, const struct task *task)
{
  if (!sweep || sweep->once || task->extent == GAMUT_ONCE)
    return false;
  if (task->extent == GAMUT_OPEN_BLOCK)
    return sweep->chunks == 0 && sweep->closes == 0;
  if (task->extent == GAMUT_PER_CHUNK)
    return sweep->closes == 0;
  return true;
}

static gamut_status form_sweeps(struct schedule *schedule, struct trace *trace)
{
  struct sweep *sweep = NULL;
  schedule->sweep = calloc(schedule->tasks + 1, sizeof *schedule->sweep);
  if (!schedule->sweep)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < schedule->tasks && schedule->task[i]->live; i++) {
    struct task *task = schedule->task[i];
    if (!joins(sweep, task)) {
      sweep = &schedule->sweep[schedule->sweeps++];
      sweep->once = task->extent == GAMUT_ONCE;
      sweep->open = calloc(3 * schedule->tasks, sizeof(*sweep->open));
      if (!sweep->open)
        return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
      sweep->chunk = sweep->open + schedule->tasks;
      sweep->close = sweep->chunk + schedule->tasks;
    }
    if (task->extent == GAMUT_OPEN_BLOCK)
      sweep->open[sweep->opens++] = task;
    else if (task->extent == GAMUT_CLOSE_BLOCK)
      sweep->close[sweep->closes++] = task;
    else
      sweep->chunk[sweep->chunks++] = task;
  }
  return GAMUT_OK;
}

/* How one sweep touches a field on one set (SIZE_MAX: on any). */
struct touch {
  bool any, writes, scales, reads_stored;
  bool needed; /* by more than who reads it only where somebody writes it */
};

static void touch_by(const struct task *task, const struct field *field, struct touch *touch)
{
  for (size_t u = 0; u < task->uses; u++) {
    if (task->use[u].field != field)
      continue;
    enum gamut_access access = task->use[u].access;
    touch->any = true;
    touch->writes |= access_writes(access);
    touch->scales |= access == GAMUT_SCALE || access == GAMUT_LEAST;
    touch->needed |= !task->use[u].optional;
    touch->reads_stored |= access == GAMUT_READ_BEGIN || access == GAMUT_READ_LAST;
  }
}

static struct touch touch_of(const struct sweep *sweep, const struct field *field, size_t set)
{
  struct touch touch = {false, false, false, false, false};
  struct task *const *group[] = {sweep->open, sweep->chunk, sweep->close};
  const size_t count[] = {sweep->opens, sweep->chunks, sweep->closes};
  for (int g = 0; g < 3; g++)
    for (size_t i = 0; i < count[g]; i++)
      if (set == SIZE_MAX || task_on_set(group[g][i], set))
        touch_by(group[g][i], field, &touch);
  return touch;
}

static bool wanted(const struct schedule *schedule, const struct field *field)
{
  for (size_t w = 0; w < schedule->wants; w++)
    if (schedule->want[w].field == field)
      return true;
  return false;
}

/* A field needs arrays if it has a history, if somebody outside wants it, or if its values must
 * live from one sweep, or one step, to another. */
static void decide_storage(const struct schedule *schedule, struct field *field)
{
  size_t touching = 0;
  bool writes = false, stored = false;
  for (size_t s = 0; s < schedule->sweeps; s++) {
    struct touch touch = touch_of(&schedule->sweep[s], field, SIZE_MAX);
    touching += touch.any;
    writes |= touch.writes;
    /* one that is not zero where nobody changes it has an array that says so */
    stored |= touch.scales || touch.reads_stored || (touch.any && schedule->sweep[s].once);
  }
  field->used = touching > 0 || wanted(schedule, field);
  field->history = field->history && writes;
  /* So has one that bodies give, since tasks may write it on other bodies only. */
  stored |= field->given == GIVEN_BY_BODY;
  field->stored = field->where == GAMUT_AT_POINT && field->used &&
                  (field->history || stored || touching > 1 || wanted(schedule, field));
}

static bool writes_on(const struct sweep *sweep, const struct field *field, size_t set)
{
  struct task *const *group[] = {sweep->open, sweep->chunk, sweep->close};
  const size_t count[] = {sweep->opens, sweep->chunks, sweep->closes};
  for (int g = 0; g < 3; g++)
    for (size_t i = 0; i < count[g]; i++)
      if (task_on_set(group[g][i], set) && task_writes(group[g][i], field))
        return true;
  return false;
}

/* Whether the field's beginning on this set is gone when the sweep comes. */
static bool written_before(const struct schedule *schedule, size_t sweep, const struct field *field,
                           size_t set)
{
  for (size_t s = 0; s < sweep; s++)
    if (writes_on(&schedule->sweep[s], field, set))
      return true;
  return false;
}

/* On one set, or with SIZE_MAX on any. */
static bool written(const struct schedule *schedule, const struct field *field, size_t set)
{
  for (size_t i = 0; i < schedule->tasks; i++)
    if (schedule->task[i]->live && task_writes(schedule->task[i], field) &&
        (set == SIZE_MAX || task_on_set(schedule->task[i], set)))
      return true;
  return false;
}

static enum source source_of(const struct schedule *schedule, size_t sweep,
                             const struct field *field, size_t set)
{
  if (field->where == GAMUT_AT_RUN)
    return SOURCE_UNIFORM;
  struct touch touch = touch_of(&schedule->sweep[sweep], field, set);
  if (field->where != GAMUT_AT_POINT || !touch.any)
    return SOURCE_NONE;
  if (!touch.needed && field->given == GIVEN_BY_NOBODY && !written(schedule, field, set))
    return SOURCE_NONE; /* absent on this set, whatever others have */
  if (field->history)
    return touch.writes && !written_before(schedule, sweep, field, set) ? SOURCE_FRESH
                                                                        : SOURCE_ARRAY;
  if (field->stored)
    return SOURCE_ARRAY;
  if (touch.writes)
    return SOURCE_SCRATCH;
  return written(schedule, field, SIZE_MAX) ? SOURCE_ZERO : SOURCE_NONE;
}

gamut_status plan_sweeps(struct schedule *schedule, struct fields *fields, size_t sets,
                         struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  size_t components = fields_components(fields);
  TRY(form_sweeps(schedule, trace));
  for (size_t f = 0; f < fields_count(fields); f++)
    decide_storage(schedule, fields_at(fields, f));
  for (size_t s = 0; s < schedule->sweeps; s++) {
    struct sweep *sweep = &schedule->sweep[s];
    sweep->source = calloc(sets * components + 1, 1);
    if (!sweep->source)
      return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    for (size_t set = 0; set < sets; set++)
      for (size_t k = 0; k < components; k++)
        sweep->source[set * components + k] =
            (unsigned char)source_of(schedule, s, fields_of_component(fields, k), set);
  }
done:
  return status;
}
