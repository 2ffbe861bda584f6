/* What a plugin makes of the values for its kernels, once a binding. */
#include <string.h>

#include "material/block_image.h"
#include "registry/guard.h"

/* As they stand in struct NAME_ops. */
struct prepare_operations {
  gamut_status (*prepare)(struct gamut_run *, const struct gamut_values *, void **data);
  void (*release)(void *data);
};

static struct prepare_operations operations(const struct kernel *kernel)
{
  struct prepare_operations own;
  const kernel_function prepare = kernel_named(kernel, "prepare");
  const kernel_function release = kernel_named(kernel, "release");
  memcpy(&own.prepare, &prepare, sizeof own.prepare);
  memcpy(&own.release, &release, sizeof own.release);
  return own;
}

/* Prepared once, a number cannot differ from point to point; a given set may make it follow from
 * one that does. */
static gamut_status check_uniform(const struct kernel *kernel, struct trace *trace)
{
  const struct instance *instance = kernel->instance;
  struct pointwise *points = pointwise_new(instance->values, kernel->descriptor);
  const struct parameter *found = NULL;
  for (size_t i = 0; points && i < instance->values->count; i++)
    if (instance->values->value[i].parameter->prepared && pointwise_varies(points, i))
      found = instance->values->value[i].parameter;
  pointwise_free(points);
  if (!found)
    return GAMUT_OK;
  return trace_fail_at(trace, GAMUT_SCENE, instance->node ? &instance->node->place : NULL,
                       instance->values->path, "leave 'field' out: then it is one random number",
                       "'%s' follows from what differs from point to point, but %s prepares its "
                       "data once",
                       found->name, kernel->descriptor->id);
}

gamut_status kernel_prepare(struct kernel *kernel, struct gamut_run *run, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *d = kernel->descriptor;
  if (!d->prepare)
    return GAMUT_OK;
  const struct prepare_operations own = operations(kernel);
  TRY(check_uniform(kernel, trace));
  /* a copy, since host_real refuses what kernels see only while this call lasts */
  struct values seen = *kernel->instance->values;
  seen.preparing = true;
  TRY(GUARDED(d->id, own.prepare(run, &seen, &kernel->data)));
  kernel->prepared = true;
done:
  return status;
}

void kernel_release(struct kernel *kernel)
{
  if (!kernel->prepared)
    return;
  const char *before = guard_enter_long(kernel->descriptor->id);
  operations(kernel).release(kernel->data);
  guard_leave(before);
  kernel->prepared = false;
  kernel->data = NULL;
}
