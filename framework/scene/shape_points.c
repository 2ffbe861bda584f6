/* Points of a body from a CSV file: a line a point, the first line names the columns. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const double turn = 2 * 3.14159265358979323846;

/* Edge of the square that a point stands for: across the circle where the scene is revolved. */
static double edge(const struct shape *shape, unsigned axes, const double *place, double volume)
{
  if (shape->revolved)
    return sqrt(volume / (turn * place[0]));
  return axes == 1 ? volume : axes == 2 ? sqrt(volume) : cbrt(volume);
}

static double volume_around(const struct shape *shape, unsigned axes, const double *place,
                            double spacing)
{
  double volume = 1;
  for (unsigned k = 0; k < axes; k++)
    volume *= spacing;
  return shape->revolved ? volume * turn * place[0] : volume;
}

static bool point_fits(struct table_file *file, const struct shape *shape, size_t i, double volume)
{
  const double *place = &shape->points.place[3 * i];
  if (shape->revolved && !(place[0] > 0))
    table_file_blame(file, i, "x is the radius, greater than 0", "point %zu has x = %.6g m", i + 1,
                     place[0]);
  else if (!(volume > 0))
    table_file_blame(file, i, "volumes greater than 0", "point %zu has volume = %.6g", i + 1,
                     volume);
  else
    return true;
  return false;
}

struct seat {
  double place[3];
  size_t row;
};

static int by_place(const void *one, const void *other)
{
  const struct seat *a = one, *b = other;
  for (int k = 0; k < 3; k++)
    if (a->place[k] != b->place[k])
      return a->place[k] < b->place[k] ? -1 : 1;
  return (a->row > b->row) - (a->row < b->row);
}

/* Two points at one place would be material in material. */
static bool points_differ(struct table_file *file, const struct shape_points *points)
{
  struct seat *seat = scene_take(points->count, sizeof *seat);
  size_t first = SIZE_MAX, again = SIZE_MAX;
  for (size_t i = 0; i < points->count; i++) {
    memcpy(seat[i].place, &points->place[3 * i], sizeof seat[i].place);
    seat[i].row = i;
  }
  qsort(seat, points->count, sizeof *seat, by_place);
  for (size_t i = 1; i < points->count; i++)
    if (memcmp(seat[i].place, seat[i - 1].place, sizeof seat[i].place) == 0 &&
        seat[i].row < again) {
      again = seat[i].row;
      first = seat[i - 1].row;
    }
  free(seat);
  if (again == SIZE_MAX)
    return true;
  table_file_blame(file, again, "each point once", "point %zu is where point %zu is, of line %zu",
                   again + 1, first + 1, table_file_line(file, first));
  return false;
}

/* From the rows of the file. */
static bool points_take(struct scene_reader *reader, struct table_file *file, double spacing,
                        struct shape *shape)
{
  unsigned axes = reader->axes ? reader->axes : 3;
  size_t numbers, width = axes + (spacing > 0 ? 0 : 1);
  double *number = table_file_numbers(file, &numbers);
  const size_t count = numbers / width;
  bool fine = true;
  shape->points = (struct shape_points){.count = count,
                                        .place = scene_keep(reader, 3 * count, sizeof(double)),
                                        .volume = scene_keep(reader, count, sizeof(double)),
                                        .half = scene_keep(reader, count, sizeof(double))};
  for (size_t i = 0; i < count && fine; i++) {
    const double *row = &number[i * width];
    double *place = &shape->points.place[3 * i];
    for (unsigned k = 0; k < axes; k++)
      place[k] = row[k] + 0.0; /* no negative zero: places are compared */
    double volume = spacing > 0 ? volume_around(shape, axes, place, spacing) : row[axes];
    fine = point_fits(file, shape, i, volume);
    shape->points.volume[i] = volume;
    shape->points.half[i] = 0.5 * edge(shape, axes, place, volume);
  }
  free(number);
  return fine && points_differ(file, &shape->points);
}

bool shape_points_read(struct scene_reader *reader, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"file", "spacing"};
  const struct tree *file = tree_get(node, "file");
  unsigned axes = reader->axes ? reader->axes : 3;
  double spacing = 0;
  expect_keys(reader, node, known, ARRAY_SIZE(known), "points");
  if (!file || file->kind != TREE_SCALAR || file->text[0] == 0) {
    if (file || !is_typo_of(reader, node, "file"))
      error_at_key(reader, node, "points: {file: NAME.csv}", "'points' names no file");
    return false;
  }
  if (!length_read(reader, node, "spacing", false, false, &spacing))
    return false;
  const char *unit[4] = {"m", "m", "m", "m"}, *name[4] = {"x", "y", "z"};
  name[axes] = "volume";
  unit[axes] = axes == 1 ? "m" : axes == 2 && !reader->axisymmetric ? "m2" : "m3";
  const struct parameter parameter = {.name = "points",
                                      .type = VALUE_TABLE,
                                      .choice = name,
                                      .choice_unit = unit,
                                      .choices = axes + (spacing > 0 ? 0 : 1)};
  struct table_file *table = table_file_read(reader, &parameter, file);
  bool fine = table && points_take(reader, table, spacing, shape);
  table_file_free(table);
  return fine;
}
