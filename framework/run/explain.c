#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_private.h"

/* Bytes a point that the declarations demand: stored components, the id, the spare for sorting. */
static size_t declared_bytes(const struct gamut_run *run, size_t *stored)
{
  *stored = 0;
  for (size_t f = 0; f < fields_count(run->fields); f++) {
    const struct field *field = fields_at(run->fields, f);
    *stored += field->stored ? field->handle.components : 0;
  }
  return *stored * sizeof(double) + sizeof(int64_t) + sizeof(double);
}

static const char *extent_text(enum gamut_extent extent)
{
  static const char *const text[] = {"per chunk", "opens a block", "closes a block", "once"};
  return text[extent];
}

static const char *field_place(const struct field *field)
{
  if (field->where == GAMUT_AT_RUN)
    return "uniform";
  if (field->where != GAMUT_AT_POINT)
    return field->where == GAMUT_AT_MATERIAL ? "parameter" : "solver";
  return !field->used ? "unused" : field->stored ? "stored" : "scratch";
}

/* For programs. */

static json_t *tasks_json(const struct gamut_run *run)
{
  json_t *all = json_array();
  size_t sweep = 0, in_sweep = 0;
  for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
    const struct task *task = schedule_task(run->schedule, i);
    json_t *one = json_pack("{s:s, s:s, s:s, s:b, s:s}", "name", task->name, "owner", task->owner,
                            "extent", extent_text(task->extent), "live", (int)task->live, "why",
                            task->why ? task->why : "");
    if (task->live) {
      const struct sweep *s = schedule_sweep(run->schedule, sweep);
      json_object_set_new(one, "sweep", json_integer((json_int_t)sweep));
      if (++in_sweep == s->opens + s->chunks + s->closes) {
        sweep++;
        in_sweep = 0;
      }
    }
    json_array_append_new(all, one);
  }
  return all;
}

static json_t *fields_json(const struct gamut_run *run)
{
  json_t *all = json_array();
  for (size_t f = 0; f < fields_count(run->fields); f++) {
    const struct field *field = fields_at(run->fields, f);
    json_array_append_new(all, json_pack("{s:s, s:s, s:i, s:s, s:b, s:i}", "name", field->name,
                                         "unit", field->unit, "components",
                                         (int)field->handle.components, "kept", field_place(field),
                                         "history", (int)field->history, "bytes_per_point",
                                         field->stored ? (int)(8 * field->handle.components) : 0));
  }
  return all;
}

static json_t *off_json(const struct gamut_run *run)
{
  json_t *all = json_array();
  for (size_t i = 0; i < schedule_declined(run->schedule); i++) {
    const char *owner, *why;
    schedule_declined_at(run->schedule, i, &owner, &why);
    json_array_append_new(all, json_pack("{s:s, s:s}", "what", owner, "why", why));
  }
  return all;
}

static json_t *random_fields_json(const struct gamut_run *run)
{
  json_t *all = json_object();
  const char *path, *plugin;
  for (size_t i = 0; random_field_at(run, i, &path, &plugin); i++)
    json_object_set_new(all, path, json_string(plugin));
  return all;
}

static json_t *memory_json(const struct gamut_run *run)
{
  json_t *all = json_object();
  const char *label;
  size_t bytes;
  for (size_t i = 0; arena_label(run->arena, i, &label, &bytes); i++)
    json_object_set_new(all, label, json_integer((json_int_t)bytes));
  return all;
}

static json_t *plugins_json(const struct gamut_run *run)
{
  json_t *all = json_array();
  for (size_t i = 0; i < registry_count(run->registry); i++) {
    const struct descriptor *d = registry_at(run->registry, i);
    if (registry_is_open(run->registry, d))
      json_array_append_new(all, json_string(d->id));
  }
  return all;
}

static void give_forecast(const struct gamut_run *run, bool good, const struct forecast *f,
                          struct run_forecast *forecast)
{
  if (forecast)
    *forecast = (struct run_forecast){good, f->steps, f->seconds, run_cost_of(run).bytes};
}

char *run_explain_json(struct gamut_run *run, struct run_forecast *forecast)
{
  struct forecast f;
  size_t stored;
  size_t declared = declared_bytes(run, &stored);
  struct run_cost cost = run_cost_of(run);
  bool good = forecast_steps(run, &f);
  struct run_cost after = run_cost_of(run);
  give_forecast(run, good, &f, forecast);
  json_t *root = json_object();
  json_object_set_new(root, "scene", json_string(run->scene->file));
  json_object_set_new(root, "solver", json_string(run->scene->solver.descriptor->id));
  json_object_set_new(root, "plugins", plugins_json(run));
  json_object_set_new(root, "tasks", tasks_json(run));
  json_object_set_new(root, "off", off_json(run));
  json_object_set_new(root, "fields", fields_json(run));
  json_object_set_new(root, "points", json_integer((json_int_t)cost.points));
  json_object_set_new(root, "declared_bytes_per_point", json_integer((json_int_t)declared));
  json_object_set_new(root, "random_fields", random_fields_json(run));
  json_object_set_new(root, "memory", memory_json(run));
  json_object_set_new(root, "bytes", json_integer((json_int_t)after.bytes));
  json_object_set_new(root, "bytes_per_point", json_real(after.bytes_per_point));
  json_object_set_new(root, "step", good ? json_real(f.step) : json_null());
  json_object_set_new(root, "step_limit", json_string(f.limit));
  json_object_set_new(root, "steps", good ? json_real(f.steps) : json_null());
  json_object_set_new(root, "seconds", good ? json_real(f.seconds) : json_null());
  char *text = json_dumps(root, JSON_INDENT(1));
  json_decref(root);
  return text;
}

