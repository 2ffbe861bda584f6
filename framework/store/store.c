#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <unistd.h>

#include "base/exclusive.h"
#include "base/memory.h"
#include "store/checksum.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/store_private.h"

static herr_t make_group(hid_t file, const char *name)
{
  hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  return group < 0 ? -1 : H5Gclose(group);
}

static gamut_status new_id(struct store *store, struct trace *trace)
{
  uint64_t number[2];
  if (getrandom(number, sizeof number, 0) != (ssize_t)sizeof number)
    return trace_fail(trace, GAMUT_INTERNAL, "no random number: %s", strerror(errno));
  snprintf(store->run, sizeof store->run, "%016" PRIx64 "%016" PRIx64, number[0], number[1]);
  return GAMUT_OK;
}

gamut_status results_make(struct store *store, struct trace *trace)
{
  gamut_status status;
  char *path = file_path(store->folder, RESULT_PARTIAL);
  if (!path)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  store_rest(store);
  store->partial = true;
  TRY(hdf5_create(path, trace, &store->file));
  TRY(hdf5_reserve(store->file, 65536, path, trace));
  herr_t result = make_group(store->file, FRAMES_GROUP);
  if (result >= 0)
    result = make_group(store->file, "vertices");
  if (result >= 0)
    result = hdf5_text_attribute(store->file, "gamut", GAMUT_VERSION);
  if (result >= 0)
    result = hdf5_text_attribute(store->file, "run", store->run);
  status = result >= 0 ? hdf5_flush(store->file, path, trace) : store_broken(store, trace);
done:
  free(path);
  return status;
}

gamut_status results_place(struct store *store, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  char *path = file_path(store->folder, RESULT_PARTIAL);
  if (!path)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  TRY(hdf5_sync(store->file, path, trace));
  if (rename(path, store->path) != 0)
    status = trace_fail(trace, GAMUT_OUTPUT, "cannot make '%s': %s", store->path, strerror(errno));
  else
    store->partial = false;
done:
  free(path);
  return status;
}

gamut_status results_there(struct store *store, struct trace *trace)
{
  if (hdf5_is_at(store->file, store->path))
    return GAMUT_OK;
  return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL,
                       "leave the folder alone while a run writes there; --resume or --force "
                       "makes it whole",
                       "'%s' was removed or replaced while it was written", store->path);
}

gamut_status store_broken(struct store *store, struct trace *trace)
{
  store->broken = true;
  return hdf5_fault(store->path, "write", trace);
}

/* Null when out of memory. */
static struct store *store_new(const char *folder)
{
  struct store *store = calloc(1, sizeof *store);
  if (!store)
    return NULL;
  store->file = -1;
  store->lock = -1;
  store->folder = strdup(folder);
  store->path = file_path(folder, RESULT_HDF5);
  if (store->folder && store->path)
    return store;
  store_close(store);
  return NULL;
}

gamut_status store_hold(const char *folder, struct trace *trace, struct store **made)
{
  gamut_status status;
  struct store *store = store_new(folder);
  *made = NULL;
  if (!store)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  TRY(folder_make(folder, trace));
  TRY(folder_lock(folder, trace, &store->lock));
  *made = store;
  return GAMUT_OK;
done:
  store_close(store);
  return status;
}

gamut_status store_begin(struct store *store, bool force, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status;
  TRY(folder_make_way(store->folder, force, trace));
  TRY(folder_tidy(store->folder, trace));
  store->frames = store->xdmf.size = 0;
  store->checksum = 0;
  TRY(new_id(store, trace));
  TRY(results_make(store, trace));
  TRY(results_place(store, trace));
done:
  return status;
}

gamut_status store_open(const char *folder, bool force, struct trace *trace, struct store **made)
{
  gamut_status status;
  TRY(store_hold(folder, trace, made));
  status = store_begin(*made, force, trace);
  if (status == GAMUT_OK)
    return GAMUT_OK;
done:
  store_close(*made);
  *made = NULL;
  return status;
}

