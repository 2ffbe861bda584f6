/* The one way in which gamut opens a text that somebody else wrote: scenes, what they include,
 * their tables, descriptors, tests of plugins. */
#ifndef GAMUT_TREE_LOAD_H
#define GAMUT_TREE_LOAD_H

#include <stddef.h>

#include "base/error.h"

/* Reads a regular file of at most `most` bytes; a link to one will do. Anything else is refused
 * without waiting for it: a named pipe would block, a device never end. *text is allocated, with a
 * zero byte behind its end. Why a file cannot be read is written to `why`. */
bool text_load(const char *file, size_t most, char **text, size_t *size, char *why,
               size_t why_size);
/* The same as a stream, for our own files that are read line by line; null with errno set. */
FILE *text_open(const char *file);

#endif
