#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "catalogue/catalogue.h"
#include "material/law.h"
#include "registry/guard.h"

enum { GUARD = 8 };

struct bench {
  const struct kernel *kernel;
  struct arena *arena;
  struct image *image;
  struct law *eos, *strength;
  size_t count, stride;
  double *memory; /* one row a slot */
  bool derivatives;
};

static double *row(const struct bench *bench, size_t slot)
{
  return bench->memory + slot * bench->stride;
}

static bool is_derivative(const struct slot *slot)
{
  return slot->kind == SLOT_DERIVATIVE || slot->kind == SLOT_SECOND_DERIVATIVE;
}

static gamut_status bind_law(struct bench *bench, size_t slot, const struct kernel *eos,
                             const struct kernel *strength)
{
  bool is_strength = strcmp(bench->kernel->slot[slot].name, "strength") == 0;
  const struct kernel *kernel = is_strength ? strength : eos;
  struct law **law = is_strength ? &bench->strength : &bench->eos;
  if (!kernel)
    return GAMUT_OK;
  if (law_new(kernel, bench->arena, bench->count + GUARD, law) != GAMUT_OK)
    return GAMUT_INTERNAL;
  bench->image->pointer[slot] = is_strength ? (void *)&(*law)->strength : (void *)&(*law)->eos;
  return GAMUT_OK;
}

/* Parameters start at the instance's values, states at their initial values. */
static void fill(struct bench *bench, size_t slot)
{
  const struct slot *s = &bench->kernel->slot[slot];
  double value = 0.0;
  if (bench->kernel->uniform[slot])
    value = bench->kernel->uniform[slot][0];
  else if (slot_varies(bench->kernel, slot))
    value = kernel_mean(bench->kernel, slot);
  else if (s->kind == SLOT_STATE_BEGIN || s->kind == SLOT_STATE_END)
    value = bench->kernel->descriptor->state[s->index].initial;
  else
    value = slot_absent(bench->kernel, slot);
  for (size_t i = 0; i < bench->stride; i++)
    row(bench, slot)[i] = value;
}

gamut_status bench_new(const struct kernel *kernel, const struct kernel *eos,
                       const struct kernel *strength, size_t count, struct trace *trace,
                       struct bench **out)
{
  bool good = true;
  struct bench *bench = calloc(1, sizeof *bench);
  if (!bench)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  bench->kernel = kernel;
  bench->arena = kernel->arena;
  bench->count = count;
  bench->stride = (count + GUARD + 7) / 8 * 8 + ARRAY_PAD;
  bench->memory =
      arena_take(bench->arena, "bench", (kernel->slots + 1) * bench->stride * sizeof(double));
  bench->image = image_new(kernel, bench->arena, count + GUARD, "bench");
  good = bench->memory && bench->image;
  for (size_t s = 0; good && s < kernel->slots; s++) {
    if (kernel->slot[s].kind == SLOT_LAW) {
      good = bind_law(bench, s, eos, strength) == GAMUT_OK;
      continue;
    }
    if (!slot_is_array(kernel, s))
      continue;
    fill(bench, s);
    bench->image->pointer[s] = is_derivative(&kernel->slot[s]) ? NULL : row(bench, s);
  }
  *out = bench;
  if (!good) {
    bench_free(bench);
    *out = NULL;
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  }
  return GAMUT_OK;
}

void bench_free(struct bench *bench)
{
  if (!bench)
    return;
  law_free(bench->eos, bench->arena);
  law_free(bench->strength, bench->arena);
  if (bench->image)
    arena_give(bench->arena, bench->image->status);
  arena_give(bench->arena, bench->image);
  arena_give(bench->arena, bench->memory);
  free(bench);
}