gamut_status store_renew(struct store *store, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status;
  store_rest(store);
  TRY(folder_tidy(store->folder, trace));
  TRY(folder_remove_file(store->folder, RESULT_SUMMARY, trace));
  TRY(new_id(store, trace));
  TRY(results_make(store, trace));
  TRY(results_place(store, trace));
done:
  return status;
}

struct store_place store_place_of(const struct store *store)
{
  return (struct store_place){.frames = store->frames,
                              .last_time = store->last_time,
                              .last_step = store->last_step,
                              .checksum = store->checksum,
                              .run = store->run,
                              .xdmf = store->xdmf.size ? store->xdmf.data : ""};
}

gamut_status store_sync(struct store *store, struct trace *trace)
{
  EXCLUSIVE;
  return hdf5_sync(store->file, store->path, trace);
}

void store_rest(struct store *store)
{
  EXCLUSIVE;
  if (store->file >= 0 && !store->broken)
    hdf5_close(store->file);
  store->file = -1;
}

void store_close(struct store *store)
{
  if (!store)
    return;
  store_rest(store);
  if (store->partial)
    folder_tidy(store->folder, NULL);
  if (store->lock >= 0)
    close(store->lock);
  free(store->folder);
  free(store->path);
  free(store->buffer);
  free(store->xdmf.data);
  free(store);
}

const char *store_folder(const struct store *store)
{
  return store->folder;
}

/* A text as a file, and as a dataset of results.h5 so that the one file holds all. */
static gamut_status keep_text(struct store *store, const char *name, const char *dataset,
                              const char *text, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status = file_replace(store->folder, name, text, strlen(text), trace);
  herr_t result = 0;
  if (status == GAMUT_OK)
    status = hdf5_reserve(store->file, strlen(text) + 65536, store->path, trace);
  if (status != GAMUT_OK)
    return status;
  if (H5Lexists(store->file, dataset, H5P_DEFAULT) > 0)
    result = H5Ldelete(store->file, dataset, H5P_DEFAULT);
  if (result >= 0)
    result = hdf5_text_dataset(store->file, dataset, text);
  return result >= 0 ? hdf5_flush(store->file, store->path, trace) : store_broken(store, trace);
}

gamut_status store_scene(struct store *store, const struct tree *tree, struct trace *trace)
{
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (!memory)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  tree_write(tree, memory);
  gamut_status status = keep_text(store, RESULT_SCENE, "scene", memory_close(memory, &text), trace);
  free(text);
  return status;
}

gamut_status store_summary(struct store *store, const char *json, struct trace *trace)
{
  return keep_text(store, RESULT_SUMMARY, "summary", json, trace);
}

/* Names and stated sums only: whoever reads a frame checks what is in it. */
static bool frames_are_there(const struct store *store, hid_t file)
{
  uint64_t sum = 0, one;
  bool good = true;
  for (size_t i = 0; good && i < store->frames; i++) {
    char name[32], path[48];
    frame_name(i, name, sizeof name);
    snprintf(path, sizeof path, FRAMES_GROUP "/%s", name);
    hid_t frame = H5Gopen2(file, path, H5P_DEFAULT);
    good = frame >= 0 && checksum_stated(frame, &one);
    sum += good ? one : 0;
    if (frame >= 0)
      H5Gclose(frame);
  }
  return good && sum == store->checksum;
}

gamut_status store_finish(struct store *store, struct trace *trace)
{
  EXCLUSIVE;
  gamut_status status;
  TRY(results_there(store, trace));
  TRY(hdf5_sync(store->file, store->path, trace));
  if (!hdf5_close(store->file))
    status = store_broken(store, trace);
  store->file = -1;
  TRY(status);
  hid_t file = hdf5_open(store->path);
  char *run = file >= 0 ? hdf5_read_text_attribute(file, "run") : NULL;
  if (!run || strcmp(run, store->run) != 0 || !frames_are_there(store, file))
    status =
        trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL,
                      "leave the folder alone while a run writes there; --force runs it anew",
                      "'%s' is not what was written there: it was changed meanwhile", store->path);
  if (file >= 0)
    H5Fclose(file);
  free(run);
done:
  return status;
}
