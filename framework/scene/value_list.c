#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "scene/reading.h"

double *vector_read(struct reading *reading, const struct tree *node, const char *name,
                    const char *unit, size_t least, size_t most, size_t *count)
{
  char expected[192], example[96] = "0";
  *count = 0;
  if (!unit_is_pure(unit))
    snprintf(example, sizeof example, "%s", unit_example(unit));
  if (least == most)
    snprintf(expected, sizeof expected, "%zu numbers in brackets, such as [%s%s]", least, example,
             least > 1 ? ", ..." : "");
  else
    snprintf(expected, sizeof expected, "%zu to %zu numbers in brackets, such as [%s, ...]", least,
             most, example);
  if (node->kind != TREE_SEQUENCE) {
    blame_value(reading, node, expected, "'%s' is %s where a vector is due", name,
                node->kind == TREE_MAPPING ? "a mapping"
                : node->text[0]            ? "a number"
                                           : "empty");
    return NULL;
  }
  if (node->children < least || node->children > most) {
    blame_value(reading, node, expected, "'%s' has %zu component%s", name, node->children,
                node->children == 1 ? "" : "s");
    return NULL;
  }
  double *number = scene_take(node->children, sizeof *number);
  size_t faults = reading->faults;
  for (size_t i = 0; i < node->children; i++)
    amount_read(reading, node->child[i], name, unit, &number[i]);
  if (reading->faults == faults) {
    *count = node->children;
    return number;
  }
  free(number);
  return NULL;
}

static bool table_in_place(struct reading *reading, const struct parameter *parameter,
                           const struct tree *node, struct value *value)
{
  size_t columns = parameter->choices, faults = reading->faults;
  char expected[WORDS_SIZE - 64], wanted[WORDS_SIZE];
  list_text(parameter->choice, columns, expected, sizeof expected);
  snprintf(wanted, sizeof wanted, "each row is [%s]", expected);
  double *number = scene_take(node->children * columns, sizeof *number);
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *row = node->child[i];
    if (row->kind != TREE_SEQUENCE || row->children != columns) {
      blame_value(reading, row, wanted, "row %zu of the table '%s' has not %zu columns", i + 1,
                  parameter->name, columns);
      continue;
    }
    for (size_t k = 0; k < columns; k++)
      amount_read(reading, row->child[k], parameter->choice[k], parameter->choice_unit[k],
                  &number[i * columns + k]);
  }
  value->number = number;
  value->numbers = node->children * columns;
  return reading->faults == faults;
}

enum { LINE_SIZE = 4096, CELLS_MAX = 64 };

/* Cuts a line at commas, in place; blanks around a cell are dropped. */
static size_t cells_of(char *line, char **cell)
{
  size_t count = 0;
  for (char *at = line; at && count < CELLS_MAX;) {
    char *comma = strchr(at, ',');
    if (comma)
      *comma = 0;
    while (isspace((unsigned char)*at))
      at++;
    for (char *end = at + strlen(at); end > at && isspace((unsigned char)end[-1]);)
      *--end = 0;
    cell[count++] = at;
    at = comma ? comma + 1 : NULL;
  }
  return count;
}

struct csv {
  const char *file;
  const struct tree *node;
  const struct parameter *parameter;
  size_t from[CELLS_MAX]; /* cell of each column */
  char unit[CELLS_MAX][32];
  size_t line;
};

/* The first line names the columns, "time [us], strain"; without a unit SI is meant. */
static bool csv_head(struct reading *reading, struct csv *csv, char **cell, size_t cells)
{
  const struct parameter *parameter = csv->parameter;
  for (size_t i = 0; i < cells; i++) {
    char *open = strchr(cell[i], '[');
    csv->unit[i][0] = 0;
    if (!open)
      continue;
    snprintf(csv->unit[i], sizeof csv->unit[i], "%.*s", (int)strcspn(open + 1, "]"), open + 1);
    do
      *open-- = 0;
    while (open >= cell[i] && isspace((unsigned char)*open));
  }
  for (size_t k = 0; k < parameter->choices; k++) {
    size_t i = 0;
    while (i < cells && strcmp(cell[i], parameter->choice[k]) != 0)
      i++;
    if (i == cells) {
      blame_value(reading, csv->node, "the first line names the columns, 'time [us], strain'",
                  "%s:%zu: column '%s' is missing", csv->file, csv->line, parameter->choice[k]);
      return false;
    }
    csv->from[k] = i;
  }
  return true;
}

