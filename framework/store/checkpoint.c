#include "store/checkpoint.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/exclusive.h"
#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"

/* Grows when a checkpoint written before cannot be read any more. */
enum { FORMAT = 3 };

struct checkpoint {
  char *folder, *path;
  hid_t file;
  bool writing, broken; /* HDF5 failed: closing would fail too */
};

static const char mark[] = "\ngamut checksum ";
enum { TRAILER = sizeof mark - 1 + 16 + 1 };

/* Over the first `size` bytes of a file; false where they cannot be read. */
static bool sum_file(int file, size_t size, uint64_t *sum)
{
  enum { PIECE = 1 << 20 };
  unsigned char *piece = malloc(PIECE);
  size_t done = 0;
  *sum = hash_begin(size);
  while (piece && done < size) {
    /* whole pieces only: the words must not depend on how much a read gives */
    size_t want = size - done < PIECE ? size - done : PIECE, have = 0;
    while (have < want) {
      ssize_t got = pread(file, piece + have, want - have, (off_t)(done + have));
      if (got < 0 && errno == EINTR)
        continue;
      if (got <= 0)
        break;
      have += (size_t)got;
    }
    if (have < want)
      break;
    *sum = hash_more(*sum, piece, want);
    done += want;
  }
  bool whole = piece && done == size;
  free(piece);
  return whole;
}

static void write_trailer(char *text, uint64_t sum)
{
  snprintf(text, TRAILER + 1, "%s%016llx\n", mark, (unsigned long long)sum);
}

/* Adds the checksum and waits until everything is on the disk. */
static int seal(const char *path)
{
  struct stat information;
  char trailer[TRAILER + 1];
  uint64_t sum;
  int file = open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC), fault = 0;
  if (file < 0)
    return errno;
  if (fstat(file, &information) != 0 || !sum_file(file, (size_t)information.st_size, &sum)) {
    fault = errno ? errno : EIO;
  } else {
    write_trailer(trailer, sum);
    errno = 0;
    if (pwrite(file, trailer, TRAILER, information.st_size) != TRAILER)
      fault = errno ? errno : ENOSPC;
    else
      fault = file_sync(file);
  }
  if (close(file) != 0 && !fault)
    fault = errno;
  return fault;
}

/* Why a file is no whole checkpoint, or null. */
static const char *flaw(const char *path)
{
  struct stat information;
  char found[TRAILER + 1] = "", expected[TRAILER + 1];
  const char *why = NULL;
  uint64_t sum;
  int file = open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0)
    return strerror(errno);
  if (fstat(file, &information) != 0 || information.st_size <= TRAILER ||
      pread(file, found, TRAILER, information.st_size - TRAILER) != TRAILER ||
      strncmp(found, mark, sizeof mark - 1) != 0) {
    why = "its end is missing";
  } else if (!sum_file(file, (size_t)(information.st_size - TRAILER), &sum)) {
    why = "it cannot be read";
  } else {
    write_trailer(expected, sum);
    if (strcmp(found, expected) != 0)
      why = "its checksum is wrong";
  }
  close(file);
  return why;
}

static struct checkpoint *checkpoint_new(const char *folder, const char *name)
{
  struct checkpoint *checkpoint = calloc(1, sizeof *checkpoint);
  if (!checkpoint)
    return NULL;
  checkpoint->file = -1;
  checkpoint->folder = strdup(folder);
  checkpoint->path = file_path(folder, name);
  if (checkpoint->folder && checkpoint->path)
    return checkpoint;
  checkpoint_close(checkpoint);
  return NULL;
}

void checkpoint_close(struct checkpoint *checkpoint)
{
  if (!checkpoint)
    return;
  EXCLUSIVE;
  if (checkpoint->file >= 0 && !checkpoint->broken)
    H5Fclose(checkpoint->file);
  if (checkpoint->writing && checkpoint->path)
    unlink(checkpoint->path);
  free(checkpoint->folder);
  free(checkpoint->path);
  free(checkpoint);
}

