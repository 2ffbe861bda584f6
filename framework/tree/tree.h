/* A YAML file as a tree whose nodes know file:line:column (libyaml). */
#ifndef GAMUT_TREE_H
#define GAMUT_TREE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/error.h"

enum tree_kind { TREE_SCALAR, TREE_SEQUENCE, TREE_MAPPING };

struct tree {
  enum tree_kind kind;
  const char *text;       /* of a scalar; "" for the others */
  bool quoted;            /* a scalar in quotes, in a block or of several lines: never a number */
  const char *key;        /* its key in the parent mapping, or null */
  struct place place;     /* of the value */
  struct place key_place; /* of the key; equals `place` where there is none */
  struct tree *parent;    /* null for a root */
  struct tree **child;    /* owned, in the order of the file */
  size_t children;
  bool used; /* set by whoever has understood the node */
};

/* Limits that keep hostile files harmless; beyond them the file is refused in words. */
enum { TREE_BYTES_MAX = 4 << 20, TREE_DEPTH_MAX = 32, TREE_NODES_MAX = 200000 };

/* Reads one YAML document. Refused with GAMUT_SCENE (or GAMUT_PLUGIN, as `blame` says), each with
 * its place: unreadable, empty or binary file, syntax errors, duplicate keys, keys that are no
 * scalars, tags (!name), several documents, aliases that repeat without bound, the limits above. An
 * alias is copied: its nodes have the place of what it repeats, its key its own. */
gamut_status tree_read(const char *file, gamut_status blame, struct trace *, struct tree **root);
/* The same from memory; `name` stands for the file. */
gamut_status tree_parse(const char *text, size_t size, const char *name, gamut_status blame,
                        struct trace *, struct tree **root);
void tree_free(struct tree *root); /* a root and all below; accepts null */

/* Child of a mapping by key; null if absent or if `t` is no mapping (or null). */
struct tree *tree_get(const struct tree *t, const char *key);
/* The number of that child among the others; SIZE_MAX if it is absent. Both take a time that does
 * not grow with the mapping. */
size_t tree_number(const struct tree *t, const char *key);
/* By scene path "bodies.bar.shape.cylinder.length"; sequence items by number ("a.0" or "a[0]"). Of
 * keys with dots the longest that is there is meant. */
struct tree *tree_at(const struct tree *t, const char *path);
/* Writes the node's scene path, without the root. Returns buffer. */
char *tree_path(const struct tree *t, char *buffer, size_t size);

/* Deep copy; parent is null, `used` is false. The texts that places point into live as long as any
 * node that came from them, in copies and merged trees too. Null without memory. */
struct tree *tree_copy(const struct tree *t);
/* Puts `over` into `base`: mappings key by key, everything else replaces. `over` is consumed. Used
 * for include (the including file wins) and --set. */
void tree_merge(struct tree *base, struct tree *over);
/* Takes a child out of its parent and frees it; or all children of a mapping or list. */
void tree_drop(struct tree *child);
void tree_clear(struct tree *);
/* Sets base.path = value, making mappings on the way; value (a root) is consumed. Of a list only
 * items that are there can be set. Refused with GAMUT_USAGE at the value's place; base is then
 * unchanged. */
gamut_status tree_put(struct tree *base, const char *path, struct tree *value, struct trace *);

/* Writes the tree as YAML that reads back to the same tree (odd plain text in quotes).
 * Ask ferror(stream) for failures. */
void tree_write(const struct tree *t, FILE *);

#endif
