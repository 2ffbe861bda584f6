#include "report/report.h"

#include <math.h>
#include <string.h>

#include <jansson.h>

#include "report/readable.h"

static double number(const json_t *object, const char *key, double otherwise)
{
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : otherwise;
}

static const char *word(const json_t *object, const char *key, const char *otherwise)
{
  const char *text = json_string_value(json_object_get(object, key));
  return text ? text : otherwise;
}

/* "102 samples, 0 m to 16.2 mm at the end, largest 17 mm" */
static void write_history(const json_t *values, const char *unit, FILE *file)
{
  double least = INFINITY, most = -INFINITY, last = NAN;
  char low[48], high[48], end[48];
  size_t index;
  json_t *entry;
  json_array_foreach(values, index, entry)
  {
    if (!json_is_number(entry))
      continue;
    last = json_number_value(entry);
    least = fmin(least, last);
    most = fmax(most, last);
  }
  if (!isfinite(least)) {
    fprintf(file, "a history without numbers\n");
    return;
  }
  double like = fmax(fabs(least), fabs(most));
  fprintf(file, "%s at the end; from %s to %s in %zu samples\n",
          readable_like(last, like, unit, end, sizeof end),
          readable_like(least, like, unit, low, sizeof low),
          readable_like(most, like, unit, high, sizeof high), json_array_size(values));
}

/* The largest mean of a curve with its error and spread: the curve itself is in the tables. */
static void write_means(const json_t *quantity, const char *unit, FILE *file)
{
  const json_t *means = json_object_get(quantity, "means");
  size_t best = 0, index;
  double most = -1;
  char text[48];
  json_t *entry;
  json_array_foreach(means, index, entry)
  {
    if (json_is_number(entry) && fabs(json_number_value(entry)) > most) {
      most = fabs(json_number_value(entry));
      best = index;
    }
  }
  if (most < 0) {
    fprintf(file, "a curve without numbers%s%s\n", json_object_get(quantity, "reason") ? ": " : "",
            word(quantity, "reason", ""));
    return;
  }
  double value = json_number_value(json_array_get(means, best));
  const json_t *error = json_array_get(json_object_get(quantity, "mean_errors"), best);
  const json_t *variance = json_array_get(json_object_get(quantity, "variances"), best);
  fprintf(file, "a curve of %zu points, mean up to %s", json_array_size(means),
          readable(value, unit, text, sizeof text));
  if (json_is_number(error))
    fprintf(file, " +- %s",
            readable_like(json_number_value(error), value, unit, text, sizeof text));
  if (json_is_number(variance))
    fprintf(file, ", standard deviation %s there",
            readable_like(sqrt(json_number_value(variance)), value, unit, text, sizeof text));
  fputc('\n', file);
}

/* Of the standard deviation, from that of the variance: " (95 %: 3.1 MPa to 4.8 MPa)" */
static void write_interval(const json_t *interval, double like, const char *unit, FILE *file)
{
  const json_t *lower = json_array_get(interval, 0), *upper = json_array_get(interval, 1);
  char low[48], high[48];
  if (!json_is_number(lower) || !json_is_number(upper))
    return;
  fprintf(file, " (95 %%: %s to %s)",
          readable_like(sqrt(json_number_value(lower)), like, unit, low, sizeof low),
          readable_like(sqrt(json_number_value(upper)), like, unit, high, sizeof high));
}

static void write_quantity(const char *name, const json_t *quantity, int width, FILE *file)
{
  const char *unit = word(quantity, "unit", "1");
  const json_t *values = json_object_get(quantity, "values");
  double value = number(quantity, "mean", number(quantity, "value", NAN));
  double variance = number(quantity, "variance", NAN), error = number(quantity, "mean_error", NAN);
  char text[48];
  fprintf(file, "  %-*s  ", width, name);
  if (json_object_get(quantity, "means")) {
    write_means(quantity, unit, file);
    return;
  }
  if (json_is_array(values)) {
    write_history(values, unit, file);
    return;
  }
  if (isnan(value)) {
    fprintf(file, "no value%s%s\n", json_object_get(quantity, "reason") ? ": " : "",
            word(quantity, "reason", ""));
    return;
  }
  fprintf(file, "%s", readable(value, unit, text, sizeof text));
  if (!isnan(error))
    fprintf(file, " +- %s", readable_like(error, value, unit, text, sizeof text));
  if (!isnan(variance))
    fprintf(file, ", standard deviation %s",
            readable_like(sqrt(variance), value, unit, text, sizeof text));
  write_interval(json_object_get(quantity, "variance_interval"), value, unit, file);
  fputc('\n', file);
  if (json_object_get(quantity, "conditional"))
    fprintf(file, "  %-*s  conditional: %s\n", width, "", word(quantity, "conditional", ""));
  if (json_object_get(quantity, "caution"))
    fprintf(file, "  %-*s  caution: %s\n", width, "", word(quantity, "caution", ""));
}

static void write_quantities(json_t *quantities, FILE *file)
{
  const char *name;
  json_t *quantity;
  int width = 0;
  json_object_foreach(quantities, name, quantity)
  {
    width = (int)strlen(name) > width ? (int)strlen(name) : width;
  }
  if (width > 0)
    fprintf(file, "quantities\n");
  json_object_foreach(quantities, name, quantity)
  {
    write_quantity(name, quantity, width, file);
  }
}

/* An account is printed by how well it closes; its parts are in summary.json. */
static void write_ledger(json_t *ledger, FILE *file)
{
  const char *account;
  json_t *parts;
  bool first = true;
  json_object_foreach(ledger, account, parts)
  {
    double residual = number(parts, "relative_residual", NAN);
    if (isnan(residual))
      residual = fabs(number(parts, "residual", NAN)) / number(parts, "scale", 1);
    if (isnan(residual))
      continue;
    fprintf(file, "%s%s to %.1e", first ? "ledger closes: " : ", ", account, residual);
    first = false;
  }
  if (!first)
    fprintf(file, " of what went through\n");
}