static bool csv_row(struct reading *reading, const struct csv *csv, char **cell, size_t cells,
                    double *row)
{
  for (size_t k = 0; k < csv->parameter->choices; k++) {
    size_t i = csv->from[k];
    char text[160] = "";
    const char *unit = csv->parameter->choice_unit[k];
    if (i < cells)
      snprintf(text, sizeof text, "%.100s%s%s", cell[i], csv->unit[i][0] ? " " : "", csv->unit[i]);
    if (unit_read_bare(reading->units, text, unit_is_pure(unit) ? "1" : unit, &row[k]) == UNIT_OK)
      continue;
    blame_value(reading, csv->node, "a number, in SI or in the unit that the first line gives",
                "%s:%zu: '%s' is no value of '%s'", csv->file, csv->line, text,
                csv->parameter->choice[k]);
    return false;
  }
  return true;
}

static bool csv_read(struct reading *reading, struct csv *csv, FILE *file, struct value *value)
{
  size_t columns = csv->parameter->choices, capacity = 0;
  bool head = false, fine = true;
  char line[LINE_SIZE], *cell[CELLS_MAX];
  while (fine && fgets(line, sizeof line, file)) {
    csv->line++;
    if (line[0] == '#' || strspn(line, " \t\r\n") == strlen(line))
      continue;
    size_t cells = cells_of(line, cell);
    if (!head) {
      fine = head = csv_head(reading, csv, cell, cells);
      continue;
    }
    if (value->numbers + columns > capacity) {
      capacity = 2 * capacity + 64 * columns;
      double *more = scene_take(capacity, sizeof *more);
      if (value->numbers)
        memcpy(more, value->number, value->numbers * sizeof *more);
      free(value->number);
      value->number = more;
    }
    fine = csv_row(reading, csv, cell, cells, value->number + value->numbers);
    value->numbers += columns;
  }
  if (fine && value->numbers == 0)
    blame_value(reading, csv->node, NULL, "table file '%s' has no rows", csv->file);
  return fine && value->numbers > 0;
}

bool table_file_read(struct reading *reading, const struct parameter *parameter,
                     const struct tree *name, struct value *value)
{
  char path[1024];
  const char *from = name->place.file ? name->place.file : "";
  const char *slash = strrchr(from, '/');
  bool absolute = name->text[0] == '/' || !slash;
  snprintf(path, sizeof path, "%.*s%s", absolute ? 0 : (int)(slash - from + 1), from, name->text);
  FILE *file = fopen(path, "r");
  if (!file) {
    blame_value(reading, name, "a file beside this one", "table file '%s' cannot be read", path);
    return false;
  }
  struct csv csv = {.file = path, .node = name, .parameter = parameter};
  bool fine = csv_read(reading, &csv, file, value);
  fclose(file);
  return fine;
}

static bool table_from_file(struct reading *reading, const struct parameter *parameter,
                            const struct tree *node, struct value *value)
{
  static const char *const known[] = {"file"};
  const struct tree *name = tree_get(node, "file");
  expect_keys(reading, node, known, 1, "a table");
  if (name && name->kind == TREE_SCALAR)
    return table_file_read(reading, parameter, name, value);
  blame_value(reading, node, "rows in brackets, or {file: NAME.csv}", "table '%s' names no file",
              parameter->name);
  return false;
}

/* One number where a curve may stand: a single row that begins with 0. */
static bool table_of_one(struct reading *reading, const struct parameter *parameter,
                         const struct tree *node, struct value *value)
{
  value->number = scene_take(2, sizeof *value->number);
  value->numbers = 2;
  return amount_read(reading, node, parameter->name, parameter->choice_unit[1], &value->number[1]);
}

bool table_read(struct reading *reading, const struct parameter *parameter, const struct tree *node,
                struct value *value)
{
  if (node->kind == TREE_MAPPING)
    return table_from_file(reading, parameter, node, value);
  if (node->kind == TREE_SEQUENCE && node->children)
    return table_in_place(reading, parameter, node, value);
  if (node->kind == TREE_SCALAR && parameter->choices == 2)
    return table_of_one(reading, parameter, node, value);
  blame_value(reading, node, "rows in brackets, or {file: NAME.csv}",
              "'%s' is %s where a table is due", parameter->name,
              node->kind == TREE_SEQUENCE ? "an empty list" : "a plain value");
  return false;
}
