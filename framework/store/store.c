#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "store/checkpoint.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/state.h"

static const char *const result_files[] = {
    RESULT_HDF5,  RESULT_XDMF, RESULT_HISTORY,  RESULT_SUMMARY,      RESULT_SCENE,
    RESULT_STUDY, RESULT_LOG,  CHECKPOINT_FILE, CHECKPOINT_PREVIOUS, CHECKPOINT_PARTIAL};
enum { RESULT_FILES = sizeof result_files / sizeof result_files[0] };

/* Name of the first file of a result that the folder holds, or null. */
static const char *former_file(const char *folder)
{
  for (size_t i = 0; i < RESULT_FILES; ++i) {
    char *path = file_path(folder, result_files[i]);
    bool there = path && file_exists(path);
    free(path);
    if (there)
      return result_files[i];
  }
  return NULL;
}

/* Whether results.h5 is one of ours: nobody else's files are removed. */
static bool is_ours(const char *folder)
{
  char *path = file_path(folder, RESULT_HDF5);
  hid_t file = path ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  bool ours = file >= 0 && H5Aexists(file, "gamut") > 0;
  if (file >= 0)
    H5Fclose(file);
  H5Eclear2(H5E_DEFAULT);
  free(path);
  return ours;
}

static bool is_picture(const char *name)
{
  const char *end = strrchr(name, '.');
  bool made = strncmp(name, "history", 7) == 0 || strncmp(name, "body", 4) == 0;
  return made && end &&
         (strcmp(end, ".png") == 0 || strcmp(end, ".gp") == 0 || strcmp(end, ".dat") == 0);
}

static gamut_status remove_pictures(const char *folder, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  char *pictures = file_path(folder, RESULT_PICTURES);
  DIR *opened = pictures ? opendir(pictures) : NULL;
  for (struct dirent *entry; opened && status == GAMUT_OK && (entry = readdir(opened));) {
    if (!is_picture(entry->d_name))
      continue;
    char *path = file_path(pictures, entry->d_name);
    if (path)
      status = file_remove(path, trace);
    free(path);
  }
  if (opened) {
    closedir(opened);
    rmdir(pictures); /* stays when somebody else has put something there */
  }
  free(pictures);
  return status;
}

static gamut_status remove_former(const char *folder, bool keep_log, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  /* results.h5 goes last: it is the mark of a result, should removing stop half-way */
  for (size_t i = RESULT_FILES; i-- > 0 && status == GAMUT_OK;) {
    if (keep_log && strcmp(result_files[i], RESULT_LOG) == 0)
      continue;
    char *path = file_path(folder, result_files[i]);
    if (!path)
      return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    if (i == 0)
      status = remove_pictures(folder, trace);
    if (status == GAMUT_OK)
      status = file_remove(path, trace);
    free(path);
  }
  return status;
}

static gamut_status make_way(const char *folder, bool force, struct trace *trace)
{
  const char *former = former_file(folder);
  if (!former)
    return GAMUT_OK;
  char *log = file_path(folder, RESULT_LOG);
  bool study = log && file_exists(log);
  free(log);
  if (!force)
    return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL,
                         study ? "--resume goes on with the study, --force replaces it"
                               : "choose another folder; --resume goes on from its checkpoint, "
                                 "--force replaces the result",
                         "'%s' holds a result already (%s)", folder, former);
  if (!is_ours(folder))
    return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL, "choose another folder",
                         "'%s' holds %s, but no results.h5 of gamut: nothing is removed", folder,
                         former);
  return remove_former(folder, false, trace);
}

static hid_t create_file(const char *path)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, 0, 1); /* a viewer may look during a run */
#endif
  hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Pclose(access);
  return file;
}

static herr_t make_group(hid_t file, const char *name)
{
  hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  return group < 0 ? -1 : H5Gclose(group);
}

