/* Files of a result: folders, names, and writing so that a reader never sees half a file. */
#ifndef GAMUT_STORE_FILE_H
#define GAMUT_STORE_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "error/error.h"

/* "FOLDER/NAME", allocated; null when out of memory. */
char *file_path(const char *folder, const char *name);
bool file_exists(const char *path);

/* Makes the folder and its parents. */
gamut_status folder_make(const char *folder, struct trace *);

/* Writes FOLDER/NAME under another name, syncs it to the disk and renames it. */
gamut_status file_replace(const char *folder, const char *name, const char *text, size_t size,
                          struct trace *);

/* Removes a file; one that is not there is fine. */
gamut_status file_remove(const char *path, struct trace *);

#endif
