#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/input_files.h"
#include "study/study_private.h"

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
             isfinite(study->outcome[r].result[m->first]);
  return count;
}

static json_t *interval(double lower, double upper)
{
  return isfinite(lower) && isfinite(upper) ? json_pack("[f, f]", lower, upper) : json_null();
}

/* Keys of moments, of one value and of a curve. */
static const struct {
  const char *one, *many;
} moment_key[] = {{"mean", "means"},
                  {"variance", "variances"},
                  {"mean_error", "mean_errors"},
                  {"variance_error", "variance_errors"}},
  interval_key[] = {{"mean_interval", "mean_intervals"},
                    {"variance_interval", "variance_intervals"}};

struct moment_rows {
  const double *moment[4], *lower[2], *upper[2];
};

static struct moment_rows rows_of(const struct study *study, const struct measured *m)
{
  const struct gamut_moments *all = &study->moments;
  return (struct moment_rows){{all->mean + m->first, all->variance + m->first,
                               all->mean_error + m->first, all->variance_error + m->first},
                              {all->mean_lower + m->first, all->variance_lower + m->first},
                              {all->mean_upper + m->first, all->variance_upper + m->first}};
}

static const char caution[] =
    "the sample has heavy tails (kurtosis %.3g): the variance may lie outside its interval more "
    "often than in 5 %% of such studies";

static void add_caution(json_t *entry, double kurtosis)
{
  char words[sizeof caution + 40];
  if (!(kurtosis > 0))
    return;
  snprintf(words, sizeof words, caution, kurtosis);
  json_object_set_new(entry, "caution", json_string(words));
}

static void add_scalar(const struct study *study, const struct measured *m, json_t *entry)
{
  const struct moment_rows rows = rows_of(study, m);
  size_t count = count_values(study, m);
  for (size_t k = 0; k < 4; k++)
    json_object_set_new(entry, moment_key[k].one, number(rows.moment[k][0]));
  for (size_t k = 0; k < 2; k++)
    json_object_set_new(entry, interval_key[k].one, interval(rows.lower[k][0], rows.upper[k][0]));
  json_object_set_new(entry, "runs", json_integer((json_int_t)count));
  if (count == 0)
    json_object_set_new(entry, "reason", json_string("no run gave a value"));
  else if (count < study->runs)
    json_object_set_new(entry, "conditional",
                        json_sprintf("%zu of %zu runs gave no value: these are statistics of the "
                                     "rest",
                                     study->runs - count, study->runs));
  add_caution(entry, study->moments.heavy_tail[m->first]);
}

static json_t *picked_intervals(const double *lower, const double *upper, const size_t *index,
                                size_t count)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(list, interval(lower[index[i]], upper[index[i]]));
  return list;
}

/* The largest kurtosis that was doubted along a curve; 0: none. */
static double doubted(const double *kurtosis, const size_t *index, size_t count)
{
  double most = 0;
  for (size_t i = 0; i < count; i++)
    most = kurtosis[index[i]] > most ? kurtosis[index[i]] : most;
  return most;
}

static void add_curve(const struct study *study, const struct measured *m, json_t *entry)
{
  const struct moment_rows rows = rows_of(study, m);
  bool time = strcmp(m->axis, "time") == 0;
  size_t *kept = calloc(m->count + 1, sizeof *kept);
  size_t count = kept ? curve_overlap(study, m, kept) : 0;
  if (!time)
    json_object_set_new(entry, "axis", json_string(m->axis));
  json_object_set_new(entry, time ? "times" : m->axis, picked(m->at, kept, count));
  for (size_t k = 0; k < 4; k++)
    json_object_set_new(entry, moment_key[k].many, picked(rows.moment[k], kept, count));
  for (size_t k = 0; k < 2; k++)
    json_object_set_new(entry, interval_key[k].many,
                        picked_intervals(rows.lower[k], rows.upper[k], kept, count));
  if (count == 0)
    json_object_set_new(entry, "reason",
                        json_sprintf("the runs share no part of the axis '%s', or it goes back and "
                                     "forth",
                                     m->axis));
  else if (count < m->count)
    json_object_set_new(entry, "reason",
                        json_sprintf("%zu of %zu points of the axis are not in every run",
                                     m->count - count, m->count));
  add_caution(entry, doubted(study->moments.heavy_tail + m->first, kept, count));
  free(kept);
}

