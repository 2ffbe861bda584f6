#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expression/expression.h"
#include "material/block_image.h"

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
  const char *operation;
  for (size_t i = 0; (operation = descriptor_operation(kernel->descriptor, i)); i++)
    if (strcmp(operation, name) == 0)
      return kernel_operation(kernel, i);
  return NULL;
}

/* Parameters with a random field, and what follows from them, are fields of their own. */
static bool name_paths(struct kernel *kernel, const struct values *values,
                       const struct descriptor *descriptor, enum slot_kind kind)
{
  struct pointwise *points = pointwise_new(values, descriptor);
  bool good = true;
  for (size_t s = 0; points && s < kernel->slots; s++) {
    if (kernel->slot[s].kind != kind)
      continue;
    for (size_t i = 0; good && i < values->count; i++) {
      const char *name = values->value[i].parameter->name;
      if (!pointwise_varies(points, i) || strcmp(name, kernel->slot[s].name) != 0)
        continue;
      size_t size = strlen(values->path) + strlen(name) + 2;
      good = (kernel->path[s] = malloc(size)) != NULL;
      if (good)
        snprintf(kernel->path[s], size, "%s.%s", values->path, name);
    }
  }
  pointwise_free(points);
  return good;
}

static bool parameter_varies(const struct kernel *kernel, size_t parameter)
{
  for (size_t s = 0; s < kernel->slots; s++)
    if (kernel->slot[s].kind == SLOT_PARAMETER && kernel->slot[s].index == parameter)
      return slot_varies(kernel, s);
  return false;
}

static bool variant_holds(const struct variant *variant, const struct kernel *kernel, bool *random)
{
  const struct descriptor *d = kernel->descriptor;
  const struct values *values = kernel->instance->values;
  const char **name = calloc(d->parameters + 1, sizeof(*name));
  double *value = calloc(d->parameters + 1, sizeof *value);
  bool holds = false;
  char why[200];
  for (size_t i = 0; name && value && i < d->parameters; i++) {
    name[i] = d->parameter[i].name;
    value[i] = values->value[i].real;
  }
  struct expression *when =
      name && value ? expression_new(variant->when, name, d->parameters, why, sizeof why) : NULL;
  *random = false;
  for (size_t i = 0; when && i < d->parameters; i++)
    *random |= expression_uses(when, i) && (values->value[i].random || parameter_varies(kernel, i));
  if (when)
    holds = expression_value(when, value) != 0.0;
  expression_free(when);
  free(name);
  free(value);
  return holds;
}

/* The first variant whose condition holds takes the place of the main operation; never for
 * parameters that are random, since every run must compute the same formula. */
static void choose_variant(struct kernel *kernel)
{
  const struct descriptor *d = kernel->descriptor;
  kernel->main = kernel_operation(kernel, 0);
  for (size_t i = 0; i < d->variants; i++) {
    bool random;
    if (!variant_holds(&d->variant[i], kernel, &random))
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
    if (!uniform || slot_varies(kernel, s))
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

/* Rows for the inputs that do not read zero where they are absent. */
static gamut_status fill_absent(struct kernel *kernel, size_t size)
{
  kernel->absent = calloc(kernel->slots + 1, sizeof(*kernel->absent));
  if (!kernel->absent)
    return GAMUT_INTERNAL;
  for (size_t s = 0; s < kernel->slots; s++) {
    const double value = slot_absent(kernel, s);
    if (value == 0.0)
      continue;
    double *array = arena_take(kernel->arena, "parameters", size * sizeof *array);
    if (!array)
      return GAMUT_INTERNAL;
    for (size_t i = 0; i < size; i++)
      array[i] = value;
    kernel->absent[s] = array;
  }
  return GAMUT_OK;
}

gamut_status kernel_new(const struct instance *instance, struct registry *registry,
                        struct arena *arena, size_t size, const struct values *material_extra,
                        double density, struct gamut_run *run, struct trace *trace,
                        struct kernel **out)
{
  gamut_status status;
  struct kernel *kernel = calloc(1, sizeof *kernel);
  if (!kernel)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  kernel->instance = instance;
  kernel->descriptor = instance->descriptor;
  kernel->arena = arena;
  kernel->extra = material_extra;
  TRY(registry_open(registry, instance->descriptor, trace, &kernel->plugin));
  kernel->slots = descriptor_layout(instance->descriptor, &kernel->slot);
  kernel->path = calloc(kernel->slots + 1, sizeof(*kernel->path));
  if (!kernel->path ||
      !name_paths(kernel, instance->values, instance->descriptor, SLOT_PARAMETER) ||
      !name_paths(kernel, material_extra, NULL, SLOT_MATERIAL_PARAMETER)) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  choose_variant(kernel);
  if (fill_uniform(kernel, size, material_extra, density) != GAMUT_OK ||
      fill_absent(kernel, size) != GAMUT_OK) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  status = kernel_prepare(kernel, run, trace);
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
  kernel_release(kernel);
  for (size_t s = 0; kernel->uniform && s < kernel->slots; s++)
    arena_give(kernel->arena, kernel->uniform[s]);
  for (size_t s = 0; kernel->absent && s < kernel->slots; s++)
    arena_give(kernel->arena, kernel->absent[s]);
  for (size_t s = 0; kernel->path && s < kernel->slots; s++)
    free(kernel->path[s]);
  free(kernel->path);
  free(kernel->uniform);
  free(kernel->absent);
  free(kernel->slot);
  free(kernel);
}

double slot_absent(const struct kernel *kernel, size_t slot)
{
  const struct slot *s = &kernel->slot[slot];
  const struct field_use *input =
      s->kind == SLOT_INPUT ? &kernel->descriptor->input[s->index] : NULL;
  return input && input->optional ? input->absent : 0.0;
}

double kernel_mean(const struct kernel *kernel, size_t slot)
{
  bool uniform;
  return slot_value(kernel, &kernel->slot[slot], kernel->extra, 0.0, &uniform);
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

enum gamut_severity status_severity(int64_t status)
{
  return (enum gamut_severity)(status / 256);
}

const struct message *status_message(const struct descriptor *descriptor, int64_t status)
{
  int64_t index = status % 256;
  if (status == 0 || index < 0 || (size_t)index >= descriptor->messages)
    return NULL;
  return &descriptor->message[index];
}
