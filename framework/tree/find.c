#include <stdint.h>
#include <string.h>

#include "tree/tree_private.h"

static struct tree *child_numbered(const struct tree *tree, const char *digits, size_t length)
{
  size_t number = 0;
  if (length == 0 || length > 9)
    return NULL;
  for (size_t k = 0; k < length; k++) {
    if (digits[k] < '0' || digits[k] > '9')
      return NULL;
    number = 10 * number + (size_t)(digits[k] - '0');
  }
  return number < tree->children ? tree->child[number] : NULL;
}

struct tree *tree_get(const struct tree *tree, const char *key)
{
  if (tree == NULL || tree->kind != TREE_MAPPING)
    return NULL;
  size_t number = index_find(tree, key, strlen(key));
  return number == SIZE_MAX ? NULL : tree->child[number];
}

size_t tree_number(const struct tree *tree, const char *key)
{
  return tree == NULL || tree->kind != TREE_MAPPING ? SIZE_MAX : index_find(tree, key, strlen(key));
}

const char *path_step(const char *path, bool first, struct step *step)
{
  step->bracket = *path == '[';
  if (!step->bracket && !first && *path++ != '.')
    return NULL;
  step->word = path + step->bracket;
  step->length = strcspn(step->word, step->bracket ? "]" : ".[");
  const char *rest = step->word + step->length;
  if (step->length == 0 || (step->bracket && *rest++ == '\0'))
    return NULL;
  return rest;
}

struct tree *path_child(const struct tree *tree, const struct step *step)
{
  if (tree->kind == TREE_SEQUENCE)
    return child_numbered(tree, step->word, step->length);
  if (tree->kind == TREE_MAPPING && !step->bracket) {
    size_t number = index_find(tree, step->word, step->length);
    return number == SIZE_MAX ? NULL : tree->child[number];
  }
  return NULL;
}

const char *path_enter(const struct tree *tree, const char *path, bool first, struct step *step,
                       struct tree **child)
{
  const char *rest = path_step(path, first, step);
  *child = rest != NULL ? path_child(tree, step) : NULL;
  if (rest == NULL || tree->kind != TREE_MAPPING)
    return rest;
  struct step longer = *step, next;
  for (const char *end = rest; end != NULL && *end == '.';) {
    end = path_step(end, false, &next);
    if (end == NULL)
      break;
    longer.length = (size_t)(next.word + next.length - longer.word);
    struct tree *found = path_child(tree, &longer);
    if (found != NULL) {
      *step = longer;
      *child = found;
      rest = end;
    }
  }
  return rest;
}

struct tree *tree_at(const struct tree *tree, const char *path)
{
  struct tree *at = (struct tree *)tree;
  for (const char *rest = path; at != NULL && *rest != '\0';) {
    struct step step;
    rest = path_enter(at, rest, rest == path, &step, &at);
    if (rest == NULL)
      return NULL;
  }
  return at;
}

static size_t index_in_parent(const struct tree *tree)
{
  size_t index = 0;
  while (tree->parent->child[index] != tree)
    index++;
  return index;
}

/* Writes the steps from the root down to `tree`; returns the length so far. */
static size_t write_path(const struct tree *tree, char *buffer, size_t size)
{
  if (tree->parent == NULL)
    return 0;
  size_t length = write_path(tree->parent, buffer, size);
  if (length >= size)
    return length;
  const char *dot = length > 0 ? "." : "";
  int more = tree->key != NULL
                 ? snprintf(buffer + length, size - length, "%s%s", dot, tree->key)
                 : snprintf(buffer + length, size - length, "%s%zu", dot, index_in_parent(tree));
  return length + (size_t)(more > 0 ? more : 0);
}

char *tree_path(const struct tree *tree, char *buffer, size_t size)
{
  if (size > 0)
    buffer[0] = '\0';
  write_path(tree, buffer, size);
  return buffer;
}
