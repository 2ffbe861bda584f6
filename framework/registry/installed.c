/* Where an installed gamut is now: its tree may have been moved, or installed to another prefix
 * than configure was told. */
#include <stdio.h>
#include <string.h>

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
  int written =
      snprintf(path, size, "%.*s%s", (int)(length - tail), program, folder + shared);
  return written > 0 && (size_t)written < size;
}
