#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "registry/guard.h"
#include "run/host.h"

static struct running_effect *effect_called(struct gamut_run *run, const char *name)
{
  for (size_t i = 0; i < run->effects; i++)
    if (strcmp(run->effect[i].effect->instance.name, name) == 0)
      return &run->effect[i];
  return NULL;
}

static bool from_points(const struct quantity *quantity)
{
  return quantity->field || (quantity->measure && quantity->measure->at == MEASURE_POINT);
}

/* Many points with many samples each must not take all memory. */
static const double samples_most_in_all = 1e8;

static gamut_status check_samples(struct gamut_run *run, const struct quantity *quantity,
                                  double *in_all)
{
  const double samples = quantity->every > 0.0 ? run->end / quantity->every : 0.0;
  const struct place *place = quantity->node ? &quantity->node->place : NULL;
  const char *name = quantity->family ? quantity->family : quantity->name;
  *in_all += samples;
  if (*in_all > samples_most_in_all)
    return trace_fail_at(run->trace, GAMUT_SCENE, place, name, "fewer points or a longer `every`",
                         "with quantity '%s' there would be more than %g samples", name,
                         samples_most_in_all);
  return GAMUT_OK;
}

static gamut_status create_probe(struct gamut_run *run, struct probe *probe,
                                 const struct quantity *quantity, double *samples)
{
  gamut_status status = GAMUT_OK;
  char why[160];
  const struct descriptor *solver = run->scene->solver.descriptor;
  probe->quantity = quantity;
  probe->formula.plain = SIZE_MAX;
  probe->derived.plain = SIZE_MAX;
  probe->id = -1;
  TRY(check_samples(run, quantity, samples));
  probe->history = history_new(quantity, run->end);
  if (!probe->history)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  if (solver->axis) {
    probe->history->axis = solver->axis;
    probe->history->axis_unit = solver->axis_unit;
  }
  const struct measure *axis = quantity->measure ? quantity->measure->against : NULL;
  if (axis) {
    probe->history->axis = axis->name;
    probe->history->axis_unit = axis->unit;
  }
  snprintf(why, sizeof why, "quantity '%s'",
           quantity->family ? quantity->family : quantity->name);
  TRY(wants_of_arguments(run, quantity, why, &probe->derived));
  if (from_points(quantity)) {
    if (!quantity->field && quantity->measure && quantity->measure->formula)
      TRY(formula_new(run, quantity->measure, &probe->formula));
    else
      TRY(formula_plain(run, quantity->field ? quantity->field : quantity->measure->name,
                        &probe->formula));
    formula_want(&probe->formula, run, quantity->body >= 0 ? (size_t)quantity->body : SIZE_MAX, why,
                 quantity->node ? &quantity->node->place : NULL);
  } else if (quantity->effect) {
    probe->effect = effect_called(run, quantity->effect);
    if (!probe->effect)
      status =
          trace_fail_at(run->trace, GAMUT_SCENE, quantity->node ? &quantity->node->place : NULL,
                        quantity->name, "turn the effect on or leave the quantity out",
                        "quantity '%s' is measured by the effect '%s', which is off",
                        quantity->name, quantity->effect);
  }
done:
  return status;
}

gamut_status observe_create(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  size_t count = run->scene->quantities;
  double samples = 0.0;
  run->probe = calloc(count + 1, sizeof *run->probe);
  run->history = calloc(count + 1, sizeof(*run->history));
  run->follower = calloc(count + 1, sizeof(*run->follower));
  if (!run->probe || !run->history || !run->follower)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < count; i++) {
    run->probes = i + 1;
    TRY(create_probe(run, &run->probe[i], &run->scene->quantity[i], &samples));
    run->history[i] = run->probe[i].history;
  }
done:
  return status;
}

void observe_free(struct gamut_run *run)
{
  for (size_t i = 0; i < run->probes; i++) {
    history_free(run->probe[i].history);
    formula_free(&run->probe[i].formula);
    formula_free(&run->probe[i].derived);
  }
  free(run->probe);
  free(run->history);
  free(run->follower);
}

/* Where the points of a set are. */
struct whereabouts {
  const double *x[3];
};

static struct whereabouts places_of(const struct gamut_run *run, const struct point_set *set)
{
  struct whereabouts places = {{NULL, NULL, NULL}};
  const struct field *position = fields_find(run->fields, "position");
  for (unsigned k = 0; position && k < 3; k++)
    places.x[k] = set_stored(set, position->handle, k);
  return places;
}

static double distance_squared(const struct whereabouts *places, size_t slot, const double point[3])
{
  double sum = 0.0;
  for (unsigned k = 0; k < 3; k++) {
    double d = places->x[k] ? places->x[k][slot] - point[k] : 0.0;
    sum += d * d;
  }
  return sum;
}

