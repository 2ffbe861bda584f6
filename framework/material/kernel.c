#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expression/expression.h"
#include "material/image.h"

static const size_t operations_of_kind[GAMUT_KINDS] = {
    [GAMUT_KIND_EOS] = 2, [GAMUT_KIND_STRENGTH] = 3, [GAMUT_KIND_ELASTICITY] = 2,
    [GAMUT_KIND_EFFECT] = 4};

kernel_function kernel_operation(const struct kernel *kernel, size_t number)
{
  const char *ops = kernel->plugin->ops;
  size_t size;
  memcpy(&size, ops, sizeof size);
  size_t at = sizeof size + number * sizeof(kernel_function);
  kernel_function operation = NULL;
  if (at + sizeof operation <= size)
    memcpy(&operation, ops + at, sizeof operation);
  return operation;
}

kernel_function kernel_named(const struct kernel *kernel, const char *name)
{
  const struct descriptor *d = kernel->descriptor;
  size_t number = operations_of_kind[d->kind];
  for (size_t i = 0; i < d->variants; i++, number++)
    if (strcmp(d->variant[i].kernel, name) == 0)
      return kernel_operation(kernel, number);
  for (size_t i = 0; i < d->tasks; i++, number++)
    if (strcmp(d->task[i].kernel, name) == 0)
      return kernel_operation(kernel, number);
  return NULL;
}

static bool variant_holds(const struct variant *variant, const struct descriptor *d,
                          const struct values *values, bool *random)
{
  const char **name = calloc(d->parameters + 1, sizeof(*name));
  double *value = calloc(d->parameters + 1, sizeof *value);
  bool holds = false;
  char why[200];
  for (size_t i = 0; name && value && i < d->parameters; i++) {
    name[i] = d->parameter[i].name;
    value[i] = values->value[i].real;
  }
  struct expression *when = name && value
                                ? expression_new(variant->when, name, d->parameters, why, sizeof why)
                                : NULL;
  *random = false;
  for (size_t i = 0; when && i < d->parameters; i++)
    *random |= expression_uses(when, i) && values->value[i].random;
  if (when)
    holds = expression_value(when, value) != 0.0;
  expression_free(when);
  free(name);
  free(value);
  return holds;
}

/* The first variant whose condition holds takes the place of the main operation; never for parameters
 * that are random, since every run must compute the same formula. */
static void choose_variant(struct kernel *kernel)
{
  const struct descriptor *d = kernel->descriptor;
  kernel->main = kernel_operation(kernel, 0);
  for (size_t i = 0; i < d->variants; i++) {
    bool random;
    if (!variant_holds(&d->variant[i], d, kernel->instance->values, &random))
      continue;
    if (random) {
      snprintf(kernel->variant, sizeof kernel->variant, "the whole formula: %s, but it is random",
               d->variant[i].when);
      continue;
    }
    kernel_function cheaper = kernel_named(kernel, d->variant[i].kernel);
    if (!cheaper)
      continue;
    kernel->main = cheaper;
    snprintf(kernel->variant, sizeof kernel->variant, "%s: %s", d->variant[i].kernel,
             d->variant[i].when);
    return;
  }
}

/* An optional parameter that is absent reads as NaN, so that every comparison with it fails. */
static double slot_value(const struct kernel *kernel, const struct slot *slot,
                         const struct values *extra, double density, bool *uniform)
{
  const struct descriptor *d = kernel->descriptor;
  *uniform = true;
  if (slot->kind == SLOT_PARAMETER) {
    const struct value *value = &kernel->instance->values->value[slot->index];
    return value->present ? value->real : NAN;
  }
  if (slot->kind == SLOT_MATERIAL_PARAMETER) {
    const struct value *value =
        extra ? values_find(extra, d->material_parameter[slot->index].name) : NULL;
    return value && value->present ? value->real : NAN;
  }
  if (slot->kind == SLOT_INPUT && strcmp(d->input[slot->index].name, "reference_density") == 0)
    return density;
  *uniform = false;
  return 0.0;
}

static gamut_status fill_uniform(struct kernel *kernel, size_t size, const struct values *extra,
                                 double density)
{
  kernel->uniform = calloc(kernel->slots + 1, sizeof(*kernel->uniform));
  if (!kernel->uniform)
    return GAMUT_INTERNAL;
  for (size_t s = 0; s < kernel->slots; s++) {
    bool uniform;
    double value = slot_value(kernel, &kernel->slot[s], extra, density, &uniform);
    if (!uniform)
      continue;
    double *array = arena_take(kernel->arena, "parameters", size * sizeof *array);
    if (!array)
      return GAMUT_INTERNAL;
    for (size_t i = 0; i < size; i++)
      array[i] = value;
    kernel->uniform[s] = array;
  }
  return GAMUT_OK;
}

gamut_status kernel_new(const struct instance *instance, struct registry *registry,
                        struct arena *arena, size_t size, const struct values *material_extra,
                        double density, struct trace *trace, struct kernel **out)
{
  gamut_status status;
  struct kernel *kernel = calloc(1, sizeof *kernel);
  if (!kernel)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  kernel->instance = instance;
  kernel->descriptor = instance->descriptor;
  kernel->arena = arena;
  TRY(registry_open(registry, instance->descriptor, trace, &kernel->plugin));
  kernel->slots = descriptor_layout(instance->descriptor, &kernel->slot);
  choose_variant(kernel);
  if (fill_uniform(kernel, size, material_extra, density) != GAMUT_OK)
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
done:
  if (status != GAMUT_OK) {
    kernel_free(kernel);
    kernel = NULL;
  }
  *out = kernel;
  return status;
}

void kernel_free(struct kernel *kernel)
{
  if (!kernel)
    return;
  for (size_t s = 0; kernel->uniform && s < kernel->slots; s++)
    arena_give(kernel->arena, kernel->uniform[s]);
  free(kernel->uniform);
  free(kernel->slot);
  free(kernel);
}

const struct descriptor *kernel_descriptor(const struct kernel *kernel)
{
  return kernel->descriptor;
}

const struct gamut_plugin *kernel_plugin(const struct kernel *kernel)
{
  return kernel->plugin;
}

const char *kernel_variant(const struct kernel *kernel)
{
  return kernel->variant;
}
