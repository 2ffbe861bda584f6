/* What a tree is made of behind its public face: nodes own their words and share their source. */
#ifndef GAMUT_TREE_PRIVATE_H
#define GAMUT_TREE_PRIVATE_H

#include <stdatomic.h>

#include "tree/tree.h"

/* A text that was read. Trees are copied and merged across files, so each node holds a reference to
 * the text its place points into. */
struct origin {
  atomic_size_t references;
  char *name, *text;
  const char **line; /* into text, whose line ends are zero bytes */
  size_t lines;
};

/* Every `struct tree` is the first member of one of these. */
struct node {
  struct tree tree;
  char *text, *key;
  struct origin *origin;
  struct key_index *index; /* of a mapping with many keys; null: they are looked up one by one */
};

/* tree/index.c: where each key of a mapping stands, by a hash of the key. Never wrong, only absent:
 * without memory there is none. */
void index_add(struct tree *mapping);   /* the last child is new */
void index_renew(struct tree *mapping); /* children have gone or moved */
void index_free(struct key_index *);    /* accepts null */
/* The number of the child with that key; SIZE_MAX if there is none. */
size_t index_find(const struct tree *mapping, const char *key, size_t length);

/* Copies name and text, one reference; null without memory. */
struct origin *origin_new(const char *name, const char *text, size_t size);
struct origin *origin_hold(struct origin *);
void origin_release(struct origin *); /* accepts null */
/* The place of line and column from 1; line 0 means the file as a whole. */
struct place origin_place(const struct origin *, size_t line, size_t column, size_t width);

/* Appends a new node to `parent` (null: a root). Text and key are copied; key null in sequences.
 * Null without memory. */
struct tree *node_new(struct tree *parent, enum tree_kind, const char *text, const char *key,
                      struct origin *);
/* Makes an existing root the last child of `parent`; false without memory (the child stays free).
 */
bool node_attach(struct tree *parent, struct tree *child);
/* Copies the words of one node, not its children, below `parent`. */
struct tree *node_copy_shallow(struct tree *parent, const struct tree *, const char *key);
/* The levels of a tree: 1 for a scalar. */
int node_depth(const struct tree *);

/* One step of a scene path: a word, or a number in brackets. */
struct step {
  const char *word;
  size_t length;
  bool bracket;
};

/* tree/find.c: takes the first step off `path`; returns the rest, or null if the path is malformed.
 */
const char *path_step(const char *path, bool first, struct step *);
struct tree *path_child(const struct tree *, const struct step *);
/* The same, with the child that the step leads to, null if it is not there. A key may hold dots
 * ("diameter_at_0.2L"): of the keys that are there the longest that fits is taken. */
const char *path_enter(const struct tree *, const char *path, bool first, struct step *,
                       struct tree **child);

/* tree/source.c: refuses what is no text at all before a parser sees it. */
gamut_status source_check(const struct origin *, const char *text, size_t size, gamut_status blame,
                          struct trace *);

#endif
