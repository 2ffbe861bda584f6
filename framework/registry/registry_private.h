/* Inside the registry room. */
#ifndef GAMUT_REGISTRY_PRIVATE_H
#define GAMUT_REGISTRY_PRIVATE_H

#include <sys/types.h>

#include "registry/registry.h"

/* One plugin that was found. */
struct entry {
  struct descriptor *descriptor; /* null where the YAML has faults */
  char *file;                    /* its YAML, absolute */
  char *kind, *name;             /* as the path says, where the YAML has faults */
  char *objects;                 /* folder of its shared objects */
  const struct entry *shadowed;  /* the plugin that stands in front of this one, or null */
  const struct gamut_plugin *plugin;
  const char *level;
  char *refusal; /* why it was refused: a second load would not run its constructors again */
};

/* A folder that was looked at, or would have been. */
struct root {
  char *yaml, *objects;
  const char *origin; /* "--plugin-path" ... */
  char *skipped;      /* why, or null */
  size_t found;
};

struct registry {
  const struct units *units;
  struct entry **entry; /* all, in the order found */
  size_t entries;
  struct entry **usable; /* sorted by id, without shadowed and faulty ones */
  size_t usables;
  struct root *root;
  size_t roots;
  bool started; /* libltdl */
};

/* "one/two"; null where there is no memory. */
char *path_join(const char *one, const char *two);
void *grow(void *list, size_t count, size_t size, bool *failed);
bool is_folder(const char *path);
bool is_file(const char *path);
/* Why somebody else could change this file: the first part of its real path, folders and the file
 * itself, that belongs to a stranger or that everybody may write; null where there is none. */
const char *path_unsafe(const char *path, char *part, size_t size);

/* Whether the bytes of a shared object are those of which the digest beside it was made; true where
 * none was installed with it. Otherwise `why` is a sentence. */
bool digest_holds(const char *file, const void *bytes, size_t size, char *why, size_t why_size);

/* The folder of the running program, and who owns the program; false where nobody can say. */
bool program_place(char *folder, size_t size, uid_t *owner);

/* Fills registry->root from the options and the environment. */
gamut_status search_roots(struct registry *, const struct registry_options *, struct trace *);
/* Reads the plugins of one root. */
gamut_status search_plugins(struct registry *, struct root *, struct trace *);
/* Reads one YAML file. A faulty one is kept as such; with `aloud` its faults are recorded. */
gamut_status registry_take(struct registry *, const char *file, const char *objects, bool aloud,
                           struct trace *, struct entry **);
/* Puts the usable entries in order; `first` (or null) wins over all others with its id. */
gamut_status registry_sort(struct registry *, struct entry *first, struct trace *);

struct entry *registry_entry(const struct registry *, const struct descriptor *);

#endif
