#include "store/result.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/result_state.h"
#include "store/state.h"

static size_t count_links(hid_t file, const char *path)
{
  H5G_info_t information = {0};
  if (H5Lexists(file, path, H5P_DEFAULT) <= 0 ||
      H5Gget_info_by_name(file, path, &information, H5P_DEFAULT) < 0)
    return 0;
  return (size_t)information.nlinks;
}

gamut_status result_open(const char *folder, struct trace *trace, struct result **opened)
{
  gamut_status status = GAMUT_OK;
  *opened = NULL;
  struct result *result = calloc(1, sizeof *result);
  if (result) {
    result->file = -1;
    result->path = file_path(folder, RESULT_HDF5);
  }
  if (!result || !result->path) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  } else if (!file_exists(result->path)) {
    status = trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL, "the folder that 'gamut run -o' made",
                           "'%s' holds no result: there is no " RESULT_HDF5, folder);
  } else if ((result->file = hdf5_open(result->path)) < 0) {
    status = hdf5_fault(result->path, "read", trace);
  } else {
    result->frames = count_links(result->file, FRAMES_GROUP);
    *opened = result;
    return GAMUT_OK;
  }
  result_close(result);
  return status;
}

void result_close(struct result *result)
{
  if (!result)
    return;
  if (result->file >= 0)
    H5Fclose(result->file);
  free(result->path);
  free(result);
}

size_t result_frames(const struct result *result)
{
  return result->frames;
}

static char *dataset_unit(hid_t group, const char *name)
{
  hid_t opened = H5Dopen2(group, name, H5P_DEFAULT);
  char *unit = opened >= 0 ? hdf5_read_text_attribute(opened, "unit") : NULL;
  if (opened >= 0)
    H5Dclose(opened);
  return unit ? unit : strdup("1");
}

static bool read_deviation(hid_t group, struct result_history *history)
{
  size_t count = 0, columns;
  history->deviation = hdf5_read_reals(group, "variance", &count, &columns);
  for (size_t i = 0; history->deviation && i < count; ++i)
    history->deviation[i] = sqrt(history->deviation[i]);
  return history->deviation && count == history->count;
}

static bool read_history(hid_t parent, size_t index, struct result_history *history)
{
  size_t columns, times = 0;
  history->name = hdf5_link_name(parent, index);
  hid_t group = history->name ? H5Gopen2(parent, history->name, H5P_DEFAULT) : -1;
  if (group < 0)
    return false;
  history->axis = hdf5_read_text_attribute(group, "axis");
  history->family = hdf5_read_text_attribute(group, "family");
  if (!history->axis)
    history->axis = strdup("time");
  bool study = H5Lexists(group, "mean", H5P_DEFAULT) > 0;
  const char *value = study ? "mean" : "value";
  history->unit = dataset_unit(group, value);
  history->axis_unit = dataset_unit(group, history->axis);
  history->time = hdf5_read_reals(group, history->axis, &times, &columns);
  history->value = hdf5_read_reals(group, value, &history->count, &columns);
  bool whole = !study || !history->value || read_deviation(group, history);
  H5Gclose(group);
  return whole && history->time && history->value && times == history->count;
}

gamut_status result_histories(const struct result *result, struct trace *trace,
                              struct result_history **histories, size_t *count)
{
  *histories = NULL;
  *count = 0;
  bool study = H5Lexists(result->file, "study", H5P_DEFAULT) > 0;
  const char *place = study ? "study/curves" : "quantities";
  if (study && H5Lexists(result->file, place, H5P_DEFAULT) <= 0)
    return GAMUT_OK;
  size_t links = count_links(result->file, place);
  if (links == 0)
    return GAMUT_OK;
  hid_t group = H5Gopen2(result->file, place, H5P_DEFAULT);
  *histories = calloc(links, sizeof **histories);
  if (group >= 0 && !checksum_holds(group, CURVES_NAME, NULL)) {
    H5Gclose(group);
    free(*histories);
    *histories = NULL;
    return trace_fail(trace, GAMUT_OUTPUT,
                      "the histories in '%s' are damaged: their checksum is wrong", result->path);
  }
  bool good = group >= 0 && *histories;
  for (size_t i = 0; good && i < links; ++i) {
    *count = i + 1;
    good = read_history(group, i, &(*histories)[i]);
  }
  if (group >= 0)
    H5Gclose(group);
  if (good)
    return GAMUT_OK;
  result_histories_free(*histories, *count);
  *histories = NULL;
  *count = 0;
  return hdf5_fault(result->path, "read the histories of", trace);
}

void result_histories_free(struct result_history *history, size_t count)
{
  for (size_t i = 0; history && i < count; ++i) {
    free(history[i].name);
    free(history[i].unit);
    free(history[i].axis);
    free(history[i].axis_unit);
    free(history[i].family);
    free(history[i].time);
    free(history[i].value);
    free(history[i].deviation);
  }
  free(history);
}