gamut_status checkpoint_begin(const char *folder, size_t bytes, struct trace *trace,
                              struct checkpoint **begun)
{
  EXCLUSIVE;
  gamut_status status = GAMUT_OK;
  struct checkpoint *checkpoint = checkpoint_new(folder, CHECKPOINT_PARTIAL);
  *begun = NULL;
  if (!checkpoint)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  checkpoint->writing = true;
  TRY(hdf5_create(checkpoint->path, trace, &checkpoint->file));
  TRY(hdf5_reserve(checkpoint->file, bytes, checkpoint->path, trace));
  if (hdf5_whole_attribute(checkpoint->file, "gamut_checkpoint", FORMAT) < 0 ||
      hdf5_text_attribute(checkpoint->file, "gamut", GAMUT_VERSION) < 0) {
    checkpoint->broken = true;
    status = hdf5_fault(checkpoint->path, "write", trace);
    goto done;
  }
  *begun = checkpoint;
  return GAMUT_OK;
done:
  checkpoint_close(checkpoint);
  return status;
}

static hid_t type_of(enum checkpoint_kind kind, bool memory)
{
  if (kind == CHECKPOINT_BYTES)
    return memory ? H5T_NATIVE_UCHAR : H5T_STD_U8LE;
  if (kind == CHECKPOINT_WHOLE)
    return memory ? H5T_NATIVE_INT64 : H5T_STD_I64LE;
  return memory ? H5T_NATIVE_DOUBLE : H5T_IEEE_F64LE;
}

gamut_status checkpoint_put(struct checkpoint *checkpoint, const char *path,
                            enum checkpoint_kind kind, const void *data, size_t count,
                            struct trace *trace)
{
  EXCLUSIVE;
  hsize_t extent = count;
  hid_t links = H5Pcreate(H5P_LINK_CREATE), space = H5Screate_simple(1, &extent, NULL);
  H5Pset_create_intermediate_group(links, 1);
  hid_t plain = hdf5_plain_dataset(type_of(kind, false));
  hid_t made =
      H5Dcreate2(checkpoint->file, path, type_of(kind, false), space, links, plain, H5P_DEFAULT);
  H5Pclose(plain);
  herr_t result = made < 0 ? -1 : 0;
  if (made >= 0 && count > 0)
    result = H5Dwrite(made, type_of(kind, true), H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  if (made >= 0)
    H5Dclose(made);
  H5Sclose(space);
  H5Pclose(links);
  if (result >= 0)
    return GAMUT_OK;
  checkpoint->broken = true;
  return hdf5_fault(checkpoint->path, "write", trace);
}

static void sync_folder(const char *folder)
{
  int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0)
    return;
  fsync(file); /* where a folder cannot be synced the rename is all there is */
  close(file);
}

static int put_in_place(const struct checkpoint *checkpoint)
{
  char *last = file_path(checkpoint->folder, CHECKPOINT_FILE);
  char *previous = file_path(checkpoint->folder, CHECKPOINT_PREVIOUS);
  int fault = last && previous ? 0 : ENOMEM;
  if (!fault && rename(last, previous) != 0 && errno != ENOENT)
    fault = errno;
  if (!fault && rename(checkpoint->path, last) != 0)
    fault = errno;
  if (!fault)
    sync_folder(checkpoint->folder);
  free(last);
  free(previous);
  return fault;
}

gamut_status checkpoint_end(struct checkpoint *checkpoint, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status;
  int fault;
  TRY(hdf5_flush(checkpoint->file, checkpoint->path, trace));
  fault = H5Fclose(checkpoint->file) < 0 ? EIO : 0;
  checkpoint->file = -1;
  if (!fault)
    fault = seal(checkpoint->path);
  if (!fault)
    fault = put_in_place(checkpoint);
  if (fault)
    status =
        trace_fail(trace, GAMUT_OUTPUT, "cannot write '%s': %s", checkpoint->path, strerror(fault));
  else
    checkpoint->writing = false;
done:
  checkpoint_close(checkpoint);
  return status;
}

static gamut_status open_whole(const char *folder, struct trace *trace, struct checkpoint **opened)
{
  struct checkpoint *checkpoint = checkpoint_new(folder, CHECKPOINT_FILE);
  gamut_status status = GAMUT_OK;
  if (!checkpoint)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  checkpoint->file = hdf5_open(checkpoint->path);
  double format = checkpoint->file < 0
                      ? 0.0
                      : hdf5_read_real_attribute(checkpoint->file, "gamut_checkpoint", 0.0);
  if (checkpoint->file < 0)
    status = hdf5_fault(checkpoint->path, "read", trace);
  else if (format != FORMAT)
    status = trace_fail(trace, GAMUT_OUTPUT,
                        "'%s' is a checkpoint of format %g, this gamut reads format %d",
                        checkpoint->path, format, FORMAT);
  if (status != GAMUT_OK)
    checkpoint_close(checkpoint);
  else
    *opened = checkpoint;
  return status;
}

