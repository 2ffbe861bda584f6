#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/inside.h"

/* JSON has neither NaN nor infinity: such a number is null. */
static json_t *number(double value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

static json_t *picked(const double *value, const size_t *index, size_t count)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(list, number(value[index[i]]));
  return list;
}

/* Runs that gave a value. */
static size_t count_values(const struct study *study, const struct measured *m)
{
  size_t count = 0;
  for (size_t r = 0; r < study->runs; r++)
    count += study->outcome[r].done && !study->outcome[r].reason &&
             isfinite(study->outcome[r].value[m->first]);
  return count;
}

static void add_scalar(const struct study *study, const struct measured *m, json_t *entry)
{
  const struct gamut_moments *moments = &study->moments;
  size_t count = count_values(study, m);
  json_object_set_new(entry, "mean", number(moments->mean[m->first]));
  json_object_set_new(entry, "variance", number(moments->variance[m->first]));
  json_object_set_new(entry, "mean_error", number(moments->mean_error[m->first]));
  json_object_set_new(entry, "variance_error", number(moments->variance_error[m->first]));
  json_object_set_new(entry, "runs", json_integer((json_int_t)count));
  if (count == 0)
    json_object_set_new(entry, "reason", json_string("no run gave a value"));
}

static void add_curve(const struct study *study, const struct measured *m, json_t *entry)
{
  const struct gamut_moments *moments = &study->moments;
  bool time = strcmp(m->axis, "time") == 0;
  size_t *kept = calloc(m->count + 1, sizeof *kept);
  size_t count = kept ? curve_overlap(study, m, kept) : 0;
  if (!time)
    json_object_set_new(entry, "axis", json_string(m->axis));
  json_object_set_new(entry, time ? "times" : m->axis, picked(m->at, kept, count));
  json_object_set_new(entry, "means", picked(moments->mean + m->first, kept, count));
  json_object_set_new(entry, "variances", picked(moments->variance + m->first, kept, count));
  json_object_set_new(entry, "mean_errors", picked(moments->mean_error + m->first, kept, count));
  json_object_set_new(entry, "variance_errors",
                      picked(moments->variance_error + m->first, kept, count));
  if (count == 0)
    json_object_set_new(entry, "reason",
                        json_sprintf("the runs share no part of the axis '%s', or it goes back and "
                                     "forth",
                                     m->axis));
  else if (count < m->count)
    json_object_set_new(entry, "reason",
                        json_sprintf("%zu of %zu points of the axis are not in every run",
                                     m->count - count, m->count));
  free(kept);
}

static json_t *quantities_json(const struct study *study, gamut_status status)
{
  json_t *all = json_object();
  for (size_t i = 0; i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    json_t *entry = json_pack("{s:s}", "unit", m->unit);
    if (status != GAMUT_OK)
      json_object_set_new(entry, "reason",
                          json_string(status == GAMUT_NUMERICS ? "too many runs failed"
                                                               : "the study is not at its end"));
    else if (m->curve)
      add_curve(study, m, entry);
    else
      add_scalar(study, m, entry);
    json_object_set_new(all, m->quantity->name, entry);
  }
  return all;
}

static json_t *plugins_json(const struct registry *registry)
{
  json_t *all = json_array();
  for (size_t i = 0; i < registry_count(registry); i++) {
    const struct descriptor *d = registry_at(registry, i);
    const char *level = registry_level(registry, d);
    if (registry_is_open(registry, d))
      json_array_append_new(all,
                            json_pack("{s:s, s:s, s:s, s:s}", "id", d->id, "version", d->version,
                                      "digest", d->digest, "level", level ? level : "baseline"));
  }
  return all;
}

/* [{"reason": ..., "runs": [3, 17]}], in the order of the first of each. */
static json_t *reasons_json(const struct study *study)
{
  json_t *all = json_array();
  for (size_t r = 0; r < study->runs; r++) {
    const char *reason = study->outcome[r].reason;
    json_t *entry = NULL, *one;
    size_t index;
    if (!reason)
      continue;
    json_array_foreach(all, index, one)
    {
      if (strcmp(json_string_value(json_object_get(one, "reason")), reason) == 0)
        entry = one;
    }
    if (!entry) {
      entry = json_pack("{s:s, s:[]}", "reason", reason, "runs");
      json_array_append_new(all, entry);
    }
    json_array_append_new(json_object_get(entry, "runs"), json_integer((json_int_t)r));
  }
  return all;
}

