#include "tree/tree_private.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a line end as YAML 1.1 counts them, so that our lines are libyaml's lines; 0 if none. */
static size_t line_end(const char *text, const char *end)
{
  const unsigned char *byte = (const unsigned char *)text;
  size_t left = (size_t)(end - text);
  if (byte[0] == '\r')
    return left > 1 && byte[1] == '\n' ? 2 : 1;
  if (byte[0] == '\n')
    return 1;
  if (left > 1 && byte[0] == 0xC2 && byte[1] == 0x85)
    return 2;
  if (left > 2 && byte[0] == 0xE2 && byte[1] == 0x80 && (byte[2] == 0xA8 || byte[2] == 0xA9))
    return 3;
  return 0;
}

/* Counts the lines, and notes where they begin if `line` is there. */
static size_t split(char *text, size_t size, const char **line)
{
  char *end = text + size;
  size_t count = 1;
  if (line != NULL)
    line[0] = text;
  for (char *at = text; at < end;) {
    size_t length = line_end(at, end);
    if (length > 0 && line != NULL) {
      *at = '\0';
      line[count] = at + length;
    }
    count += length > 0;
    at += length > 0 ? length : 1;
  }
  return count;
}

struct origin *origin_new(const char *name, const char *text, size_t size)
{
  struct origin *origin = calloc(1, sizeof *origin);
  if (origin == NULL)
    return NULL;
  atomic_init(&origin->references, 1);
  origin->name = strdup(name);
  origin->text = malloc(size + 1);
  if (origin->name == NULL || origin->text == NULL)
    goto failed;
  if (size > 0)
    memcpy(origin->text, text, size);
  origin->text[size] = '\0';
  origin->lines = split(origin->text, size, NULL);
  origin->line = malloc(origin->lines * sizeof *origin->line);
  if (origin->line == NULL)
    goto failed;
  split(origin->text, size, origin->line);
  return origin;
failed:
  origin_release(origin);
  return NULL;
}

struct origin *origin_hold(struct origin *origin)
{
  atomic_fetch_add(&origin->references, 1);
  return origin;
}

void origin_release(struct origin *origin)
{
  if (origin == NULL || atomic_fetch_sub(&origin->references, 1) > 1)
    return;
  free(origin->name);
  free(origin->text);
  free(origin->line);
  free(origin);
}

struct place origin_place(const struct origin *origin, size_t line, size_t column, size_t width)
{
  bool inside = line >= 1 && line <= origin->lines;
  return (struct place){.file = origin->name,
                        .line = line > INT_MAX ? INT_MAX : (int)line,
                        .column = column > INT_MAX ? INT_MAX : (int)column,
                        .width = width < 1         ? 1
                                 : width > INT_MAX ? INT_MAX
                                                   : (int)width,
                        .source = inside ? origin->line[line - 1] : NULL};
}

bool node_attach(struct tree *parent, struct tree *child)
{
  size_t count = parent->children;
  if ((count & (count - 1)) == 0) { /* the room is the next power of two, so it needs no record */
    size_t room = count == 0 ? 1 : 2 * count;
    struct tree **grown = realloc(parent->child, room * sizeof *grown);
    if (grown == NULL)
      return false;
    parent->child = grown;
  }
  parent->child[parent->children++] = child;
  child->parent = parent;
  index_add(parent);
  return true;
}

struct tree *node_new(struct tree *parent, enum tree_kind kind, const char *text, const char *key,
                      struct origin *origin)
{
  struct node *node = calloc(1, sizeof *node);
  if (node == NULL)
    return NULL;
  node->origin = origin_hold(origin);
  node->text = kind == TREE_SCALAR ? strdup(text) : NULL;
  node->key = key != NULL ? strdup(key) : NULL;
  node->tree.kind = kind;
  node->tree.text = node->text != NULL ? node->text : "";
  node->tree.key = node->key;
  bool complete = (kind != TREE_SCALAR || node->text != NULL) && (key == NULL || node->key != NULL);
  if (!complete || (parent != NULL && !node_attach(parent, &node->tree))) {
    tree_free(&node->tree);
    return NULL;
  }
  return &node->tree;
}

void tree_free(struct tree *tree)
{
  if (tree == NULL)
    return;
  for (size_t k = 0; k < tree->children; k++)
    tree_free(tree->child[k]);
  struct node *node = (struct node *)tree;
  free(tree->child);
  index_free(node->index);
  free(node->text);
  free(node->key);
  origin_release(node->origin);
  free(node);
}

struct tree *node_copy_shallow(struct tree *parent, const struct tree *from, const char *key)
{
  const struct node *node = (const struct node *)from;
  struct tree *copy = node_new(parent, from->kind, from->text, key, node->origin);
  if (copy != NULL) {
    copy->quoted = from->quoted;
    copy->place = from->place;
    copy->key_place = from->key_place;
  }
  return copy;
}

static bool copy_children(struct tree *to, const struct tree *from)
{
  for (size_t k = 0; k < from->children; k++) {
    struct tree *copy = node_copy_shallow(to, from->child[k], from->child[k]->key);
    if (copy == NULL || !copy_children(copy, from->child[k]))
      return false;
  }
  return true;
}

struct tree *tree_copy(const struct tree *from)
{
  struct tree *copy = node_copy_shallow(NULL, from, from->key);
  if (copy != NULL && !copy_children(copy, from)) {
    tree_free(copy);
    copy = NULL;
  }
  return copy;
}

int node_depth(const struct tree *tree)
{
  int deepest = 0;
  for (size_t k = 0; k < tree->children; k++) {
    int depth = node_depth(tree->child[k]);
    deepest = depth > deepest ? depth : deepest;
  }
  return deepest + 1;
}
