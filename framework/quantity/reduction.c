#include "quantity/quantity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The part of a history inside a window: the samples between its edges, and the edges themselves
 * with interpolated values. Point 0 is the lower edge, point count - 1 the upper one. */
struct window {
  const struct history *history;
  double from, to;
  size_t first, inside, count;
};

static double value_at(const struct history *h, double time)
{
  size_t low = 0, high = h->count - 1;
  if (time <= h->time[0])
    return h->value[0];
  if (time >= h->time[high])
    return h->value[high];
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (h->time[middle] <= time)
      low = middle;
    else
      high = middle;
  }
  double share = (time - h->time[low]) / (h->time[high] - h->time[low]);
  if (share <= 0)
    return h->value[low];
  return h->value[low] + share * (h->value[high] - h->value[low]);
}

static double window_time(const struct window *w, size_t i)
{
  if (i == 0)
    return w->from;
  return i + 1 == w->count ? w->to : w->history->time[w->first + i - 1];
}

static double window_value(const struct window *w, size_t i)
{
  if (i == 0 || i + 1 == w->count)
    return value_at(w->history, window_time(w, i));
  return w->history->value[w->first + i - 1];
}

/* A curve over another measure may go back along it: a loop. Only its last value is one number. */
static bool goes_back(const struct history *h)
{
  for (size_t i = 1; h->every_step && i < h->count; ++i) {
    if (h->time[i] < h->time[i - 1])
      return true;
  }
  return false;
}

static bool window_open(const struct reduction *r, const struct history *h, struct window *w,
                        char *why, size_t size)
{
  if (goes_back(h)) {
    snprintf(why, size, "the curve goes back along its axis, %s", h->axis);
    return false;
  }
  double begin = h->time[0], end = h->time[h->count - 1];
  double tolerance = 1e-9 * (h->every > 0 ? h->every : end - begin);
  *w = (struct window){.history = h, .from = fmax(r->from, begin), .to = fmin(r->to, end)};
  if (r->kind == REDUCE_AT)
    w->from = w->to = r->at_end ? end : r->from;
  if (w->from > w->to || w->to < begin - tolerance || w->from > end + tolerance) {
    snprintf(why, size, "the history covers %g to %g %s only", begin, end, h->axis_unit);
    return false;
  }
  while (w->first < h->count && h->time[w->first] <= w->from + tolerance)
    ++w->first;
  while (w->first + w->inside < h->count && h->time[w->first + w->inside] < w->to - tolerance)
    ++w->inside;
  w->count = w->to - w->from > tolerance ? w->inside + 2 : 1;
  for (size_t i = 0; i < w->count; ++i) {
    if (!isfinite(window_value(w, i))) {
      snprintf(why, size, "the history is not finite at %g %s", window_time(w, i), h->axis_unit);
      return false;
    }
  }
  return true;
}

/* Point with the largest value times `sign`; the first of equals. */
static size_t extreme(const struct window *w, double sign)
{
  size_t best = 0;
  for (size_t i = 1; i < w->count; ++i) {
    if (sign * window_value(w, i) > sign * window_value(w, best))
      best = i;
  }
  return best;
}

static double mean(const struct window *w)
{
  double sum = 0;
  for (size_t i = 1; i < w->count; ++i)
    sum += 0.5 * (window_value(w, i) + window_value(w, i - 1)) *
           (window_time(w, i) - window_time(w, i - 1));
  return w->count > 1 ? sum / (w->to - w->from) : window_value(w, 0);
}

static bool crossing(const struct window *w, double level, double *time)
{
  double before = window_value(w, 0);
  *time = w->from;
  for (size_t i = 1; i < w->count && before != level; ++i) {
    double after = window_value(w, i);
    if ((before < level) == (after < level) && after != level) {
      before = after;
      continue;
    }
    double start = window_time(w, i - 1);
    *time = start + (window_time(w, i) - start) * ((level - before) / (after - before));
    return true;
  }
  return before == level;
}

/* Least squares, from the middle of the window so that no digits are lost. */
static bool slope(const struct window *w, double *result)
{
  double n = (double)w->count, time = 0, value = 0, above = 0, below = 0;
  for (size_t i = 0; i < w->count; ++i) {
    time += window_time(w, i) / n;
    value += window_value(w, i) / n;
  }
  for (size_t i = 0; i < w->count; ++i) {
    double t = window_time(w, i) - time;
    above += t * (window_value(w, i) - value);
    below += t * t;
  }
  *result = above / below;
  return w->count > 1 && below > 0;
}

static void unit_of(const struct reduction *r, const struct history *h, char *unit, size_t size)
{
  const char *axis = h->axis_unit;
  size_t length = strlen(h->unit), tail = strlen(axis) + 1;
  if (r->kind == REDUCE_TIME_OF)
    snprintf(unit, size, "%s", axis);
  else if (r->kind != REDUCE_SLOPE || strcmp(axis, "1") == 0)
    snprintf(unit, size, "%s", h->unit);
  else if (length > tail && h->unit[length - tail] == '/' &&
           strcmp(h->unit + length - tail + 1, axis) == 0)
    snprintf(unit, size, "%s2", h->unit);
  else
    snprintf(unit, size, "%s/%s", h->unit, axis);
}

bool reduction_value(const struct reduction *r, const struct history *h, double *value, char *unit,
                     size_t unit_size, char *why, size_t size)
{
  struct window w;
  unit_of(r, h, unit, unit_size);
  if (h->count == 0) {
    snprintf(why, size, "nothing was recorded");
    return false;
  }
  if (r->kind == REDUCE_AT && r->at_end && h->every_step) {
    *value = h->value[h->count - 1];
    if (!isfinite(*value))
      snprintf(why, size, "the curve is not finite at its end");
    return isfinite(*value);
  }
  if (!window_open(r, h, &w, why, size))
    return false;
  switch (r->kind) {
  case REDUCE_NONE:
    snprintf(why, size, "it is a history");
    return false;
  case REDUCE_AT:
    *value = window_value(&w, 0);
    return true;
  case REDUCE_MAX:
  case REDUCE_MIN:
    *value = window_value(&w, extreme(&w, r->kind == REDUCE_MAX ? 1 : -1));
    return true;
  case REDUCE_MEAN:
    *value = mean(&w);
    return true;
  case REDUCE_TIME_OF:
    if (r->time_of_max)
      *value = window_time(&w, extreme(&w, 1));
    else if (!crossing(&w, r->level, value)) {
      snprintf(why, size, "it never reaches %g %s between %g and %g %s", r->level, h->unit, w.from,
               w.to, h->axis_unit);
      return false;
    }
    return true;
  case REDUCE_SLOPE:
    if (!slope(&w, value)) {
      snprintf(why, size, "the window holds less than two samples");
      return false;
    }
    return true;
  }
  return false;
}
