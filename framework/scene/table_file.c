/* Tables from CSV files as RFC 4180 has them (libcsv): the first line names the columns, with units
 * in brackets. Blank lines and lines that begin with '#' are passed over. */
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <csv.h>

#include "base/memory.h"
#include "scene/scene_private.h"
#include "tree/load.h"

enum { TABLE_BYTES_MAX = 256 << 20, SHOWN = 60 };

/* A cell of the first line. */
struct head {
  char *name, *unit;    /* unit null: numbers are SI, or bring a unit of their own */
  size_t wanted;        /* which column of the table it gives; SIZE_MAX: none */
  double scale, offset; /* from its unit to SI */
};

struct table_file {
  struct scene_reader *reader;
  const struct parameter *parameter;
  const struct tree *node;
  char path[PATH_MAX];
  char *text;
  size_t size, at;        /* bytes, and those that have been read */
  size_t cell_at, row_at; /* where the cell and the row begin */
  size_t cells;           /* of this row, so far */
  struct head *head;
  size_t heads;
  bool headed, failed;
  bool cell_ended, row_ended; /* in the piece that is being read */
  double *number;
  size_t numbers, capacity;
  size_t *row; /* where each row begins */
};

/* Whether a line ends with this character. */
static bool ends_line(const char *c)
{
  return *c == '\n' || (*c == '\r' && c[1] != '\n');
}

/* Line and column of a byte, from 1, and a copy of its line. */
static char *locate(const struct table_file *table, size_t byte, struct place *place)
{
  size_t start = 0;
  *place = (struct place){.file = table->path, .line = 1, .column = 1, .width = 1};
  for (size_t k = 0; k < byte; k++) {
    if (!ends_line(&table->text[k]))
      continue;
    place->line += place->line < INT_MAX;
    start = k + 1;
  }
  for (size_t k = start; k < byte; k++)
    place->column += (table->text[k] & 0xC0) != 0x80 && place->column < INT_MAX;
  const size_t length = strcspn(table->text + start, "\r\n");
  char *source = scene_take(length + 1, 1);
  if (length > 0)
    memcpy(source, table->text + start, length);
  place->source = source;
  return source;
}

static void fault(struct table_file *table, size_t byte, const char *expected, const char *format,
                  ...) __attribute__((format(printf, 4, 5)));

static void fault(struct table_file *table, size_t byte, const char *expected, const char *format,
                  ...)
{
  char words[WORDS_SIZE];
  struct place place;
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  char *source = locate(table, byte, &place);
  error_at_place(table->reader, &place, table->node, expected, "%s", words);
  free(source);
  table->failed = true;
}

/* "time [us]" becomes name and unit. */
static bool head_cell(struct table_file *table, const char *cell)
{
  struct head *grown = realloc(table->head, (table->heads + 1) * sizeof *grown);
  char *name = strdup(cell);
  if (!grown || !name)
    memory_ended();
  table->head = grown;
  struct head *head = &grown[table->heads++];
  *head = (struct head){.name = name, .wanted = SIZE_MAX, .scale = 1};
  char *open = strchr(name, '['), *close = open ? strchr(open, ']') : NULL;
  if (open && (!close || close[1 + strspn(close + 1, " \t")])) {
    fault(table, table->cell_at, "such as 'time [us]'", "'%.*s' is no name with a unit in brackets",
          SHOWN, cell);
    return false;
  }
  if (open) {
    head->unit = open + 1;
    *close = *open = 0;
    for (char *end = open; end > name && (end[-1] == ' ' || end[-1] == '\t');)
      *--end = 0;
  }
  if (name[0] == 0)
    fault(table, table->cell_at, "no comma at the end of the line",
          "column %zu has no name in the first line", table->heads);
  for (size_t i = 0; i + 1 < table->heads && !table->failed; i++)
    if (strcmp(table->head[i].name, name) == 0)
      fault(table, table->cell_at, "each column once", "column '%.*s' stands twice", SHOWN, name);
  return !table->failed;
}

