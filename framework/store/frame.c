#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/exclusive.h"
#include "catalogue/catalogue.h"
#include "store/checksum.h"
#include "store/hdf5.h"
#include "store/store_private.h"

/* A symmetric tensor, kept as xx yy zz xy yz zx, is written whole: xx xy xz yx yy yz zx zy zz.
 * ParaView's two XDMF readers disagree about six columns; about nine they agree. */
static const unsigned whole_tensor[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};

unsigned stored_components(const struct frame_field *field)
{
  return field->components == 6 ? 9 : field->components;
}

bool buffer_reserve(struct store *store, size_t size)
{
  if (size <= store->buffer_size)
    return true;
  double *buffer = realloc(store->buffer, size * sizeof *buffer);
  if (!buffer)
    return false;
  store->buffer = buffer;
  store->buffer_size = size;
  return true;
}

/* "xx xy xz yx ...": what the columns of a dataset are. */
static void component_list(unsigned components, char *list, size_t size)
{
  int length = 0;
  list[0] = 0;
  for (unsigned k = 0; k < components && length >= 0 && (size_t)length < size; ++k)
    length += snprintf(list + length, size - (size_t)length, "%s%s", k ? " " : "",
                       component_name(components, k));
}

static herr_t describe(hid_t dataset, const char *unit, const char *meaning, unsigned components,
                       bool symmetric)
{
  char list[8 * CATALOGUE_COMPONENTS_MAX];
  herr_t result = hdf5_text_attribute(dataset, "unit", unit);
  if (result >= 0)
    result = hdf5_text_attribute(dataset, "meaning", meaning);
  component_list(components, list, sizeof list);
  if (result >= 0 && components > 1)
    result = hdf5_text_attribute(dataset, "components", list);
  if (result >= 0 && symmetric)
    result = hdf5_whole_attribute(dataset, "symmetric", 1);
  return result;
}

static herr_t write_described(hid_t group, const char *name, const char *unit, const char *meaning,
                              unsigned components, bool symmetric, size_t count, const double *data)
{
  hid_t made =
      hdf5_dataset(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, components, data);
  herr_t result = made < 0 ? -1 : describe(made, unit, meaning, components, symmetric);
  if (made >= 0)
    H5Dclose(made);
  return result;
}

static herr_t write_ids(hid_t group, const struct frame_set *set)
{
  hid_t made = hdf5_dataset(group, "id", H5T_STD_I64LE, H5T_NATIVE_INT64, set->count, 1, set->id);
  herr_t result =
      made < 0 ? -1 : describe(made, "1", "the point's number for its whole life", 1, false);
  if (made >= 0)
    H5Dclose(made);
  return result;
}

bool is_position(const struct frame_field *field)
{
  return strcmp(field->name, "position") == 0;
}

static herr_t write_field(struct store *store, hid_t group, const struct frame_set *set,
                          size_t number, const struct frame_field *field)
{
  double *buffer = store->buffer;
  unsigned columns = stored_components(field);
  for (unsigned k = 0; k < columns; ++k) {
    unsigned component = field->components == 6 ? whole_tensor[k] : k;
    const double *from = field->data[number * field->components + component];
    for (size_t i = 0; i < set->count; ++i)
      buffer[columns * i + k] = from[i];
  }
  return write_described(group, field->name, field->unit, field->meaning, columns,
                         field->components == 6, set->count, buffer);
}

/* XDMF's points are vertices 0 .. N-1 that must be listed: one list serves all bodies of N points.
 */
herr_t vertices_write(struct store *store, size_t count)
{
  char name[48];
  int64_t *vertex = (int64_t *)(void *)store->buffer; /* of the same size as a double */
  vertices_name(count, name, sizeof name);
  if (H5Lexists(store->file, name, H5P_DEFAULT) > 0)
    return 0;
  for (size_t i = 0; i < count; ++i)
    vertex[i] = (int64_t)i;
  hid_t made = hdf5_dataset(store->file, name, H5T_STD_I64LE, H5T_NATIVE_INT64, count, 1, vertex);
  herr_t result = made < 0 ? -1 : describe(made, "1", "numbers of the rows", 1, false);
  if (made >= 0)
    H5Dclose(made);
  return result;
}

