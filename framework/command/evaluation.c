#include "command/evaluation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/difference.h"
#include "catalogue/catalogue.h"

/* What every law of a kind may be asked at, whether it reads it or not. */
static const char *const standard_input[][3] = {
    [GAMUT_KIND_EOS] = {"compression", "energy", "reference_density"},
    [GAMUT_KIND_STRENGTH] = {"plastic_strain", "plastic_strain_rate", "temperature"},
};

static struct eval_input *input_named(const struct evaluation *e, const char *name)
{
  for (size_t i = 0; i < e->inputs; i++)
    if (strcmp(e->input[i].name, name) == 0)
      return &e->input[i];
  return NULL;
}

static struct eval_input *add_input(struct evaluation *e, const char *name, const char *unit)
{
  struct eval_input *input = &e->input[e->inputs++];
  snprintf(input->name, sizeof input->name, "%s", name);
  input->unit = unit;
  input->count = 1;
  input->from = input->to = strcmp(name, "temperature") == 0 ? 298.0 : 0.0;
  return input;
}

gamut_status evaluation_new(struct evaluation *e, const struct descriptor *descriptor,
                            struct command *command)
{
  *e = (struct evaluation){.descriptor = descriptor};
  e->slots = descriptor_layout(descriptor, &e->slot);
  e->input = calloc(e->slots + 3, sizeof *e->input);
  e->by = calloc(e->slots + 1, sizeof *e->by);
  if (!e->input || !e->by)
    return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < 3; i++) {
    const char *name = standard_input[descriptor->kind][i];
    add_input(e, name, catalogue_find(name)->unit);
  }
  for (size_t i = 0; i < e->slots; i++) {
    char label[64];
    if (e->slot[i].kind != SLOT_INPUT)
      continue;
    slot_label(&e->slot[i], label, sizeof label);
    struct eval_input *input = input_named(e, label);
    if (!input) {
      input = add_input(e, label, e->slot[i].unit);
      input->from = input->to = descriptor->input[e->slot[i].index].absent;
    }
    input->read = true;
  }
  return GAMUT_OK;
}

void evaluation_free(struct evaluation *e)
{
  if (e->bench)
    bench_free(e->bench);
  if (e->probe)
    bench_free(e->probe);
  specimen_close(&e->specimen);
  free(e->slot);
  free(e->input);
  free(e->by);
  free(e->first);
  free(e->second);
}

gamut_status split_pairs(struct command *command, const char *option, const char *text,
                         gamut_status (*take)(void *, const char *name, const char *value),
                         void *self)
{
  gamut_status status = GAMUT_OK;
  char *copy = strdup(text), *word = copy;
  while (copy && word && status == GAMUT_OK) {
    /* A comma separates only where another "name=" follows: values may be lists. */
    char *next = word;
    do
      next = strchr(next + 1, ',');
    while (next && next[1 + strcspn(next + 1, "=,[]")] != '=');
    if (next)
      *next++ = 0;
    char *equals = strchr(word, '=');
    if (!equals || equals == word || equals[1] == 0) {
      status = usage_fail(command, "%s wants name=value, not '%s'", option, word);
      break;
    }
    *equals = 0;
    status = take(self, word, equals + 1);
    word = next;
  }
  free(copy);
  return status;
}

struct at_reader {
  struct evaluation *evaluation;
  struct command *command;
};

static gamut_status read_value(struct command *command, const struct eval_input *input,
                               const char *text, double *value)
{
  enum unit_result result = unit_read_bare(command->units, text, input->unit, value);
  if (result == UNIT_OK)
    return GAMUT_OK;
  if (result == UNIT_DIMENSION || result == UNIT_UNKNOWN || result == UNIT_UNWANTED)
    return usage_fail(command, "--at %s: the unit of '%s' does not fit (expected %s)", input->name,
                      text, input->unit);
  return usage_fail(command, "--at %s: '%s' is not a finite number", input->name, text);
}

static gamut_status unknown_input(struct at_reader *reader, const char *name)
{
  const struct evaluation *e = reader->evaluation;
  char list[512] = "";
  for (size_t i = 0; i < e->inputs; i++)
    snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i ? ", " : "",
             e->input[i].name);
  return usage_fail(reader->command, "--at: %s has no input '%s'; its inputs are %s",
                    e->descriptor->id, name, list);
}