/* The body's point nearest to the place at the start; of equally near ones the lowest id. */
static void find_point(const struct gamut_run *run, struct probe *probe)
{
  const struct point_set *set = run->set[probe->quantity->body];
  const struct whereabouts places = places_of(run, set);
  double best = INFINITY;
  for (size_t slot = 0; slot < set->open.slots; slot++) {
    if (set->id[slot] < 0)
      continue;
    double d = distance_squared(&places, slot, probe->quantity->point);
    if (d < best || (d == best && set->id[slot] < probe->id)) {
      best = d;
      probe->id = set->id[slot];
      probe->slot = slot;
    }
  }
  probe->distance = sqrt(best);
  for (unsigned k = 0; k < 3 && probe->id >= 0; k++)
    probe->history->place[k] = places.x[k] ? places.x[k][probe->slot] : 0.0;
}

static int by_point(const void *one, const void *other)
{
  const struct probe *a = *(struct probe *const *)one, *b = *(struct probe *const *)other;
  if (a->quantity->body != b->quantity->body)
    return a->quantity->body < b->quantity->body ? -1 : 1;
  return (a->id > b->id) - (a->id < b->id);
}

/* Finds all points of a body that are followed, in one pass over its slots. */
static void find_again(struct gamut_run *run, int body)
{
  const struct point_set *set = run->set[body];
  const size_t count = run->followers;
  for (size_t i = 0; i < count; i++)
    if (run->follower[i]->quantity->body == body)
      run->follower[i]->slot = SIZE_MAX;
  for (size_t slot = 0; slot < set->open.slots; slot++) {
    size_t low = 0, high = set->id[slot] < 0 ? 0 : count;
    while (low < high) {
      const struct probe *middle = run->follower[(low + high) / 2];
      if (middle->quantity->body < body ||
          (middle->quantity->body == body && middle->id < set->id[slot]))
        low = (low + high) / 2 + 1;
      else
        high = (low + high) / 2;
    }
    while (low < count && run->follower[low]->quantity->body == body &&
           run->follower[low]->id == set->id[slot])
      run->follower[low++]->slot = slot;
  }
}

static double at_material_point(struct gamut_run *run, struct probe *probe)
{
  const struct point_set *set = run->set[probe->quantity->body];
  if (probe->slot >= set->open.slots || set->id[probe->slot] != probe->id)
    find_again(run, probe->quantity->body);
  return probe->slot == SIZE_MAX ? NAN : formula_value(&probe->formula, run, set, probe->slot);
}

/* Mean over the body's points within one cell of the place. */
static double at_place(const struct gamut_run *run, struct probe *probe)
{
  const struct point_set *set = run->set[probe->quantity->body];
  const struct whereabouts places = places_of(run, set);
  const struct field *cell = fields_find(run->fields, "cell_size");
  double reach = cell && run->uniform[cell->handle.first] ? *run->uniform[cell->handle.first] : 0.0;
  double sum = 0.0, count = 0.0;
  for (size_t slot = 0; slot < set->open.slots; slot++)
    if (set->id[slot] >= 0 &&
        distance_squared(&places, slot, probe->quantity->point) <= reach * reach) {
      sum += formula_value(&probe->formula, run, set, slot);
      count += 1.0;
    }
  return count > 0.0 ? sum / count : NAN;
}

/* Who gives a measure: an effect, or null for the solver. */
static const char *provider_id(const struct gamut_run *run, const struct running_effect *effect)
{
  return effect ? effect->effect->instance.descriptor->id : run->scene->solver.descriptor->id;
}

static gamut_status call_measure(struct gamut_run *run, const struct running_effect *effect,
                                 const char *name, const struct gamut_body *body,
                                 const struct values *arguments, double *value)
{
  gamut_status (*measure)(void *, const char *, const struct gamut_body *,
                          const struct gamut_values *, double *) =
      effect ? effect->ops->measure : run->solver->measure;
  if (!measure)
    return trace_fail(run->trace, GAMUT_PLUGIN,
                      "the measure '%s' is declared, but its plugin has no operation `measure`",
                      name);
  return GUARDED(provider_id(run, effect),
                 measure(effect ? effect->self : run->solver_self, name, body, arguments, value));
}

gamut_status run_measure(struct gamut_run *run, const struct descriptor *plugin, const char *name,
                         struct values *arguments, double *value, struct trace *trace)
{
  const struct running_effect *effect = NULL;
  run->trace = trace;
  for (size_t i = 0; i < run->effects && plugin != run->scene->solver.descriptor; i++)
    if (run->effect[i].effect->instance.descriptor == plugin && run->effect[i].created)
      effect = &run->effect[i];
  if (!effect && plugin != run->scene->solver.descriptor)
    return trace_fail(trace, GAMUT_SCENE, "%s is not in this run", plugin->id);
  host_of_values(arguments, &run_host);
  return call_measure(run, effect, name, run->scene->bodies ? &run->scene->body[0] : NULL,
                      arguments, value);
}

