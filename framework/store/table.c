/* What a study leaves: a table with a row a run, and curves with their moments. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/exclusive.h"
#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/store_private.h"

static gamut_status replace_text(struct store *store, const char *file, struct text *text,
                                 struct trace *trace)
{
  gamut_status status = text->failed
                            ? trace_fail(trace, GAMUT_INTERNAL, "out of memory")
                            : file_replace(store->folder, file, text->data, text->size, trace);
  free(text->data);
  return status;
}

static gamut_status write_csv(struct store *store, const char *file,
                              const struct table_column *column, size_t columns, size_t rows,
                              struct trace *trace)
{
  struct text text = {0};
  for (size_t c = 0; c < columns; c++) {
    char name[400];
    bool unit = column[c].unit && strcmp(column[c].unit, "1") != 0;
    snprintf(name, sizeof name, "%s%s%s%s", column[c].name, unit ? " [" : "",
             unit ? column[c].unit : "", unit ? "]" : "");
    text_add(&text, "%s", c ? "," : "");
    text_cell(&text, name);
  }
  text_add(&text, "\n");
  for (size_t r = 0; r < rows; r++) {
    for (size_t c = 0; c < columns; c++) {
      text_add(&text, "%s", c ? "," : "");
      if (column[c].text)
        text_cell(&text, column[c].text[r]);
      else if (column[c].value[r] == column[c].value[r]) /* a value that is not there is left out */
        text_number(&text, column[c].value[r]);
    }
    text_add(&text, "\n");
  }
  return replace_text(store, file, &text, trace);
}

static herr_t describe(hid_t dataset, const char *unit, const char *meaning)
{
  herr_t result = 0;
  if (unit)
    result = hdf5_text_attribute(dataset, "unit", unit);
  if (result >= 0 && meaning)
    result = hdf5_text_attribute(dataset, "meaning", meaning);
  H5Dclose(dataset);
  return result;
}

static herr_t write_reals(hid_t at, const char *name, const char *unit, const char *meaning,
                          size_t rows, size_t columns, const double *value)
{
  hid_t made = hdf5_dataset(at, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rows, columns, value);
  return made < 0 ? -1 : describe(made, unit, meaning);
}

static herr_t write_texts(hid_t at, const struct table_column *column, size_t above, size_t rows)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  herr_t result = H5Tset_size(type, H5T_VARIABLE);
  if (result >= 0)
    result = H5Tset_cset(type, H5T_CSET_UTF8);
  hid_t made =
      result >= 0 ? hdf5_dataset(at, column->name, type, type, rows, 1, column->text + above) : -1;
  H5Tclose(type);
  return made < 0 ? -1 : describe(made, NULL, column->meaning);
}

/* Opens a group by its path, making what is missing. */
static hid_t group_at(hid_t file, const char *path)
{
  if (strcmp(path, ".") == 0)
    return H5Gopen2(file, path, H5P_DEFAULT);
  hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  hid_t group = H5Lexists(file, path, H5P_DEFAULT) > 0
                    ? H5Gopen2(file, path, H5P_DEFAULT)
                    : H5Gcreate2(file, path, links, H5P_DEFAULT, H5P_DEFAULT);
  H5Pclose(links);
  return group;
}

static herr_t write_column(hid_t table, const struct table_column *column, size_t above,
                           size_t rows)
{
  hid_t at = group_at(table, column->group ? column->group : ".");
  if (at < 0)
    return -1;
  herr_t result = column->text ? write_texts(at, column, above, rows)
                               : write_reals(at, column->name, column->unit, column->meaning, rows,
                                             1, column->value + above);
  H5Gclose(at);
  return result;
}