/* "stress_xx_begin" and "stress_begin_xx" are both understood; scratch rows are "scratch_0", ... */
static bool slot_is_called(const struct slot *slot, const char *name)
{
  char text[160];
  if (slot->components == 1)
    return strcmp(slot->name, name) == 0;
  if (slot->kind == SLOT_SCRATCH) {
    snprintf(text, sizeof text, "%s_%u", slot->name, slot->component);
    return strcmp(text, name) == 0;
  }
  const char *component = component_name(slot->components, slot->component);
  snprintf(text, sizeof text, "%s_%s", slot->name, component);
  if (strcmp(text, name) == 0)
    return true;
  size_t stem = strlen(slot->name), tail = strlen("_begin");
  if (slot->kind != SLOT_STATE_BEGIN || stem < tail)
    return false;
  snprintf(text, sizeof text, "%.*s_%s_begin", (int)(stem - tail), slot->name, component);
  return strcmp(text, name) == 0;
}

double *bench_array(struct bench *bench, const char *name)
{
  for (size_t s = 0; s < bench->kernel->slots; s++)
    if (slot_is_array(bench->kernel, s) && slot_is_called(&bench->kernel->slot[s], name))
      return row(bench, s);
  return NULL;
}

int64_t *bench_status(struct bench *bench)
{
  return bench->image->status;
}

void bench_offer_derivatives(struct bench *bench, bool offer)
{
  bench->derivatives = offer;
  for (size_t s = 0; s < bench->kernel->slots; s++)
    if (is_derivative(&bench->kernel->slot[s]))
      bench->image->pointer[s] = offer ? row(bench, s) : NULL;
}

static void move_block(struct bench *bench, ptrdiff_t points)
{
  struct image *image = bench->image;
  image->status += points;
  for (size_t s = 0; s < bench->kernel->slots; s++)
    if (slot_is_array(bench->kernel, s) && image->pointer[s])
      image->pointer[s] = (double *)image->pointer[s] + points;
}

/* A block holds at most GAMUT_CHUNK_MAX points: kernels count on it. */
static void call_in_blocks(struct bench *bench, kernel_function operation, size_t count)
{
  size_t from = 0;
  for (; count - from > GAMUT_CHUNK_MAX; from += GAMUT_CHUNK_MAX) {
    bench->image->count = GAMUT_CHUNK_MAX;
    operation(bench->image);
    move_block(bench, GAMUT_CHUNK_MAX);
  }
  bench->image->count = count - from;
  operation(bench->image);
  move_block(bench, -(ptrdiff_t)from);
  bench->image->count = count;
}

void bench_call(struct bench *bench, kernel_function operation, size_t count)
{
  assert(count <= GAMUT_CHUNK_MAX || (!bench->eos && !bench->strength));
  memset(bench->image->status, 0, (bench->count + GUARD) * sizeof *bench->image->status);
  struct law *law[] = {bench->eos, bench->strength};
  for (int i = 0; i < 2; i++)
    if (law[i])
      law_begin(law[i], count);
  /* A law's temperature begins where the kernel's own does, as in a run. */
  double *temperature = bench_array(bench, "temperature");
  if (bench->strength && temperature)
    memcpy(bench->strength->strength.temperature, temperature, count * sizeof *temperature);
  const char *before = guard_enter(bench->kernel->descriptor->id);
  call_in_blocks(bench, operation, count);
  guard_leave(before);
}

/* The output whose derivatives are declared, at one point, with argument `by` moved by `step`. */
static double moved_value(struct bench *bench, size_t point, double *const *argument, size_t by,
                          double step_by, size_t other, double step_other, const double *output)
{
  double *one = argument[by], *two = argument[other];
  double keep_one = one[point], keep_two = two[point];
  one[point] += step_by;
  two[point] += step_other;
  bench_call(bench, bench->kernel->main, bench->count);
  double value = output[point];
  two[point] = keep_two;
  one[point] = keep_one;
  return value;
}

/* Three steps, each half of the one before, and two Richardson extrapolations: the error falls with
 * the sixth power of the step, so the step may be large enough to keep round-off away. */
static double extrapolate(const double *d)
{
  double a = (4.0 * d[1] - d[0]) / 3.0, b = (4.0 * d[2] - d[1]) / 3.0;
  return (16.0 * b - a) / 15.0;
}