static gamut_status probe_value(struct gamut_run *run, struct probe *probe,
                                const struct measure *measure, double *value)
{
  const struct quantity *q = probe->quantity;
  if (from_points(q)) {
    *value = q->follow_space ? at_place(run, probe) : at_material_point(run, probe);
    return GAMUT_OK;
  }
  const struct gamut_body *body = q->body >= 0 ? &run->scene->body[q->body] : NULL;
  run->measuring = q;
  run->measured = probe;
  gamut_status status = call_measure(run, probe->effect, measure->name, body, q->arguments, value);
  run->measuring = NULL;
  run->measured = NULL;
  if (status == GAMUT_PLUGIN && trace_errors(run->trace) == 0)
    trace_fail(run->trace, GAMUT_PLUGIN, "%s declares the measure '%s' and does not know it",
               provider_id(run, probe->effect), measure->name);
  return status;
}

/* A point that leaves the run takes its history along: the last sample is the last value known. */
static bool has_left(struct gamut_run *run, struct probe *probe)
{
  const struct quantity *q = probe->quantity;
  struct history *history = probe->history;
  const struct point_set *set = q->body >= 0 ? run->set[q->body] : NULL;
  if (!from_points(q) || q->follow_space || !q->has_point || probe->left)
    return probe->left;
  if (probe->slot < set->open.slots && set->id[probe->slot] == probe->id)
    return false;
  find_again(run, q->body);
  probe->left = probe->slot == SIZE_MAX;
  if (!probe->left)
    return false;
  history_tell(history, history->last_time, history->last_value, true);
  trace_warn_at(run->trace, q->node ? &q->node->place : NULL, q->name, NULL,
                "quantity '%s' follows point %lld of body '%s', which left the run before t = %.6g "
                "%s: its history ends there",
                q->name, (long long)probe->id, set->open.body, run->time, history->axis_unit);
  return true;
}

static gamut_status tell(struct gamut_run *run, struct probe *probe, bool final)
{
  gamut_status status;
  if (has_left(run, probe))
    return GAMUT_OK;
  double value = NAN, at = run->time;
  const struct measure *measure = probe->quantity->measure;
  TRY(probe_value(run, probe, measure, &value));
  if (measure && measure->against)
    TRY(probe_value(run, probe, measure->against, &at));
  history_tell(probe->history, at, value, final);
  if (probe->history->failed)
    status = trace_fail(run->trace, GAMUT_INTERNAL, "out of memory for the curve '%s'",
                        probe->quantity->name);
done:
  return status;
}

gamut_status observe_start(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  run->followers = 0;
  for (size_t i = 0; i < run->probes; i++) {
    struct probe *probe = &run->probe[i];
    const struct quantity *q = probe->quantity;
    if (!from_points(q))
      continue;
    probe->history->placed = q->has_point;
    memcpy(probe->history->place, q->point, sizeof probe->history->place);
    if (q->follow_space)
      continue;
    find_point(run, probe);
    run->follower[run->followers++] = probe;
  }
  qsort(run->follower, run->followers, sizeof(*run->follower), by_point);
  for (size_t i = 0; i < run->probes; i++)
    TRY(tell(run, &run->probe[i], false));
done:
  return status;
}

/* Samples lie at multiples of `every`; rounding may put one a hair beyond the step's end. */
static bool sample_within(const struct history *history, double until)
{
  if (history->every_step || !(history->every > 0.0))
    return history->every_step;
  return until * (1.0 + 1e-9) >= (double)history->count * history->every;
}

gamut_status observe_before(struct gamut_run *run, double step, bool *due)
{
  gamut_status status = GAMUT_OK;
  *due = false;
  for (size_t i = 0; i < run->probes; i++) {
    struct history *history = run->probe[i].history;
    if (!sample_within(history, run->time + step))
      continue;
    *due = true;
    if (history->every_step)
      continue;
    if (!history->has_last || history->last_time < run->time)
      TRY(tell(run, &run->probe[i], false));
  }
done:
  return status;
}

gamut_status observe_after(struct gamut_run *run, bool due, bool final)
{
  gamut_status status = GAMUT_OK;
  if (!due && !final)
    return GAMUT_OK;
  for (size_t i = 0; i < run->probes; i++)
    if (final || sample_within(run->probe[i].history, run->time))
      TRY(tell(run, &run->probe[i], final));
done:
  return status;
}