/* Mean of a scalar over the runs of one level. */
static double level_mean(const struct study *study, const struct measured *m, size_t level)
{
  double sum = 0, count = 0;
  for (size_t r = 0; r < study->runs; r++) {
    const struct outcome *o = &study->outcome[r];
    if (o->level != level || !o->done || o->reason || !isfinite(o->value[m->first]))
      continue;
    sum += o->value[m->first];
    count += 1;
  }
  return sum / count;
}

/* [{"set": {"solver.cell": "0.4 mm"}, "quantities": {"length": 0.0162}}], SI. */
static json_t *levels_json(const struct study *study)
{
  json_t *all = json_array();
  for (size_t i = 0; i < study->levels; i++) {
    json_t *set = json_object(), *values = json_object();
    for (size_t k = 0; k < study->varies; k++) {
      char *text = level_text(study, i, k);
      json_object_set_new(set, study->varied[k], json_string(text ? text : ""));
      free(text);
    }
    for (size_t k = 0; k < study->quantities; k++)
      if (!study->measured[k].curve)
        json_object_set_new(values, study->measured[k].quantity->name,
                            number(level_mean(study, &study->measured[k], i)));
    json_array_append_new(all, json_pack("{s:o, s:o}", "set", set, "quantities", values));
  }
  return all;
}

static json_t *parameters_json(const struct study *study)
{
  json_t *all = json_array();
  for (size_t i = 0; i < study->parameters; i++)
    json_array_append_new(all, json_string(study->scene->random_parameter[i].path));
  return all;
}

static json_t *cost_json(const struct study *study)
{
  double wall = 0, cpu = 0, steps = 0, work = 0;
  for (size_t r = 0; r < study->runs; r++) {
    const struct outcome *o = &study->outcome[r];
    wall += o->done ? o->wall : 0;
    cpu += o->done ? o->cpu : 0;
    steps += o->done ? (double)o->steps : 0;
    work += o->done ? (double)o->steps * (double)o->points : 0;
  }
  json_t *entry = json_object();
  json_object_set_new(entry, "runs", json_integer((json_int_t)study->finished));
  json_object_set_new(entry, "from_log", json_integer((json_int_t)study->repeated));
  json_object_set_new(entry, "threads", json_integer(study->threads));
  json_object_set_new(entry, "wall_s", number(study->wall));
  json_object_set_new(entry, "run_s", number(wall));
  json_object_set_new(entry, "cpu_s", number(cpu));
  json_object_set_new(entry, "steps", number(steps));
  json_object_set_new(entry, "point_steps", number(work));
  return entry;
}

static json_t *study_json(const struct study *study, gamut_status status)
{
  json_t *entry = json_object();
  json_object_set_new(entry, "estimator", json_string(study->scene->estimator.descriptor->name));
  json_object_set_new(entry, "parameters", parameters_json(study));
  json_object_set_new(entry, "asked", json_integer((json_int_t)study->runs));
  json_object_set_new(entry, "done", json_integer((json_int_t)(study->finished - study->failed)));
  json_object_set_new(entry, "failed", json_integer((json_int_t)study->failed));
  json_object_set_new(entry, "reasons", reasons_json(study));
  if (study->failed && status == GAMUT_OK)
    json_object_set_new(entry, "note",
                        json_string("the moments are those of the runs that did not fail"));
  if (study->levels)
    json_object_set_new(entry, "levels", levels_json(study));
  json_object_set_new(entry, "cost", cost_json(study));
  return entry;
}

char *study_summary(const struct study *study, gamut_status status)
{
  const struct scene *scene = study->scene;
  const char *ending = status == GAMUT_OK        ? "done"
                       : status == GAMUT_STOPPED ? "interrupted"
                                                 : "failed";
  json_t *root = json_object();
  json_object_set_new(root, "gamut", json_string(GAMUT_VERSION));
  json_object_set_new(root, "scene", json_string(scene->file));
  json_object_set_new(root, "title", json_string(scene->title ? scene->title : ""));
  json_object_set_new(root, "solver", json_string(scene->solver.descriptor->name));
  json_object_set_new(root, "status", json_string(ending));
  json_object_set_new(root, "seed", json_integer((json_int_t)scene->seed));
  json_object_set_new(root, "plugins", plugins_json(study->registry));
  json_object_set_new(root, "quantities", quantities_json(study, status));
  json_object_set_new(root, "study", study_json(study, status));
  json_object_set_new(root, "cost", cost_json(study));
  char *text = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
  json_decref(root);
  return text;
}
