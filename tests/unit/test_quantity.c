/* Histories and reductions against curves whose answers are known in closed form. */
#include <stdlib.h>

#include "quantity/quantity.h"
#include "tests/tap.h"

static const struct measure length = {.name = "extent", .unit = "m"};

/* value = 2 + 3 time, in uneven steps that hit neither the multiples nor 1. */
static struct history *line(const struct quantity *quantity, double end)
{
  struct history *h = history_new(quantity, end);
  double time = 0, step = 0.013;
  history_tell(h, 0, 2, false);
  while (time + step < end) {
    time += step;
    step *= 1.03;
    history_tell(h, time, 2 + 3 * time, false);
  }
  history_tell(h, end, 2 + 3 * end, true);
  return h;
}

static void test_samples(void)
{
  struct quantity quantity = {.name = "q", .measure = &length, .every = 0.1};
  struct history *h = line(&quantity, 1);
  double off = 0, value_off = 0;
  tap_text("unit of the measure", h->unit, "m");
  tap_ok(h->count == 11, "11 samples from 0 to 1 every 0.1: %zu", h->count);
  for (size_t i = 0; i < h->count; ++i) {
    off = fmax(off, fabs(h->time[i] - 0.1 * (double)i));
    value_off = fmax(value_off, fabs(h->value[i] - 2 - 3 * h->time[i]));
  }
  tap_absolute("samples lie at multiples", off, 0, 1e-15);
  tap_absolute("straight lines are kept", value_off, 0, 1e-14);
  tap_ok(h->time[h->count - 1] == 1.0 && h->value[h->count - 1] == 5.0, "the end is exact");
  history_free(h);

  quantity.every = 0.3;
  h = line(&quantity, 1);
  tap_ok(h->count == 5 && h->time[4] == 1.0 && h->time[3] < 0.95,
         "an end that is no multiple is one sample more: %zu", h->count);
  history_free(h);

  quantity.every = 0;
  h = line(&quantity, 1);
  tap_ok(h->count == 501, "about 500 samples by default: %zu", h->count);
  history_free(h);
}

static void test_rounding(void)
{
  struct quantity quantity = {.name = "q", .measure = &length, .every = 1e-6};
  struct history *h = history_new(&quantity, 80e-6);
  history_tell(h, 0, 0, false);
  for (int i = 1; i < 1000; ++i)
    history_tell(h, 80e-6 * i / 1000.0, i, false);
  history_tell(h, 80e-6, 1000, true);
  tap_ok(h->count == 81, "80 us every 1 us has no twin at the end: %zu samples", h->count);
  history_free(h);

  h = history_new(&quantity, 80e-6);
  history_tell(h, 0, 0, false);
  history_tell(h, 10.5e-6, 10.5, false);
  history_tell(h, 20.25e-6, 20.25, true);
  tap_ok(h->count == 22 && h->time[h->count - 1] == 20.25e-6, "a run may end early: %zu samples",
         h->count);
  history_free(h);

  h = history_new(&quantity, 3e-6);
  history_tell(h, 0, 0, false);
  for (int i = 1; i < 100; ++i)
    history_tell(h, i * 1e-6, i, false);
  tap_ok(h->count <= h->capacity, "no sample beyond the room made: %zu of %zu", h->count,
         h->capacity);
  history_free(h);

  quantity.every = 1e-300;
  tap_ok(history_new(&quantity, 1) == NULL, "more samples than memory gives no history");
}

static void test_units(void)
{
  struct quantity field = {.name = "v", .field = "velocity_y", .every = 1};
  struct history *h = history_new(&field, 1);
  tap_text("unit of a field's component", h->unit, "m/s");
  history_free(h);
  field.field = "plastic_strain_rate";
  h = history_new(&field, 1);
  tap_text("unit of a field", h->unit, "1/s");
  history_free(h);
}

static bool reduce(struct reduction r, const struct history *h, double *value, char unit[16],
                   char why[128])
{
  *value = NAN;
  why[0] = 0;
  return reduction_value(&r, h, value, unit, 16, why, 128);
}

static void test_reductions(void)
{
  struct quantity quantity = {.name = "q", .measure = &length, .every = 0.1};
  struct history *h = line(&quantity, 1);
  char unit[16], why[128];
  double value;
  const double all = INFINITY;

  reduce((struct reduction){.kind = REDUCE_AT, .at_end = true}, h, &value, unit, why);
  tap_relative("at end", value, 5, 1e-15);
  reduce((struct reduction){.kind = REDUCE_AT, .from = 0.234}, h, &value, unit, why);
  tap_relative("at a time between samples", value, 2 + 3 * 0.234, 1e-14);
  tap_ok(!reduce((struct reduction){.kind = REDUCE_AT, .from = 2}, h, &value, unit, why),
         "at a time outside: %s", why);
  reduce((struct reduction){.kind = REDUCE_MAX, .from = -all, .to = 0.55}, h, &value, unit, why);
  tap_relative("max counts the edge of its window", value, 2 + 3 * 0.55, 1e-14);
  reduce((struct reduction){.kind = REDUCE_MIN, .from = 0.25, .to = all}, h, &value, unit, why);
  tap_relative("min counts the edge of its window", value, 2 + 3 * 0.25, 1e-14);
  reduce((struct reduction){.kind = REDUCE_MEAN, .from = 0.25, .to = 0.85}, h, &value, unit, why);
  tap_relative("mean over a window", value, 2 + 3 * 0.55, 1e-14);
  tap_text("its unit", unit, "m");
  reduce((struct reduction){.kind = REDUCE_TIME_OF, .level = 4.1, .from = 0, .to = all}, h, &value,
         unit, why);
  tap_relative("time of a level", value, 0.7, 1e-13);
  tap_text("its unit", unit, "s");
  tap_ok(!reduce((struct reduction){.kind = REDUCE_TIME_OF, .level = 6, .to = all}, h, &value, unit,
                 why),
         "a level never reached: %s", why);
  reduce((struct reduction){.kind = REDUCE_TIME_OF, .time_of_max = true, .to = all}, h, &value,
         unit, why);
  tap_relative("time of the largest", value, 1, 1e-15);
  reduce((struct reduction){.kind = REDUCE_SLOPE, .from = 0.13, .to = 0.91}, h, &value, unit, why);
  tap_relative("slope", value, 3, 1e-13);
  tap_text("its unit", unit, "m/s");
  h->unit = "m/s";
  reduce((struct reduction){.kind = REDUCE_SLOPE, .to = all}, h, &value, unit, why);
  tap_text("unit of the slope of a velocity", unit, "m/s2");
  tap_ok(!reduce((struct reduction){.kind = REDUCE_SLOPE, .from = 0.5, .to = 0.5}, h, &value, unit,
                 why),
         "no slope at one time: %s", why);
  tap_ok(!reduce((struct reduction){.kind = REDUCE_MEAN, .from = 3, .to = 4}, h, &value, unit, why),
         "an empty window: %s", why);
  h->value[4] = NAN;
  tap_ok(!reduce((struct reduction){.kind = REDUCE_MAX, .to = all}, h, &value, unit, why),
         "not a number: %s", why);
  history_free(h);
}

