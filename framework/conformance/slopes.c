/* Slopes and derivatives against differences. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/conformance_private.h"

enum { TRIED = 96, DERIVED = 48 };

struct slope_probe {
  struct block *block;
  kernel_function function;
  size_t point;
  double *argument, *result;
  double at;
};

static double moved_value(void *self, double x, double y)
{
  (void)y;
  struct slope_probe *probe = self;
  int64_t *status = &bench_status(probe->block->bench)[0];
  probe->argument[0] = probe->at + x;
  *status = 0;
  bench_call(probe->block->bench, probe->function, 1);
  probe->argument[0] = probe->at;
  return status_severity(*status) >= GAMUT_WARN ? NAN : probe->result[0];
}

/* Error of a slope against the nearest of the central and the one-sided differences: at a kink the
 * law may give either side's. */
static double slope_error(const struct difference *d, double slope, double scale)
{
  double error, least = INFINITY;
  for (int side = -1; side <= 1; side++) {
    double value = side == 0 ? difference_first(d, &error) : difference_sided(d, side, &error);
    double off = fabs(slope - value) - 4 * error;
    if (isfinite(value) && off < least)
      least = off;
  }
  if (!isfinite(least))
    return 0; /* no difference can be had there */
  return fmax(least, 0) / fmax(scale, fabs(slope));
}

static void load_point(struct block *block, size_t point)
{
  for (size_t s = 0; s < block->proof->slots; s++)
    if (block->kept[s] && block->array[s])
      block->array[s][0] = block->kept[s][point];
}

static double worst_slope(struct block *block, kernel_function function, size_t of, size_t by,
                          size_t slope, size_t *tried)
{
  double worst = 0;
  char label[96];
  struct slope_probe probe = {.block = block, .function = function};
  probe.argument = block->array[by];
  probe.result = block->array[of];
  double step = span_of(slot_label(&block->proof->slot[by], label, sizeof label)).step;
  for (size_t i = 0; i < TRIED; i++) {
    load_point(block, i);
    probe.at = probe.argument[0];
    double value = moved_value(&probe, 0, 0), given = block->array[slope][0];
    if (!isfinite(value) || !isfinite(given))
      continue;
    struct difference difference = {.value = moved_value, .self = &probe};
    difference.step_x = probe.at != 0 ? fmin(0.05 * fabs(probe.at), step) : step;
    double scale = fabs(value) / fmax(fabs(probe.at), step);
    double error = slope_error(&difference, given, scale);
    worst = fmax(worst, error);
    (*tried)++;
  }
  return worst;
}

static double largest_slope(struct block *block, kernel_function function, size_t slope)
{
  double most = 0;
  block_mark(block);
  bench_call(block->bench, function, BLOCK_POINTS);
  for (size_t i = 0; i < BLOCK_POINTS; i++)
    most = fmax(most, fabs(block->array[slope][i]));
  return most;
}

/* Splits "pressure_slope_energy" into its output and input. */
static bool slope_slots(const struct proof *proof, size_t slope, size_t *of, size_t *by)
{
  const char *name = proof->slot[slope].name, *middle = strstr(name, "_slope_");
  if (!middle || proof->slot[slope].kind != SLOT_OUTPUT)
    return false;
  char output[96];
  snprintf(output, sizeof output, "%.*s", (int)(middle - name), name);
  *of = slot_named(proof, SLOT_OUTPUT, output);
  *by = slot_named(proof, SLOT_INPUT, middle + strlen("_slope_"));
  return *of != SIZE_MAX;
}

void prove_slopes(struct proof *proof, struct block *block, kernel_function function)
{
  for (size_t s = 0; s < proof->slots; s++) {
    size_t of, by, tried = 0;
    if (!slope_slots(proof, s, &of, &by))
      continue;
    check_begin(&proof->checks, "%s", proof->slot[s].name);
    block_draw(block, 1);
    if (by == SIZE_MAX) {
      check_figure(&proof->checks, largest_slope(block, function, s), 0,
                   "%s, by what the law does not read", proof->slot[s].name);
      continue;
    }
    double worst = worst_slope(block, function, of, by, s, &tried);
    check_figure(&proof->checks, tried ? worst : NAN, 1e-6,
                 "%s against differences at %zu points, relative", proof->slot[s].name, tried);
  }
}

static double at_of(const struct proof *proof, const struct block *block, size_t by, size_t point)
{
  const char *name = proof->descriptor->derivative_by[by];
  size_t slot = slot_named(proof, SLOT_PARAMETER, name);
  if (slot == SIZE_MAX)
    slot = slot_named(proof, SLOT_INPUT, name);
  double value = slot == SIZE_MAX ? 1 : fabs(block->array[slot][point]);
  return value > 0 ? value : 1;
}

static void compare(const struct proof *proof, const struct block *block, size_t point,
                    const double *own, const double *other, double *first, double *second)
{
  size_t n = proof->descriptor->derivatives;
  size_t of = slot_named(proof, SLOT_OUTPUT, proof->descriptor->derivative_of);
  double size = fabs(block->array[of][point]);
  for (size_t k = 0; k < n; k++) {
    double at = at_of(proof, block, k, point);
    double scale = fmax(size / at, fabs(own[k]));
    if (isfinite(other[k]) && scale > 0)
      *first = fmax(*first, fabs(own[k] - other[k]) / scale);
    for (size_t l = 0; l < n; l++) {
      double a = own[n + k * n + l], b = other[n + k * n + l];
      double scale2 = fmax(scale / at_of(proof, block, l, point), fabs(a));
      if (isfinite(b) && scale2 > 0)
        *second = fmax(*second, fabs(a - b) / scale2);
    }
  }
}

void prove_derivatives(struct proof *proof, struct block *block, kernel_function function)
{
  size_t n = proof->descriptor->derivatives, tried = 0;
  double first = 0, second = 0;
  if (n == 0)
    return;
  check_begin(&proof->checks, "derivatives of %s by parameters", proof->descriptor->derivative_of);
  double *own = calloc(2 * (n + n * n), sizeof *own), *other = own ? own + n + n * n : NULL;
  block_draw(block, 1);
  int64_t status[DERIVED];
  block_mark(block);
  bench_call(block->bench, function, BLOCK_POINTS);
  memcpy(status, bench_status(block->bench), sizeof status);
  for (size_t i = 0; own && i < DERIVED; i++) {
    if (status[i] != 0)
      continue;
    if (bench_derivatives(block->bench, i, false, own, own + n) != GAMUT_OK ||
        bench_derivatives(block->bench, i, true, other, other + n) != GAMUT_OK)
      break;
    compare(proof, block, i, own, other, &first, &second);
    tried++;
  }
  free(own);
  check_figure(&proof->checks, tried ? first : NAN, 1e-6,
               "first derivatives against differences at %zu points, relative", tried);
  check_figure(&proof->checks, tried ? second : NAN, 1e-4,
               "second derivatives against differences at %zu points, relative", tried);
}
