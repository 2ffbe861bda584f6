#include <math.h>
#include <string.h>

#include "base/array.h"
#include "run/run_private.h"

/* "position 0.001 0.002 0 m, velocity ..., temperature 298 K": the state that the point had. */
static void describe_state(const struct gamut_run *run, const struct point_set *set, size_t slot,
                           char *text, size_t size)
{
  static const char *const shown[] = {"position",       "velocity", "volume_ratio", "stress",
                                      "plastic_strain", "energy",   "temperature"};
  *text = '\0';
  for (size_t f = 0; f < ARRAY_SIZE(shown); f++) {
    const struct field *field = fields_find(run->fields, shown[f]);
    if (!field || !field->stored)
      continue;
    size_t used = strlen(text);
    if (used + 1 < size)
      snprintf(text + used, size - used, "%s%s", used ? "; " : "", field->name);
    for (unsigned k = 0; k < field->handle.components; k++) {
      const double *array = set_stored(set, field->handle, k);
      used = strlen(text);
      if (array && used + 1 < size)
        snprintf(text + used, size - used, " %.6g", array[slot]);
    }
    used = strlen(text);
    if (used + 1 < size && strcmp(field->unit, "1") != 0)
      snprintf(text + used, size - used, " %s", field->unit);
  }
}

/* " C0 3940 m/s": the number that the point has, where it differs from point to point. */
static void describe_value(const struct gamut_run *run, const struct point_set *set, size_t slot,
                           const struct instance *part, const struct value *value, char *text,
                           size_t size)
{
  char path[512];
  const char *unit = value->parameter->unit;
  snprintf(path, sizeof path, "%s.%s", part->values->path, value->parameter->name);
  const struct field *field = fields_find(run->fields, path);
  const double *array = field && field->stored ? set_stored(set, field->handle, 0) : NULL;
  if (value->text)
    snprintf(text, size, " %s %s", value->parameter->name, value->text);
  else
    snprintf(text, size, " %s %.6g%s%s", value->parameter->name, array ? array[slot] : value->real,
             unit && strcmp(unit, "1") != 0 ? " " : "",
             unit && strcmp(unit, "1") != 0 ? unit : "");
}

static bool is_shown(enum value_type type)
{
  return type == VALUE_REAL || type == VALUE_INTEGER || type == VALUE_BOOLEAN ||
         type == VALUE_CHOICE;
}

/* "; eos/mie_gruneisen: C0 3940 m/s, S1 1.489": what the point's material is made of. */
static void describe_parameters(const struct gamut_run *run, const struct point_set *set,
                                size_t slot, char *text, size_t size)
{
  const struct material *material = &run->scene->material[set->material];
  const struct instance *part[] = {&material->elasticity, &material->strength, &material->eos};
  snprintf(text, size, "; density %.6g kg/m3", material->density);
  for (size_t p = 0; p < ARRAY_SIZE(part); p++) {
    const struct values *values = part[p]->descriptor ? part[p]->values : NULL;
    bool any = false;
    for (size_t i = 0; values && i < values->count; i++) {
      const struct value *value = &values->value[i];
      size_t used = strlen(text);
      if (!value->present || !is_shown(value->parameter->type) || used + 1 >= size)
        continue;
      snprintf(text + used, size - used, any ? "," : "; %s:", part[p]->descriptor->id);
      used = strlen(text);
      describe_value(run, set, slot, part[p], value, text + used, size - used);
      any = true;
    }
  }
}

gamut_status start_check(struct gamut_run *run)
{
  const struct field *velocity = fields_find(run->fields, "velocity");
  const struct field *position = fields_find(run->fields, "position");
  if (!velocity || !velocity->stored || !position || !position->stored)
    return GAMUT_OK;
  for (size_t s = 0; s < run->scene->bodies; s++) {
    const struct point_set *set = run->set[s];
    const struct tree *node = tree_get(run->scene->body[s].node, "velocity");
    for (size_t i = 0; i < set->open.slots; i++) {
      double x[3] = {0.0, 0.0, 0.0}, v[3] = {0.0, 0.0, 0.0};
      for (unsigned k = 0; k < 3; k++) {
        const double *place = set_stored(set, position->handle, k);
        const double *speed = set_stored(set, velocity->handle, k);
        x[k] = place && k < position->handle.components ? place[i] : 0.0;
        v[k] = speed && k < velocity->handle.components ? speed[i] : 0.0;
      }
      if (set->id[i] >= 0 && !(isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2])))
        return trace_fail_at(run->trace, GAMUT_SCENE, node ? &node->place : NULL, NULL,
                             "arithmetic that has a value all over the body",
                             "the velocity of body '%s' at (%g, %g, %g) m is (%g, %g, %g) m/s",
                             set->open.body, x[0], x[1], x[2], v[0], v[1], v[2]);
    }
  }
  return GAMUT_OK;
}

static double speed_squared(const struct point_set *set, const struct field *velocity, size_t slot)
{
  double sum = 0.0;
  for (unsigned k = 0; k < velocity->handle.components; k++) {
    const double *v = set_stored(set, velocity->handle, k);
    sum += v ? v[slot] * v[slot] : 0.0;
  }
  return sum;
}

void describe_fastest(const struct gamut_run *run, char *text, size_t size)
{
  const struct field *velocity = fields_find(run->fields, "velocity");
  const struct point_set *worst = NULL;
  size_t slot = 0;
  double most = -1.0;
  *text = '\0';
  for (size_t s = 0; velocity && velocity->stored && s < run->scene->bodies; s++)
    for (size_t i = 0; i < run->set[s]->open.slots; i++) {
      double speed = run->set[s]->id[i] < 0 ? -1.0 : speed_squared(run->set[s], velocity, i);
      if (speed > most || isnan(speed)) {
        most = isnan(speed) ? INFINITY : speed;
        worst = run->set[s];
        slot = i;
      }
    }
  if (!worst)
    return;
  int used = snprintf(text, size, "point %lld of body '%s': ", (long long)worst->id[slot],
                      worst->open.body);
  if (used > 0 && (size_t)used < size)
    describe_state(run, worst, slot, text + used, size - (size_t)used);
}

static gamut_status report(struct gamut_run *run, const struct flag_stop *stop)
{
  char state[768] = "", made[900] = "";
  const struct point_set *set = run->set[stop->set];
  size_t slot = set_find(set, stop->id);
  if (slot != SIZE_MAX) {
    describe_state(run, set, slot, state, sizeof state);
    describe_parameters(run, set, slot, made, sizeof made);
  }
  return trace_fail(run->trace, GAMUT_NUMERICS,
                    "%s stopped the run at t = %.6g s, step %llu: %s. Point %lld of body '%s' "
                    "(material '%s'): %s%s",
                    stop->plugin->id, run->time, (unsigned long long)run->steps,
                    stop->message ? stop->message->text : "a point may not go on",
                    (long long)stop->id, set->open.body, run->scene->material[set->material].name,
                    state, made);
}

gamut_status stop_check(struct gamut_run *run)
{
  struct flag_stop stop;
  for (size_t m = 0; m < run->scene->materials; m++)
    if (run->material[m] && material_stopped(run->material[m], &stop))
      return report(run, &stop);
  for (size_t i = 0; i < run->effects; i++)
    if (run->effect[i].bound && effect_stopped(run->effect[i].bound, &stop))
      return report(run, &stop);
  return GAMUT_OK;
}