/* A wave: it falls through the level, so the first crossing is downwards. */
static void test_wave(void)
{
  const double pi = 3.14159265358979323846;
  struct quantity quantity = {.name = "q", .measure = &length, .every = 1e-3};
  struct history *h = history_new(&quantity, 1);
  char unit[16], why[128];
  double value;
  for (int i = 0; i <= 2000; ++i)
    history_tell(h, i / 2000.0, cos(2 * pi * i / 2000.0), i == 2000);
  reduce((struct reduction){.kind = REDUCE_TIME_OF, .level = 0.5, .to = 1}, h, &value, unit, why);
  tap_relative("first crossing, downwards", value, 1 / 6.0, 1e-5);
  reduce((struct reduction){.kind = REDUCE_TIME_OF, .level = 0.5, .from = 0.3, .to = 1}, h, &value,
         unit, why);
  tap_relative("first crossing in a window, upwards", value, 5 / 6.0, 1e-5);
  reduce((struct reduction){.kind = REDUCE_TIME_OF, .level = 1, .to = 1}, h, &value, unit, why);
  tap_ok(value == 0, "a level met at the start");
  reduce((struct reduction){.kind = REDUCE_MEAN, .to = 1}, h, &value, unit, why);
  tap_absolute("mean of a period", value, 0, 1e-12);
  history_free(h);
}

static const struct measure strain = {.name = "strain", .unit = "1"};
static const struct measure stress = {.name = "stress", .unit = "Pa", .against = &strain};

/* A loop: its axis goes up and back. Every step is kept as it was, more than there was room for. */
static void test_curve(void)
{
  enum { STEPS = 2000 };
  struct quantity quantity = {.name = "q", .measure = &stress};
  struct history *h = history_new(&quantity, 0);
  size_t other = 0;
  double value = 0;
  char unit[64], why[200];
  for (int i = 0; i <= STEPS; ++i)
    history_tell(h, i < STEPS / 2 ? i : STEPS - i, 3.0 * i, false);
  history_tell(h, 0, 3.0 * STEPS, true);
  tap_ok(h->count == STEPS + 1, "every step of a curve is kept once: %zu", h->count);
  for (int i = 0; i <= STEPS; ++i)
    other += h->time[i] != (i < STEPS / 2 ? i : STEPS - i) || h->value[i] != 3.0 * i;
  tap_ok(other == 0, "pairs that are not as they were told: %zu", other);
  struct reduction end = {.kind = REDUCE_AT, .at_end = true, .to = INFINITY};
  tap_ok(reduction_value(&end, h, &value, unit, sizeof unit, why, sizeof why) &&
             value == 3.0 * STEPS,
         "the end of a loop is its last pair: %g", value);
  struct reduction most = {.kind = REDUCE_MAX, .to = INFINITY};
  tap_ok(!reduction_value(&most, h, &value, unit, sizeof unit, why, sizeof why),
         "a window of a loop is refused: %s", why);
  history_free(h);
}

/* A run whose end is not known keeps every step; with a reduction at its end, only that. */
static void test_endless(void)
{
  struct quantity quantity = {.name = "q", .measure = &length};
  struct history *h = history_new(&quantity, 0);
  for (int i = 0; i <= 700; ++i)
    history_tell(h, i, i, false);
  history_tell(h, 700, 700, true);
  tap_ok(h->count == 701, "every step of a run without a known end: %zu", h->count);
  history_free(h);
  quantity.every = 10;
  h = history_new(&quantity, 0);
  for (int i = 0; i <= 7000; ++i)
    history_tell(h, i, i, false);
  history_tell(h, 7000, 7000, true);
  tap_ok(h->count == 701, "every 10 of a run without a known end: %zu", h->count);
  history_free(h);
  quantity = (struct quantity){
      .name = "q", .measure = &length, .reduction = {.kind = REDUCE_AT, .at_end = true}};
  h = history_new(&quantity, 0);
  history_tell(h, 0, 1, false);
  history_tell(h, 700, 5, true);
  tap_ok(h->count == 2 && h->value[1] == 5, "its end alone: %zu samples", h->count);
  history_free(h);
}

int main(void)
{
  test_samples();
  test_rounding();
  test_units();
  test_reductions();
  test_wave();
  test_curve();
  test_endless();
  return tap_done();
}