gamut_status store_table(struct store *store, const char *file, const char *group,
                         const struct table_column *column, size_t columns, size_t rows,
                         size_t above, struct trace *trace)
{
  EXCLUSIVE;
  size_t bytes = 65536;
  herr_t result = 0;
  gamut_status status = write_csv(store, file, column, columns, rows, trace);
  for (size_t c = 0; c < columns; c++) {
    bytes += rows * 64 + 4096;
    for (size_t r = 0; column[c].text && r < rows; r++)
      bytes += strlen(column[c].text[r]);
  }
  if (status == GAMUT_OK)
    status = hdf5_reserve(store->file, bytes, store->path, trace);
  if (status != GAMUT_OK)
    return status;
  hid_t at = group_at(store->file, group);
  for (size_t c = 0; at >= 0 && result >= 0 && c < columns; c++)
    result = write_column(at, &column[c], above, rows - above);
  if (at >= 0)
    H5Gclose(at);
  return at >= 0 && result >= 0 ? hdf5_flush(store->file, store->path, trace)
                                : store_broken(store, trace);
}

/* "Pa2" would be read as a name: a square is stated in words of the unit. */
static void square_of(const char *unit, char *square, size_t size)
{
  if (strcmp(unit, "1") == 0)
    snprintf(square, size, "1");
  else
    snprintf(square, size, "(%s)2", unit);
}

static herr_t write_curve(hid_t parent, const struct table_curve *curve)
{
  char square[64];
  hid_t at = group_at(parent, curve->name);
  if (at < 0)
    return -1;
  square_of(curve->unit, square, sizeof square);
  const struct {
    const char *name, *unit, *meaning;
    const double *value;
  } part[] = {
      {curve->axis, curve->axis_unit, "common axis of the runs", curve->at},
      {"mean", curve->unit, "mean over the runs", curve->mean},
      {"variance", square, "variance over the runs", curve->variance},
      {"mean_error", curve->unit, "standard error of the mean", curve->mean_error},
      {"variance_error", square, "standard error of the variance", curve->variance_error},
      {"mean_lower", curve->unit, "the mean is above it, 95 %", curve->mean_interval[0]},
      {"mean_upper", curve->unit, "the mean is below it, 95 %", curve->mean_interval[1]},
      {"variance_lower", square, "the variance is above it, 95 %", curve->variance_interval[0]},
      {"variance_upper", square, "the variance is below it, 95 %", curve->variance_interval[1]},
      {"nominal", curve->unit, "the run at the means", curve->nominal}};
  herr_t result = hdf5_text_attribute(at, "axis", curve->axis);
  if (result >= 0 && curve->meaning)
    result = hdf5_text_attribute(at, "meaning", curve->meaning);
  for (size_t i = 0; result >= 0 && i < ARRAY_SIZE(part); i++)
    result = write_reals(at, part[i].name, part[i].unit, part[i].meaning, curve->count, 1,
                         part[i].value);
  if (result >= 0 && curve->runs > 0)
    result = write_reals(at, "runs", curve->unit, "one row a run, as in the table", curve->runs,
                         curve->count, curve->run);
  H5Gclose(at);
  return result;
}

static gamut_status write_curves_csv(struct store *store, const struct table_curve *curve,
                                     size_t curves, struct trace *trace)
{
  struct text text = {0};
  text_add(&text, "quantity,unit,");
  text_cell(&text, curve[0].axis);
  text_add(&text, ",value,variance,mean_error,variance_error,mean_lower,mean_upper,"
                  "variance_lower,variance_upper,nominal\n");
  for (size_t k = 0; k < curves; k++)
    for (size_t i = 0; i < curve[k].count; i++) {
      const double number[] = {curve[k].at[i],
                               curve[k].mean[i],
                               curve[k].variance[i],
                               curve[k].mean_error[i],
                               curve[k].variance_error[i],
                               curve[k].mean_interval[0][i],
                               curve[k].mean_interval[1][i],
                               curve[k].variance_interval[0][i],
                               curve[k].variance_interval[1][i],
                               curve[k].nominal[i]};
      text_cell(&text, curve[k].name);
      text_add(&text, ",");
      text_cell(&text, curve[k].unit);
      for (size_t p = 0; p < ARRAY_SIZE(number); p++) {
        text_add(&text, ",");
        if (isfinite(number[p])) /* what is not known is left out */
          text_number(&text, number[p]);
      }
      text_add(&text, "\n");
    }
  return replace_text(store, RESULT_HISTORY, &text, trace);
}