/* The last checkpoint, or the previous one under its name. */
static gamut_status choose(const char *last, const char *previous, struct trace *trace, bool *there)
{
  const char *why = file_exists(last) ? flaw(last) : NULL, *older;
  *there = file_exists(last) || file_exists(previous);
  if (!*there || (file_exists(last) && !why))
    return GAMUT_OK;
  older = file_exists(previous) ? flaw(previous) : "there is none";
  if (older)
    return trace_fail(trace, GAMUT_OUTPUT,
                      "no checkpoint can be read: '%s': %s; '%s': %s. --force runs the scene anew",
                      last, why ? why : "it is missing", previous, older);
  trace_warn_at(trace, NULL, NULL, NULL,
                "'%s' is broken: %s. The run goes on from the one before it", last,
                why ? why : "it is missing");
  if (rename(previous, last) != 0)
    return trace_fail(trace, GAMUT_OUTPUT, "cannot rename '%s': %s", previous, strerror(errno));
  return GAMUT_OK;
}

gamut_status checkpoint_open(const char *folder, struct trace *trace, struct checkpoint **opened)
{
  EXCLUSIVE;
  gamut_status status = GAMUT_OK;
  char *last = file_path(folder, CHECKPOINT_FILE),
       *previous = file_path(folder, CHECKPOINT_PREVIOUS);
  bool there = false;
  *opened = NULL;
  if (!last || !previous)
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  else
    status = choose(last, previous, trace, &there);
  if (status == GAMUT_OK && there)
    status = open_whole(folder, trace, opened);
  free(last);
  free(previous);
  return status;
}

bool checkpoint_has(const struct checkpoint *checkpoint, const char *path)
{
  EXCLUSIVE;
  hid_t found = H5Dopen2(checkpoint->file, path, H5P_DEFAULT);
  if (found >= 0)
    H5Dclose(found);
  H5Eclear2(H5E_DEFAULT);
  return found >= 0;
}

gamut_status checkpoint_get(const struct checkpoint *checkpoint, const char *path,
                            enum checkpoint_kind kind, void **data, size_t *count,
                            struct trace *trace)
{
  EXCLUSIVE;
  size_t size = kind == CHECKPOINT_BYTES ? 1 : 8;
  hid_t opened = H5Dopen2(checkpoint->file, path, H5P_DEFAULT);
  hid_t space = opened < 0 ? -1 : H5Dget_space(opened),
        type = opened < 0 ? -1 : H5Dget_type(opened);
  hsize_t extent = 0;
  bool good = opened >= 0 && H5Sget_simple_extent_ndims(space) == 1 &&
              H5Sget_simple_extent_dims(space, &extent, NULL) == 1 &&
              H5Tequal(type, type_of(kind, false)) > 0 && extent < SIZE_MAX / 16;
  *count = (size_t)extent;
  *data = good ? malloc(*count * size + 1) : NULL;
  if (*data && *count > 0)
    good = H5Dread(opened, type_of(kind, true), H5S_ALL, H5S_ALL, H5P_DEFAULT, *data) >= 0;
  if (*data)
    ((char *)*data)[*count * size] = 0;
  if (opened >= 0) {
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(opened);
  }
  H5Eclear2(H5E_DEFAULT);
  if (good && *data)
    return GAMUT_OK;
  free(*data);
  *data = NULL;
  return trace_fail(trace, GAMUT_OUTPUT, "'%s' lacks '%s'", checkpoint->path, path);
}

gamut_status checkpoint_fill(const struct checkpoint *checkpoint, const char *path,
                             enum checkpoint_kind kind, void *data, size_t count,
                             struct trace *trace)
{
  void *read;
  size_t found;
  gamut_status status = checkpoint_get(checkpoint, path, kind, &read, &found, trace);
  if (status != GAMUT_OK)
    return status;
  if (found != count)
    status = trace_fail(trace, GAMUT_OUTPUT, "'%s' has %zu numbers of '%s', not %zu",
                        checkpoint->path, found, path, count);
  else if (count > 0)
    memcpy(data, read, count * (kind == CHECKPOINT_BYTES ? 1 : 8));
  free(read);
  return status;
}