static herr_t write_set(struct store *store, hid_t frame, const struct frame_set *set,
                        size_t number, const struct frame_field *field, size_t fields)
{
  double *buffer = store->buffer;
  hid_t group = H5Gcreate2(frame, set->body, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0)
    return -1;
  for (size_t i = 0; i < set->count; ++i) {
    for (size_t k = 0; k < 3; ++k)
      buffer[3 * i + k] = set->position[k] ? set->position[k][i] : 0;
  }
  herr_t result = hdf5_whole_attribute(group, "axes", set->axes);
  if (result >= 0)
    result =
        write_described(group, "position", "m", "where the point is", 3, false, set->count, buffer);
  if (result >= 0)
    result = write_ids(group, set);
  if (result >= 0)
    result = vertices_write(store, set->count);
  for (size_t f = 0; f < fields && result >= 0; ++f) {
    if (!is_position(&field[f]))
      result = write_field(store, group, set, number, &field[f]);
  }
  H5Gclose(group);
  return result;
}

void frame_name(size_t frame, char *name, size_t size)
{
  snprintf(name, size, "%08zu", frame);
}

static herr_t write_frame(struct store *store, double time, uint64_t step,
                          const struct frame_set *set, size_t sets, const struct frame_field *field,
                          size_t fields, uint64_t *sum)
{
  char name[32], path[48];
  frame_name(store->frames, name, sizeof name);
  snprintf(path, sizeof path, FRAMES_GROUP "/%s", name);
  hid_t group = H5Gcreate2(store->file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0)
    return -1;
  herr_t result = hdf5_real_attribute(group, "time", time);
  if (result >= 0)
    result = hdf5_whole_attribute(group, "step", (long long)step);
  for (size_t i = 0; i < sets && result >= 0; ++i)
    result = write_set(store, group, &set[i], i, field, fields);
  if (result >= 0)
    result = checksum_write(group, name, sum);
  H5Gclose(group);
  return result;
}

/* Generous: what HDF5 keeps beside the numbers is far less than this a dataset. */
static size_t frame_bytes(const struct frame_set *set, size_t sets, const struct frame_field *field,
                          size_t fields)
{
  size_t columns = 5, beside = 8192, bytes = 65536;
  for (size_t f = 0; f < fields; ++f)
    columns += stored_components(&field[f]);
  for (size_t i = 0; i < sets; ++i)
    bytes += set[i].count * columns * sizeof(double) + (fields + 4) * beside;
  return bytes;
}

gamut_status store_frame(struct store *store, double time, uint64_t step,
                         const struct frame_set *set, size_t sets, const struct frame_field *field,
                         size_t fields, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status = GAMUT_OK;
  size_t count = 0, columns = 3;
  uint64_t sum;
  if (store->frames > 0 && store->last_step == step && !(time > store->last_time))
    return GAMUT_OK; /* the last state of a run that stops right after a frame */
  for (size_t i = 0; i < sets; ++i) {
    assert(set[i].axes >= 1 && set[i].axes <= 3);
    count = set[i].count > count ? set[i].count : count;
  }
  for (size_t i = 0; i < fields; ++i) {
    assert(field[i].components >= 1 && field[i].components <= CATALOGUE_COMPONENTS_MAX);
    columns = stored_components(&field[i]) > columns ? stored_components(&field[i]) : columns;
  }
  if (!buffer_reserve(store, count * columns + 1))
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  TRY(results_there(store, trace));
  TRY(hdf5_reserve(store->file, frame_bytes(set, sets, field, fields), store->path, trace));
  if (write_frame(store, time, step, set, sets, field, fields, &sum) < 0)
    return store_broken(store, trace);
  TRY(hdf5_flush(store->file, store->path, trace));
  xdmf_frame(store, time, set, sets, field, fields);
  ++store->frames;
  store->checksum += sum;
  store->last_time = time;
  store->last_step = step;
  status = xdmf_write(store, trace);
done:
  return status;
}