gamut_status store_curves(struct store *store, const char *group, const struct table_curve *curve,
                          size_t curves, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status = GAMUT_OK;
  size_t bytes = 65536;
  uint64_t sum;
  herr_t result = 0;
  if (curves == 0)
    return GAMUT_OK;
  for (size_t k = 0; k < curves; k++)
    bytes += 32768 + (10 + curve[k].runs) * curve[k].count * sizeof(double);
  TRY(write_curves_csv(store, curve, curves, trace));
  TRY(hdf5_reserve(store->file, bytes, store->path, trace));
  hid_t at = group_at(store->file, group);
  for (size_t k = 0; at >= 0 && result >= 0 && k < curves; k++)
    result = write_curve(at, &curve[k]);
  if (at >= 0 && result >= 0)
    result = checksum_write(at, CURVES_NAME, &sum);
  if (at >= 0)
    H5Gclose(at);
  status = at >= 0 && result >= 0 ? hdf5_flush(store->file, store->path, trace)
                                  : store_broken(store, trace);
done:
  return status;
}

static gamut_status write_members_csv(struct store *store, const struct table_member *member,
                                      size_t members, struct trace *trace)
{
  struct text text = {0};
  const char *axis = member[0].axis;
  for (size_t k = 1; k < members; k++)
    axis = strcmp(member[k].axis, axis) == 0 ? axis : "axis";
  text_add(&text, "run,label,quantity,unit,");
  text_cell(&text, axis);
  text_add(&text, ",value\n");
  for (size_t k = 0; k < members; k++)
    for (size_t i = 0; i < member[k].count; i++) {
      text_add(&text, "%zu,", member[k].run);
      text_cell(&text, member[k].label);
      text_add(&text, ",");
      text_cell(&text, member[k].name);
      text_add(&text, ",");
      text_cell(&text, member[k].unit);
      text_add(&text, ",");
      text_number(&text, member[k].at[i]);
      text_add(&text, ",");
      if (isfinite(member[k].value[i]))
        text_number(&text, member[k].value[i]);
      text_add(&text, "\n");
    }
  return replace_text(store, RESULT_HISTORY, &text, trace);
}

static herr_t write_member(hid_t parent, const struct table_member *member)
{
  char name[24];
  snprintf(name, sizeof name, "%08zu", member->run);
  hid_t family = group_at(parent, member->name);
  hid_t at = family >= 0 ? group_at(family, name) : -1;
  if (family >= 0)
    H5Gclose(family);
  if (at < 0)
    return -1;
  herr_t result = hdf5_text_attribute(at, "axis", member->axis);
  if (result >= 0)
    result = hdf5_text_attribute(at, "family", member->name);
  if (result >= 0)
    result = hdf5_text_attribute(at, "label", member->label);
  if (result >= 0)
    result = write_reals(at, member->axis, member->axis_unit, NULL, member->count, 1, member->at);
  if (result >= 0)
    result =
        write_reals(at, "value", member->unit, member->meaning, member->count, 1, member->value);
  H5Gclose(at);
  return result;
}

gamut_status store_members(struct store *store, const char *group,
                           const struct table_member *member, size_t members, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  size_t bytes = 65536;
  uint64_t sum;
  herr_t result = 0;
  if (members == 0)
    return GAMUT_OK;
  for (size_t k = 0; k < members; k++)
    bytes += 32768 + 2 * member[k].count * sizeof(double);
  TRY(write_members_csv(store, member, members, trace));
  TRY(hdf5_reserve(store->file, bytes, store->path, trace));
  hid_t at = group_at(store->file, group);
  for (size_t k = 0; at >= 0 && result >= 0 && k < members; k++)
    result = write_member(at, &member[k]);
  if (at >= 0 && result >= 0)
    result = checksum_write(at, CURVES_NAME, &sum);
  if (at >= 0)
    H5Gclose(at);
  status = at >= 0 && result >= 0 ? hdf5_flush(store->file, store->path, trace)
                                  : store_broken(store, trace);
done:
  return status;
}
