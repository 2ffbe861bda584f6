/* Values that fields have though no task writes them. */
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "catalogue/catalogue.h"
#include "run/run_private.h"

static bool puts_out(const struct gamut_run *run, const char *name)
{
  const struct descriptor *solver = run->scene->solver.descriptor;
  for (size_t i = 0; i < solver->outputs; i++)
    if (strcmp(solver->output[i].name, name) == 0)
      return true;
  return false;
}

static bool keeps(const struct gamut_run *run, const char *name)
{
  const struct descriptor *solver = run->scene->solver.descriptor;
  for (size_t i = 0; i < solver->states; i++)
    if (strcmp(solver->state[i].name, name) == 0)
      return true;
  return false;
}

static enum given given_by(const struct gamut_run *run, const struct field *field)
{
  if (field->drawn || puts_out(run, field->name))
    return GIVEN_BY_SOLVER;
  if (keeps(run, field->name))
    return GIVEN_AT_START;
  if (strcmp(field->name, "first_position") == 0 && puts_out(run, "position"))
    return GIVEN_BY_CORE;
  return strcmp(field->name, "temperature") == 0 ? GIVEN_BY_BODY : GIVEN_BY_NOBODY;
}

/* Fields that have values though no task writes them: a body's temperature, where points were at
 * the start, what the solver says that it puts out, and parameters with a random field. */
gamut_status given_mark(struct gamut_run *run)
{
  for (size_t f = 0; f < fields_count(run->fields); f++)
    fields_at(run->fields, f)->given = given_by(run, fields_at(run->fields, f));
  struct field *deformation = fields_find(run->fields, "deformation_gradient");
  if (deformation)
    deformation->history = true;
  const struct field *first = fields_find(run->fields, "first_position");
  struct gamut_field unused;
  if (!first || first->given != GIVEN_BY_CORE)
    return GAMUT_OK;
  gamut_status status = run_host.field(run, "position", &unused);
  if (status == GAMUT_OK)
    schedule_want(run->schedule, fields_find(run->fields, "position"), SIZE_MAX,
                  "first_position begins there", NULL, true);
  return status;
}

void given_start(const struct point_set *set)
{
  const struct field *to = fields_find(set->fields, "first_position");
  const struct field *from = fields_find(set->fields, "position");
  for (unsigned k = 0; to && from && to->given == GIVEN_BY_CORE && k < 3; k++) {
    double *first = set_stored(set, to->handle, k);
    const double *now = set_stored(set, from->handle, k);
    if (first && now)
      memcpy(first, now, set->open.slots * sizeof *first);
  }
}

static void fill(const struct gamut_run *run, const struct field *field, unsigned component,
                 size_t set, double value)
{
  double *array = set_stored(run->set[set], field->handle, component);
  for (size_t i = 0; array && i < run->set[set]->capacity; i++)
    array[i] = value;
}

/* A solver without materials starts none, and their temperature is the body's all the same. A
 * deformation begins with none. */
void given_fill(struct gamut_run *run)
{
  const struct field *temperature = fields_find(run->fields, "temperature");
  const struct field *deformation = fields_find(run->fields, "deformation_gradient");
  for (size_t s = 0; s < run->scene->bodies; s++) {
    if (temperature)
      fill(run, temperature, 0, s, run->scene->body[s].temperature);
    for (unsigned k = 0; deformation && k < 9; k += 4)
      fill(run, deformation, k, s, 1.0);
  }
}

static bool is_unset(const struct gamut_run *run, const struct field_use *input)
{
  const struct field *field = input->optional ? NULL : fields_find(run->fields, input->name);
  return field && field->where == GAMUT_AT_RUN && !run->uniform[field->handle.first];
}

/* Whether the kernel reads an input: tasks that say which they read leave out the others. */
static bool kernel_reads(const struct descriptor *d, const char *kernel, const char *input)
{
  bool listed = false;
  for (size_t t = 0; t < d->tasks; t++)
    for (size_t i = 0; i < d->task[t].reads; i++) {
      if (strcmp(d->task[t].read[i], input) != 0)
        continue;
      if (strcmp(d->task[t].kernel, kernel) == 0)
        return true;
      listed = true;
    }
  return !listed;
}

/* An input of the plugin, or of one kernel of it, that is one number a run and that nobody has set;
 * or null. */
static const char *unset_input(const struct gamut_run *run, const struct descriptor *d,
                               const char *kernel)
{
  for (size_t i = 0; d && i < d->inputs; i++)
    if (is_unset(run, &d->input[i]) && (!kernel || kernel_reads(d, kernel, d->input[i].name)))
      return d->input[i].name;
  return NULL;
}

static const char *unset_use(const struct gamut_run *run, const struct task *task)
{
  for (size_t u = 0; u < task->uses; u++) {
    const struct field *field = task->use[u].field;
    if (!task->use[u].optional && field->where == GAMUT_AT_RUN &&
        !run->uniform[field->handle.first])
      return field->name;
  }
  return NULL;
}

static gamut_status refuse_unset(struct gamut_run *run, const struct instance *asked,
                                 const char *name)
{
  char path[256] = "", expected[96];
  const struct instance *solver = &run->scene->solver;
  const bool cell = strcmp(name, "cell_size") == 0 && values_find(solver->values, "cell");
  snprintf(expected, sizeof expected, "%s",
           cell ? "`cell:` of the solver, a length" : "a solver that gives it");
  return trace_fail_at(run->trace, GAMUT_SCENE, asked->node ? &asked->node->place : NULL,
                       asked->node ? tree_path(asked->node, path, sizeof path) : NULL, expected,
                       "%s needs '%s' (%s), which %s does not give here", asked->descriptor->id,
                       name, catalogue_find(name)->meaning, solver->descriptor->id);
}

gamut_status given_check(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  for (size_t e = 0; e < run->effects; e++) {
    const struct running_effect *effect = &run->effect[e];
    const struct instance *asked = &effect->effect->instance;
    for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
      const struct task *task = schedule_task(run->schedule, i);
      if (!task->live || strcmp(task->owner, effect->label) != 0)
        continue;
      const char *name = unset_use(run, task);
      if (!name && effect->bound)
        name = unset_input(run, asked->descriptor, task->name);
      if (name)
        TRY(refuse_unset(run, asked, name));
    }
  }
  for (size_t m = 0; m < run->scene->materials; m++) {
    const struct material *material = &run->scene->material[m];
    const struct instance *part[] = {&material->elasticity, &material->strength, &material->eos};
    for (size_t p = 0; run->material[m] && p < ARRAY_SIZE(part); p++) {
      const char *name = unset_input(run, part[p]->descriptor, NULL);
      if (name)
        TRY(refuse_unset(run, part[p], name));
    }
  }
done:
  return status;
}
