#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_private.h"
#include "scene/input_files.h"

/* JSON has no NaN: such a number is null. */
static json_t *number(double value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

static json_t *numbers(const double *value, size_t count)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(list, number(value[i]));
  return list;
}

static json_t *quantity_json(const struct probe *probe)
{
  const struct history *h = probe->history;
  json_t *entry = json_object();
  char unit[64], why[200];
  double value;
  if (probe->quantity->reduction.kind != REDUCE_NONE) {
    bool has = reduction_value(&probe->quantity->reduction, h, &value, unit, sizeof unit, why,
                               sizeof why);
    json_object_set_new(entry, "unit", json_string(has ? unit : h->unit));
    json_object_set_new(entry, "value", has ? number(value) : json_null());
    if (!has)
      json_object_set_new(entry, "reason", json_string(why));
  } else {
    bool time = strcmp(h->axis, "time") == 0;
    json_object_set_new(entry, "unit", json_string(h->unit));
    if (!time)
      json_object_set_new(entry, "axis", json_string(h->axis));
    json_object_set_new(entry, time ? "times" : h->axis, numbers(h->time, h->count));
    json_object_set_new(entry, "values", numbers(h->value, h->count));
  }
  if (h->placed)
    json_object_set_new(entry, "place", numbers(h->place, 3));
  if (h->placed && probe->id >= 0) {
    json_object_set_new(entry, "point", json_integer(probe->id));
    json_object_set_new(entry, "distance", number(probe->distance));
  }
  return entry;
}

static json_t *quantities_json(const struct gamut_run *run)
{
  json_t *all = json_object();
  for (size_t i = 0; i < run->probes; i++)
    json_object_set_new(all, run->probe[i].quantity->name, quantity_json(&run->probe[i]));
  return all;
}

static json_t *plugins_json(const struct registry *registry)
{
  json_t *all = json_array();
  for (size_t i = 0; i < registry_count(registry); i++) {
    const struct descriptor *d = registry_at(registry, i);
    if (!registry_is_open(registry, d))
      continue;
    const char *level = registry_level(registry, d);
    json_array_append_new(all, json_pack("{s:s, s:s, s:s, s:s}", "id", d->id, "version",
                                         d->version, "digest", d->digest, "level",
                                         level ? level : "baseline"));
  }
  return all;
}

static json_t *account_json(const struct gamut_run *run, const char *account)
{
  static const char *const role[] = {"stored", "supplied", "lost"};
  json_t *entry = json_object(), *lines = json_object();
  double scale, residual = run_ledger_residual(run, account, &scale);
  for (size_t i = 0; i < run->lines; i++) {
    const struct ledger_line *line = &run->ledger[i];
    if (strcmp(line->account, account) != 0)
      continue;
    json_t *one = json_object();
    json_object_set_new(one, "role", json_string(role[line->role]));
    json_object_set_new(one, "unit", json_string(line->unit));
    json_object_set_new(one, "start", number(line->start));
    json_object_set_new(one, "value", number(line->value));
    json_object_set_new(lines, line->name, one);
  }
  json_object_set_new(entry, "lines", lines);
  json_object_set_new(entry, "residual", number(residual));
  json_object_set_new(entry, "scale", number(scale));
  json_object_set_new(entry, "relative_residual", number(scale > 0.0 ? residual / scale : 0.0));
  return entry;
}

static json_t *ledger_json(const struct gamut_run *run)
{
  json_t *all = json_object();
  for (size_t i = 0; i < run->lines; i++)
    if (!json_object_get(all, run->ledger[i].account))
      json_object_set_new(all, run->ledger[i].account,
                          account_json(run, run->ledger[i].account));
  return all;
}

