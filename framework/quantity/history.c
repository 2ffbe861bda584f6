#include "quantity/quantity.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"

enum { SAMPLES_BY_DEFAULT = 500 };

/* Multiples of `every` and the end differ by rounding; closer than this share of `every` they are
 * one. */
static const double same_sample = 1e-6;

/* "velocity_y" has the unit of the field "velocity". */
static const char *field_unit(const char *name)
{
  const struct field_info *whole = catalogue_find(name);
  if (whole)
    return whole->unit;
  const char *end = strrchr(name, '_');
  size_t length = end ? (size_t)(end - name) : 0;
  for (size_t i = 0; length && catalogue_at(i); ++i) {
    const struct field_info *entry = catalogue_at(i);
    if (strlen(entry->name) == length && strncmp(entry->name, name, length) == 0)
      return entry->unit;
  }
  return "1";
}

static const char *quantity_unit(const struct quantity *quantity)
{
  if (quantity->measure && quantity->measure->unit)
    return quantity->measure->unit;
  return quantity->field ? field_unit(quantity->field) : "1";
}

static double samples_until(const struct history *h, double end)
{
  return h->every > 0 ? ceil(end / h->every) + 3 : 3;
}

struct history *history_new(const struct quantity *quantity, double end)
{
  assert(quantity && end >= 0);
  struct history *h = calloc(1, sizeof *h);
  if (!h)
    return NULL;
  h->quantity = quantity;
  h->unit = quantity_unit(quantity);
  h->axis = "time";
  h->axis_unit = "s";
  h->every = quantity->every > 0 ? quantity->every : end / SAMPLES_BY_DEFAULT;
  const struct reduction *reduction = &quantity->reduction;
  bool last_only = reduction->kind == REDUCE_AT && reduction->at_end;
  h->grows = !(end > 0);
  h->every_step =
      (quantity->measure && quantity->measure->against) || (!(h->every > 0) && !last_only);
  h->grows |= h->every_step;
  double samples = samples_until(h, end);
  if (samples < (double)(PTRDIFF_MAX / (ptrdiff_t)sizeof(double))) {
    h->capacity = (size_t)samples;
    h->time = malloc(h->capacity * sizeof *h->time);
    h->value = malloc(h->capacity * sizeof *h->value);
  }
  if (!h->time || !h->value) {
    history_free(h);
    return NULL;
  }
  return h;
}

void history_free(struct history *h)
{
  if (!h)
    return;
  free(h->time);
  free(h->value);
  free(h);
}

static bool reserve(struct history *h, size_t capacity)
{
  double *time = realloc(h->time, capacity * sizeof *time);
  if (time)
    h->time = time;
  double *value = realloc(h->value, capacity * sizeof *value);
  if (value)
    h->value = value;
  if (!time || !value)
    return false;
  h->capacity = capacity;
  return true;
}

static bool grow(struct history *h)
{
  return reserve(h, 2 * h->capacity + 256);
}

bool history_go_on(struct history *h, double end, double every, const double *time,
                   const double *value, size_t count)
{
  h->every = every;
  double samples = samples_until(h, end);
  size_t room = samples < (double)(PTRDIFF_MAX / (ptrdiff_t)sizeof(double)) ? (size_t)samples : 0;
  if (!reserve(h, room > count ? room : count))
    return false;
  memcpy(h->time, time, count * sizeof *time);
  memcpy(h->value, value, count * sizeof *value);
  h->count = count;
  return true;
}

static void sample(struct history *h, double time, double value)
{
  /* A run that goes past its end has no place for more. */
  if (h->count == h->capacity && !h->grows)
    return;
  if (h->count == h->capacity && !grow(h)) {
    h->failed = true;
    return;
  }
  h->time[h->count] = time;
  h->value[h->count] = value;
  ++h->count;
}

void history_tell(struct history *h, double time, double value, bool final)
{
  if (h->every_step) {
    if (!final || !h->has_last)
      sample(h, time, value);
    h->has_last = true;
    return;
  }
  if (!h->has_last) {
    sample(h, time, value);
  } else if (h->every > 0 && time > h->last_time) {
    double slope = (value - h->last_value) / (time - h->last_time);
    double tolerance = same_sample * h->every;
    for (;;) {
      double next = (floor(h->time[h->count - 1] / h->every + 0.5) + 1) * h->every;
      /* the last place is kept for the end */
      if (next > time + (final ? -tolerance : 0) || (h->count + 1 >= h->capacity && !h->grows))
        break;
      sample(h, next, next >= time ? value : h->last_value + slope * (next - h->last_time));
    }
  }
  if (final && h->has_last && time > h->time[h->count - 1])
    sample(h, time, value);
  h->last_time = time;
  h->last_value = value;
  h->has_last = true;
}
