#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/study_private.h"

/* Axes that differ by rounding are one; a share of their length. */
static const double same_axis = 1e-12;
static const double near_end = 1e-9;

/* Units and kinds, from a run that has been made. */
gamut_status measured_plan(struct study *study, const struct gamut_run *run)
{
  size_t count;
  struct history *const *history = run_histories(run, &count);
  study->measured = calloc(count + 1, sizeof *study->measured);
  if (!study->measured)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  study->quantities = count;
  for (size_t i = 0; i < count; i++) {
    struct measured *m = &study->measured[i];
    double unused;
    char why[200];
    m->quantity = &study->scene->quantity[i];
    m->curve = m->quantity->reduction.kind == REDUCE_NONE;
    m->axis = history[i]->axis;
    m->axis_unit = history[i]->axis_unit;
    reduction_value(&m->quantity->reduction, history[i], &unused, m->unit, sizeof m->unit, why,
                    sizeof why);
    m->count = m->curve ? 0 : 1;
  }
  measured_place(study);
  return GAMUT_OK;
}

void measured_place(struct study *study)
{
  study->results = 0;
  for (size_t i = 0; i < study->quantities; i++) {
    study->measured[i].first = study->results;
    study->results += study->measured[i].count;
  }
}

gamut_status measured_axes(struct study *study, const struct gamut_run *run)
{
  size_t count;
  struct history *const *history = run_histories(run, &count);
  for (size_t i = 0; i < study->quantities; i++) {
    struct measured *m = &study->measured[i];
    if (m->curve) {
      m->count = history[i]->count;
      free(m->at);
      m->at = calloc(m->count + 1, sizeof *m->at);
      if (!m->at)
        return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
      memcpy(m->at, history[i]->time, m->count * sizeof *m->at);
    }
  }
  measured_place(study);
  return GAMUT_OK;
}

static bool rising(const double *at, size_t count)
{
  for (size_t i = 1; i < count; i++)
    if (!(at[i] > at[i - 1]))
      return false;
  return true;
}

static bool same(const double *one, const double *other, size_t count)
{
  double length = 0;
  for (size_t i = 0; i < count; i++)
    length = fmax(length, fabs(one[i]));
  for (size_t i = 0; i < count; i++)
    if (!(fabs(one[i] - other[i]) <= same_axis * length))
      return false;
  return true;
}

/* Straight lines between the samples; nothing beyond them. */
static void interpolate(const struct history *h, const double *at, size_t count, double *value)
{
  double slack = near_end * (h->time[h->count - 1] - h->time[0]);
  size_t low = 0;
  for (size_t i = 0; i < count; i++) {
    double x = at[i];
    while (low + 2 < h->count && h->time[low + 1] <= x)
      low++;
    value[i] = NAN;
    if (x < h->time[0] - slack || x > h->time[h->count - 1] + slack)
      continue;
    x = fmin(fmax(x, h->time[0]), h->time[h->count - 1]);
    if (h->count == 1) {
      value[i] = h->value[0];
      continue;
    }
    double share = (x - h->time[low]) / (h->time[low + 1] - h->time[low]);
    value[i] = share >= 1 ? h->value[low + 1]
                          : h->value[low] + share * (h->value[low + 1] - h->value[low]);
  }
}

static void take_curve(const struct measured *m, const struct history *h, double *value)
{
  if (h->count == m->count && same(m->at, h->time, m->count))
    memcpy(value, h->value, m->count * sizeof *value);
  else if (h->count > 0 && rising(h->time, h->count) && rising(m->at, m->count))
    interpolate(h, m->at, m->count, value);
  else
    for (size_t i = 0; i < m->count; i++)
      value[i] = NAN;
}

static bool take_own(const struct history *h, struct own_curve *own)
{
  own->at = calloc(h->count + 1, sizeof *own->at);
  own->value = calloc(h->count + 1, sizeof *own->value);
  if (!own->at || !own->value)
    return false;
  own->count = h->count;
  memcpy(own->at, h->time, h->count * sizeof *own->at);
  memcpy(own->value, h->value, h->count * sizeof *own->value);
  return true;
}

gamut_status measured_take(const struct study *study, const struct gamut_run *run,
                           struct outcome *outcome)
{
  size_t count;
  struct history *const *history = run_histories(run, &count);
  double *result = outcome->result;
  for (size_t i = 0; i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    char unit[64], why[200];
    if (m->curve && study->table) {
      if (!take_own(history[i], &outcome->own[i]))
        return GAMUT_INTERNAL;
    } else if (m->curve) {
      take_curve(m, history[i], result + m->first);
    } else if (!reduction_value(&m->quantity->reduction, history[i], &result[m->first], unit,
                                sizeof unit, why, sizeof why)) {
      result[m->first] = NAN;
    }
  }
  return GAMUT_OK;
}

size_t curve_overlap(const struct study *study, const struct measured *m, size_t *kept)
{
  size_t count = 0;
  for (size_t i = 0; i < m->count; i++) {
    bool whole = true;
    for (size_t r = 0; r < study->runs && whole; r++)
      whole = study->outcome[r].reason || isfinite(study->outcome[r].result[m->first + i]);
    if (whole)
      kept[count++] = i;
  }
  return count;
}