static void add_flag(void *all, const struct flag_report *report)
{
  static const char *const severity[] = {"fine", "note", "warn", "stop"};
  json_array_append_new(
      all, json_pack("{s:s, s:s, s:s, s:s, s:I}", "plugin", report->plugin->id, "message",
                     report->message->name, "severity", severity[report->message->severity],
                     "text", report->message->text, "count", (json_int_t)report->count));
}

/* What kernels flagged: nothing is clamped or left in silence. */
static void each_flag(const struct gamut_run *run, void (*tell)(void *, const struct flag_report *),
                      void *self)
{
  struct flag_report report;
  for (size_t m = 0; m < run->scene->materials; m++)
    for (size_t i = 0; run->material[m] && material_flag(run->material[m], i, &report); i++)
      tell(self, &report);
  for (size_t e = 0; e < run->effects; e++)
    for (size_t i = 0; run->effect[e].bound && effect_flag(run->effect[e].bound, i, &report); i++)
      tell(self, &report);
}

static json_t *flags_json(const struct gamut_run *run)
{
  json_t *all = json_array();
  each_flag(run, add_flag, all);
  return all;
}

static void warn_of_flag(void *trace, const struct flag_report *report)
{
  if (report->message->severity == GAMUT_WARN)
    trace_warn_at(trace, NULL, NULL, NULL, "%s: %s (at a point and step: %llu times)",
                  report->plugin->id, report->message->text, (unsigned long long)report->count);
}

void run_warn(const struct gamut_run *run, struct trace *trace)
{
  each_flag(run, warn_of_flag, trace);
  removal_warn(run, trace);
}

static json_t *cost_json(const struct gamut_run *run)
{
  struct run_cost cost = run_cost_of(run);
  json_t *entry = json_object();
  json_object_set_new(entry, "points", json_integer((json_int_t)cost.points));
  json_object_set_new(entry, "steps", json_integer((json_int_t)cost.steps));
  json_object_set_new(entry, "threads", json_integer(run->threads));
  json_object_set_new(entry, "wall_s", number(cost.wall));
  json_object_set_new(entry, "cpu_s", number(cost.cpu));
  json_object_set_new(entry, "point_steps_per_s",
                      number(cost.wall > 0.0 ? run->work / cost.wall : 0.0));
  json_object_set_new(entry, "bytes_per_point", number(cost.bytes_per_point));
  json_object_set_new(entry, "peak_bytes", json_integer((json_int_t)cost.peak));
  json_object_set_new(entry, "resident_bytes", json_integer((json_int_t)cost.resident));
  json_object_set_new(entry, "work", work_json(run));
  return entry;
}

static const char *ending(gamut_status status)
{
  return status == GAMUT_OK ? "done" : status == GAMUT_STOPPED ? "interrupted" : "failed";
}

char *run_summary(const struct gamut_run *run, gamut_status status,
                  const struct registry *registry)
{
  const struct tree *uncertainty = tree_get(run->scene->tree, "uncertainty");
  const struct tree *node = tree_get(uncertainty, "seed");
  json_t *root = json_object();
  json_object_set_new(root, "gamut", json_string(GAMUT_VERSION));
  json_object_set_new(root, "scene", json_string(run->scene->file));
  json_object_set_new(root, "title", json_string(run->scene->title ? run->scene->title : ""));
  json_object_set_new(root, "solver", json_string(run->scene->solver.descriptor->name));
  json_object_set_new(root, "status", json_string(ending(status)));
  json_object_set_new(root, "time", number(run->time));
  json_object_set_new(root, "seed", json_integer(node ? strtoll(node->text, NULL, 10) : 1));
  json_object_set_new(root, "plugins", plugins_json(registry));
  json_object_set_new(root, "input_files", input_files_json(run->scene));
  json_object_set_new(root, "quantities", quantities_json(run));
  json_object_set_new(root, "ledger", ledger_json(run));
  json_object_set_new(root, "flags", flags_json(run));
  json_object_set_new(root, "cost", cost_json(run));
  char *text = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
  json_decref(root);
  return text;
}
