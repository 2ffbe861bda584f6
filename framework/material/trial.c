/* Laws, elasticities and the kernels of effects are tried once before a run: on eight points, in
 * rows with guard bands of their own. */
#include <fenv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "material/law.h"
#include "registry/guard.h"

enum { POINTS = 8, BAND = 8, STRIDE = BAND + POINTS + 2 * BAND };

struct trial {
  const struct kernel *kernel;
  struct trace *trace;
  kernel_function function;
  const struct kernel_task *task; /* of an effect; else null */
  struct law *strength, *eos;     /* that an elasticity calls, or null */
  bool carried;                   /* what it may write begins as a value, and may stay so */
  struct image *image;
  double *memory, *before; /* rows of all slots; what they held before a call */
  int64_t status[STRIDE];
};

/* A number that no computation gives. */
static double mark(void)
{
  const uint64_t bits = UINT64_C(0x7ff4dead5eed0bad);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static bool same(double a, double b)
{
  return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static double *row(const struct trial *trial, size_t slot)
{
  return trial->memory + slot * STRIDE + BAND;
}

static bool is_written(enum slot_kind kind)
{
  return kind == SLOT_OUTPUT || kind == SLOT_STATE_END || kind == SLOT_SCRATCH ||
         kind == SLOT_INVERSE_OUTPUT;
}

enum due { KEPT, ADDED, WRITTEN };

static bool named(const char *const *name, size_t count, const char *wanted)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(name[i], wanted) == 0)
      return true;
  return false;
}

/* What may become of a slot's points. */
static enum due due_of(const struct trial *trial, size_t s)
{
  const struct slot *slot = &trial->kernel->slot[s];
  const struct kernel_task *task = trial->task;
  if (!task || slot->kind == SLOT_SCRATCH || !is_written(slot->kind))
    return is_written(slot->kind) ? WRITTEN : KEPT;
  if (named(task->write, task->writes, slot->name))
    return WRITTEN;
  return named(task->add, task->adds, slot->name) ||
                 named(task->scale, task->scales, slot->name) ||
                 named(task->lower, task->lowers, slot->name)
             ? ADDED
             : KEPT;
}

static bool is_derivative(enum slot_kind kind)
{
  return kind == SLOT_DERIVATIVE || kind == SLOT_SECOND_DERIVATIVE;
}

/* Moderate states away from round numbers, where laws like to have their kinks. */
static double input_at(const char *name, size_t point)
{
  static const struct {
    const char *name;
    double first, more, times;
  } known[] = {{"plastic_strain", 0.0131, 0.0171, 1},   {"plastic_strain_rate", 1.7, 0, 3.1},
               {"temperature", 301.3, 23.1, 1},         {"compression", -0.0213, 0.0067, 1},
               {"energy", 1.03e6, 1.01e6, 1},           {"cell_size", 1.03e-3, 1e-5, 1},
               {"pressure", 1.03e6, 1e6, 1},            {"time_step", 1.03e-6, 0, 1},
               {"volume_ratio", 0.973, 0.0071, 1}};
  for (size_t i = 0; i < ARRAY_SIZE(known); i++)
    if (strcmp(name, known[i].name) == 0)
      return (known[i].first + (double)point * known[i].more) *
             pow(known[i].times, (double)point);
  return 0.53 + 0.0617 * (double)point;
}

static double value_at(const struct kernel *kernel, size_t slot, size_t point)
{
  const struct slot *s = &kernel->slot[slot];
  if (kernel->uniform[slot])
    return kernel->uniform[slot][0];
  if (s->kind == SLOT_PARAMETER || s->kind == SLOT_MATERIAL_PARAMETER)
    return kernel_mean(kernel, slot);
  if (s->kind == SLOT_STATE_BEGIN || s->kind == SLOT_STATE_END)
    return kernel->descriptor->state[s->index].initial;
  return input_at(s->name, point);
}