/* "  pressure up to 16.2 GPa": a curve in a row of the levels. */
static void write_peak(const char *name, const json_t *values, const char *unit, FILE *file)
{
  double peak = NAN;
  char text[48];
  size_t index;
  json_t *entry;
  json_array_foreach(values, index, entry)
  {
    const double value = json_is_number(entry) ? json_number_value(entry) : NAN;
    if (isnan(peak) || fabs(value) > fabs(peak))
      peak = value;
  }
  fprintf(file, "  %s %s%s", name, isnan(peak) ? "no value" : "up to ",
          isnan(peak) ? "" : readable(peak, unit, text, sizeof text));
}

/* What was varied beside what came out. */
static void write_levels(const json_t *levels, const json_t *quantities, FILE *file)
{
  enum { LEVELS_SHOWN = 40 };
  size_t index;
  json_t *level, *value;
  const char *name;
  json_array_foreach(levels, index, level)
  {
    char text[48];
    if (index == LEVELS_SHOWN) {
      fprintf(file, "  and %zu more, in study.csv\n", json_array_size(levels) - index);
      break;
    }
    fprintf(file, " ");
    json_object_foreach(json_object_get(level, "set"), name, value)
    {
      fprintf(file, " %s: %s ", name, json_string_value(value));
    }
    fprintf(file, " ->");
    if (strcmp(word(level, "status", "ok"), "ok") != 0) {
      fprintf(file, "  %s\n", word(level, "status", "?"));
      continue;
    }
    json_object_foreach(json_object_get(level, "quantities"), name, value)
    {
      const char *unit = word(json_object_get(quantities, name), "unit", "1");
      if (json_is_object(value))
        write_peak(name, json_object_get(value, "values"), unit, file);
      else
        fprintf(file, "  %s %s", name,
                json_is_number(value) ? readable(json_number_value(value), unit, text, sizeof text)
                                      : "no value");
    }
    fputc('\n', file);
  }
}

static void write_truncation(const json_t *cuts, FILE *file)
{
  size_t index;
  json_t *cut;
  json_array_foreach(cuts, index, cut)
  {
    const char *constraint = word(cut, "constraint", NULL);
    fprintf(file, "truncated: %s, %s%.3g %% cut off", word(cut, "parameter", "?"),
            constraint ? "about " : "", 100 * number(cut, "cut_off", NAN));
    if (constraint)
      fprintf(file, " by '%s' (%.0f runs drawn again)", constraint,
              number(cut, "runs_drawn_again", 0));
    fputc('\n', file);
  }
}

static void write_study(const json_t *study, FILE *file)
{
  const json_t *reasons = json_object_get(study, "reasons");
  const json_t *cost = json_object_get(study, "cost");
  size_t index;
  json_t *entry;
  if (!study)
    return;
  fprintf(file, "study: %s, %.0f runs", word(study, "estimator", "?"), number(study, "asked", 0));
  if (number(study, "failed", 0) > 0)
    fprintf(file, ", %.0f of them failed%s", number(study, "failed", 0),
            json_object_get(study, "note") ? ": the moments are conditional, those of the rest"
                                           : "");
  if (number(cost, "from_log", 0) > 0)
    fprintf(file, ", %.0f taken from the log", number(cost, "from_log", 0));
  fprintf(file, "; %.3g s on %.0f thread%s\n", number(cost, "wall_s", 0),
          number(cost, "threads", 1), number(cost, "threads", 1) > 1 ? "s" : "");
  json_array_foreach(reasons, index, entry)
  {
    if (index == 5) {
      fprintf(file, "  and %zu more reasons\n", json_array_size(reasons) - index);
      break;
    }
    const char *reason = word(entry, "reason", "?");
    fprintf(file, "  %zu failed: %.160s%s\n", json_array_size(json_object_get(entry, "runs")),
            reason, strlen(reason) > 160 ? " ... (study.csv has it whole)" : "");
  }
}

static void write_cost(const json_t *cost, FILE *file)
{
  double wall = number(cost, "wall_s", NAN), rate = number(cost, "point_steps_per_s", NAN);
  char text[64];
  if (isnan(wall))
    return;
  fprintf(file, "cost: %.0f points, %.0f steps, %.3g s", number(cost, "points", 0),
          number(cost, "steps", 0), wall);
  if (!isnan(rate))
    fprintf(file, " (%s)", readable_rate(rate, text, sizeof text));
  double peak = number(cost, "peak_bytes", NAN);
  if (!isnan(peak))
    fprintf(file, ", %.3g MB", peak / 1e6);
  fputc('\n', file);
}

void report_summary(const char *summary_json, FILE *file)
{
  json_error_t error;
  json_t *summary = json_loads(summary_json, 0, &error);
  if (!summary) {
    fprintf(file, "the summary cannot be read: %s\n", error.text);
    return;
  }
  const json_t *study = json_object_get(summary, "study");
  const json_t *levels = json_object_get(study, "levels");
  const bool table = strcmp(word(study, "yields", ""), "table") == 0;
  if (!table)
    write_quantities(json_object_get(summary, "quantities"), file);
  write_ledger(json_object_get(summary, "ledger"), file);
  write_truncation(json_object_get(study, "truncation"), file);
  if (levels)
    write_levels(levels, json_object_get(summary, "quantities"), file);
  if (study)
    write_study(study, file);
  else
    write_cost(json_object_get(summary, "cost"), file);
  json_decref(summary);
}
