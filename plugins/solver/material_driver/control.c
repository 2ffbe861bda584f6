#include <stdio.h>
#include <stdlib.h>

#include "driver.h"

static const char *const component_name[COMPONENTS] = {"xx", "yy", "zz", "xy", "yz",
                                                       "zx", "yx", "zy", "xz"};
/* Place in a matrix, and that of the mirror image. */
static const size_t place[COMPONENTS] = {0, 4, 8, 1, 5, 6, 3, 7, 2};
static const size_t mirror[COMPONENTS] = {0, 4, 8, 3, 7, 2, 1, 5, 6};

static const struct key {
  const char *name;
  enum control control;
  size_t from, to; /* components that have it */
  bool symmetric;  /* a shear is that of its mirror image too */
} key[] = {{"strain_rate", CONTROL_RATE, 0, SYMMETRIC, true},
           {"log_strain", CONTROL_LOG_STRAIN, 0, NORMALS, false},
           {"engineering_strain", CONTROL_STRAIN, 0, NORMALS, false},
           {"stress", CONTROL_STRESS, 0, SYMMETRIC, true},
           {"velocity_gradient", CONTROL_RATE, NORMALS, COMPONENTS, false}};
enum { KEYS = sizeof key / sizeof key[0] };

static gamut_status check_rows(struct gamut_run *run, const struct gamut_values *values,
                               const char *path, const struct curve *curve)
{
  for (size_t i = 0; i < curve->rows; i++) {
    if (i > 0 && !(curve->row[2 * i] >= curve->row[2 * i - 2]))
      return gamut_fail_at(run, values, path, "rows in order of time",
                           "time goes back in row %zu of the table", i + 1);
    if (curve->control == CONTROL_STRAIN && !(curve->row[2 * i + 1] > -1.0))
      return gamut_fail_at(run, values, path, "greater than -1",
                           "an engineering strain of %g leaves no length", curve->row[2 * i + 1]);
  }
  return GAMUT_OK;
}

/* A strain given as one number is reached at the end of the run. */
static gamut_status make_ramp(struct gamut_run *run, double end, struct curve *curve)
{
  curve->owned = calloc(4, sizeof *curve->owned);
  if (!curve->owned)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  curve->owned[2] = end;
  curve->owned[3] = curve->row[1];
  curve->row = curve->owned;
  curve->rows = 2;
  return GAMUT_OK;
}

static gamut_status curve_read(struct gamut_run *run, const struct gamut_values *values, size_t c,
                               struct path *out)
{
  gamut_status status = GAMUT_OK;
  struct curve *curve = &out->curve[c];
  *curve = (struct curve){.control = CONTROL_NONE, .name = component_name[c]};
  for (size_t k = 0; k < KEYS && status == GAMUT_OK; k++) {
    char path[64];
    size_t rows;
    if (c < key[k].from || c >= key[k].to)
      continue;
    snprintf(path, sizeof path, "control.%s.%s", component_name[c], key[k].name);
    const double *row = gamut_table(values, path, &rows);
    if (!rows)
      continue;
    if (curve->control != CONTROL_NONE)
      return gamut_fail_at(run, values, path, "one of strain, rate and stress",
                           "component %s is controlled twice", component_name[c]);
    curve->control = key[k].control;
    curve->row = row;
    curve->rows = rows;
    bool rate = key[k].control == CONTROL_RATE || key[k].control == CONTROL_STRESS;
    out->symmetric[c] = c >= NORMALS && key[k].symmetric;
    status = check_rows(run, values, path, curve);
    if (status == GAMUT_OK && !rate && rows == 1)
      status = make_ramp(run, gamut_real(values, "end"), curve);
  }
  return status;
}

gamut_status path_read(struct gamut_run *run, const struct gamut_values *values, struct path *path)
{
  bool any = false;
  for (size_t c = 0; c < COMPONENTS; c++) {
    gamut_status status = curve_read(run, values, c, path);
    if (status != GAMUT_OK)
      return status;
    any |= path->curve[c].control != CONTROL_NONE;
  }
  for (size_t c = NORMALS; c < SYMMETRIC; c++)
    if (path->symmetric[c] && path->curve[c + NORMALS].control != CONTROL_NONE) {
      char at[64];
      snprintf(at, sizeof at, "control.%s", component_name[c + NORMALS]);
      return gamut_fail_at(run, values, at, "velocity_gradient for both",
                           "%s moves already with %s, whose strain_rate or stress is prescribed",
                           component_name[c + NORMALS], component_name[c]);
    }
  if (!any)
    return gamut_fail_at(run, values, "control", "xx: {strain_rate: 1000 1/s}, for example",
                         "no component is controlled: the point would never move");
  return GAMUT_OK;
}

void path_free(struct path *path)
{
  for (size_t c = 0; c < COMPONENTS; c++)
    free(path->curve[c].owned);
}

/* On a line between rows; constant before the first and after the last. */
static double value_at(const struct curve *curve, double time)
{
  const double *row = curve->row, *last = row + 2 * (curve->rows - 1);
  if (time >= last[0])
    return last[1];
  if (time <= row[0])
    return row[1];
  while (row[2] <= time)
    row += 2;
  return row[1] + (row[3] - row[1]) * ((time - row[0]) / (row[2] - row[0]));
}

static double integral(const struct curve *curve, double from, double step)
{
  double sum = 0.0, at = from, to = from + step;
  if (curve->rows == 1)
    return curve->row[1] * step;
  for (size_t i = 0; i <= curve->rows && at < to; i++) {
    double until = i < curve->rows ? curve->row[2 * i] : to;
    until = until < to ? until : to;
    if (until <= at)
      continue;
    /* The line within the piece, from its middle: right at a jump too. */
    sum += (until - at) * value_at(curve, 0.5 * (at + until));
    at = until;
  }
  return sum;
}

static double increment(const struct curve *curve, double from, double step)
{
  double to = from + step;
  switch (curve->control) {
  case CONTROL_RATE:
    return integral(curve, from, step);
  case CONTROL_LOG_STRAIN:
    return value_at(curve, to) - value_at(curve, from);
  case CONTROL_STRAIN: {
    double before = value_at(curve, from), after = value_at(curve, to);
    return log1p((after - before) / (1.0 + before));
  }
  case CONTROL_NONE:
  case CONTROL_STRESS:
    break;
  }
  return 0.0;
}

void path_move(const struct path *path, size_t c, double by, double A[9])
{
  A[place[c]] += by;
  if (path->symmetric[c])
    A[mirror[c]] += by;
}

void path_increment(const struct path *path, double from, double step, double A[9])
{
  for (size_t k = 0; k < 9; k++)
    A[k] = 0.0;
  for (size_t c = 0; c < COMPONENTS; c++)
    path_move(path, c, increment(&path->curve[c], from, step), A);
}

size_t path_stresses(const struct path *path, double time, size_t component[SYMMETRIC],
                     double stress[SYMMETRIC])
{
  size_t count = 0;
  for (size_t c = 0; c < SYMMETRIC; c++)
    if (path->curve[c].control == CONTROL_STRESS) {
      component[count] = c;
      stress[count++] = value_at(&path->curve[c], time);
    }
  return count;
}