static double first_difference(struct bench *bench, size_t point, double *const *argument,
                               size_t by, double step, const double *output)
{
  double d[3];
  for (int k = 0; k < 3; k++, step *= 0.5)
    d[k] = (moved_value(bench, point, argument, by, step, by, 0.0, output) -
            moved_value(bench, point, argument, by, -step, by, 0.0, output)) /
           (2.0 * step);
  return extrapolate(d);
}

static double second_difference(struct bench *bench, size_t point, double *const *argument,
                                size_t by, double h, size_t other, double k, const double *output)
{
  double d[3];
  for (int i = 0; i < 3; i++, h *= 0.5, k *= 0.5) {
    if (by == other)
      d[i] = (moved_value(bench, point, argument, by, h, by, 0.0, output) -
              2.0 * moved_value(bench, point, argument, by, 0.0, by, 0.0, output) +
              moved_value(bench, point, argument, by, -h, by, 0.0, output)) /
             (h * h);
    else
      d[i] = (moved_value(bench, point, argument, by, h, other, k, output) -
              moved_value(bench, point, argument, by, h, other, -k, output) -
              moved_value(bench, point, argument, by, -h, other, k, output) +
              moved_value(bench, point, argument, by, -h, other, -k, output)) /
             (4.0 * h * k);
  }
  return extrapolate(d);
}

static double step_for(double value, double share)
{
  double step = share * (fabs(value) > 0.0 ? fabs(value) : 1.0);
  volatile double moved = value + step; /* so that the step is exact in binary */
  return moved - value;
}

static void by_differences(struct bench *bench, size_t point, double *const *argument, size_t n,
                           const double *output, double *first, double *second)
{
  for (size_t i = 0; i < n; i++) {
    double h = step_for(argument[i][point], 1.0 / 64.0);
    first[i] = first_difference(bench, point, argument, i, h, output);
    for (size_t j = i; j < n; j++) {
      double k = step_for(argument[j][point], 1.0 / 32.0);
      double wide = step_for(argument[i][point], 1.0 / 32.0);
      second[i * n + j] = second[j * n + i] =
          second_difference(bench, point, argument, i, wide, j, k, output);
    }
  }
}

static void by_kernel(struct bench *bench, size_t point, size_t n, double *first, double *second)
{
  const struct kernel *kernel = bench->kernel;
  bool offered = bench->derivatives;
  bench_offer_derivatives(bench, true);
  bench_call(bench, kernel_operation(kernel, kernel->descriptor->kind == GAMUT_KIND_EOS ? 1 : 2),
             bench->count);
  for (size_t s = 0; s < kernel->slots; s++) {
    const struct slot *slot = &kernel->slot[s];
    if (slot->kind == SLOT_DERIVATIVE)
      first[slot->index] = row(bench, s)[point];
    if (slot->kind == SLOT_SECOND_DERIVATIVE)
      second[slot->index * n + slot->other] = second[slot->other * n + slot->index] =
          row(bench, s)[point];
  }
  bench_offer_derivatives(bench, offered);
}

gamut_status bench_derivatives(struct bench *bench, size_t point, bool differences, double *first,
                               double *second)
{
  const struct kernel *kernel = bench->kernel;
  const struct descriptor *d = kernel->descriptor;
  kernel_function own = d->kind == GAMUT_KIND_EOS        ? kernel_operation(kernel, 1)
                        : d->kind == GAMUT_KIND_STRENGTH ? kernel_operation(kernel, 2)
                                                         : NULL;
  if (!d->derivative_of)
    return GAMUT_PLUGIN;
  if (own && !differences) {
    by_kernel(bench, point, d->derivatives, first, second);
    return GAMUT_OK;
  }
  double **argument = calloc(d->derivatives + 1, sizeof(*argument));
  const double *output = bench_array(bench, d->derivative_of);
  bool good = argument && output;
  for (size_t i = 0; good && i < d->derivatives; i++)
    good = (argument[i] = bench_array(bench, d->derivative_by[i])) != NULL;
  if (good)
    by_differences(bench, point, argument, d->derivatives, output, first, second);
  free(argument);
  return good ? GAMUT_OK : GAMUT_PLUGIN;
}
