#include "store/result.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/exclusive.h"
#include "base/memory.h"
#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/store_private.h"

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
  EXCLUSIVE;
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
  EXCLUSIVE;
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
  return unit ? unit : memory_copy("1");
}

static bool read_deviation(hid_t group, struct result_history *history)
{
  size_t count = 0, columns;
  history->deviation = hdf5_read_reals(group, "variance", &count, &columns);
  for (size_t i = 0; history->deviation && i < count; ++i)
    history->deviation[i] = sqrt(history->deviation[i]);
  return history->deviation && count == history->count;
}

/* The curve of one run among several stands below its quantity: a number distinguishes them. */
static bool name_member(struct result_history *history)
{
  history->label = NULL;
  if (!history->family)
    return true;
  const size_t size = strlen(history->family) + strlen(history->name) + 2;
  char *name = malloc(size);
  if (!name)
    return false;
  snprintf(name, size, "%s.%s", history->family, history->name);
  free(history->name);
  history->name = name;
  return true;
}

static bool read_history(hid_t parent, size_t index, bool member, struct result_history *history)
{
  size_t columns, times = 0;
  history->name = hdf5_link_name(parent, index);
  hid_t group = history->name ? H5Gopen2(parent, history->name, H5P_DEFAULT) : -1;
  if (group < 0)
    return false;
  history->axis = hdf5_read_text_attribute(group, "axis");
  history->family = hdf5_read_text_attribute(group, "family");
  if (!history->axis)
    history->axis = memory_copy("time");
  bool sample = H5Lexists(group, "mean", H5P_DEFAULT) > 0;
  const char *value = sample ? "mean" : "value";
  history->unit = dataset_unit(group, value);
  history->axis_unit = dataset_unit(group, history->axis);
  history->time = hdf5_read_reals(group, history->axis, &times, &columns);
  history->value = hdf5_read_reals(group, value, &history->count, &columns);
  bool whole = !sample || !history->value || read_deviation(group, history);
  if (member)
    whole = name_member(history) && whole;
  if (member)
    history->label = hdf5_read_text_attribute(group, "label");
  H5Gclose(group);
  return whole && history->time && history->value && times == history->count;
}

/* Whether a quantity of a study holds one curve a run, each in a group of its own. */
static bool has_members(hid_t parent, const char *name)
{
  hid_t group = H5Gopen2(parent, name, H5P_DEFAULT);
  bool members = group >= 0 && H5Lexists(group, "mean", H5P_DEFAULT) <= 0 &&
                 H5Lexists(group, "value", H5P_DEFAULT) <= 0;
  if (group >= 0)
    H5Gclose(group);
  return members;
}

struct reading {
  struct result_history *history;
  size_t count, room;
};

static bool read_all(hid_t parent, size_t links, bool member, struct reading *reading)
{
  bool good = true;
  for (size_t i = 0; good && i < links; i++) {
    char *name = hdf5_link_name(parent, i);
    if (name && !member && has_members(parent, name)) {
      hid_t group = H5Gopen2(parent, name, H5P_DEFAULT);
      good = group >= 0 && read_all(group, count_links(parent, name), true, reading);
      if (group >= 0)
        H5Gclose(group);
    } else {
      if (reading->count == reading->room) {
        const size_t room = 2 * reading->room + 16;
        struct result_history *grown = realloc(reading->history, room * sizeof *grown);
        good = grown != NULL;
        reading->history = good ? grown : reading->history;
        reading->room = good ? room : reading->room;
      }
      if (good) {
        reading->history[reading->count] = (struct result_history){0};
        good = read_history(parent, i, member, &reading->history[reading->count++]);
      }
    }
    free(name);
  }
  return good;
}

gamut_status result_histories(const struct result *result, struct trace *trace,
                              struct result_history **histories, size_t *count)
{
  EXCLUSIVE;
  *histories = NULL;
  *count = 0;
  bool study = H5Lexists(result->file, "study", H5P_DEFAULT) > 0;
  const char *place = study ? "study/curves" : "quantities";
  if (study && H5Lexists(result->file, place, H5P_DEFAULT) <= 0)
    return GAMUT_OK;
  size_t links = count_links(result->file, place);
  if (links == 0)
    return GAMUT_OK;
  struct reading reading = {0};
  hid_t group = H5Gopen2(result->file, place, H5P_DEFAULT);
  if (group >= 0 && !checksum_holds(group, CURVES_NAME, NULL)) {
    H5Gclose(group);
    return trace_fail(trace, GAMUT_OUTPUT,
                      "the histories in '%s' are damaged: their checksum is wrong", result->path);
  }
  bool good = group >= 0 && read_all(group, links, false, &reading);
  if (group >= 0)
    H5Gclose(group);
  if (good) {
    *histories = reading.history;
    *count = reading.count;
    return GAMUT_OK;
  }
  result_histories_free(reading.history, reading.count);
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
    free(history[i].label);
  }
  free(history);
}