/* Scale and offset of a unit, so that each number need not be read together with it. */
static bool unit_fits(struct table_file *table, struct head *head, const char *unit)
{
  const struct units *units = table->reader->units;
  char text[96];
  double one;
  if (!head->unit)
    return true;
  if (strlen(head->unit) < sizeof text - 4) {
    snprintf(text, sizeof text, "0 %s", head->unit);
    bool fits = unit_read(units, text, unit, &head->offset) == UNIT_OK;
    snprintf(text, sizeof text, "1 %s", head->unit);
    if (fits && unit_read(units, text, unit, &one) == UNIT_OK) {
      head->scale = one - head->offset;
      return true;
    }
  }
  snprintf(text, sizeof text, "a unit like %s", unit_is_pure(unit) ? "1" : unit);
  fault(table, table->row_at, text, "column '%.*s' has the unit '%.*s'", SHOWN, head->name, SHOWN,
        head->unit);
  return false;
}

static const char *unit_of(const struct parameter *parameter, size_t column)
{
  const char *unit = parameter->choice_unit[column];
  return unit_is_pure(unit) ? "1" : unit;
}

static void head_row(struct table_file *table)
{
  const struct parameter *parameter = table->parameter;
  for (size_t k = 0; k < parameter->choices && !table->failed; k++) {
    size_t i = 0;
    while (i < table->heads && strcmp(table->head[i].name, parameter->choice[k]) != 0)
      i++;
    if (i == table->heads) {
      fault(table, table->row_at, "the first line names the columns, 'time [us], strain'",
            "column '%s' is missing", parameter->choice[k]);
    } else {
      table->head[i].wanted = k;
      unit_fits(table, &table->head[i], unit_of(parameter, k));
    }
  }
  table->headed = true;
}

static bool cell_number(const struct table_file *table, const struct head *head, const char *cell,
                        double *number)
{
  const struct units *units = table->reader->units;
  if (!head->unit)
    return unit_read_bare(units, cell, unit_of(table->parameter, head->wanted), number) == UNIT_OK;
  if (strspn(cell, "0123456789+-.eE") < strlen(cell) ||
      unit_read(units, cell, "1", number) != UNIT_OK)
    return false;
  *number = *number * head->scale + head->offset;
  return true;
}

static void make_room(struct table_file *table)
{
  const size_t columns = table->parameter->choices;
  if (table->numbers + columns <= table->capacity)
    return;
  table->capacity = 2 * table->capacity + 64 * columns;
  double *number = realloc(table->number, table->capacity * sizeof *number);
  size_t *row = realloc(table->row, table->capacity / columns * sizeof *row);
  if (!number || !row)
    memory_ended();
  table->number = number;
  table->row = row;
}

static void take_cell(void *text, size_t length, void *data)
{
  struct table_file *table = data;
  const char *cell = length > 0 ? text : "";
  table->cell_ended = true;
  if (table->failed)
    return;
  if (!table->headed) {
    head_cell(table, cell);
    table->cells++;
    return;
  }
  if (table->cells == table->heads) {
    fault(table, table->cell_at, "a row has as many cells as the first line",
          "more than the %zu cells that the first line names", table->heads);
    return;
  }
  const struct head *head = &table->head[table->cells++];
  if (head->wanted == SIZE_MAX)
    return;
  make_room(table);
  if (!cell_number(table, head, cell, &table->number[table->numbers + head->wanted]))
    fault(table, table->cell_at, "a number, in SI or in the unit that the first line gives",
          "'%.*s' is no value of '%s'", SHOWN, cell, head->name);
}

static void take_row(int end, void *data)
{
  struct table_file *table = data;
  (void)end;
  table->row_ended = true;
  if (table->failed || table->cells == 0)
    return;
  if (!table->headed) {
    head_row(table);
  } else if (table->cells < table->heads) {
    fault(table, table->row_at, "a row has as many cells as the first line",
          "%zu cell%s where the first line names %zu", table->cells, table->cells == 1 ? "" : "s",
          table->heads);
  } else {
    table->row[table->numbers / table->parameter->choices] = table->row_at;
    table->numbers += table->parameter->choices;
  }
  table->cells = 0;
}

/* The parser is given the text in pieces that end where a cell or a row may, so that the place of
 * each is known. */