/* For people. */

static void print_tasks(const struct gamut_run *run, FILE *file)
{
  fputs("\ntasks of a step, in order (| joins what runs on a block while it is in cache)\n", file);
  size_t sweep = 0, in_sweep = 0;
  for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
    const struct task *task = schedule_task(run->schedule, i);
    if (!task->live)
      continue;
    const struct sweep *s = schedule_sweep(run->schedule, sweep);
    fprintf(file, "  %c %-26s %-20s %-15s %s\n", s->once ? ' ' : '|', task->name, task->owner,
            extent_text(task->extent), task->why ? task->why : "");
    if (++in_sweep == s->opens + s->chunks + s->closes) {
      sweep++;
      in_sweep = 0;
    }
  }
}

static void print_off(const struct gamut_run *run, FILE *file)
{
  bool any = schedule_declined(run->schedule) > 0;
  for (size_t i = 0; i < schedule_tasks(run->schedule); i++)
    any |= !schedule_task(run->schedule, i)->live;
  if (!any)
    return;
  fputs("\noff, and why\n", file);
  for (size_t i = 0; i < schedule_declined(run->schedule); i++) {
    const char *owner, *why;
    schedule_declined_at(run->schedule, i, &owner, &why);
    fprintf(file, "    %-26s %s\n", owner, why);
  }
  for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
    const struct task *task = schedule_task(run->schedule, i);
    if (!task->live)
      fprintf(file, "    %-26s %s\n", task->owner, task->why ? task->why : "");
  }
}

static void print_variants(const struct gamut_run *run, FILE *file)
{
  static const enum gamut_kind kind[] = {GAMUT_KIND_EOS, GAMUT_KIND_STRENGTH,
                                         GAMUT_KIND_ELASTICITY};
  fputs("\nmaterials\n", file);
  for (size_t m = 0; m < run->scene->materials; m++)
    for (int k = 0; run->material[m] && k < 3; k++) {
      const struct kernel *kernel = material_kernel(run->material[m], kind[k]);
      if (!kernel)
        continue;
      const struct descriptor *d = kernel_descriptor(kernel);
      const char *level = registry_level(run->registry, d), *variant = kernel_variant(kernel);
      fprintf(file, "    %-14s %-26s %-10s %s\n", run->scene->material[m].name, d->id,
              level ? level : "", *variant ? variant : "the whole formula");
    }
}

static void print_fields(const struct gamut_run *run, FILE *file)
{
  fputs("\nfields\n", file);
  for (size_t f = 0; f < fields_count(run->fields); f++) {
    const struct field *field = fields_at(run->fields, f);
    if (field->where == GAMUT_AT_POINT && field->used)
      fprintf(file, "    %-26s %2u x %-8s %-8s %4d B/point%s\n", field->name,
              field->handle.components, field->unit, field_place(field),
              field->stored ? (int)(8 * field->handle.components) : 0,
              field->history ? ", begin and end of the step" : "");
  }
}

static void print_random_fields(const struct gamut_run *run, FILE *file)
{
  const char *path, *plugin;
  for (size_t i = 0; random_field_at(run, i, &path, &plugin); i++)
    fprintf(file, "%s    %-26s %s\n", i ? "" : "\nrandom fields\n", path, plugin);
}

static void print_memory(const struct gamut_run *run, size_t declared, FILE *file)
{
  const char *label;
  size_t bytes;
  struct run_cost cost = run_cost_of(run);
  fputs("\nmemory\n", file);
  for (size_t i = 0; arena_label(run->arena, i, &label, &bytes); i++)
    if (bytes)
      fprintf(file, "    %-26s %12zu B\n", label, bytes);
  fprintf(file, "    %-26s %12zu B, %.0f B/point (fields, ids and sorting: %zu B/point)\n",
          "together", cost.bytes, cost.bytes_per_point, declared);
}

void run_explain(struct gamut_run *run, FILE *file, struct run_forecast *forecast)
{
  struct forecast f;
  size_t stored;
  struct run_cost cost = run_cost_of(run);
  fprintf(file, "scene %s", run->scene->file);
  fprintf(file, "%s%s\n", run->scene->title ? ": " : "",
          run->scene->title ? run->scene->title : "");
  fprintf(file, "solver %s, %llu points, %d thread%s, blocks of %zu points\n",
          run->scene->solver.descriptor->id, (unsigned long long)cost.points, run->threads,
          run->threads == 1 ? "" : "s", run->chunk);
  print_variants(run, file);
  print_tasks(run, file);
  print_off(run, file);
  print_fields(run, file);
  bool good = forecast_steps(run, &f);
  give_forecast(run, good, &f, forecast);
  print_random_fields(run, file);
  print_memory(run, declared_bytes(run, &stored), file);
  if (!good)
    return;
  fprintf(file,
          "\ntime step %.4g s%s%s: about %.0f steps, %.3g s on this machine (from %d steps)\n",
          f.step, *f.limit ? ", limited by " : "", f.limit, f.steps, f.seconds, TRIAL_STEPS);
}
