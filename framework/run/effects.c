#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"
#include "registry/guard.h"
#include "run/run_private.h"

static gamut_status make_kernels(struct gamut_run *run, struct running_effect *effect)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = run->scene;
  if (!effect->effect->instance.descriptor->tasks || !scene->materials)
    return GAMUT_OK;
  effect->kernel = calloc(scene->materials, sizeof(*effect->kernel));
  if (!effect->kernel)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t m = 0; m < scene->materials; m++)
    TRY(kernel_new(&effect->effect->instance, run->registry, run->arena, run->chunk,
                   scene->material[m].extra, scene->material[m].density, run, run->trace,
                   &effect->kernel[m]));
  TRY(effect_new((const struct kernel *const *)effect->kernel, scene->materials, run->arena,
                 run->fields, run->threads, run->trace, &effect->bound));
done:
  return status;
}

/* Whether the effect says that it has nothing to do here. */
static bool declines(struct gamut_run *run, struct running_effect *effect)
{
  char why[256] = "it declined";
  const struct instance *instance = &effect->effect->instance;
  if (effect->effect->enabled == EFFECT_ON || !effect->ops->decline)
    return false;
  const char *before = guard_enter_long(instance->descriptor->id);
  bool declined = effect->ops->decline(effect->self, instance->values, why, sizeof why);
  guard_leave(before);
  if (!declined)
    return false;
  schedule_decline(run->schedule, effect->label, why);
  return true;
}

static gamut_status run_effect_job(void *self, const struct gamut_chunk *chunk)
{
  struct effect_job *job = self;
  effect_call(job->owner->bound, job->task, set_material(chunk->set), chunk);
  return GAMUT_OK;
}

static gamut_status add_kernel_tasks(struct gamut_run *run, struct running_effect *effect)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *d = effect->effect->instance.descriptor;
  effect->job = calloc(d->tasks + 1, sizeof *effect->job);
  if (!effect->job)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t t = 0; effect->bound && t < d->tasks; t++) {
    effect->job[t] = (struct effect_job){effect, t};
    struct gamut_task task = {.name = d->task[t].kernel,
                              .phase = d->task[t].phase,
                              .extent = GAMUT_PER_CHUNK,
                              .run = run_effect_job,
                              .self = &effect->job[t]};
    task.uses = effect_uses(effect->bound, t, &task.use_count);
    task.essential = effect->effect->enabled == EFFECT_ON;
    TRY(run_add_task(run, effect->label, &task, SIZE_MAX, effect->effect->on_body));
  }
done:
  return status;
}

gamut_status declare_states(struct gamut_run *run, const struct instance *instance)
{
  const struct descriptor *d = instance->descriptor;
  for (size_t i = 0; i < d->states; i++) {
    const struct state_variable *state = &d->state[i];
    if (catalogue_find(state->name))
      continue;
    struct field *field =
        fields_add(run->fields, instance_state_field(instance, i), GAMUT_AT_POINT,
                   state->components, state->unit, state->doc ? state->doc : "", run->trace);
    if (!field)
      return GAMUT_PLUGIN;
    field->history = true;
    field->initial = state->initial;
  }
  return GAMUT_OK;
}

static gamut_status create_one(struct gamut_run *run, const struct effect *from)
{
  gamut_status status;
  const struct gamut_plugin *plugin;
  struct running_effect *effect = &run->effect[run->effects];
  effect->effect = from;
  snprintf(effect->label, sizeof effect->label, "effect %s", from->instance.name);
  if (from->enabled == EFFECT_OFF) {
    schedule_decline(run->schedule, effect->label, "enabled: off");
    return GAMUT_OK;
  }
  run->effects++;
  TRY(registry_open(run->registry, from->instance.descriptor, run->trace, &plugin));
  effect->ops = plugin->ops;
  TRY(declare_states(run, &from->instance));
  run->creating = effect;
  if (effect->ops->create)
    TRY(GUARDED(from->instance.descriptor->id,
                effect->ops->create(run, from->instance.values, &effect->self)));
  effect->created = true;
  if (declines(run, effect))
    goto done;
  TRY(make_kernels(run, effect));
  TRY(add_kernel_tasks(run, effect));
done:
  run->creating = NULL;
  return status;
}

gamut_status effects_create(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  run->effect = calloc(run->scene->effects + 1, sizeof *run->effect);
  if (!run->effect)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < run->scene->effects; i++)
    TRY(create_one(run, &run->scene->effect[i]));
done:
  return status;
}

gamut_status effects_resolve(struct gamut_run *run)
{
  for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
    const struct task *task = schedule_task(run->schedule, i);
    if (!task->live || task->run != run_effect_job)
      continue;
    struct effect_job *job = task->self;
    effect_resolve(job->owner->bound, job->task, task);
  }
  return GAMUT_OK;
}

void effects_free(struct gamut_run *run)
{
  for (size_t i = 0; i < run->effects; i++) {
    struct running_effect *effect = &run->effect[i];
    if (effect->created && effect->ops->destroy)
      effect->ops->destroy(effect->self);
    effect_free(effect->bound);
    for (size_t m = 0; effect->kernel && m < run->scene->materials; m++)
      kernel_free(effect->kernel[m]);
    free(effect->kernel);
    free(effect->job);
  }
  free(run->effect);
  free(run->plane);
}
