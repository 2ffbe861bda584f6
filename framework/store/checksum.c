#include "store/checksum.h"

#include <stdlib.h>
#include <string.h>

#include "store/hdf5.h"

static const char attribute[] = "checksum";

uint64_t hash_begin(uint64_t seed)
{
  return UINT64_C(0xcbf29ce484222325) ^ seed;
}

uint64_t hash_more(uint64_t hash, const void *bytes, size_t size)
{
  const unsigned char *byte = bytes;
  uint64_t word;
  for (; size >= sizeof word; byte += sizeof word, size -= sizeof word) {
    memcpy(&word, byte, sizeof word);
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    hash ^= hash >> 29;
  }
  for (; size > 0; byte++, size--)
    hash = (hash ^ *byte) * UINT64_C(0x100000001b3);
  return hash;
}

/* MurmurHash3's finalizer: rows that differ by a bit must not have hashes that differ by few. */
uint64_t hash_end(uint64_t hash)
{
  hash = (hash ^ hash >> 33) * UINT64_C(0xff51afd7ed558ccd);
  hash = (hash ^ hash >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
  return hash ^ hash >> 33;
}

static uint64_t name_below(uint64_t parent, char mark, const char *name)
{
  uint64_t hash = hash_more(hash_begin(parent), &mark, 1);
  return hash_end(hash_more(hash, name, strlen(name)));
}

static uint64_t row_hash(uint64_t name, uint64_t row, const void *bytes, size_t size)
{
  uint64_t hash = hash_more(hash_begin(name), &row, sizeof row);
  return hash_end(hash_more(hash, bytes, size));
}

enum { RANK_MAX = 2, SHAPE = 5 + RANK_MAX };

/* What the bytes mean: shape and type are part of the sum. False for what this store never writes
 * where it sums up. */
static bool shape_of(hid_t space, hid_t type, uint64_t shape[SHAPE])
{
  hsize_t extent[RANK_MAX] = {1, 1};
  int rank = H5Sget_simple_extent_ndims(space);
  H5T_class_t kind = H5Tget_class(type);
  if (rank < 0 || rank > RANK_MAX || H5Sget_simple_extent_dims(space, extent, NULL) != rank ||
      (kind != H5T_INTEGER && kind != H5T_FLOAT && kind != H5T_STRING) ||
      H5Tis_variable_str(type) != 0)
    return false;
  shape[0] = (uint64_t)kind;
  shape[1] = (uint64_t)H5Tget_size(type);
  shape[2] = kind == H5T_STRING ? 0 : (uint64_t)H5Tget_order(type);
  shape[3] = kind == H5T_INTEGER ? (uint64_t)H5Tget_sign(type) : 0;
  shape[4] = (uint64_t)rank;
  for (int k = 0; k < RANK_MAX; k++)
    shape[5 + k] = (uint64_t)extent[k];
  return true;
}

enum { DEPTH_MAX = 8 }; /* a damaged file may lead in circles */

struct walk {
  uint64_t name, sum;
  bool top; /* the group that carries the sum */
  int depth;
};

static bool sum_attribute(hid_t at, const char *name, struct walk *walk)
{
  uint64_t shape[SHAPE], below = name_below(walk->name, '@', name);
  hid_t opened = H5Aopen(at, name, H5P_DEFAULT);
  if (opened < 0)
    return false;
  hid_t space = H5Aget_space(opened), type = H5Aget_type(opened);
  bool good = shape_of(space, type, shape);
  size_t size = good ? (size_t)(shape[1] * shape[5] * shape[6]) : 0;
  void *bytes = good ? malloc(size + 1) : NULL;
  good = bytes && H5Aread(opened, type, bytes) >= 0;
  if (good) {
    walk->sum += row_hash(below, UINT64_MAX, shape, sizeof shape);
    walk->sum += row_hash(below, 0, bytes, size);
  }
  free(bytes);
  H5Tclose(type);
  H5Sclose(space);
  H5Aclose(opened);
  return good;
}

static herr_t each_attribute(hid_t at, const char *name, const H5A_info_t *information, void *self)
{
  struct walk *walk = self;
  (void)information;
  if (walk->top && strcmp(name, attribute) == 0)
    return 0;
  return sum_attribute(at, name, walk) ? 0 : -1;
}

static bool sum_attributes(hid_t at, struct walk *walk)
{
  hsize_t place = 0;
  return H5Aiterate2(at, H5_INDEX_NAME, H5_ITER_INC, &place, each_attribute, walk) >= 0;
}

/* Reads `rows` rows from `first` on. */
static bool read_rows(hid_t dataset, hid_t space, hid_t type, const uint64_t shape[SHAPE],
                      hsize_t first, hsize_t rows, void *bytes)
{
  hsize_t start[RANK_MAX] = {first, 0}, count[RANK_MAX] = {rows, shape[6]};
  if (shape[4] == 0)
    return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0;
  hid_t memory = H5Screate_simple((int)shape[4], count, NULL);
  bool good = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
              H5Dread(dataset, type, memory, space, H5P_DEFAULT, bytes) >= 0;
  H5Sclose(memory);
  return good;
}

static bool sum_rows(hid_t dataset, hid_t space, hid_t type, const uint64_t shape[SHAPE],
                     struct walk *walk)
{
  enum { PIECE = 1 << 20 };
  size_t row = (size_t)(shape[1] * shape[6]), room = row < PIECE ? PIECE / (row ? row : 1) : 1;
  unsigned char *bytes = malloc(room * row + 1);
  bool good = bytes != NULL;
  for (hsize_t first = 0; good && first < shape[5] && row > 0; first += room) {
    hsize_t rows = shape[5] - first < room ? shape[5] - first : room;
    good = read_rows(dataset, space, type, shape, first, rows, bytes);
    for (hsize_t r = 0; good && r < rows; r++)
      walk->sum += row_hash(walk->name, first + r, bytes + r * row, row);
  }
  free(bytes);
  return good;
}

static bool sum_dataset(hid_t dataset, struct walk *walk)
{
  uint64_t shape[SHAPE];
  hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  bool good = shape_of(space, type, shape);
  if (good) {
    walk->sum += row_hash(walk->name, UINT64_MAX, shape, sizeof shape);
    good = sum_rows(dataset, space, type, shape, walk);
  }
  H5Tclose(type);
  H5Sclose(space);
  return good;
}

static bool sum_below(hid_t group, struct walk *walk);

/* Hard links only: a file may not lead into another. */
static bool sum_link(hid_t group, const char *name, struct walk *walk)
{
  H5L_info_t information;
  if (H5Lget_info(group, name, &information, H5P_DEFAULT) < 0 ||
      information.type != H5L_TYPE_HARD)
    return false;
  hid_t opened = H5Oopen(group, name, H5P_DEFAULT);
  if (opened < 0)
    return false;
  struct walk below = {.name = name_below(walk->name, '/', name), .depth = walk->depth + 1};
  bool good = sum_attributes(opened, &below);
  H5I_type_t kind = H5Iget_type(opened);
  good = good && (kind == H5I_DATASET ? sum_dataset(opened, &below)
                                      : kind == H5I_GROUP && sum_below(opened, &below));
  walk->sum += below.sum + hash_end(below.name);
  H5Oclose(opened);
  return good;
}

static bool sum_below(hid_t group, struct walk *walk)
{
  H5G_info_t information;
  bool good = walk->depth < DEPTH_MAX && H5Gget_info(group, &information) >= 0;
  for (size_t i = 0; good && i < (size_t)information.nlinks; i++) {
    char *name = hdf5_link_name(group, i);
    good = name && sum_link(group, name, walk);
    free(name);
  }
  return good;
}

bool checksum_group(hid_t group, const char *name, uint64_t *sum)
{
  struct walk walk = {.name = name_below(0, '/', name), .top = true};
  bool good = sum_attributes(group, &walk);
  walk.top = false;
  good = good && sum_below(group, &walk);
  *sum = walk.sum;
  return good;
}

herr_t checksum_write(hid_t group, const char *name, uint64_t *sum)
{
  if (!checksum_group(group, name, sum))
    return -1;
  hid_t space = H5Screate(H5S_SCALAR);
  hid_t made = H5Acreate2(group, attribute, H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t result = made < 0 ? -1 : H5Awrite(made, H5T_NATIVE_UINT64, sum);
  if (made >= 0)
    H5Aclose(made);
  H5Sclose(space);
  return result;
}

bool checksum_stated(hid_t group, uint64_t *sum)
{
  hid_t opened = hdf5_open_single(group, attribute);
  bool good = opened >= 0 && H5Aread(opened, H5T_NATIVE_UINT64, sum) >= 0;
  if (opened >= 0)
    H5Aclose(opened);
  return good;
}

bool checksum_holds(hid_t group, const char *name, uint64_t *sum)
{
  uint64_t stated, found;
  if (!checksum_stated(group, &stated) || !checksum_group(group, name, &found))
    return false;
  if (sum)
    *sum = found;
  return found == stated;
}
