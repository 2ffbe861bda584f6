/* What lies in the folder of a result, and whose it is. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "store/checkpoint.h"
#include "store/file.h"
#include "store/hdf5.h"
#include "store/store_private.h"

static const char *const result_files[] = {
    RESULT_HDF5,      RESULT_XDMF, RESULT_HISTORY,  RESULT_SCENE,        RESULT_STUDY,
    RESULT_ESTIMATES, RESULT_LOG,  CHECKPOINT_FILE, CHECKPOINT_PREVIOUS, RESULT_SUMMARY};
enum { RESULT_FILES = ARRAY_SIZE(result_files) };

static bool folder_has(const char *folder, const char *name)
{
  char *path = file_path(folder, name);
  bool there = path && file_exists(path);
  free(path);
  return there;
}

/* What a run that was killed while it wrote leaves behind: no part of a result. */
static const char *const partial_files[] = {RESULT_PARTIAL,
                                            CHECKPOINT_PARTIAL,
                                            RESULT_XDMF FILE_PARTIAL,
                                            RESULT_HISTORY FILE_PARTIAL,
                                            RESULT_SUMMARY FILE_PARTIAL,
                                            RESULT_SCENE FILE_PARTIAL,
                                            RESULT_LOG FILE_PARTIAL,
                                            RESULT_STUDY FILE_PARTIAL,
                                            RESULT_ESTIMATES FILE_PARTIAL};
enum { PARTIAL_FILES = ARRAY_SIZE(partial_files) };

/* Name of the first file of a result that the folder holds, or null. */
static const char *former_file(const char *folder)
{
  for (size_t i = 0; i < RESULT_FILES; ++i)
    if (folder_has(folder, result_files[i]))
      return result_files[i];
  return NULL;
}

static bool carries(const char *folder, const char *name, const char *mark)
{
  char *path = file_path(folder, name);
  hid_t file = path ? hdf5_open(path) : -1;
  bool found = file >= 0 && H5Aexists(file, mark) > 0;
  if (file >= 0)
    H5Fclose(file);
  H5Eclear2(H5E_DEFAULT);
  free(path);
  return found;
}

static bool is_log(const char *folder)
{
  char *path = file_path(folder, RESULT_LOG), start[sizeof RESULT_LOG_MARK] = "";
  FILE *file = path ? fopen(path, "re") : NULL;
  bool ours = file && fgets(start, sizeof start, file) && strcmp(start, RESULT_LOG_MARK) == 0;
  if (file)
    fclose(file);
  free(path);
  return ours;
}

/* Nobody else's files are removed. One mark is enough: another file may be broken. */
static bool is_ours(const char *folder)
{
  return carries(folder, RESULT_HDF5, "gamut") || carries(folder, CHECKPOINT_FILE, "gamut") ||
         carries(folder, CHECKPOINT_PREVIOUS, "gamut") || is_log(folder);
}

static bool is_picture(const char *name)
{
  const char *end = strrchr(name, '.');
  bool made = strncmp(name, "history", 7) == 0 || strncmp(name, "body", 4) == 0;
  return made && end &&
         (strcmp(end, ".png") == 0 || strcmp(end, ".gp") == 0 || strcmp(end, ".dat") == 0);
}

static bool ends_in(const char *name, const char *end)
{
  const size_t length = strlen(name), tail = strlen(end);
  return length >= tail && strcmp(name + length - tail, end) == 0;
}

/* Of an estimator's tables; one that a killed run left half written is one too. */
static bool is_table(const char *name)
{
  return strncmp(name, RESULT_TABLE, strlen(RESULT_TABLE)) == 0 &&
         (ends_in(name, ".csv") || ends_in(name, ".csv" FILE_PARTIAL));
}

static gamut_status remove_those(const char *folder, bool (*is_one)(const char *name),
                                 struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  int place = open(folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  DIR *opened = place >= 0 ? fdopendir(place) : NULL;
  for (struct dirent *entry; opened && status == GAMUT_OK && (entry = readdir(opened));)
    if (is_one(entry->d_name) && unlinkat(place, entry->d_name, 0) != 0 && errno != ENOENT)
      status = trace_fail(trace, GAMUT_OUTPUT, "cannot remove '%s/%s': %s", folder, entry->d_name,
                          strerror(errno));
  if (opened)
    closedir(opened);
  else if (place >= 0)
    close(place);
  return status;
}

static gamut_status remove_pictures(const char *folder, struct trace *trace)
{
  char *pictures = file_path(folder, RESULT_PICTURES);
  if (!pictures)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  const gamut_status status = remove_those(pictures, is_picture, trace);
  rmdir(pictures); /* stays when somebody else has put something there */
  free(pictures);
  return status;
}

gamut_status folder_remove_file(const char *folder, const char *name, struct trace *trace)
{
  char *path = file_path(folder, name);
  gamut_status status =
      path ? file_remove(path, trace) : trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  free(path);
  return status;
}

gamut_status folder_tidy(const char *folder, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < PARTIAL_FILES; ++i)
    TRY(folder_remove_file(folder, partial_files[i], trace));
done:
  return status;
}

static gamut_status remove_former(const char *folder, struct trace *trace)
{
  gamut_status status;
  TRY(remove_pictures(folder, trace));
  TRY(remove_those(folder, is_table, trace));
  /* Should removing stop half-way: the summary goes first, since it says that all is there, and
   * results.h5 last, since it is the mark of a result. */
  for (size_t i = RESULT_FILES; i-- > 0;)
    TRY(folder_remove_file(folder, result_files[i], trace));
done:
  return status;
}

gamut_status folder_make_way(const char *folder, bool force, struct trace *trace)
{
  const char *former = former_file(folder);
  if (!former)
    return GAMUT_OK;
  bool study = folder_has(folder, RESULT_LOG);
  if (!force)
    return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL,
                         study ? "--resume goes on with the study, --force replaces it"
                               : "choose another folder; --resume goes on from its checkpoint, "
                                 "--force replaces the result",
                         "'%s' holds a result already (%s)", folder, former);
  if (!is_ours(folder))
    return trace_fail_at(
        trace, GAMUT_OUTPUT, NULL, NULL, "choose another folder, or remove what is in this one",
        "'%s' holds %s, but no results.h5 of gamut: nothing is removed", folder, former);
  return remove_former(folder, trace);
}

bool store_there(const char *folder)
{
  return former_file(folder) != NULL;
}

bool store_is_bare(const char *folder)
{
  for (size_t i = 0; i < RESULT_FILES; ++i)
    if (strcmp(result_files[i], RESULT_HDF5) != 0 && strcmp(result_files[i], RESULT_SCENE) != 0 &&
        folder_has(folder, result_files[i]))
      return false;
  return true;
}