/* Runs that are no sample have no moments. */
static void add_none(const struct measured *m, json_t *entry)
{
  for (size_t k = 0; k < 4; k++)
    json_object_set_new(entry, m->curve ? moment_key[k].many : moment_key[k].one, json_null());
  for (size_t k = 0; k < 2; k++)
    json_object_set_new(entry, m->curve ? interval_key[k].many : interval_key[k].one, json_null());
  json_object_set_new(entry, "reason",
                      json_string("the runs are no sample: study.levels has their values"));
}

static json_t *quantities_json(const struct study *study, gamut_status status)
{
  json_t *all = json_object();
  for (size_t i = 0; i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    json_t *entry = json_pack("{s:s}", "unit", m->unit);
    if (study->table)
      add_none(m, entry);
    else if (status != GAMUT_OK)
      json_object_set_new(entry, "reason",
                          json_string(status == GAMUT_NUMERICS ? "too many runs failed"
                                                               : "the study is not at its end"));
    else if (m->curve)
      add_curve(study, m, entry);
    else
      add_scalar(study, m, entry);
    json_t *estimates = status == GAMUT_OK ? report_estimates_json(study, i) : NULL;
    if (estimates)
      json_object_set_new(entry, "estimates", estimates);
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
    if (o->level != level || !o->done || o->reason || !isfinite(o->result[m->first]))
      continue;
    sum += o->result[m->first];
    count += 1;
  }
  return sum / count;
}

static json_t *numbers(const double *value, size_t count)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(list, number(value[i]));
  return list;
}

/* {"times": [...], "values": [...]}, as a single run's. */
static json_t *own_json(const struct measured *m, const struct own_curve *own)
{
  bool time = strcmp(m->axis, "time") == 0;
  json_t *entry = json_object();
  if (!time)
    json_object_set_new(entry, "axis", json_string(m->axis));
  json_object_set_new(entry, time ? "times" : m->axis, numbers(own->at, own->count));
  json_object_set_new(entry, "values", numbers(own->value, own->count));
  return entry;
}

static const struct outcome *run_of_level(const struct study *study, size_t level)
{
  for (size_t r = 0; r < study->runs; r++)
    if (study->outcome[r].level == level && study->outcome[r].done)
      return &study->outcome[r];
  return NULL;
}

static json_t *level_values(const struct study *study, size_t level, const struct outcome *run)
{
  json_t *values = json_object();
  for (size_t k = 0; k < study->quantities; k++) {
    const struct measured *m = &study->measured[k];
    json_t *value = NULL;
    if (!m->curve)
      value = number(level_mean(study, m, level));
    else if (study->table)
      value = run && !run->reason ? own_json(m, &run->own[k]) : json_null();
    if (value)
      json_object_set_new(values, m->quantity->name, value);
  }
  return values;
}

/* The run at the means of a level, beside the statistics. */
static json_t *nominal_json(const struct study *study, size_t level)
{
  const struct outcome *nominal = &study->nominal[level].outcome;
  json_t *entry = json_object(), *values = json_object();
  json_object_set_new(entry, "status", json_string(nominal->reason ? "failed" : "ok"));
  if (nominal->reason)
    json_object_set_new(entry, "reason", json_string(nominal->reason));
  json_object_set_new(entry, "steps", json_integer((json_int_t)nominal->steps));
  if (study->nominal[level].steps.count > 0)
    json_object_set_new(entry, "common_steps",
                        json_integer((json_int_t)study->nominal[level].steps.count));
  for (size_t k = 0; k < study->quantities; k++)
    if (!study->measured[k].curve)
      json_object_set_new(values, study->measured[k].quantity->name,
                          number(nominal->result[study->measured[k].first]));
  json_object_set_new(entry, "quantities", values);
  return entry;
}

