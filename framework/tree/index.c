/* Keys of large mappings: a table with open addressing, its cells numbers of children from 1. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tree/tree_private.h"

enum { FEW = 16 }; /* so many keys are found one by one as fast */

struct key_index {
  size_t cells; /* a power of two, at least twice the children */
  uint32_t cell[];
};

static size_t hash(const char *key, size_t length)
{
  uint64_t sum = 14695981039346656037u; /* FNV-1a */
  for (size_t k = 0; k < length; k++)
    sum = (sum ^ (unsigned char)key[k]) * 1099511628211u;
  return (size_t)(sum ^ sum >> 32);
}

static bool is_named(const struct tree *child, const char *key, size_t length)
{
  return strncmp(child->key, key, length) == 0 && child->key[length] == '\0';
}

/* The first of several with one key stays the one that is found. */
static void put(struct key_index *index, const struct tree *mapping, size_t number)
{
  const char *key = mapping->child[number]->key;
  size_t length = strlen(key), at = hash(key, length) & (index->cells - 1);
  for (; index->cell[at] != 0; at = (at + 1) & (index->cells - 1))
    if (is_named(mapping->child[index->cell[at] - 1], key, length))
      return;
  index->cell[at] = (uint32_t)number + 1;
}

void index_free(struct key_index *index)
{
  free(index);
}

void index_renew(struct tree *mapping)
{
  struct node *node = (struct node *)mapping;
  index_free(node->index);
  node->index = NULL;
  if (mapping->kind != TREE_MAPPING || mapping->children <= FEW ||
      mapping->children > UINT32_MAX / 8)
    return;
  size_t cells = 1;
  while (cells < 4 * mapping->children)
    cells *= 2;
  struct key_index *index = calloc(1, sizeof *index + cells * sizeof *index->cell);
  if (index == NULL)
    return;
  index->cells = cells;
  for (size_t k = 0; k < mapping->children; k++)
    put(index, mapping, k);
  node->index = index;
}

void index_add(struct tree *mapping)
{
  struct key_index *index = ((struct node *)mapping)->index;
  if (mapping->kind != TREE_MAPPING || mapping->children <= FEW)
    return;
  if (index == NULL || 2 * mapping->children > index->cells)
    index_renew(mapping);
  else
    put(index, mapping, mapping->children - 1);
}

size_t index_find(const struct tree *mapping, const char *key, size_t length)
{
  const struct key_index *index = ((const struct node *)mapping)->index;
  if (index == NULL) {
    for (size_t k = 0; k < mapping->children; k++)
      if (is_named(mapping->child[k], key, length))
        return k;
    return SIZE_MAX;
  }
  size_t at = hash(key, length) & (index->cells - 1);
  for (; index->cell[at] != 0; at = (at + 1) & (index->cells - 1))
    if (is_named(mapping->child[index->cell[at] - 1], key, length))
      return index->cell[at] - 1;
  return SIZE_MAX;
}
