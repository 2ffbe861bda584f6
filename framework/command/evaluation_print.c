#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command/evaluation.h"

/* JSON has no NaN: null, and the status says why. */
static json_t *number(double value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

static const char *severity_name(enum gamut_severity severity)
{
  static const char *const name[] = {"fine", "note", "warn", "stop"};
  return name[severity];
}

static bool outputs_finite(struct evaluation *e, size_t point)
{
  char label[64];
  for (size_t i = 0; i < e->slots; i++)
    if (slot_is_output(&e->slot[i]) &&
        !isfinite(bench_array(e->bench, slot_label(&e->slot[i], label, sizeof label))[point]))
      return false;
  return true;
}

/* The point's status as a name, its severity and its text. */
static enum gamut_severity point_status(struct evaluation *e, size_t point, const char **name,
                                        const char **text)
{
  int64_t status = bench_status(e->bench)[point];
  const struct message *message = status_message(e->descriptor, status);
  *text = NULL;
  if (message) {
    *name = message->name;
    *text = message->text;
    return status_severity(status);
  }
  if (!outputs_finite(e, point)) {
    *name = "not_finite";
    *text = "the law gave a number that is not finite and did not flag it";
    return GAMUT_STOP;
  }
  *name = "ok";
  return GAMUT_FINE;
}

static json_t *json_outputs(struct evaluation *e, size_t point)
{
  json_t *outputs = json_object();
  for (size_t i = 0; i < e->slots; i++) {
    char label[64];
    if (slot_is_output(&e->slot[i])) {
      slot_label(&e->slot[i], label, sizeof label);
      json_object_set_new(outputs, label, number(bench_array(e->bench, label)[point]));
    }
  }
  return outputs;
}

static void json_derivatives(struct evaluation *e, size_t point, json_t *object)
{
  size_t n = e->bys;
  json_t *first = json_object(), *second = json_object();
  for (size_t k = 0; k < n; k++) {
    json_t *row = json_object();
    json_object_set_new(first, e->by[k].name, number(e->first[point * n + k]));
    for (size_t l = 0; l < n; l++)
      json_object_set_new(row, e->by[l].name, number(e->second[(point * n + k) * n + l]));
    json_object_set_new(second, e->by[k].name, row);
  }
  json_object_set_new(object, "derivatives", json_pack("{s:o}", e->of, first));
  json_object_set_new(object, "second_derivatives", json_pack("{s:o}", e->of, second));
}

static json_t *json_point(struct evaluation *e, size_t point)
{
  const char *name, *text;
  enum gamut_severity severity = point_status(e, point, &name, &text);
  json_t *object = json_object(), *inputs = json_object();
  for (size_t i = 0; i < e->inputs; i++)
    if (e->input[i].read || e->input[i].given)
      json_object_set_new(inputs, e->input[i].name, number(evaluation_input(e, i, point)));
  json_object_set_new(object, "inputs", inputs);
  json_object_set_new(object, "status", json_string(name));
  if (severity != GAMUT_FINE) {
    json_object_set_new(object, "severity", json_string(severity_name(severity)));
    json_object_set_new(object, "message", json_string(text ? text : ""));
  }
  json_object_set_new(object, "outputs", json_outputs(e, point));
  if (e->derivatives)
    json_derivatives(e, point, object);
  return object;
}

gamut_status evaluation_json(struct evaluation *e, FILE *file, struct trace *trace)
{
  json_t *points = json_array();
  for (size_t p = 0; p < e->points; p++)
    json_array_append_new(points, json_point(e, p));
  json_t *root = json_pack("{s:s, s:o}", "plugin", e->descriptor->id, "points", points);
  if (!root || json_dumpf(root, file, JSON_INDENT(1) | JSON_REAL_PRECISION(17)) != 0) {
    json_decref(root);
    return trace_fail(trace, GAMUT_INTERNAL, "the JSON object cannot be made");
  }
  fputc('\n', file);
  json_decref(root);
  return GAMUT_OK;
}

static const char *shown_unit(const char *unit)
{
  return unit && strcmp(unit, "1") != 0 ? unit : "";
}

static void text_parameters(const struct evaluation *e, FILE *file)
{
  const struct values *values = e->specimen.values;
  for (size_t i = 0; i < values->count; i++) {
    const struct value *value = &values->value[i];
    if (!value->present || value->group)
      continue;
    fprintf(file, "  %-24s ", value->parameter->name);
    if (value->text)
      fprintf(file, "%s", value->text);
    else
      fprintf(file, "%.6g %s", value->real, shown_unit(value->parameter->unit));
    if (!value->given)
      fputs(value->parameter->standard ? "  (default)" : "  (derived)", file);
    fputc('\n', file);
  }
}

static void text_inputs(const struct evaluation *e, FILE *file)
{
  for (size_t i = 0; i < e->inputs; i++) {
    const struct eval_input *input = &e->input[i];
    if (!input->read && !input->given)
      continue;
    fprintf(file, "  %-24s %.6g", input->name, input->from);
    if (input->count > 1)
      fprintf(file, " to %.6g, %zu values,", input->to, input->count);
    fprintf(file, " %s%s%s\n", shown_unit(input->unit), input->given ? "" : "  (default)",
            input->read ? "" : "  (this law does not read it)");
  }
}

static void text_point(struct evaluation *e, FILE *file)
{
  char label[160];
  for (size_t i = 0; i < e->slots; i++)
    if (slot_is_output(&e->slot[i])) {
      slot_label(&e->slot[i], label, sizeof label);
      fprintf(file, "  %-50s %16.9g %s\n", label, bench_array(e->bench, label)[0],
              shown_unit(e->slot[i].unit));
    }
  for (size_t k = 0; e->derivatives && k < e->bys; k++) {
    snprintf(label, sizeof label, "d %s / d %s", e->of, e->by[k].name);
    fprintf(file, "  %-50s %16.9g%s\n", label, e->first[k],
            e->by[k].own < 0 ? "  (by differences)" : "");
  }
  for (size_t k = 0; e->derivatives && k < e->bys; k++)
    for (size_t l = k; l < e->bys; l++) {
      snprintf(label, sizeof label, "d2 %s / d %s d %s", e->of, e->by[k].name, e->by[l].name);
      fprintf(file, "  %-50s %16.9g%s\n", label, e->second[k * e->bys + l],
              e->by[k].own < 0 || e->by[l].own < 0 ? "  (by differences)" : "");
    }
}

/* Columns as wide as their names, and wide enough for numbers. */
static void put_cell(FILE *file, const char *name, const double *value)
{
  int width = (int)strlen(name) < 14 ? 14 : (int)strlen(name);
  if (value)
    fprintf(file, "%*.8g  ", width, *value);
  else
    fprintf(file, "%*s  ", width, name);
}

/* One row of the table: names, or the values at a point. */
static void text_row(struct evaluation *e, FILE *file, bool names, size_t point)
{
  char label[96];
  for (size_t i = 0; i < e->inputs; i++)
    if (e->input[i].count > 1) {
      double value = evaluation_input(e, i, point);
      put_cell(file, e->input[i].name, names ? NULL : &value);
    }
  for (size_t i = 0; i < e->slots; i++)
    if (slot_is_output(&e->slot[i])) {
      slot_label(&e->slot[i], label, sizeof label);
      put_cell(file, label, names ? NULL : &bench_array(e->bench, label)[point]);
    }
}

static void text_table(struct evaluation *e, FILE *file)
{
  text_row(e, file, true, 0);
  fputs("status\n", file);
  for (size_t p = 0; p < e->points; p++) {
    const char *name, *text;
    point_status(e, p, &name, &text);
    text_row(e, file, false, p);
    fprintf(file, "%s\n", name);
  }
}

void evaluation_text(struct evaluation *e, FILE *file)
{
  const char *name, *text;
  fprintf(file, "%s: %s\nparameters\n", e->descriptor->id, e->descriptor->summary);
  text_parameters(e, file);
  fputs("at\n", file);
  text_inputs(e, file);
  if (e->points > 1) {
    fputc('\n', file);
    text_table(e, file);
    return;
  }
  point_status(e, 0, &name, &text);
  fprintf(file, "status %s%s%s\n", name, text ? ": " : "", text ? text : "");
  text_point(e, file);
}

enum gamut_severity evaluation_worst(struct evaluation *e, size_t *point, const char **name,
                                     const char **text)
{
  enum gamut_severity worst = GAMUT_FINE;
  for (size_t p = 0; p < e->points; p++) {
    const char *n, *t;
    enum gamut_severity severity = point_status(e, p, &n, &t);
    if (severity > worst) {
      worst = severity;
      *point = p;
      *name = n;
      *text = t;
    }
  }
  return worst;
}