/* [{"set": {"solver.cell": "0.4 mm"}, "label": "cell: 0.4 mm", "status": "ok",
 *   "quantities": {"length": 0.0162, "pressure": {"times": [..], "values": [..]}}}], SI. */
static json_t *levels_json(const struct study *study)
{
  json_t *all = json_array();
  for (size_t i = 0; i < study->levels; i++) {
    const struct outcome *run = run_of_level(study, i);
    char *label = level_label(study, i);
    json_t *set = json_object(), *level = json_object();
    for (size_t k = 0; k < study->varies; k++) {
      char *text = level_text(study, i, k);
      json_object_set_new(set, study->varied[k], json_string(text ? text : ""));
      free(text);
    }
    json_object_set_new(level, "set", set);
    json_object_set_new(level, "label", json_string(label ? label : ""));
    if (study->table)
      json_object_set_new(level, "status",
                          json_string(!run          ? "not run"
                                      : run->reason ? "failed"
                                                    : "ok"));
    if (study->table && run && run->reason)
      json_object_set_new(level, "reason", json_string(run->reason));
    json_object_set_new(level, "quantities", level_values(study, i, run));
    if (study->nominal && study->nominal[i].outcome.done)
      json_object_set_new(level, "nominal", nominal_json(study, i));
    json_array_append_new(all, level);
    free(label);
  }
  return all;
}

/* What was cut off, and how often a run was drawn again for it. */
static json_t *truncation_json(const struct study *study)
{
  json_t *all = json_array();
  size_t again = 0;
  for (size_t r = 0; r < study->runs; r++)
    again += study->outcome[r].again;
  for (size_t i = 0; i < study->cuts; i++) {
    const struct cut *cut = &study->cut[i];
    json_t *entry = json_object();
    json_object_set_new(entry, "parameter", json_string(cut->parameter->path));
    if (cut->constraint[0]) {
      json_object_set_new(entry, "constraint", json_string(cut->constraint));
      json_object_set_new(entry, "runs_drawn_again", json_integer((json_int_t)again));
    }
    json_object_set_new(entry, "cut_off", number(cut->share));
    json_array_append_new(all, entry);
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
    work += o->done ? o->work : 0;
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
  json_object_set_new(entry, "yields", json_string(study->table ? "table" : "moments"));
  json_object_set_new(entry, "parameters", parameters_json(study));
  json_object_set_new(entry, "asked", json_integer((json_int_t)study->runs));
  json_object_set_new(entry, "done", json_integer((json_int_t)(study->finished - study->failed)));
  json_object_set_new(entry, "failed", json_integer((json_int_t)study->failed));
  json_object_set_new(entry, "reasons", reasons_json(study));
  if (study->failed && status == GAMUT_OK && !study->table)
    json_object_set_new(entry, "note",
                        json_string("conditional: the moments are those of the runs that did not "
                                    "fail"));
  if (study->nominal && study->nominal[0].outcome.done)
    json_object_set_new(entry, "nominal", nominal_json(study, 0));
  if (study->cuts)
    json_object_set_new(entry, "truncation", truncation_json(study));
  if (study->levels)
    json_object_set_new(entry, "levels", levels_json(study));
  json_t *tables = status == GAMUT_OK ? report_tables_json(study) : NULL;
  if (tables)
    json_object_set_new(entry, "tables", tables);
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
  json_object_set_new(root, "input_files", input_files_json(scene));
  json_object_set_new(root, "quantities", quantities_json(study, status));
  json_object_set_new(root, "study", study_json(study, status));
  json_object_set_new(root, "cost", cost_json(study));
  char *text = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
  json_decref(root);
  return text;
}