/* Points `first` and those after it stand in the rows; what surrounds them is `around`. */
static void fill(struct trial *trial, size_t first, size_t count, double around)
{
  for (size_t s = 0; s < trial->kernel->slots; s++) {
    const enum due due = due_of(trial, s);
    const bool empty = due == WRITTEN && !trial->carried;
    for (size_t i = 0; i < STRIDE; i++) {
      const bool inside = i >= BAND && i < BAND + count;
      row(trial, s)[(ptrdiff_t)i - BAND] =
          inside && !empty ? value_at(trial->kernel, s, first + i - BAND)
          : due == KEPT    ? around
                           : mark();
    }
  }
}

/* An elasticity's laws as the core hands them over: their arguments and parameters are there. */
static void fill_law(struct law *law, size_t first, size_t count)
{
  static const char *const argument[] = {"temperature", "plastic_strain"};
  if (!law)
    return;
  law_begin(law, count);
  for (size_t s = 0; s < law->kernel->slots; s++)
    for (size_t i = 0; slot_varies(law->kernel, s) && i < count; i++)
      ((double *)law->image->pointer[s])[i] = kernel_mean(law->kernel, s);
  for (size_t a = 0; a < ARRAY_SIZE(argument); a++) {
    double *to = law_row(law, argument[a]);
    for (size_t i = 0; to && i < count; i++)
      to[i] = input_at(argument[a], first + i);
  }
}

static gamut_status refuse(const struct trial *trial, const char *what, const char *name);

static gamut_status call(struct trial *trial, size_t first, size_t count)
{
  fenv_t calm, after;
  const struct kernel *kernel = trial->kernel;
  memset(trial->status, 0, sizeof trial->status);
  memcpy(trial->before, trial->memory, (kernel->slots + 1) * STRIDE * sizeof(double));
  fill_law(trial->strength, first, count);
  fill_law(trial->eos, first, count);
  trial->image->count = count;
  const char *before = guard_enter(kernel->descriptor->id);
  fegetenv(&calm);
  trial->function(trial->image);
  fegetenv(&after);
  fesetenv(&calm);
  guard_leave(before);
  return same_arithmetic(&calm, &after)
             ? GAMUT_OK
             : refuse(trial, "changes the processor's rounding, flush-to-zero or trap flags", NULL);
}

static gamut_status refuse(const struct trial *trial, const char *what, const char *name)
{
  const struct instance *instance = trial->kernel->instance;
  char hint[200];
  snprintf(hint, sizeof hint, "mend the plugin; `gamut verify %s` shows all that is wrong with it",
           trial->kernel->descriptor->id);
  return trace_fail_at(trial->trace, GAMUT_PLUGIN, instance->node ? &instance->node->place : NULL,
                       NULL, hint, "plugin %s %s%s%s", trial->kernel->descriptor->id, what,
                       name ? " " : "", name ? name : "");
}

/* Only the first `count` points of what a law gives may change. */
static gamut_status check_writes(const struct trial *trial, size_t count)
{
  for (size_t s = 0; s < trial->kernel->slots; s++) {
    const struct slot *slot = &trial->kernel->slot[s];
    const enum due due = due_of(trial, s);
    for (size_t i = 0; i < STRIDE; i++) {
      const size_t at = s * STRIDE + i;
      const bool inside = i >= BAND && i < BAND + count;
      const bool kept =
          memcmp(&trial->memory[at], &trial->before[at], sizeof trial->memory[at]) == 0;
      if (inside && due != KEPT) {
        if (kept && !trial->carried && due == WRITTEN && slot->kind == SLOT_OUTPUT)
          return refuse(trial, "leaves points unwritten of", slot->name);
      } else if (!kept) {
        return refuse(trial,
                      due != KEPT ? "writes beyond the points that it was given, in"
                      : is_written(slot->kind) ? "has a task that writes, and does not say so, to"
                      : slot->kind == SLOT_INPUT || slot->kind == SLOT_STATE_BEGIN
                          ? "writes to its input"
                          : "writes to its parameter",
                      slot->name);
      }
    }
  }
  for (size_t i = 0; i < STRIDE; i++)
    if ((i < BAND || i >= BAND + count) && trial->status[i] != 0)
      return refuse(trial, "writes beyond the points that it was given, in", "status");
  return GAMUT_OK;
}

