#include <stdlib.h>
#include <string.h>

#include "expansion.h"

static int by_size(const void *one, const void *other)
{
  const double *a = one, *b = other;
  return (*a > *b) - (*a < *b);
}

/* The different numbers of one column, rising. */
static bool lines_of(struct table *table, int k, const double *row, size_t rows)
{
  double *line = table->line[k] = calloc(rows, sizeof *line);
  size_t count = 0;
  if (!line)
    return false;
  for (size_t i = 0; i < rows; i++)
    line[i] = row[i * (AXES + 1) + (size_t)k];
  qsort(line, rows, sizeof *line, by_size);
  for (size_t i = 0; i < rows; i++)
    if (count == 0 || line[i] > line[count - 1])
      line[count++] = line[i];
  table->count[k] = count;
  return true;
}

static size_t place_of(const struct table *table, const double *row)
{
  size_t place = 0;
  for (int k = AXES - 1; k >= 0; k--) {
    const double *found = bsearch(&row[k], table->line[k], table->count[k], sizeof *found, by_size);
    place = place * table->count[k] + (size_t)(found - table->line[k]);
  }
  return place;
}

const char *table_new(struct table *table, const double *row, size_t rows)
{
  for (int k = 0; k < AXES; k++)
    if (!lines_of(table, k, row, rows))
      return "out of memory";
  if (table->count[0] * table->count[1] * table->count[2] != rows)
    return "its places are no full grid, or one stands twice";
  table->value = calloc(rows, sizeof *table->value);
  bool *filled = calloc(rows, sizeof *filled);
  const char *wrong = table->value && filled ? NULL : "out of memory";
  for (size_t i = 0; !wrong && i < rows; i++) {
    size_t place = place_of(table, row + i * (AXES + 1));
    if (filled[place])
      wrong = "a place stands twice";
    filled[place] = true;
    table->value[place] = row[i * (AXES + 1) + AXES];
  }
  free(filled);
  return wrong;
}

void table_free(struct table *table)
{
  for (int k = 0; k < AXES; k++)
    free(table->line[k]);
  free(table->value);
}

/* The line before x, and how far x is on the way to the next; held constant beyond the ends. */
static size_t line_before(const struct table *table, int k, double x, double *way)
{
  const double *line = table->line[k];
  size_t low = 0, high = table->count[k] - 1;
  *way = 0.0;
  if (high == 0 || !(x > line[0]))
    return 0;
  if (x >= line[high]) {
    *way = 1.0;
    return high - 1;
  }
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (line[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  *way = (x - line[low]) / (line[high] - line[low]);
  return low;
}

double table_at(const struct table *table, const double x[AXES])
{
  size_t low[AXES];
  double way[AXES], sum = 0.0;
  for (int k = 0; k < AXES; k++)
    low[k] = line_before(table, k, x[k], &way[k]);
  for (unsigned corner = 0; corner < 8; corner++) {
    double weight = 1.0;
    size_t place = 0;
    for (int k = AXES - 1; k >= 0; k--) {
      bool next = corner >> k & 1u;
      weight *= next ? way[k] : 1.0 - way[k];
      place = place * table->count[k] + low[k] + (next && weight > 0.0);
    }
    if (weight > 0.0)
      sum += weight * table->value[place];
  }
  return sum;
}
