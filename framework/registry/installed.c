/* Where an installed gamut is now: its tree may have been moved, or installed to another prefix
 * than configure was given. */
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "registry/registry.h"

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

static bool exists(const char *path)
{
  return access(path, F_OK) == 0;
}

/* A program built in place has a file plugins.path beside it, which names the tree's plugins. */
static bool in_tree(const char *program, const char *name, char *path, size_t size)
{
  char line[PATH_MAX] = "";
  snprintf(path, size, "%s/plugins.path", program);
  FILE *file = fopen(path, "r");
  if (!file)
    return false;
  const bool read = fgets(line, sizeof line, file) != NULL;
  fclose(file);
  line[strcspn(line, " \n")] = 0;
  if (!read || !line[0])
    return false;
  if (line[0] == '/')
    snprintf(path, size, "%s/../%s", line, name);
  else
    snprintf(path, size, "%s/%s/../%s", program, line, name);
  return exists(path);
}

bool installed_data(const char *name, char *path, size_t size)
{
  char program[PATH_MAX], beside[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = 0;
  char *slash = strrchr(program, '/');
  if (slash) {
    *slash = 0;
    if (in_tree(program, name, path, size))
      return true;
  }
#ifdef GAMUT_DATA_DIR
  if (slash && installed_beside(program, GAMUT_DATA_DIR, beside, sizeof beside)) {
    snprintf(path, size, "%s/%s", beside, name);
    if (exists(path))
      return true;
  }
  snprintf(path, size, "%s/%s", GAMUT_DATA_DIR, name);
  return exists(path);
#else
  (void)beside;
  return false;
#endif
}
