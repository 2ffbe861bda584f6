/* Where an installed gamut is now: its tree may have been moved, or installed to another prefix
 * than configure was given. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "registry/registry.h"
#include "registry/registry_private.h"
#include "tree/load.h"

#ifndef GAMUT_BIN_FOLDER
#define GAMUT_BIN_FOLDER ""
#endif

bool installed_beside(const char *program, const char *folder, char *path, size_t size)
{
  static const char bin[] = GAMUT_BIN_FOLDER;
  size_t shared = 0, length = strlen(program);
  for (size_t i = 0; bin[i] && bin[i] == folder[i]; i++)
    if (bin[i] == '/')
      shared = i;
  const char *rest = bin + shared;
  size_t tail = strlen(rest);
  if (!bin[0] || length < tail || strcmp(program + length - tail, rest) != 0)
    return false;
  int written = snprintf(path, size, "%.*s%s", (int)(length - tail), program, folder + shared);
  return written > 0 && (size_t)written < size;
}

bool program_place(char *folder, size_t size, uid_t *owner)
{
  struct stat info;
  char path[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
  if (length <= 0)
    return false;
  path[length] = 0;
  snprintf(folder, size, "%s", path);
  if (stat(folder, &info) != 0)
    return false;
  *owner = info.st_uid;
  char *slash = strrchr(folder, '/');
  if (!slash)
    return false;
  *slash = 0;
  return true;
}

/* What there is at `place`, by its real name. */
static bool resolve(const char *place, char *path, size_t size)
{
  char real[PATH_MAX];
  if (!realpath(place, real))
    return false;
  return snprintf(path, size, "%s", real) < (int)size;
}

/* A program built in place has a file plugins.path beside it, which names the tree's plugins. */
static bool in_tree(const char *program, const char *name, char *path, size_t size)
{
  char line[2 * PATH_MAX] = "", place[4 * PATH_MAX];
  snprintf(place, sizeof place, "%s/plugins.path", program);
  FILE *file = text_open(place);
  if (!file)
    return false;
  char *blank = fgets(line, sizeof line, file) ? strrchr(line, ' ') : NULL;
  fclose(file);
  if (!blank)
    return false;
  *blank = 0;
  snprintf(place, sizeof place, "%s%s%s/../%s", line[0] == '/' ? "" : program,
           line[0] == '/' ? "" : "/", line, name);
  return resolve(place, path, size);
}

bool installed_data(const char *name, char *path, size_t size)
{
  char program[PATH_MAX], beside[PATH_MAX], place[3 * PATH_MAX];
  uid_t owner;
  const bool known = program_place(program, sizeof program, &owner);
  if (known && in_tree(program, name, path, size))
    return true;
#ifdef GAMUT_DATA_DIR
  if (known && installed_beside(program, GAMUT_DATA_DIR, beside, sizeof beside)) {
    snprintf(place, sizeof place, "%s/%s", beside, name);
    if (resolve(place, path, size))
      return true;
  }
  snprintf(place, sizeof place, "%s/%s", GAMUT_DATA_DIR, name);
  return resolve(place, path, size);
#else
  (void)beside, (void)place;
  return false;
#endif
}
