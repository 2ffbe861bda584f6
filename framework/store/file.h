/* Files of a result: folders, names, and writing so that a reader never sees half a file. */
#ifndef GAMUT_STORE_FILE_H
#define GAMUT_STORE_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

/* "FOLDER/NAME", allocated; null when out of memory. */
char *file_path(const char *folder, const char *name);
bool file_exists(const char *path);

/* Makes the folder and its parents. */
gamut_status folder_make(const char *folder, struct trace *);
/* Makes FOLDER itself, which may be there, but no link that leads elsewhere. */
gamut_status folder_make_inside(const char *folder, struct trace *);
/* Takes a folder for this process alone until the descriptor is closed or the process ends, however
 * it ends. GAMUT_OUTPUT where another one has it. *lock is -1 where the file system has no locks,
 * which is warned of. */
gamut_status folder_lock(const char *folder, struct trace *, int *lock);

/* Opens a new file for writing: what had its name is gone, no link is followed. -1 and errno. */
int file_create(const char *path);
/* Waits until it is on the disk; an errno, or 0. */
int file_sync(int file);

#define FILE_PARTIAL ".partial"
/* Writes FOLDER/NAME under another name (NAME.partial), syncs it to the disk and renames it. */
gamut_status file_replace(const char *folder, const char *name, const char *text, size_t size,
                          struct trace *);

/* The same for a file that a user named, which may be there, but as a file: no link or device. */
gamut_status file_write(const char *path, const char *text, size_t size, struct trace *);

/* Removes a file; one that is not there is fine. */
gamut_status file_remove(const char *path, struct trace *);

#endif
