#include "store/hdf5.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "store/file.h"

static hid_t access_list(void)
{
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* what HDF5 has to say is in our messages */
  H5PLset_loading_state(0);              /* no file may ask for a shared object */
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, 0, 1); /* a viewer may look during a run */
#endif
#if H5_VERSION_GE(1, 10, 2)
  /* from this format on HDF5 finds damage of its own tables by itself */
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
#endif
  return access;
}

hid_t hdf5_open(const char *path)
{
  struct stat information;
  /* a name that leads elsewhere, or to no file, is nothing of ours */
  if (lstat(path, &information) != 0 || !S_ISREG(information.st_mode))
    return -1;
  hid_t access = access_list(), file = H5Fopen(path, H5F_ACC_RDONLY, access);
  hid_t reasons = H5Eget_current_stack(); /* closing the list would forget them */
  H5Pclose(access);
  H5Eset_current_stack(reasons);
  return file;
}

struct reason {
  char text[256];
};

/* The file driver writes "... error message = 'No space left on device', ...". */
static herr_t collect_reason(unsigned number, const H5E_error2_t *entry, void *self)
{
  static const char mark[] = "error message = '";
  struct reason *reason = self;
  const char *words = entry->desc ? strstr(entry->desc, mark) : NULL;
  if (words) {
    words += sizeof mark - 1;
    snprintf(reason->text, sizeof reason->text, "%.*s", (int)strcspn(words, "'"), words);
    return 1;
  }
  if (number == 0 && entry->desc)
    snprintf(reason->text, sizeof reason->text, "%s", entry->desc);
  return 0;
}

gamut_status hdf5_fault(const char *file, const char *what, struct trace *trace)
{
  struct reason reason = {"HDF5 gives no reason"};
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect_reason, &reason);
  H5Eclear2(H5E_DEFAULT);
  return trace_fail(trace, GAMUT_OUTPUT, "cannot %s '%s': %s", what, file, reason.text);
}

gamut_status hdf5_create(const char *path, struct trace *trace, hid_t *file)
{
  /* HDF5 hides the reason of a file that cannot be made, and wants to make it itself */
  int probe = file_create(path);
  *file = -1;
  if (probe < 0 || close(probe) != 0 || unlink(path) != 0)
    return trace_fail(trace, GAMUT_OUTPUT, "cannot make '%s': %s", path, strerror(errno));
  hid_t access = access_list();
  *file = H5Fcreate(path, H5F_ACC_EXCL, H5P_DEFAULT, access);
  gamut_status status = *file < 0 ? hdf5_fault(path, "make", trace) : GAMUT_OK;
  H5Pclose(access);
  return status;
}

/* The file's descriptor and where its contents end; false where the driver has none. */
static bool file_end(hid_t file, int *descriptor, hsize_t *end)
{
  void *handle = NULL;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || H5Fget_filesize(file, end) < 0)
    return false;
  *descriptor = *(int *)handle;
  return true;
}

gamut_status hdf5_reserve(hid_t file, size_t bytes, const char *path, struct trace *trace)
{
  int descriptor;
  hsize_t end;
  if (!file_end(file, &descriptor, &end))
    return hdf5_fault(path, "write", trace);
  int fault = posix_fallocate(descriptor, (off_t)end, (off_t)bytes);
  if (fault == 0 || fault == EOPNOTSUPP || fault == EINVAL)
    return GAMUT_OK;
  if (ftruncate(descriptor, (off_t)end) != 0)
    fault = fault ? fault : errno;
  return trace_fail(trace, GAMUT_OUTPUT, "cannot write '%s': %s", path, strerror(fault));
}

gamut_status hdf5_flush(hid_t file, const char *path, struct trace *trace)
{
  int descriptor;
  hsize_t end;
  gamut_status status = GAMUT_OK;
  memory_must_last();
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || !file_end(file, &descriptor, &end))
    status = hdf5_fault(path, "write", trace);
  else if (ftruncate(descriptor, (off_t)end) != 0)
    status = trace_fail(trace, GAMUT_OUTPUT, "cannot write '%s': %s", path, strerror(errno));
  memory_may_end();
  return status;
}

bool hdf5_close(hid_t file)
{
  memory_must_last();
  const bool closed = H5Fclose(file) >= 0;
  memory_may_end();
  return closed;
}

gamut_status hdf5_sync(hid_t file, const char *path, struct trace *trace)
{
  int descriptor;
  hsize_t end;
  if (!file_end(file, &descriptor, &end))
    return hdf5_fault(path, "write", trace);
  int fault = file_sync(descriptor);
  return fault ? trace_fail(trace, GAMUT_OUTPUT, "cannot write '%s': %s", path, strerror(fault))
               : GAMUT_OK;
}

