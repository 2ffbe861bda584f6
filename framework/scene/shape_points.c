/* Points of a body from a CSV file: a line a point, the first line names the columns. */
#include <math.h>
#include <stdlib.h>

#include "scene/reading.h"

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

static bool point_fits(struct reading *reading, const struct tree *file, const struct shape *shape,
                       size_t i, double volume)
{
  const double *place = &shape->points.place[3 * i];
  if (shape->revolved && !(place[0] > 0))
    blame_value(reading, file, "x is the radius, greater than 0",
                "point %zu of '%s' has x = %.6g m", i + 1, file->text, place[0]);
  else if (!(volume > 0))
    blame_value(reading, file, "volumes greater than 0", "point %zu of '%s' has volume = %.6g",
                i + 1, file->text, volume);
  else
    return true;
  return false;
}

/* From the rows of the file. */
static bool points_take(struct reading *reading, const struct tree *file, const struct value *rows,
                        double spacing, struct shape *shape)
{
  unsigned axes = reading->axes ? reading->axes : 3;
  size_t width = axes + (spacing > 0 ? 0 : 1), count = rows->numbers / width;
  shape->points =
      (struct shape_points){.count = count,
                            .place = scene_keep(reading, 3 * count, sizeof(double)),
                            .volume = scene_keep(reading, count, sizeof(double)),
                            .half = scene_keep(reading, count, sizeof(double))};
  for (size_t i = 0; i < count; i++) {
    const double *row = &rows->number[i * width];
    double *place = &shape->points.place[3 * i];
    for (unsigned k = 0; k < axes; k++)
      place[k] = row[k];
    double volume = spacing > 0 ? volume_around(shape, axes, place, spacing) : row[axes];
    if (!point_fits(reading, file, shape, i, volume))
      return false;
    shape->points.volume[i] = volume;
    shape->points.half[i] = 0.5 * edge(shape, axes, place, volume);
  }
  return true;
}

bool shape_points_read(struct reading *reading, const struct tree *node, struct shape *shape)
{
  static const char *const known[] = {"file", "spacing"};
  const struct tree *file = tree_get(node, "file");
  unsigned axes = reading->axes ? reading->axes : 3;
  double spacing = 0;
  expect_keys(reading, node, known, COUNT_OF(known), "points");
  if (!file || file->kind != TREE_SCALAR) {
    if (file || !was_meant(reading, node, "file"))
      blame_key(reading, node, "points: {file: NAME.csv}", "'points' names no file");
    return false;
  }
  if (!length_read(reading, node, "spacing", false, false, &spacing))
    return false;
  const char *unit[4] = {"m", "m", "m", "m"}, *name[4] = {"x", "y", "z"};
  name[axes] = "volume";
  unit[axes] = axes == 1 ? "m" : axes == 2 && !reading->axisymmetric ? "m2" : "m3";
  const struct parameter parameter = {.name = "points",
                                      .type = VALUE_TABLE,
                                      .choice = name,
                                      .choice_unit = unit,
                                      .choices = axes + (spacing > 0 ? 0 : 1)};
  struct value rows = {.parameter = &parameter};
  bool fine = table_file_read(reading, &parameter, file, &rows) &&
              points_take(reading, file, &rows, spacing, shape);
  free(rows.number);
  return fine;
}
