#include "store/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

char *file_path(const char *folder, const char *name)
{
  size_t size = strlen(folder) + strlen(name) + 2;
  char *path = malloc(size);
  if (path)
    snprintf(path, size, "%s/%s", folder, name);
  return path;
}

bool file_exists(const char *path)
{
  struct stat information;
  return lstat(path, &information) == 0;
}

gamut_status folder_make(const char *folder, struct trace *trace)
{
  struct stat information;
  gamut_status status = GAMUT_OK;
  char *path = strdup(folder);
  if (!path)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (char *end = path; *end && status == GAMUT_OK;) {
    end += strspn(end, "/");
    end += strcspn(end, "/");
    char kept = *end;
    *end = 0;
    int fault = mkdir(path, 0777) == 0 ? 0 : errno;
    if (fault && fault != EEXIST && stat(path, &information) != 0)
      status =
          trace_fail(trace, GAMUT_OUTPUT, "cannot make the folder '%s': %s", path, strerror(fault));
    *end = kept;
  }
  if (status == GAMUT_OK && (stat(folder, &information) != 0 || !S_ISDIR(information.st_mode)))
    status = trace_fail(trace, GAMUT_OUTPUT, "'%s' is not a folder", folder);
  free(path);
  return status;
}

gamut_status folder_make_inside(const char *folder, struct trace *trace)
{
  struct stat information;
  if (mkdir(folder, 0777) == 0)
    return GAMUT_OK;
  int fault = errno;
  if (fault == EEXIST && lstat(folder, &information) == 0) {
    if (S_ISDIR(information.st_mode))
      return GAMUT_OK;
    return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL, "remove it, or name another folder",
                         "'%s' is no folder%s", folder,
                         S_ISLNK(information.st_mode) ? ", but a link, which is not followed" : "");
  }
  return trace_fail(trace, GAMUT_OUTPUT, "cannot make the folder '%s': %s", folder,
                    strerror(fault));
}

gamut_status folder_lock(const char *folder, struct trace *trace, int *lock)
{
  *lock = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (*lock < 0)
    return trace_fail(trace, GAMUT_OUTPUT, "cannot open '%s': %s", folder, strerror(errno));
  if (flock(*lock, LOCK_EX | LOCK_NB) == 0)
    return GAMUT_OK;
  int fault = errno;
  close(*lock);
  *lock = -1;
  if (fault == EWOULDBLOCK)
    return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL, "wait for its end, or choose another",
                         "'%s' is in use by another gamut", folder);
  trace_warn_at(trace, NULL, NULL, NULL,
                "the folder '%s' cannot be locked (%s): see to it that no other gamut writes there",
                folder, strerror(fault));
  return GAMUT_OK;
}

int file_create(const char *path)
{
  if (unlink(path) != 0 && errno != ENOENT)
    return -1;
  return open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

int file_sync(int file)
{
  /* pipes and some file systems cannot be synced: what was written is all there is */
  return fsync(file) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
}

static int write_all(int file, const char *text, size_t size)
{
  while (size > 0) {
    ssize_t written = write(file, text, size);
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0)
      return errno;
    text += written;
    size -= (size_t)written;
  }
  return file_sync(file);
}

gamut_status file_replace(const char *folder, const char *name, const char *text, size_t size,
                          struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  char *path = file_path(folder, name), *partial = NULL;
  int fault = 0;
  if (path && (partial = malloc(strlen(path) + sizeof FILE_PARTIAL)))
    sprintf(partial, "%s" FILE_PARTIAL, path);
  if (!partial) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  int file = file_create(partial);
  fault = file < 0 ? errno : write_all(file, text, size);
  if (file >= 0 && close(file) != 0 && !fault)
    fault = errno;
  if (!fault && rename(partial, path) != 0)
    fault = errno;
  if (fault) {
    status = trace_fail(trace, GAMUT_OUTPUT, "cannot write '%s': %s", path, strerror(fault));
    if (file >= 0)
      unlink(partial);
  }
done:
  free(partial);
  free(path);
  return status;
}

gamut_status file_write(const char *path, const char *text, size_t size, struct trace *trace)
{
  struct stat information;
  const char *slash = strrchr(path, '/');
  if (lstat(path, &information) == 0 && !S_ISREG(information.st_mode))
    return trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL, "another name",
                         "cannot write '%s': it is %s, not a file", path,
                         S_ISLNK(information.st_mode)   ? "a link, which is not followed"
                         : S_ISDIR(information.st_mode) ? "a folder"
                                                        : "a device or a pipe");
  char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
  gamut_status status =
      folder ? file_replace(folder, slash ? slash + 1 : path, text, size, trace)
             : trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  free(folder);
  return status;
}

gamut_status file_remove(const char *path, struct trace *trace)
{
  if (unlink(path) == 0 || errno == ENOENT)
    return GAMUT_OK;
  return trace_fail(trace, GAMUT_OUTPUT, "cannot remove '%s': %s", path, strerror(errno));
}