static gamut_status start_file(struct store *store, struct trace *trace)
{
  /* HDF5 hides the reason of a file that cannot be made */
  int probe = open(store->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (probe < 0)
    return trace_fail(trace, GAMUT_OUTPUT, "cannot make '%s': %s", store->path, strerror(errno));
  close(probe);
  store->file = create_file(store->path);
  if (store->file < 0)
    return hdf5_fault(store->path, "make", trace);
  herr_t result = make_group(store->file, "frames");
  if (result >= 0)
    result = make_group(store->file, "vertices");
  if (result >= 0)
    result = hdf5_text_attribute(store->file, "gamut", GAMUT_VERSION);
  return result >= 0 ? hdf5_flush(store->file, store->path, trace) : store_broken(store, trace);
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
  store->folder = strdup(folder);
  store->path = file_path(folder, RESULT_HDF5);
  if (store->folder && store->path)
    return store;
  store_close(store);
  return NULL;
}

enum opening { OPEN_NEW, OPEN_FORCE, OPEN_RENEW };

static gamut_status open_as(const char *folder, enum opening how, struct trace *trace,
                            struct store **made)
{
  gamut_status status = GAMUT_OK;
  *made = NULL;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  struct store *store = store_new(folder);
  if (!store)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  TRY(folder_make(folder, trace));
  TRY(how == OPEN_RENEW ? remove_former(folder, true, trace)
                        : make_way(folder, how == OPEN_FORCE, trace));
  TRY(start_file(store, trace));
  *made = store;
  return GAMUT_OK;
done:
  store_close(store);
  return status;
}

gamut_status store_open(const char *folder, bool force, struct trace *trace, struct store **made)
{
  return open_as(folder, force ? OPEN_FORCE : OPEN_NEW, trace, made);
}

gamut_status store_renew(const char *folder, struct trace *trace, struct store **made)
{
  return open_as(folder, OPEN_RENEW, trace, made);
}

static gamut_status remove_file(const char *folder, const char *name, struct trace *trace)
{
  char *path = file_path(folder, name);
  gamut_status status =
      path ? file_remove(path, trace) : trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  free(path);
  return status;
}

static herr_t drop_frames(struct store *store)
{
  H5G_info_t information;
  char name[32];
  if (H5Gget_info_by_name(store->file, "frames", &information, H5P_DEFAULT) < 0 ||
      information.nlinks < store->frames)
    return -1;
  for (size_t i = store->frames; i < information.nlinks; i++) {
    snprintf(name, sizeof name, "frames/%08zu", i);
    if (H5Ldelete(store->file, name, H5P_DEFAULT) < 0)
      return -1;
  }
  return 0;
}

static hid_t reopen_file(const char *path)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, 0, 1);
#endif
  hid_t file = H5Fopen(path, H5F_ACC_RDWR, access);
  H5Pclose(access);
  return file;
}

gamut_status store_reopen(const char *folder, const struct store_place *place, struct trace *trace,
                          struct store **made)
{
  gamut_status status = GAMUT_OK;
  *made = NULL;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  struct store *store = store_new(folder);
  if (!store)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  store->frames = place->frames;
  store->last_time = place->last_time;
  store->last_step = place->last_step;
  text_add(&store->xdmf, "%s", place->xdmf);
  store->file = is_ours(folder) ? reopen_file(store->path) : -1;
  if (store->file < 0 || drop_frames(store) < 0)
    status = trace_fail(trace, GAMUT_OUTPUT,
                        "'%s' cannot be gone on with: it is missing, broken, or lacks frames that "
                        "were there at the checkpoint",
                        store->path);
  else
    status = hdf5_flush(store->file, store->path, trace);
  if (status == GAMUT_OK)
    status = xdmf_write(store, trace);
  /* what it says is no longer so */
  if (status == GAMUT_OK)
    status = remove_file(folder, RESULT_SUMMARY, trace);
  if (status == GAMUT_OK)
    *made = store;
  else
    store_close(store);
  return status;
}

struct store_place store_place_of(const struct store *store)
{
  return (struct store_place){.frames = store->frames,
                              .last_time = store->last_time,
                              .last_step = store->last_step,
                              .xdmf = store->xdmf.data ? store->xdmf.data : ""};
}

bool store_there(const char *folder)
{
  return former_file(folder) != NULL;
}

void store_close(struct store *store)
{
  if (!store)
    return;
  if (store->file >= 0 && !store->broken)
    H5Fclose(store->file);
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

/* A text as a file, and as a dataset of results.h5 so that the one file tells all. */
static gamut_status keep_text(struct store *store, const char *name, const char *dataset,
                              const char *text, struct trace *trace)
{
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
  gamut_status status = fclose(memory) == 0 ? keep_text(store, RESULT_SCENE, "scene", text, trace)
                                            : trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  free(text);
  return status;
}

gamut_status store_summary(struct store *store, const char *json, struct trace *trace)
{
  return keep_text(store, RESULT_SUMMARY, "summary", json, trace);
}