/* Each point alone gives the bits that it gave in company. */
static gamut_status check_company(struct trial *trial, const double *together)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < POINTS; i++) {
    fill(trial, i, 1, NAN);
    TRY(call(trial, i, 1));
    TRY(check_writes(trial, 1));
    for (size_t s = 0; s < trial->kernel->slots; s++)
      if ((trial->kernel->slot[s].kind == SLOT_OUTPUT ||
           trial->kernel->slot[s].kind == SLOT_STATE_END ||
           trial->kernel->slot[s].kind == SLOT_INVERSE_OUTPUT) &&
          !same(row(trial, s)[0], together[s * STRIDE + BAND + i]))
        return refuse(trial, "gives a point alone another value than beside others:",
                      trial->kernel->slot[s].name);
  }
done:
  return status;
}

static size_t slot_of(const struct kernel *kernel, enum slot_kind kind, const char *name,
                      size_t length)
{
  for (size_t s = 0; s < kernel->slots; s++)
    if (kernel->slot[s].kind == kind && strlen(kernel->slot[s].name) == length &&
        strncmp(kernel->slot[s].name, name, length) == 0)
      return s;
  return SIZE_MAX;
}

/* The output `of` at all points with input `by` moved by `share` of itself; NaN where flagged. */
static gamut_status moved(struct trial *trial, size_t of, size_t by, double share, double *value)
{
  fill(trial, 0, POINTS, 0.0);
  for (size_t i = 0; i < POINTS; i++)
    row(trial, by)[i] += share * row(trial, by)[i];
  const gamut_status status = call(trial, 0, POINTS);
  for (size_t i = 0; i < POINTS; i++)
    value[i] =
        status_severity(trial->status[BAND + i]) >= GAMUT_WARN ? NAN : row(trial, of)[i];
  return status;
}

/* A slope is wrong where central differences agree with each other, the two sides too, and the
 * slope with neither: a kink or a jump nearby excuses it, and so does round-off. */
static gamut_status check_slope(struct trial *trial, size_t slope, size_t of, size_t by,
                                const double *given)
{
  enum { SHARES = 5 };
  static const double share[SHARES] = {-1e-3, -0.5e-3, 0, 0.5e-3, 1e-3};
  double v[SHARES][POINTS];
  char what[200];
  gamut_status status = GAMUT_OK;
  for (int k = 0; k < SHARES; k++)
    TRY(moved(trial, of, by, share[k], v[k]));
  for (size_t i = 0; i < POINTS; i++) {
    const double step = 1e-3 * value_at(trial->kernel, by, i);
    const double wide = (v[4][i] - v[0][i]) / (2 * step), near = (v[3][i] - v[1][i]) / step;
    const double sides = (v[4][i] - 2 * v[2][i] + v[0][i]) / step;
    const double noise = 1e3 * 2.2e-16 * fabs(v[2][i] / step);
    const double allowed = 1e-3 * fmax(fabs(near), fabs(given[i])) + fabs(sides) +
                           4 * fabs(wide - near) + noise;
    if (!(fabs(given[i] - near) > allowed))
      continue;
    snprintf(what, sizeof what, "gives %g where differences give %g (at %s = %g) for", given[i],
             near, trial->kernel->slot[by].name, value_at(trial->kernel, by, i));
    return refuse(trial, what, trial->kernel->slot[slope].name);
  }
done:
  return status;
}

static gamut_status check_slopes(struct trial *trial, const double *together)
{
  static const char between[] = "_slope_";
  gamut_status status = GAMUT_OK;
  const struct kernel *kernel = trial->kernel;
  for (size_t s = 0; s < kernel->slots; s++) {
    const char *name = kernel->slot[s].name;
    const char *middle = kernel->slot[s].kind == SLOT_OUTPUT ? strstr(name, between) : NULL;
    if (!middle)
      continue;
    const char *argument = middle + sizeof between - 1;
    const size_t of = slot_of(kernel, SLOT_OUTPUT, name, (size_t)(middle - name));
    const size_t by = slot_of(kernel, SLOT_INPUT, argument, strlen(argument));
    if (of != SIZE_MAX && by != SIZE_MAX)
      TRY(check_slope(trial, s, of, by, together + s * STRIDE + BAND));
  }
done:
  return status;
}