bool hdf5_is_at(hid_t file, const char *path)
{
  int descriptor;
  hsize_t end;
  struct stat open, named;
  return file_end(file, &descriptor, &end) && fstat(descriptor, &open) == 0 &&
         lstat(path, &named) == 0 && open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

static herr_t attribute(hid_t at, const char *name, hid_t stored, hid_t memory, const void *value)
{
  herr_t result = -1;
  hid_t space = H5Screate(H5S_SCALAR);
  hid_t made = H5Acreate2(at, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
  if (made >= 0) {
    result = H5Awrite(made, memory, value);
    H5Aclose(made);
  }
  H5Sclose(space);
  return result;
}

static hid_t text_type(const char *text)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, strlen(text) + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

herr_t hdf5_text_attribute(hid_t at, const char *name, const char *text)
{
  hid_t type = text_type(text ? text : "");
  herr_t result = attribute(at, name, type, type, text ? text : "");
  H5Tclose(type);
  return result;
}

herr_t hdf5_real_attribute(hid_t at, const char *name, double value)
{
  return attribute(at, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

herr_t hdf5_reals_attribute(hid_t at, const char *name, const double *value, size_t count)
{
  hsize_t size = count;
  hid_t space = H5Screate_simple(1, &size, NULL);
  hid_t made = H5Acreate2(at, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t result = made < 0 ? -1 : H5Awrite(made, H5T_NATIVE_DOUBLE, value);
  if (made >= 0)
    H5Aclose(made);
  H5Sclose(space);
  return result;
}

herr_t hdf5_whole_attribute(hid_t at, const char *name, long long value)
{
  return attribute(at, name, H5T_STD_I64LE, H5T_NATIVE_LLONG, &value);
}

hid_t hdf5_plain_dataset(hid_t stored)
{
  hid_t plain = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_alloc_time(plain, H5D_ALLOC_TIME_EARLY);
  if (H5Tis_variable_str(stored) <= 0)
    H5Pset_fill_time(plain, H5D_FILL_TIME_NEVER);
  H5Pset_obj_track_times(plain, false);
  return plain;
}

herr_t hdf5_text_dataset(hid_t at, const char *name, const char *text)
{
  herr_t result = -1;
  hid_t type = text_type(text), space = H5Screate(H5S_SCALAR);
  hid_t plain = hdf5_plain_dataset(type);
  hid_t made = H5Dcreate2(at, name, type, space, H5P_DEFAULT, plain, H5P_DEFAULT);
  H5Pclose(plain);
  if (made >= 0) {
    result = H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
    H5Dclose(made);
  }
  H5Sclose(space);
  H5Tclose(type);
  return result;
}

hid_t hdf5_dataset(hid_t at, const char *name, hid_t stored, hid_t memory, size_t rows,
                   size_t columns, const void *data)
{
  hsize_t extent[2] = {rows, columns};
  hid_t space = H5Screate_simple(columns == 1 ? 1 : 2, extent, NULL);
  hid_t plain = hdf5_plain_dataset(stored);
  hid_t made = H5Dcreate2(at, name, stored, space, H5P_DEFAULT, plain, H5P_DEFAULT);
  H5Pclose(plain);
  if (made >= 0 && rows > 0 && H5Dwrite(made, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    H5Dclose(made);
    made = -1;
  }
  H5Sclose(space);
  return made;
}

char *hdf5_link_name(hid_t group, size_t index)
{
  ssize_t size =
      H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, NULL, 0, H5P_DEFAULT);
  char *name = size >= 0 ? malloc((size_t)size + 1) : NULL;
  if (name && H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, name,
                                 (size_t)size + 1, H5P_DEFAULT) < 0)
    name[0] = '\0';
  return name;
}

hid_t hdf5_open_single(hid_t at, const char *name)
{
  hid_t opened = H5Aexists(at, name) > 0 ? H5Aopen(at, name, H5P_DEFAULT) : -1;
  hid_t space = opened >= 0 ? H5Aget_space(opened) : -1;
  bool single = space >= 0 && H5Sget_simple_extent_npoints(space) == 1;
  if (space >= 0)
    H5Sclose(space);
  if (opened >= 0 && !single)
    H5Aclose(opened);
  return single ? opened : -1;
}

char *hdf5_read_text_attribute(hid_t at, const char *name)
{
  char *text = NULL;
  hid_t opened = hdf5_open_single(at, name);
  if (opened < 0)
    return NULL;
  hid_t type = H5Aget_type(opened);
  if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0) {
    text = calloc(1, H5Tget_size(type) + 1);
    if (text && H5Aread(opened, type, text) < 0) {
      free(text);
      text = NULL;
    }
  }
  H5Tclose(type);
  H5Aclose(opened);
  return text;
}

double hdf5_read_real_attribute(hid_t at, const char *name, double otherwise)
{
  double value = otherwise;
  hid_t opened = hdf5_open_single(at, name);
  if (opened < 0)
    return otherwise;
  if (H5Aread(opened, H5T_NATIVE_DOUBLE, &value) < 0)
    value = otherwise;
  H5Aclose(opened);
  return value;
}

double *hdf5_read_reals(hid_t at, const char *name, size_t *rows, size_t *columns)
{
  double *data = NULL;
  hsize_t extent[2] = {0, 1};
  hid_t opened = H5Dopen2(at, name, H5P_DEFAULT);
  if (opened < 0)
    return NULL;
  hid_t space = H5Dget_space(opened);
  int rank = H5Sget_simple_extent_ndims(space);
  if ((rank == 1 || rank == 2) && H5Sget_simple_extent_dims(space, extent, NULL) == rank &&
      extent[0] <= SIZE_MAX / sizeof(double) / (extent[1] ? extent[1] : 1)) {
    size_t size = (size_t)(extent[0] * extent[1]);
    data = malloc(size ? size * sizeof *data : 1);
    if (data && size &&
        H5Dread(opened, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
      free(data);
      data = NULL;
    }
  }
  *rows = (size_t)extent[0];
  *columns = (size_t)extent[1];
  H5Sclose(space);
  H5Dclose(opened);
  return data;
}
