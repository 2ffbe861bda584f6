/* Takes what an estimator reports beside moments: numbers of a quantity and tables, each under a
 * name of the estimator's. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "registry/guard.h"
#include "study/report.h"

enum { NAME_LENGTH_MAX = 60 };

/* A name becomes a key, a dataset and a part of a file's name. */
static bool is_word(const char *name)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  const size_t length = name ? strlen(name) : 0;
  return length > 0 && length <= NAME_LENGTH_MAX && strspn(name, letters) == length;
}

static gamut_status fails(struct study_report *report, gamut_status status, const char *what,
                          const char *name, const char *why)
{
  report->status =
      trace_fail(report->study->trace, status, "%s reports the %s '%.60s': %s",
                 report->study->scene->estimator.descriptor->id, what, name ? name : "", why);
  return report->status;
}

static double *copy_numbers(const double *number, size_t count)
{
  double *copy = calloc(count + 1, sizeof *copy);
  if (!copy)
    memory_ended();
  if (count > 0)
    memcpy(copy, number, count * sizeof *copy);
  return copy;
}

static char **copy_texts(const char *const *text, size_t count)
{
  char **copy = calloc(count + 1, sizeof *copy);
  if (!copy)
    memory_ended();
  for (size_t i = 0; i < count; i++)
    copy[i] = memory_copy(text[i] ? text[i] : "");
  return copy;
}

static void *grown(void *list, size_t count, size_t size)
{
  void *more = realloc(list, (count + 1) * size);
  if (!more)
    memory_ended();
  return more;
}

static gamut_status take_number(struct gamut_report *open, size_t quantity, const char *name,
                                const char *unit, const char *meaning, const double *value)
{
  struct study_report *report = (struct study_report *)(void *)open;
  const struct study *study = report->study;
  if (!is_word(name))
    return fails(report, GAMUT_PLUGIN, "number", name, "that is no word of letters, digits and _");
  if (quantity >= study->quantities || !value)
    return fails(report, GAMUT_PLUGIN, "number", name, "there is no such quantity, or no number");
  for (size_t i = 0; i < report->estimates; i++)
    if (report->estimate[i].quantity == quantity && strcmp(report->estimate[i].name, name) == 0)
      return fails(report, GAMUT_PLUGIN, "number", name, "it was reported before");
  report->estimate = grown(report->estimate, report->estimates, sizeof *report->estimate);
  report->estimate[report->estimates++] =
      (struct estimate){.name = memory_copy(name),
                        .unit = memory_copy(unit ? unit : "1"),
                        .meaning = memory_copy(meaning),
                        .quantity = quantity,
                        .value = copy_numbers(value, study->measured[quantity].count)};
  return GAMUT_OK;
}

/* Why a table cannot be taken; null: it can. */
static const char *table_fault(const struct study_report *report, const char *name,
                               const struct gamut_table_column *column, size_t columns)
{
  if (!is_word(name))
    return "that is no word of letters, digits and _";
  if (columns == 0 || !column)
    return "it has no columns";
  for (size_t i = 0; i < report->tables; i++)
    if (strcmp(report->table[i].name, name) == 0)
      return "it was reported before";
  for (size_t c = 0; c < columns; c++) {
    if (!is_word(column[c].name))
      return "the name of a column is no word of letters, digits and _";
    if (!column[c].number == !column[c].text)
      return "a column has either numbers or texts";
    for (size_t k = 0; k < c; k++)
      if (strcmp(column[k].name, column[c].name) == 0)
        return "two of its columns have one name";
  }
  return NULL;
}

static gamut_status take_table(struct gamut_report *open, const char *name, const char *meaning,
                               const struct gamut_table_column *column, size_t columns, size_t rows)
{
  struct study_report *report = (struct study_report *)(void *)open;
  const char *fault = table_fault(report, name, column, columns);
  if (fault)
    return fails(report, GAMUT_PLUGIN, "table", name, fault);
  struct reported_table table = {memory_copy(name), memory_copy(meaning), NULL, columns, rows};
  table.column = calloc(columns, sizeof *table.column);
  if (!table.column)
    memory_ended();
  for (size_t c = 0; c < columns; c++)
    table.column[c] = (struct reported_column){
        .name = memory_copy(column[c].name),
        .unit = memory_copy(column[c].unit),
        .meaning = memory_copy(column[c].meaning),
        .number = column[c].number ? copy_numbers(column[c].number, rows) : NULL,
        .text = column[c].text ? copy_texts(column[c].text, rows) : NULL};
  report->table = grown(report->table, report->tables, sizeof *report->table);
  report->table[report->tables++] = table;
  return GAMUT_OK;
}

gamut_status report_new(struct study *study)
{
  struct study_report *report = study->report = calloc(1, sizeof *report);
  if (!report)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  report->study = study;
  report->open = (struct gamut_report){.number = take_number, .table = take_table};
  if (!study->table)
    report->open.moments = study->moments;
  return GAMUT_OK;
}

gamut_status report_take(struct study *study)
{
  struct study_report *report = study->report;
  if (!study->ops->report)
    return GAMUT_OK;
  const gamut_status status = GUARDED(study->scene->estimator.descriptor->id,
                                      study->ops->report(study->self, &report->open));
  return status != GAMUT_OK ? status : report->status;
}

static void free_table(struct reported_table *table)
{
  for (size_t c = 0; c < table->columns; c++) {
    struct reported_column *column = &table->column[c];
    for (size_t r = 0; column->text && r < table->rows; r++)
      free(column->text[r]);
    free(column->text);
    free(column->number);
    free(column->name);
    free(column->unit);
    free(column->meaning);
  }
  free(table->column);
  free(table->name);
  free(table->meaning);
}

void report_free(struct study *study)
{
  struct study_report *report = study->report;
  if (!report)
    return;
  for (size_t i = 0; i < report->estimates; i++) {
    free(report->estimate[i].name);
    free(report->estimate[i].unit);
    free(report->estimate[i].meaning);
    free(report->estimate[i].value);
  }
  for (size_t i = 0; i < report->tables; i++)
    free_table(&report->table[i]);
  free(report->estimate);
  free(report->table);
  free(report);
  study->report = NULL;
}