static bool make(struct trial *trial, struct image *image, double *memory)
{
  const struct kernel *kernel = trial->kernel;
  if (!image || !memory)
    return false;
  trial->image = image;
  trial->memory = memory;
  trial->before = memory + (kernel->slots + 1) * STRIDE;
  image->status = trial->status + BAND;
  for (size_t s = 0; s < kernel->slots; s++) {
    image->pointer[s] = is_derivative(kernel->slot[s].kind) ? NULL
                        : slot_is_array(kernel, s)          ? row(trial, s)
                                                            : slot_constant(kernel, s);
    if (kernel->slot[s].kind != SLOT_LAW)
      continue;
    const bool strength = strcmp(kernel->slot[s].name, "strength") == 0;
    const struct law *law = strength ? trial->strength : trial->eos;
    image->pointer[s] = !law       ? NULL
                        : strength ? (void *)(uintptr_t)&law->strength
                                   : (void *)(uintptr_t)&law->eos;
  }
  return true;
}

static gamut_status perform(struct trial trial, bool slopes)
{
  gamut_status status = GAMUT_OK;
  const struct kernel *kernel = trial.kernel;
  const size_t numbers = (kernel->slots + 1) * STRIDE;
  struct image *image = calloc(1, sizeof *image + kernel->slots * sizeof image->pointer[0]);
  double *memory = aligned_alloc(64, 3 * numbers * sizeof *memory);
  double *together = memory ? memory + 2 * numbers : NULL;
  if (!make(&trial, image, memory)) {
    status = trace_fail(trial.trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  memset(memory, 0, 3 * numbers * sizeof *memory);
  fill(&trial, 0, POINTS, 0.0);
  TRY(call(&trial, 0, POINTS));
  TRY(check_writes(&trial, POINTS));
  memcpy(together, memory, numbers * sizeof *memory);
  TRY(check_company(&trial, together));
  if (slopes)
    TRY(check_slopes(&trial, together));
done:
  free(memory);
  free(image);
  return status;
}

gamut_status kernel_try(const struct kernel *kernel, struct trace *trace)
{
  gamut_status status;
  struct trial trial = {.kernel = kernel, .trace = trace, .function = kernel->main};
  TRY(perform(trial, true));
  trial.function = kernel->descriptor->inverse ? kernel_operation(kernel, 1) : NULL;
  trial.carried = true;
  if (trial.function)
    TRY(perform(trial, false));
done:
  return status;
}

/* A trial is no work of the run, and leaves its laws as new. */
static void renew(struct law *law, uint64_t evaluated)
{
  if (!law)
    return;
  law->evaluated = evaluated;
  law_clear(law);
}

gamut_status elasticity_try(const struct kernel *kernel, struct law *strength, struct law *eos,
                            struct trace *trace)
{
  gamut_status status;
  const uint64_t evaluated[] = {strength ? strength->evaluated : 0, eos ? eos->evaluated : 0};
  struct trial trial = {.kernel = kernel,
                        .trace = trace,
                        .function = kernel->main,
                        .strength = strength,
                        .eos = eos};
  TRY(perform(trial, false));
  trial.function = kernel_operation(kernel, 1);
  trial.carried = true;
  if (trial.function)
    TRY(perform(trial, false));
done:
  renew(strength, evaluated[0]);
  renew(eos, evaluated[1]);
  return status;
}

gamut_status effect_try(const struct kernel *kernel, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *d = kernel->descriptor;
  for (size_t t = 0; t < d->tasks; t++) {
    const struct trial trial = {.kernel = kernel,
                                .trace = trace,
                                .function = kernel_named(kernel, d->task[t].kernel),
                                .task = &d->task[t]};
    if (trial.function)
      TRY(perform(trial, false));
  }
done:
  return status;
}
