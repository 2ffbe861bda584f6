#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "schedule/plan.h"

static void enliven(struct task *task, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void enliven(struct task *task, const char *format, ...)
{
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  task->live = true;
  free(task->why);
  task->why = strdup(text);
}

static void start_from_roots(struct schedule *schedule)
{
  for (size_t i = 0; i < schedule->tasks; i++)
    if (schedule->task[i]->essential)
      enliven(schedule->task[i], "the solver needs it");
  for (size_t w = 0; w < schedule->wants; w++)
    for (size_t i = 0; i < schedule->tasks; i++)
      if (!schedule->task[i]->live && task_writes(schedule->task[i], schedule->want[w].field))
        enliven(schedule->task[i], "%s wants %s", schedule->want[w].why,
                schedule->want[w].field->name);
}

/* Marks the writers of what `reader` reads; true if some were not live before. */
static bool follow(struct schedule *schedule, const struct task *reader)
{
  bool more = false;
  for (size_t u = 0; u < reader->uses; u++) {
    if (!access_reads(reader->use[u].access))
      continue;
    for (size_t i = 0; i < schedule->tasks; i++) {
      struct task *writer = schedule->task[i];
      if (writer->live || !task_writes(writer, reader->use[u].field))
        continue;
      enliven(writer, "%s reads %s", reader->name, reader->use[u].field->name);
      more = true;
    }
  }
  return more;
}

static const char *dead_reason(const struct task *task, char *text, size_t size)
{
  for (size_t u = 0; u < task->uses; u++)
    if (access_writes(task->use[u].access)) {
      snprintf(text, size, "nobody reads %s", task->use[u].field->name);
      return text;
    }
  return "it writes nothing";
}

/* What a read means now that the live writers are known. */
static gamut_status resolve(const struct schedule *schedule, struct task *task, struct use *use,
                            struct trace *trace)
{
  if (use->access != GAMUT_READ && use->access != GAMUT_READ_IF)
    return GAMUT_OK;
  size_t writers = 0, later = 0;
  for (size_t i = 0; i < schedule->tasks; i++) {
    const struct task *writer = schedule->task[i];
    if (!writer->live || !task_writes(writer, use->field))
      continue;
    writers++;
    later += writer->phase > task->phase;
  }
  if (writers && writers == later)
    use->access = GAMUT_READ_LAST;
  if (!writers && use->access == GAMUT_READ && use->field->where == GAMUT_AT_POINT)
    return trace_fail(trace, GAMUT_SCENE,
                      "task '%s' of %s reads '%s' (%s), which nothing in this scene provides",
                      task->name, task->owner, use->field->name, use->field->meaning);
  return GAMUT_OK;
}

gamut_status plan_liveness(struct schedule *schedule, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  start_from_roots(schedule);
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < schedule->tasks; i++)
      if (schedule->task[i]->live)
        more |= follow(schedule, schedule->task[i]);
  }
  for (size_t i = 0; i < schedule->tasks; i++) {
    struct task *task = schedule->task[i];
    char text[256];
    if (!task->live)
      task->why = strdup(dead_reason(task, text, sizeof text));
    for (size_t u = 0; task->live && u < task->uses; u++)
      TRY(resolve(schedule, task, &task->use[u], trace));
  }
done:
  return status;
}
