#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

double *vector_read(struct scene_reader *reader, const struct tree *node, const char *name,
                    const char *unit, size_t least, size_t most, size_t *count)
{
  char expected[192], example[96] = "0";
  *count = 0;
  if (!unit_is_pure(unit))
    snprintf(example, sizeof example, "%s", unit_example(unit));
  if (least == most)
    snprintf(expected, sizeof expected, "%zu number%s in brackets, such as [%s%s]", least,
             least > 1 ? "s" : "", example, least > 1 ? ", ..." : "");
  else
    snprintf(expected, sizeof expected, "%zu to %zu numbers in brackets, such as [%s, ...]", least,
             most, example);
  if (node->kind != TREE_SEQUENCE) {
    error_at_value(reader, node, expected, "'%s' is %s where a vector is due", name,
                   node->kind == TREE_MAPPING ? "a mapping"
                   : node->text[0]            ? "a number"
                                              : "empty");
    return NULL;
  }
  if (node->children < least || node->children > most) {
    error_at_value(reader, node, expected, "'%s' has %zu component%s", name, node->children,
                   node->children == 1 ? "" : "s");
    return NULL;
  }
  double *number = scene_take(node->children, sizeof *number);
  size_t faults = reader->faults;
  for (size_t i = 0; i < node->children; i++)
    amount_read(reader, node->child[i], name, unit, &number[i]);
  if (reader->faults == faults) {
    *count = node->children;
    return number;
  }
  free(number);
  return NULL;
}

/* "at least 4 rows"; false where there are as many. */
bool rows_expected(const struct parameter *parameter, size_t rows, char *expected, size_t size)
{
  if (rows < parameter->size_min)
    snprintf(expected, size, "at least %zu rows", parameter->size_min);
  else if (parameter->size_max && rows > parameter->size_max)
    snprintf(expected, size, "at most %zu rows", parameter->size_max);
  else
    return false;
  return true;
}

static bool table_in_place(struct scene_reader *reader, const struct parameter *parameter,
                           const struct tree *node, struct value *value)
{
  size_t columns = parameter->choices, faults = reader->faults;
  char expected[WORDS_SIZE - 64], wanted[WORDS_SIZE];
  if (rows_expected(parameter, node->children, wanted, sizeof wanted)) {
    error_at_value(reader, node, wanted, "the table '%s' has %zu row%s", parameter->name,
                   node->children, node->children == 1 ? "" : "s");
    return false;
  }
  list_text(parameter->choice, columns, expected, sizeof expected);
  snprintf(wanted, sizeof wanted, "each row is [%s]", expected);
  double *number = scene_take(node->children * columns, sizeof *number);
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *row = node->child[i];
    if (row->kind != TREE_SEQUENCE || row->children != columns) {
      error_at_value(reader, row, wanted, "row %zu of the table '%s' has not %zu columns", i + 1,
                     parameter->name, columns);
      continue;
    }
    for (size_t k = 0; k < columns; k++)
      amount_read(reader, row->child[k], parameter->choice[k], parameter->choice_unit[k],
                  &number[i * columns + k]);
  }
  value->number = number;
  value->numbers = node->children * columns;
  return reader->faults == faults;
}

static bool table_from_file(struct scene_reader *reader, const struct parameter *parameter,
                            const struct tree *node, struct value *value)
{
  static const char *const known[] = {"file"};
  const struct tree *name = tree_get(node, "file");
  expect_keys(reader, node, known, 1, "a table");
  if (name && name->kind == TREE_SCALAR && name->text[0]) {
    struct table_file *file = table_file_read(reader, parameter, name);
    const bool fine = file && table_file_fits(file);
    if (fine) {
      value->file = table_file_source(file);
      value->number = table_file_numbers(file, &value->numbers);
    }
    table_file_free(file);
    return fine;
  }
  error_at_value(reader, node, "rows in brackets, or {file: NAME.csv}", "table '%s' names no file",
                 parameter->name);
  return false;
}

/* One number where a curve may stand: a single row that begins with 0. */
static bool table_of_one(struct scene_reader *reader, const struct parameter *parameter,
                         const struct tree *node, struct value *value)
{
  char expected[WORDS_SIZE];
  if (rows_expected(parameter, 1, expected, sizeof expected)) {
    error_at_value(reader, node, expected, "one number is one row of the table '%s'",
                   parameter->name);
    return false;
  }
  value->number = scene_take(2, sizeof *value->number);
  value->numbers = 2;
  return amount_read(reader, node, parameter->name, parameter->choice_unit[1], &value->number[1]);
}

bool table_read(struct scene_reader *reader, const struct parameter *parameter,
                const struct tree *node, struct value *value)
{
  if (node->kind == TREE_MAPPING)
    return table_from_file(reader, parameter, node, value);
  if (node->kind == TREE_SEQUENCE && node->children)
    return table_in_place(reader, parameter, node, value);
  if (node->kind == TREE_SCALAR && parameter->choices == 2)
    return table_of_one(reader, parameter, node, value);
  error_at_value(reader, node, "rows in brackets, or {file: NAME.csv}",
                 "'%s' is %s where a table is due", parameter->name,
                 node->kind == TREE_SEQUENCE ? "an empty list" : "a plain value");
  return false;
}
