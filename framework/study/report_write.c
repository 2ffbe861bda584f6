/* Writes what an estimator has reported beside moments: into summary.json, one CSV file for all
 * numbers of quantities and one a table, and the same into results.h5. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "study/report.h"

static json_t *number_json(double value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

/* Places of a quantity that are shown: all of a curve that every run has. */
static size_t places_of(const struct study *study, size_t quantity, size_t *kept)
{
  const struct measured *m = &study->measured[quantity];
  kept[0] = 0;
  return m->curve ? curve_overlap(study, m, kept) : 1;
}

static size_t *make_places(const struct study *study)
{
  return calloc(study->results + 1, sizeof(size_t));
}

json_t *report_estimates_json(const struct study *study, size_t quantity)
{
  const struct study_report *report = study->report;
  size_t *kept = make_places(study);
  json_t *all = NULL;
  for (size_t i = 0; kept && report && i < report->estimates; i++) {
    const struct estimate *e = &report->estimate[i];
    if (e->quantity != quantity)
      continue;
    json_t *entry = json_pack("{s:s}", "unit", e->unit);
    if (study->measured[quantity].curve) {
      const size_t count = places_of(study, quantity, kept);
      json_t *list = json_array();
      for (size_t k = 0; k < count; k++)
        json_array_append_new(list, number_json(e->value[kept[k]]));
      json_object_set_new(entry, "values", list);
    } else {
      json_object_set_new(entry, "value", number_json(e->value[0]));
    }
    if (e->meaning)
      json_object_set_new(entry, "meaning", json_string(e->meaning));
    all = all ? all : json_object();
    json_object_set_new(all, e->name, entry);
  }
  free(kept);
  return all;
}

static json_t *column_json(const struct reported_column *column, size_t rows)
{
  json_t *entry = json_object(), *list = json_array();
  if (column->unit)
    json_object_set_new(entry, "unit", json_string(column->unit));
  if (column->meaning)
    json_object_set_new(entry, "meaning", json_string(column->meaning));
  for (size_t r = 0; r < rows; r++)
    json_array_append_new(list, column->text ? json_string(column->text[r])
                                             : number_json(column->number[r]));
  json_object_set_new(entry, "values", list);
  return entry;
}

json_t *report_tables_json(const struct study *study)
{
  const struct study_report *report = study->report;
  json_t *all = NULL;
  for (size_t i = 0; report && i < report->tables; i++) {
    const struct reported_table *table = &report->table[i];
    json_t *entry = json_object(), *columns = json_object();
    if (table->meaning)
      json_object_set_new(entry, "meaning", json_string(table->meaning));
    for (size_t c = 0; c < table->columns; c++)
      json_object_set_new(columns, table->column[c].name,
                          column_json(&table->column[c], table->rows));
    json_object_set_new(entry, "columns", columns);
    all = all ? all : json_object();
    json_object_set_new(all, table->name, entry);
  }
  return all;
}

static gamut_status write_table(struct study *study, const struct reported_table *table,
                                struct store *store)
{
  char file[128], group[128];
  struct table_column *column = calloc(table->columns, sizeof *column);
  if (!column)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t c = 0; c < table->columns; c++) {
    const struct reported_column *given = &table->column[c];
    column[c] = (struct table_column){.name = given->name,
                                      .unit = given->unit,
                                      .meaning = given->meaning,
                                      .value = given->number,
                                      .text = (const char *const *)given->text};
  }
  snprintf(file, sizeof file, RESULT_TABLE "%s.csv", table->name);
  snprintf(group, sizeof group, "study/tables/%s", table->name);
  const gamut_status status =
      store_table(store, file, group, column, table->columns, table->rows, 0, study->trace);
  free(column);
  return status;
}

/* A row a number: those of curves have their place beside them. */
struct estimate_rows {
  size_t count;
  const char **quantity, **name, **unit;
  double *at, *value;
};

static void add_rows(const struct study *study, const struct estimate *e, size_t *kept,
                     struct estimate_rows *rows)
{
  const struct measured *m = &study->measured[e->quantity];
  const size_t count = places_of(study, e->quantity, kept);
  for (size_t k = 0; k < count; k++) {
    const size_t row = rows->count++;
    rows->quantity[row] = m->quantity->name;
    rows->name[row] = e->name;
    rows->unit[row] = e->unit;
    rows->at[row] = m->curve ? m->at[kept[k]] : NAN;
    rows->value[row] = e->value[kept[k]];
  }
}

static gamut_status write_estimates(struct study *study, struct store *store)
{
  gamut_status status = GAMUT_INTERNAL;
  const struct study_report *report = study->report;
  size_t most = 0, *kept = make_places(study);
  for (size_t i = 0; i < report->estimates; i++)
    most += study->measured[report->estimate[i].quantity].count;
  struct estimate_rows rows = {0,
                               calloc(most + 1, sizeof *rows.quantity),
                               calloc(most + 1, sizeof *rows.name),
                               calloc(most + 1, sizeof *rows.unit),
                               calloc(most + 1, sizeof *rows.at),
                               calloc(most + 1, sizeof *rows.value)};
  if (kept && rows.quantity && rows.name && rows.unit && rows.at && rows.value) {
    for (size_t i = 0; i < report->estimates; i++)
      add_rows(study, &report->estimate[i], kept, &rows);
    const struct table_column column[] = {
        {.name = "quantity", .meaning = "of the scene", .text = rows.quantity},
        {.name = "name", .meaning = "of the number, by the estimator", .text = rows.name},
        {.name = "unit", .meaning = "of the number", .text = rows.unit},
        {.name = "at", .meaning = "place along the axis of a curve", .value = rows.at},
        {.name = "value", .meaning = "the number", .value = rows.value}};
    status = store_table(store, RESULT_ESTIMATES, "study/estimates", column, ARRAY_SIZE(column),
                         rows.count, 0, study->trace);
  } else {
    trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  }
  free(kept);
  free(rows.quantity);
  free(rows.name);
  free(rows.unit);
  free(rows.at);
  free(rows.value);
  return status;
}

gamut_status report_write(struct study *study, struct store *store)
{
  gamut_status status = GAMUT_OK;
  const struct study_report *report = study->report;
  if (report && report->estimates > 0)
    TRY(write_estimates(study, store));
  for (size_t i = 0; report && i < report->tables; i++)
    TRY(write_table(study, &report->table[i], store));
done:
  return status;
}