static void feed(struct table_file *table, struct csv_parser *parser)
{
  bool fresh = true; /* a row may begin here */
  while (table->at < table->size && !table->failed) {
    const char *from = table->text + table->at;
    if (fresh && *from == '#') {
      table->at += strcspn(from, "\n");
      table->cell_at = table->row_at = table->at += table->text[table->at] == '\n';
      continue;
    }
    size_t length = strcspn(from, ",\r\n");
    length += from[length] != 0;
    table->cell_ended = table->row_ended = false;
    const size_t read = csv_parse(parser, from, length, take_cell, take_row, table);
    if (read < length && !table->failed)
      fault(table, table->at + read, "quotes stand around a whole cell, or nowhere",
            "a cell with quotes inside");
    table->at += length;
    fresh = table->row_ended || (fresh && strspn(from, " \t\r\n") >= length);
    if (table->cell_ended || fresh)
      table->cell_at = table->at + strspn(table->text + table->at, " \t");
    if (fresh)
      table->row_at = table->at;
  }
}

static void parse(struct table_file *table)
{
  struct csv_parser parser;
  const char *zero = memchr(table->text, 0, table->size);
  if (zero) {
    fault(table, (size_t)(zero - table->text), "save it as UTF-8 text", "a zero byte in a table");
    return;
  }
  if (strncmp(table->text, "\xEF\xBB\xBF", 3) == 0) /* a byte order mark is no text */
    table->cell_at = table->row_at = table->at = 3;
  if (csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) != 0)
    memory_ended();
  feed(table, &parser);
  if (!table->failed && csv_fini(&parser, take_cell, take_row, table) != 0)
    fault(table, table->cell_at, "close them", "quotes are not closed");
  csv_free(&parser);
  if (!table->failed && table->numbers == 0)
    fault(table, 0, "the first line names the columns, then a row a line",
          table->headed ? "the table has no rows" : "there is nothing in it");
}

struct table_file *table_file_read(struct scene_reader *reader, const struct parameter *parameter,
                                   const struct tree *name)
{
  char why[160] = "the name is too long";
  struct table_file *table = scene_take(1, sizeof *table);
  table->reader = reader;
  table->parameter = parameter;
  table->node = name;
  if (!path_beside(name, table->path, sizeof table->path) ||
      !text_load(table->path, TABLE_BYTES_MAX, &table->text, &table->size, why, sizeof why)) {
    error_at_value(reader, name, "a CSV file beside this one", "table file '%.300s': %s",
                   table->path, why);
    table->failed = true;
  } else {
    input_file_record(reader, name, table->path, table->text, table->size);
    parse(table);
  }
  if (!table->failed)
    return table;
  table_file_free(table);
  return NULL;
}

double *table_file_numbers(struct table_file *table, size_t *count)
{
  double *number = table->number;
  *count = table->numbers;
  table->number = NULL;
  return number;
}

void table_file_blame(struct table_file *table, size_t row, const char *expected,
                      const char *format, ...)
{
  char words[WORDS_SIZE];
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  fault(table, table->row[row], expected, "%s", words);
}

bool table_file_fits(struct table_file *table)
{
  char expected[WORDS_SIZE];
  const size_t rows = table->numbers / table->parameter->choices;
  if (!rows_expected(table->parameter, rows, expected, sizeof expected))
    return true;
  table_file_blame(table, rows - 1, expected, "the table '%s' ends after %zu row%s",
                   table->parameter->name, rows, rows == 1 ? "" : "s");
  return false;
}

struct value_file *table_file_source(const struct table_file *table)
{
  const size_t rows = table->numbers / table->parameter->choices;
  struct value_file *file = value_file_new(table->path);
  file->line = scene_take(rows, sizeof *file->line);
  size_t line = 1;
  for (size_t row = 0, at = 0; row < rows; row++) {
    for (; at < table->row[row]; at++)
      line += ends_line(table->text + at);
    file->line[row] = line;
  }
  return file;
}

size_t table_file_line(const struct table_file *table, size_t row)
{
  struct place place;
  free(locate(table, table->row[row], &place));
  return (size_t)place.line;
}

void table_file_free(struct table_file *table)
{
  if (!table)
    return;
  for (size_t i = 0; i < table->heads; i++)
    free(table->head[i].name);
  free(table->head);
  free(table->number);
  free(table->row);
  free(table->text);
  free(table);
}
