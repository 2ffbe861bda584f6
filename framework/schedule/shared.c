/* Fields that several tasks change in a step, each on top of the others: who starts them, and what
 * does not go together. */
#include <stdlib.h>

#include "base/memory.h"
#include "catalogue/catalogue.h"
#include "schedule/schedule_private.h"

static bool scales_or_lowers(enum gamut_access access)
{
  return access == GAMUT_SCALE || access == GAMUT_LEAST;
}

/* A product of what was set or added up by others in between depends on who came when. */
static gamut_status check_mixed(const struct schedule *schedule, const struct task *one,
                                const struct use *use, size_t sets, struct trace *trace)
{
  for (size_t k = 0; k < schedule->tasks; k++) {
    const struct task *other = schedule->task[k];
    for (size_t u = 0; other->live && u < other->uses; u++) {
      const enum gamut_access access = other->use[u].access;
      if (other->use[u].field == use->field && access_writes(access) && access != use->access &&
          tasks_meet(one, other, sets))
        return trace_fail_at(trace, GAMUT_SCENE, one->place.file ? &one->place : NULL, NULL,
                             "one of them, or `bodies:` that they do not share",
                             "task '%s' of %s and task '%s' of %s change '%s' of the same points "
                             "in different ways",
                             one->name, one->owner, other->name, other->owner, use->field->name);
    }
  }
  return GAMUT_OK;
}

/* Whether on some set the field is changed both before and after the task reads it. */
static bool reads_between(const struct schedule *schedule, const struct task *reader,
                          const struct field *field, size_t sets)
{
  for (size_t s = 0; s < sets; s++) {
    bool before = false, after = false;
    for (size_t k = 0; task_on_set(reader, s) && k < schedule->tasks; k++) {
      const struct task *task = schedule->task[k];
      if (!task->live || !task_on_set(task, s) || !task_uses_as(task, field, scales_or_lowers))
        continue;
      *(task->phase > reader->phase ? &after : &before) = true;
    }
    if (before && after)
      return true;
  }
  return false;
}

static gamut_status check_use(const struct schedule *schedule, const struct task *task,
                              const struct use *use, size_t sets, struct trace *trace)
{
  const struct field_info *info = catalogue_find(use->field->name);
  if (info && info->access != GAMUT_WRITE && access_writes(use->access) &&
      use->access != info->access)
    return trace_fail(trace, GAMUT_PLUGIN,
                      "task '%s' of %s changes '%s' in another way than the catalogue of "
                      "fields says",
                      task->name, task->owner, use->field->name);
  if (scales_or_lowers(use->access))
    return check_mixed(schedule, task, use, sets, trace);
  if (access_reads(use->access) && reads_between(schedule, task, use->field, sets))
    return trace_fail_at(trace, GAMUT_SCENE, task->place.file ? &task->place : NULL, NULL,
                         "effects that change it in the same phase, or in phases on one side",
                         "task '%s' of %s reads '%s' when some of its effects have changed it in "
                         "the step and others not yet",
                         task->name, task->owner, use->field->name);
  return GAMUT_OK;
}

/* Where no task before it in a step shares the field: there it starts it. */
static void add_clear(const struct schedule *schedule, size_t number, const struct use *use,
                      size_t sets)
{
  struct task *task = schedule->task[number];
  const struct gamut_field handle = use->field->handle;
  for (unsigned c = 0; c < handle.components; c++) {
    struct clear *grown = realloc(task->clear, (task->clears + 1) * sizeof *grown);
    bool *on_set = calloc(sets + 1, sizeof *on_set), any = false;
    if (!grown || !on_set)
      memory_ended();
    task->clear = grown;
    for (size_t s = 0; s < sets; s++) {
      on_set[s] = task_on_set(task, s);
      for (size_t k = 0; k < number; k++)
        on_set[s] = on_set[s] && !(schedule->task[k]->live && task_on_set(schedule->task[k], s) &&
                                   task_uses_as(schedule->task[k], use->field, access_shares));
      any = any || on_set[s];
    }
    grown[task->clears++] =
        (struct clear){handle.first + c, access_neutral(use->access), on_set,
                       /* the core itself adds marks of flagged points as soon as there are some */
                       use->access == GAMUT_ADD};
    if (!any)
      free(grown[--task->clears].on_set);
  }
}

gamut_status plan_shared(struct schedule *schedule, size_t sets, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < schedule->tasks; i++) {
    const struct task *task = schedule->task[i];
    for (size_t u = 0; task->live && u < task->uses; u++) {
      const struct use *use = &task->use[u];
      TRY(check_use(schedule, task, use, sets, trace));
      if (access_shares(use->access))
        add_clear(schedule, i, use, sets);
      /* Before anybody has changed it, and where nobody does. */
      if (scales_or_lowers(use->access))
        use->field->initial = access_neutral(use->access);
    }
  }
done:
  return status;
}
