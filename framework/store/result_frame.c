#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/exclusive.h"
#include "base/memory.h"
#include "store/checksum.h"
#include "store/hdf5.h"
#include "store/store_private.h"

enum { FIELDS_MAX = 64 };

/* A field as asked for: a dataset and one of its columns, or -1 for a scalar made of them all. */
struct choice {
  const char *dataset;
  int column;
};

/* Number of the word in a list "xx xy xz", or -1. */
static int word_number(const char *list, const char *word)
{
  size_t length = strlen(word);
  for (int number = 0; list && *list; ++number) {
    size_t size = strcspn(list, " ");
    if (size == length && strncmp(list, word, size) == 0)
      return number;
    list += size;
    list += *list == ' ';
  }
  return -1;
}

static size_t list_datasets(hid_t group, char *name[FIELDS_MAX])
{
  H5G_info_t information = {0};
  size_t count = 0;
  H5Gget_info(group, &information);
  for (size_t i = 0; i < (size_t)information.nlinks && count < FIELDS_MAX; ++i) {
    char *link = hdf5_link_name(group, i);
    if (link && strcmp(link, "id") != 0 && strcmp(link, "position") != 0)
      name[count++] = link;
    else
      free(link);
  }
  return count;
}

static int column_of(hid_t group, const char *dataset, const char *component)
{
  hid_t opened = H5Dopen2(group, dataset, H5P_DEFAULT);
  char *list = opened >= 0 ? hdf5_read_text_attribute(opened, "components") : NULL;
  int column = word_number(list, component);
  free(list);
  if (opened >= 0)
    H5Dclose(opened);
  return column;
}

static bool choose(hid_t group, char *const name[], size_t count, const char *field,
                   struct choice *choice)
{
  *choice = (struct choice){NULL, -1};
  for (size_t i = 0; i < count; ++i) {
    if (strcmp(name[i], field) == 0) {
      choice->dataset = name[i];
      return true;
    }
  }
  for (size_t i = 0; i < count; ++i) {
    size_t length = strlen(name[i]);
    if (strncmp(name[i], field, length) != 0 || field[length] != '_')
      continue;
    choice->column = column_of(group, name[i], field + length + 1);
    choice->dataset = name[i];
    if (choice->column >= 0)
      return true;
  }
  return false;
}

static gamut_status unknown_field(char *const name[], size_t count, const char *field,
                                  struct trace *trace)
{
  char list[512] = "";
  const char *near = nearest(field, (const char *const *)name, count);
  size_t used = 0;
  for (size_t i = 0; i < count && used < sizeof list; ++i)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", name[i]);
  if (near)
    trace_fail(trace, GAMUT_USAGE, "the result has no field '%s'; did you mean '%s'?", field, near);
  else
    trace_fail(trace, GAMUT_USAGE, "the result has no field '%s'", field);
  trace_note(trace, "the fields are %s", list);
  return GAMUT_USAGE;
}

static double scalar_of(const double *row, size_t columns, bool symmetric)
{
  double sum = 0;
  if (columns == 9 && symmetric) {
    double mean = (row[0] + row[4] + row[8]) / 3;
    double xx = row[0] - mean, yy = row[4] - mean, zz = row[8] - mean;
    sum = 0.5 * (xx * xx + yy * yy + zz * zz) + row[1] * row[1] + row[2] * row[2] + row[5] * row[5];
    return sqrt(3 * sum);
  }
  for (size_t k = 0; k < columns; ++k)
    sum += row[k] * row[k];
  return columns == 1 ? row[0] : sqrt(sum);
}

static bool is_symmetric(hid_t group, const char *name)
{
  hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
  bool symmetric = H5Aexists(dataset, "symmetric") > 0;
  H5Dclose(dataset);
  return symmetric;
}

static bool read_value(hid_t group, const struct choice *choice, struct result_body *body)
{
  size_t rows, columns;
  if (!choice->dataset || H5Lexists(group, choice->dataset, H5P_DEFAULT) <= 0)
    return true;
  double *data = hdf5_read_reals(group, choice->dataset, &rows, &columns);
  if (!data || rows != body->count || columns == 0 || choice->column >= (int)columns) {
    free(data);
    return false;
  }
  bool symmetric = is_symmetric(group, choice->dataset);
  for (size_t i = 0; i < rows; ++i)
    data[i] = choice->column >= 0 ? data[i * columns + (size_t)choice->column]
                                  : scalar_of(data + i * columns, columns, symmetric);
  body->value = data;
  return true;
}

