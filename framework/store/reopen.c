/* Going on with a result: what stands there is checked and copied, never written to, so that damage
 * can neither be carried on nor do more of it. */
#include <stdlib.h>
#include <string.h>

#include "base/exclusive.h"
#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/store_private.h"

/* Copies a frame; the checksum is that of the copy. */
static bool copy_frame(hid_t from, hid_t to, const char *name, uint64_t *sum)
{
  if (H5Ocopy(from, name, to, name, H5P_DEFAULT, H5P_DEFAULT) < 0)
    return false;
  hid_t frame = H5Gopen2(to, name, H5P_DEFAULT);
  bool whole = frame >= 0 && checksum_holds(frame, name, sum);
  if (frame >= 0)
    H5Gclose(frame);
  return whole;
}

static bool body_size(hid_t frame, size_t body, size_t *count)
{
  hsize_t rows = 0;
  char *name = hdf5_link_name(frame, body);
  hid_t group = name ? H5Gopen2(frame, name, H5P_DEFAULT) : -1;
  hid_t id = group >= 0 ? H5Dopen2(group, "id", H5P_DEFAULT) : -1;
  hid_t space = id >= 0 ? H5Dget_space(id) : -1;
  bool good = space >= 0 && H5Sget_simple_extent_dims(space, &rows, NULL) == 1;
  *count = (size_t)rows;
  if (space >= 0)
    H5Sclose(space);
  if (id >= 0)
    H5Dclose(id);
  if (group >= 0)
    H5Gclose(group);
  free(name);
  return good;
}

/* The lists of vertices that a frame needs are made again. */
static bool make_vertices(struct store *store, hid_t frames, const char *name)
{
  H5G_info_t information;
  size_t count;
  hid_t frame = H5Gopen2(frames, name, H5P_DEFAULT);
  bool good = frame >= 0 && H5Gget_info(frame, &information) >= 0;
  for (size_t b = 0; good && b < (size_t)information.nlinks; b++)
    good = body_size(frame, b, &count) && buffer_reserve(store, count + 1) &&
           vertices_write(store, count) >= 0;
  if (frame >= 0)
    H5Gclose(frame);
  return good;
}

static bool copy_frames(struct store *store, hid_t old, const struct store_place *place)
{
  hid_t from = H5Gopen2(old, FRAMES_GROUP, H5P_DEFAULT),
        to = H5Gopen2(store->file, FRAMES_GROUP, H5P_DEFAULT);
  bool good = from >= 0 && to >= 0;
  uint64_t sum = 0;
  for (size_t i = 0; good && i < place->frames; i++) {
    char name[32];
    uint64_t one;
    frame_name(i, name, sizeof name);
    good = copy_frame(from, to, name, &one) && make_vertices(store, to, name);
    sum += good ? one : 0;
  }
  if (from >= 0)
    H5Gclose(from);
  if (to >= 0)
    H5Gclose(to);
  return good && sum == place->checksum;
}

static gamut_status refuse(const struct store *store, struct trace *trace, const char *why)
{
  return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL,
                       "put the file back that was there, or --force to run the scene anew",
                       "'%s' cannot be gone on with: %s", store->path, why);
}

/* What the copy takes: no more than what is there. */
static size_t size_of(hid_t file)
{
  hsize_t size = 0;
  return H5Fget_filesize(file, &size) < 0 ? 0 : (size_t)size;
}

static gamut_status copy_results(struct store *store, hid_t old, const struct store_place *place,
                                 struct trace *trace, bool *damaged)
{
  gamut_status status;
  char *run = hdf5_read_text_attribute(old, "run");
  bool same = run && strcmp(run, place->run) == 0;
  free(run);
  if (!same)
    return refuse(store, trace, "it is the result of another run than the checkpoint");
  snprintf(store->run, sizeof store->run, "%s", place->run);
  TRY(results_make(store, trace));
  TRY(hdf5_reserve(store->file, size_of(old) + 65536, store->path, trace));
  if (!copy_frames(store, old, place)) {
    *damaged = true;
    status = refuse(store, trace,
                    "it is damaged, or lacks frames that were there at the checkpoint");
    goto done;
  }
  status = hdf5_flush(store->file, store->path, trace);
done:
  return status;
}

gamut_status store_reopen(struct store *store, const struct store_place *place, struct trace *trace,
                          bool *damaged)
{
  EXCLUSIVE;
  gamut_status status;
  hid_t old = hdf5_open(store->path);
  *damaged = file_exists(store->path) && (old < 0 || H5Aexists(old, "run") <= 0);
  store->frames = place->frames;
  store->last_time = place->last_time;
  store->last_step = place->last_step;
  store->checksum = place->checksum;
  text_add(&store->xdmf, "%s", place->xdmf);
  TRY(folder_tidy(store->folder, trace));
  if (old < 0) {
    status = refuse(store, trace, *damaged ? "it is no HDF5 file" : "it is missing");
    goto done;
  }
  status = copy_results(store, old, place, trace, damaged);
done:
  if (old >= 0)
    H5Fclose(old);
  return status;
}

gamut_status store_join(struct store *store, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status;
  /* what it says is no longer so */
  TRY(folder_remove_file(store->folder, RESULT_SUMMARY, trace));
  TRY(results_place(store, trace));
  TRY(xdmf_write(store, trace));
done:
  return status;
}
