/* A law is tried once before a run: on eight points, in rows with guard bands of their own. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "material/image.h"
#include "registry/guard.h"

enum { POINTS = 8, BAND = 8, STRIDE = BAND + POINTS + 2 * BAND };

struct trial {
  const struct kernel *kernel;
  struct trace *trace;
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
               {"pressure", 1.03e6, 1e6, 1}};
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
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
  for (size_t s = 0; s < trial->kernel->slots; s++)
    for (size_t i = 0; i < STRIDE; i++) {
      const bool inside = i >= BAND && i < BAND + count;
      row(trial, s)[(ptrdiff_t)i - BAND] =
          is_written(trial->kernel->slot[s].kind) ? mark()
          : inside ? value_at(trial->kernel, s, first + i - BAND)
                   : around;
    }
}

static void call(struct trial *trial, size_t count)
{
  const struct kernel *kernel = trial->kernel;
  memset(trial->status, 0, sizeof trial->status);
  memcpy(trial->before, trial->memory, (kernel->slots + 1) * STRIDE * sizeof(double));
  trial->image->count = count;
  const char *before = guard_enter(kernel->descriptor->id);
  kernel->main(trial->image);
  guard_leave(before);
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
    for (size_t i = 0; i < STRIDE; i++) {
      const size_t at = s * STRIDE + i;
      const bool inside = i >= BAND && i < BAND + count;
      const bool kept =
          memcmp(&trial->memory[at], &trial->before[at], sizeof trial->memory[at]) == 0;
      if (inside && is_written(slot->kind)) {
        if (kept && slot->kind == SLOT_OUTPUT)
          return refuse(trial, "leaves points unwritten of", slot->name);
      } else if (!kept) {
        return refuse(trial,
                      is_written(slot->kind) ? "writes beyond the points that it was given, in"
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
    call(trial, 1);
    TRY(check_writes(trial, 1));
    for (size_t s = 0; s < trial->kernel->slots; s++)
      if (trial->kernel->slot[s].kind == SLOT_OUTPUT &&
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
static void moved(struct trial *trial, size_t of, size_t by, double share, double *value)
{
  fill(trial, 0, POINTS, 0.0);
  for (size_t i = 0; i < POINTS; i++)
    row(trial, by)[i] += share * row(trial, by)[i];
  call(trial, POINTS);
  for (size_t i = 0; i < POINTS; i++)
    value[i] =
        status_severity(trial->status[BAND + i]) >= GAMUT_WARN ? NAN : row(trial, of)[i];
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
  for (int k = 0; k < SHARES; k++)
    moved(trial, of, by, share[k], v[k]);
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
  return GAMUT_OK;
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
  for (size_t s = 0; s < kernel->slots; s++)
    image->pointer[s] = is_derivative(kernel->slot[s].kind) ? NULL : row(trial, s);
  return true;
}

gamut_status kernel_try(const struct kernel *kernel, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct trial trial = {.kernel = kernel, .trace = trace};
  const size_t numbers = (kernel->slots + 1) * STRIDE;
  struct image *image = calloc(1, sizeof *image + kernel->slots * sizeof image->pointer[0]);
  double *memory = aligned_alloc(64, 3 * numbers * sizeof *memory);
  double *together = memory ? memory + 2 * numbers : NULL;
  if (!make(&trial, image, memory)) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  memset(memory, 0, 3 * numbers * sizeof *memory);
  fill(&trial, 0, POINTS, 0.0);
  call(&trial, POINTS);
  TRY(check_writes(&trial, POINTS));
  memcpy(together, memory, numbers * sizeof *memory);
  TRY(check_company(&trial, together));
  TRY(check_slopes(&trial, together));
done:
  free(memory);
  free(image);
  return status;
}