static gamut_status take_input(void *self, const char *name, const char *value)
{
  gamut_status status = GAMUT_OK;
  struct at_reader *reader = self;
  struct eval_input *input = input_named(reader->evaluation, name);
  if (!input)
    return unknown_input(reader, name);
  char *from = strdup(value), *to = strchr(from, ':'), *count = to ? strchr(to + 1, ':') : NULL;
  if (to) {
    char *end = NULL;
    *to++ = 0;
    if (count)
      *count++ = 0;
    long number = count ? strtol(count, &end, 10) : 0;
    if (!count || end == count || *end || number < 2 || number > EVAL_POINTS_MAX) {
      status = usage_fail(reader->command,
                          "--at %s: a range is from:to:count with count from 2 to %d, not '%s'",
                          name, EVAL_POINTS_MAX, value);
      goto done;
    }
    input->count = (size_t)number;
  } else {
    input->count = 1;
  }
  TRY(read_value(reader->command, input, from, &input->from));
  input->to = input->from;
  if (to)
    TRY(read_value(reader->command, input, to, &input->to));
  if (input->given)
    status = usage_fail(reader->command, "--at: '%s' is given twice", name);
  input->given = true;
done:
  free(from);
  return status;
}

gamut_status evaluation_at(struct evaluation *e, struct command *command, const char *text)
{
  struct at_reader reader = {.evaluation = e, .command = command};
  return split_pairs(command, "--at", text, take_input, &reader);
}

double evaluation_input(const struct evaluation *e, size_t index, size_t point)
{
  const struct eval_input *input = &e->input[index];
  size_t stride = 1;
  for (size_t i = index + 1; i < e->inputs; i++)
    stride *= e->input[i].count;
  size_t k = point / stride % input->count;
  if (k + 1 == input->count)
    return input->to;
  return input->from + (input->to - input->from) * (double)k / (double)(input->count - 1);
}

static gamut_status count_points(struct evaluation *e, struct command *command)
{
  e->points = 1;
  for (size_t i = 0; i < e->inputs; i++) {
    struct eval_input *input = &e->input[i];
    if (input->read && !input->given && strcmp(input->name, "reference_density") == 0)
      return usage_fail(command, "%s needs --at reference_density=..., e.g. '7830 kg/m3'",
                        e->descriptor->id);
    e->points *= input->count;
    if (e->points > EVAL_POINTS_MAX)
      return usage_fail(command, "the ranges together give more than %d points", EVAL_POINTS_MAX);
  }
  return GAMUT_OK;
}

/* Everything a law depends on: the real parameters that were stated or have a default, and the
 * density where it reads that. What follows from others by a given set is no free parameter. */
static void list_bys(struct evaluation *e)
{
  const struct descriptor *d = e->descriptor;
  e->of = d->kind == GAMUT_KIND_EOS ? "pressure" : "flow_stress";
  bool own = d->derivative_of && strcmp(d->derivative_of, e->of) == 0;
  for (size_t i = 0; i < e->slots; i++) {
    const struct slot *slot = &e->slot[i];
    struct eval_by by = {.name = slot->name, .own = -1, .parameter = -1};
    if (slot->kind == SLOT_PARAMETER && d->parameter[slot->index].type == VALUE_REAL) {
      const struct value *value = &e->specimen.values->value[slot->index];
      by.parameter = (int)slot->index;
      if (!value->present || (!value->given && !value->parameter->standard))
        continue;
    } else if (slot->kind != SLOT_INPUT || strcmp(slot->name, "reference_density") != 0) {
      continue;
    }
    for (size_t k = 0; own && k < d->derivatives; k++)
      if (strcmp(d->derivative_by[k], slot->name) == 0)
        by.own = (int)k;
    e->by[e->bys++] = by;
  }
}

/* One or two arguments of the law that are moved for differences. */
struct probe {
  struct evaluation *e;
  const struct eval_by *x, *y; /* y may be null */
  double x0, y0;
};

static double argument_value(const struct evaluation *e, const struct eval_by *by)
{
  if (by->parameter >= 0)
    return e->specimen.values->value[by->parameter].real;
  return bench_array(e->probe, by->name)[0];
}

/* Sets a parameter as a scene would, so that what follows from it by a given set follows. */
static bool argument_set(struct evaluation *e, const struct eval_by *by, double value)
{
  if (by->parameter < 0) {
    bench_array(e->probe, by->name)[0] = value;
    return true;
  }
  struct trace *trace = trace_new();
  gamut_status status =
      values_set(e->specimen.values, e->descriptor, (size_t)by->parameter, value, trace);
  trace_free(trace);
  for (size_t i = 0; i < e->slots; i++)
    if (e->slot[i].kind == SLOT_PARAMETER) {
      const struct value *one = &e->specimen.values->value[e->slot[i].index];
      bench_array(e->probe, e->slot[i].name)[0] = one->present ? one->real : NAN;
    }
  return status == GAMUT_OK;
}

