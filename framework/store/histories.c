#include <stdlib.h>
#include <string.h>

#include "base/exclusive.h"
#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/store_private.h"

void text_number(struct text *text, double value)
{
  char number[40];
  snprintf(number, sizeof number, "%.15g", value);
  if (strtod(number, NULL) != value)
    snprintf(number, sizeof number, "%.17g", value);
  text_add(text, "%s", number);
}

void text_cell(struct text *text, const char *words)
{
  if (!strpbrk(words, ",\"\r\n")) {
    text_add(text, "%s", words);
    return;
  }
  text_add(text, "\"");
  for (; *words; ++words)
    text_add(text, *words == '"' ? "\"\"" : "%c", *words);
  text_add(text, "\"");
}

static gamut_status write_table(struct store *store, struct history *const *history, size_t count,
                                struct trace *trace)
{
  struct text text = {0};
  gamut_status status;
  const char *axis = count ? history[0]->axis : "time";
  for (size_t h = 1; h < count; ++h) {
    if (strcmp(history[h]->axis, axis) != 0)
      axis = "axis";
  }
  text_add(&text, "quantity,unit,");
  text_cell(&text, axis);
  text_add(&text, ",value\n");
  for (size_t h = 0; h < count; ++h) {
    for (size_t i = 0; i < history[h]->count; ++i) {
      text_cell(&text, history[h]->quantity->name);
      text_add(&text, ",");
      text_cell(&text, history[h]->unit);
      text_add(&text, ",");
      text_number(&text, history[h]->time[i]);
      text_add(&text, ",");
      text_number(&text, history[h]->value[i]);
      text_add(&text, "\n");
    }
  }
  if (text.failed)
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  else
    status = file_replace(store->folder, RESULT_HISTORY, text.data, text.size, trace);
  free(text.data);
  return status;
}

static herr_t write_series(hid_t group, const char *name, const char *unit, size_t count,
                           const double *data)
{
  hid_t made = hdf5_dataset(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, 1, data);
  if (made < 0)
    return -1;
  herr_t result = hdf5_text_attribute(made, "unit", unit);
  H5Dclose(made);
  return result;
}

static herr_t write_history(hid_t parent, const struct history *history)
{
  const struct quantity *quantity = history->quantity;
  hid_t group = H5Gcreate2(parent, quantity->name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0)
    return -1;
  herr_t result = hdf5_text_attribute(group, "axis", history->axis);
  if (result >= 0 && quantity->measure && quantity->measure->doc)
    result = hdf5_text_attribute(group, "meaning", quantity->measure->doc);
  if (result >= 0 && history->placed)
    result = hdf5_reals_attribute(group, "place", history->place, 3);
  if (result >= 0 && quantity->family)
    result = hdf5_text_attribute(group, "family", quantity->family);
  if (result >= 0)
    result = write_series(group, history->axis, history->axis_unit, history->count, history->time);
  if (result >= 0)
    result = write_series(group, "value", history->unit, history->count, history->value);
  H5Gclose(group);
  return result;
}

gamut_status store_histories(struct store *store, struct history *const *history, size_t count,
                             struct trace *trace)
{
  EXCLUSIVE;
  herr_t result = 0;
  uint64_t sum;
  size_t bytes = 65536;
  gamut_status status = write_table(store, history, count, trace);
  for (size_t h = 0; h < count; ++h)
    bytes += 2 * history[h]->count * sizeof(double) + 32768;
  if (status == GAMUT_OK)
    status = hdf5_reserve(store->file, bytes, store->path, trace);
  if (status != GAMUT_OK)
    return status;
  if (H5Lexists(store->file, "quantities", H5P_DEFAULT) > 0)
    result = H5Ldelete(store->file, "quantities", H5P_DEFAULT);
  hid_t group = H5Gcreate2(store->file, "quantities", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0 || result < 0) {
    if (group >= 0)
      H5Gclose(group);
    return store_broken(store, trace);
  }
  for (size_t h = 0; h < count && result >= 0; ++h)
    result = write_history(group, history[h]);
  if (result >= 0)
    result = checksum_write(group, CURVES_NAME, &sum);
  H5Gclose(group);
  return result >= 0 ? hdf5_flush(store->file, store->path, trace) : store_broken(store, trace);
}
