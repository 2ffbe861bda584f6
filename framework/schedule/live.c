#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "schedule/schedule_private.h"

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
  task->why = memory_copy(text);
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

static bool written(const struct schedule *schedule, const struct field *field, size_t set)
{
  for (size_t i = 0; i < schedule->tasks; i++) {
    const struct task *writer = schedule->task[i];
    if (writer->live && task_writes(writer, field) && (set == SIZE_MAX || task_on_set(writer, set)))
      return true;
  }
  return false;
}

static const struct place *known(const struct place *place)
{
  return place->file ? place : NULL;
}

/* By others than those that offer to work on it. */
static bool is_sought(const struct schedule *schedule, const struct field *field, bool for_reading)
{
  for (size_t w = 0; w < schedule->wants; w++)
    if (for_reading && schedule->want[w].field == field)
      return true;
  for (size_t i = 0; i < schedule->tasks; i++) {
    const struct task *task = schedule->task[i];
    for (size_t u = 0; task->live && u < task->uses; u++)
      if (task->use[u].field == field && !task->use[u].offered &&
          access_reads(task->use[u].access) == for_reading)
        return true;
  }
  return false;
}

/* The first use of an offer stands before the others. */
static bool writes_offered(const struct task *task, const struct field *offered)
{
  for (size_t u = 0; u < task->uses; u++)
    if (task->use[u].offered == offered)
      return access_writes(task->use[u].access);
  return false;
}

/* Nothing is worked out that nobody reads. */
static void drop_offers(const struct schedule *schedule, struct task *task)
{
  size_t kept = 0;
  for (size_t u = 0; u < task->uses; u++) {
    const struct field *offered = task->use[u].offered;
    task->use[u].dropped = offered && !is_sought(schedule, offered, writes_offered(task, offered));
  }
  for (size_t u = 0; u < task->uses; u++)
    if (!task->use[u].dropped)
      task->use[kept++] = task->use[u];
  task->uses = kept;
}

/* What a read means now that the live writers are known. */
static gamut_status resolve(const struct schedule *schedule, struct task *task, struct use *use,
                            struct trace *trace)
{
  const struct field *field = use->field;
  if (!access_reads(use->access))
    return GAMUT_OK;
  size_t writers = 0, later = 0;
  for (size_t i = 0; i < schedule->tasks; i++) {
    const struct task *writer = schedule->task[i];
    if (!writer->live || !task_writes(writer, field))
      continue;
    writers++;
    later += writer->phase > task->phase;
  }
  if (writers && writers == later && (use->access == GAMUT_READ || use->access == GAMUT_READ_IF))
    use->access = GAMUT_READ_LAST;
  if (writers || field->where != GAMUT_AT_POINT)
    return GAMUT_OK;
  if (use->access == GAMUT_READ_IF) {
    if (field->given != GIVEN_BY_NOBODY)
      use->access = GAMUT_READ_BEGIN;
    return GAMUT_OK;
  }
  if (field->given == GIVEN_BY_NOBODY)
    return trace_fail_at(trace, GAMUT_SCENE, known(&task->place), NULL, NULL,
                         "task '%s' of %s reads '%s' (%s), which nothing in this scene provides",
                         task->name, task->owner, field->name, field->meaning);
  if (use->access == GAMUT_READ) {
    use->access = GAMUT_READ_BEGIN;
    if (field->given == GIVEN_BY_BODY)
      trace_warn_at(trace, known(&task->place), NULL, NULL,
                    "%s reads the %s, which never changes in this scene", task->owner, field->name);
  }
  return GAMUT_OK;
}

/* A state that was given at the start is there where a live task reads it. */
static bool is_read(const struct schedule *schedule, const struct field *field)
{
  for (size_t i = 0; i < schedule->tasks; i++)
    for (size_t u = 0; schedule->task[i]->live && u < schedule->task[i]->uses; u++)
      if (schedule->task[i]->use[u].field == field &&
          access_reads(schedule->task[i]->use[u].access))
        return true;
  return false;
}

/* What somebody outside wants and no task writes would be zeros. */
static gamut_status check_want(const struct schedule *schedule, const struct want *want,
                               struct trace *trace)
{
  const struct field *field = want->field;
  if (field->where != GAMUT_AT_POINT || want->zero || written(schedule, field, want->set))
    return GAMUT_OK;
  if (field->given == GIVEN_AT_START && is_read(schedule, field))
    return GAMUT_OK;
  if (field->given == GIVEN_BY_NOBODY || field->given == GIVEN_AT_START)
    return trace_fail_at(
        trace, GAMUT_SCENE, known(&want->place), NULL, "add what writes it, or leave it out",
        "%s asks for '%s' (%s), which nothing in this scene writes%s", want->why, field->name,
        field->meaning, written(schedule, field, SIZE_MAX) ? " for this body" : "");
  if (field->given == GIVEN_BY_BODY)
    trace_warn_at(trace, known(&want->place), NULL, NULL,
                  "%s asks for the %s, which never changes: nothing in this scene writes it",
                  want->why, field->name);
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
  for (size_t i = 0; i < schedule->tasks; i++)
    drop_offers(schedule, schedule->task[i]);
  for (size_t i = 0; i < schedule->tasks; i++) {
    struct task *task = schedule->task[i];
    char text[256];
    if (!task->live)
      task->why = memory_copy(dead_reason(task, text, sizeof text));
    for (size_t u = 0; task->live && u < task->uses; u++)
      TRY(resolve(schedule, task, &task->use[u], trace));
  }
  for (size_t w = 0; w < schedule->wants; w++)
    TRY(check_want(schedule, &schedule->want[w], trace));
done:
  return status;
}