static double probe_value(void *self, double x, double y)
{
  struct probe *probe = self;
  struct evaluation *e = probe->e;
  double value = NAN;
  bool taken = argument_set(e, probe->x, probe->x0 + x) &&
               (!probe->y || argument_set(e, probe->y, probe->y0 + y));
  if (taken) {
    bench_call(e->probe, kernel_operation(e->specimen.kernel, 0), 1);
    if (status_severity(bench_status(e->probe)[0]) != GAMUT_STOP)
      value = bench_array(e->probe, e->of)[0];
  }
  argument_set(e, probe->x, probe->x0);
  if (probe->y)
    argument_set(e, probe->y, probe->y0);
  return value;
}

/* The largest step of a table; second differences need a longer one against rounding. */
static double first_step(double value, bool second)
{
  return (second ? 5 : 1) * (value != 0 ? 0.02 * fabs(value) : 1e-3);
}

static double by_differences(struct evaluation *e, size_t k, size_t l, bool second)
{
  double error, value;
  struct probe probe = {.e = e, .x = &e->by[k], .x0 = argument_value(e, &e->by[k])};
  struct difference difference = {
      .value = probe_value, .self = &probe, .step_x = first_step(probe.x0, second)};
  if (!second) {
    value = difference_first(&difference, &error);
    return isfinite(value) ? value : difference_sided(&difference, 1, &error);
  }
  if (k == l)
    return difference_second(&difference, &error);
  probe.y = &e->by[l];
  probe.y0 = argument_value(e, probe.y);
  difference.step_y = first_step(probe.y0, true);
  return difference_mixed(&difference, &error);
}

static void copy_to_probe(struct evaluation *e, size_t point)
{
  for (size_t i = 0; i < e->slots; i++) {
    char label[64];
    if (slot_is_input(&e->slot[i])) {
      slot_label(&e->slot[i], label, sizeof label);
      bench_array(e->probe, label)[0] = bench_array(e->bench, label)[point];
    }
  }
}

static gamut_status derive_point(struct evaluation *e, size_t point, double *own_first,
                                 double *own_second)
{
  gamut_status status = GAMUT_OK;
  size_t n = e->bys, own = e->descriptor->derivatives;
  copy_to_probe(e, point);
  if (own > 0)
    TRY(bench_derivatives(e->probe, 0, false, own_first, own_second));
  for (size_t k = 0; k < n; k++) {
    int a = e->by[k].own;
    e->first[point * n + k] = a >= 0 ? own_first[a] : by_differences(e, k, k, false);
    for (size_t l = 0; l < n; l++) {
      int b = e->by[l].own;
      double value;
      if (a >= 0 && b >= 0)
        value = own_second[(size_t)a * own + (size_t)b];
      else if (l < k)
        value = e->second[(point * n + l) * n + k];
      else
        value = by_differences(e, k, l, true);
      e->second[(point * n + k) * n + l] = value;
    }
  }
done:
  return status;
}

static gamut_status derive(struct evaluation *e, struct command *command)
{
  gamut_status status = GAMUT_OK;
  list_bys(e);
  size_t own = e->descriptor->derivatives, n = e->bys;
  double *scratch = calloc(own + own * own + 1, sizeof *scratch);
  e->first = calloc(e->points * n + 1, sizeof *e->first);
  e->second = calloc(e->points * n * n + 1, sizeof *e->second);
  if (!scratch || !e->first || !e->second) {
    status = trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  TRY(bench_new(e->specimen.kernel, NULL, NULL, 1, command->trace, &e->probe));
  for (size_t p = 0; p < e->points; p++)
    TRY(derive_point(e, p, scratch, scratch + own));
done:
  free(scratch);
  return status;
}

gamut_status evaluation_run(struct evaluation *e, const struct settings *settings,
                            struct command *command)
{
  gamut_status status = GAMUT_OK;
  const struct eval_input *density = input_named(e, "reference_density");
  TRY(count_points(e, command));
  TRY(specimen_values(&e->specimen, e->descriptor, settings, "--param", command->units,
                      command->trace));
  TRY(specimen_open(&e->specimen, command->registry, e->points,
                    density && density->given ? density->from : 1.0, command->trace));
  TRY(bench_new(e->specimen.kernel, NULL, NULL, e->points, command->trace, &e->bench));
  for (size_t i = 0; i < e->inputs; i++) {
    double *array = e->input[i].read ? bench_array(e->bench, e->input[i].name) : NULL;
    for (size_t p = 0; array && p < e->points; p++)
      array[p] = evaluation_input(e, i, p);
  }
  bench_call(e->bench, kernel_operation(e->specimen.kernel, 0), e->points);
  if (e->derivatives)
    TRY(derive(e, command));
done:
  return status;
}