static bool read_body(hid_t frame, const char *name, const struct choice *choice,
                      struct result_body *body)
{
  size_t columns = 0;
  hid_t group = H5Gopen2(frame, name, H5P_DEFAULT);
  if (group < 0)
    return false;
  body->name = memory_copy(name);
  body->axes = (int)hdf5_read_real_attribute(group, "axes", 3);
  body->position = hdf5_read_reals(group, "position", &body->count, &columns);
  bool good = body->position && columns == 3 && read_value(group, choice, body);
  H5Gclose(group);
  return good;
}

/* What becomes of a field of several components that is asked for as a whole. */
static const char *reduction_of(hid_t dataset)
{
  char *list = hdf5_read_text_attribute(dataset, "components");
  const char *reduced = !list ? NULL : strcmp(list, "x y z") == 0 ? "magnitude" : "norm";
  free(list);
  return H5Aexists(dataset, "symmetric") > 0 ? "von Mises" : reduced;
}

/* The choice is made on the first body that has fields; the others follow it. */
static gamut_status find_field(hid_t frame, size_t bodies, const char *field, struct trace *trace,
                               struct result_frame *made)
{
  char *name[FIELDS_MAX];
  size_t count = 0;
  gamut_status status = GAMUT_OK;
  struct choice choice = {NULL, -1};
  for (size_t b = 0; b < bodies && count == 0; ++b) {
    char *body = hdf5_link_name(frame, b);
    hid_t group = body ? H5Gopen2(frame, body, H5P_DEFAULT) : -1;
    count = group >= 0 ? list_datasets(group, name) : 0;
    if (count > 0 && !field)
      field = choose(group, name, count, "plastic_strain", &choice) ? choice.dataset : name[0];
    if (count > 0 && !choose(group, name, count, field, &choice))
      status = unknown_field(name, count, field, trace);
    if (count > 0 && status == GAMUT_OK) {
      hid_t dataset = H5Dopen2(group, choice.dataset, H5P_DEFAULT);
      made->unit = hdf5_read_text_attribute(dataset, "unit");
      made->reduced = choice.column < 0 ? reduction_of(dataset) : NULL;
      made->field = memory_copy(field);
      H5Dclose(dataset);
    }
    if (group >= 0)
      H5Gclose(group);
    free(body);
  }
  for (size_t b = 0; b < bodies && status == GAMUT_OK; ++b) {
    char *body = hdf5_link_name(frame, b);
    made->bodies = b + 1;
    if (!body || !read_body(frame, body, &choice, &made->body[b]))
      status = trace_fail(trace, GAMUT_OUTPUT, "a body of the frame cannot be read");
    free(body);
  }
  for (size_t i = 0; i < count; ++i)
    free(name[i]);
  return status;
}

gamut_status result_frame_read(const struct result *result, size_t index, const char *field,
                               struct trace *trace, struct result_frame **read)
{
  EXCLUSIVE;
  char name[32], path[48];
  H5G_info_t information = {0};
  *read = NULL;
  frame_name(index, name, sizeof name);
  snprintf(path, sizeof path, FRAMES_GROUP "/%s", name);
  hid_t frame = H5Gopen2(result->file, path, H5P_DEFAULT);
  struct result_frame *made = calloc(1, sizeof *made);
  if (frame >= 0 && H5Gget_info(frame, &information) >= 0 && made)
    made->body = calloc((size_t)information.nlinks + 1, sizeof *made->body);
  gamut_status status;
  if (frame < 0) {
    status = hdf5_fault(result->path, "read a frame of", trace);
  } else if (!checksum_holds(frame, name, NULL)) {
    status = trace_fail(trace, GAMUT_OUTPUT, "frame %zu of '%s' is damaged: its checksum is wrong",
                        index, result->path);
  } else if (!made || !made->body) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  } else {
    made->time = hdf5_read_real_attribute(frame, "time", 0);
    made->step = (uint64_t)hdf5_read_real_attribute(frame, "step", 0);
    status = find_field(frame, (size_t)information.nlinks, field, trace, made);
  }
  if (frame >= 0)
    H5Gclose(frame);
  if (status == GAMUT_OK)
    *read = made;
  else
    result_frame_free(made);
  return status;
}

void result_frame_free(struct result_frame *frame)
{
  if (!frame)
    return;
  for (size_t b = 0; b < frame->bodies; ++b) {
    free(frame->body[b].name);
    free(frame->body[b].position);
    free(frame->body[b].value);
  }
  free(frame->body);
  free(frame->field);
  free(frame->unit);
  free(frame);
}
