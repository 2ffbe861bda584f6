#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tree/tree_private.h"

/* Gives `base` the content of `over` and keeps its seat in the parent and its key; frees the old.
 */
static void replace(struct tree *base, struct tree *over)
{
  struct node *to = (struct node *)base, *from = (struct node *)over;
  struct node old = *to;
  *to = *from;
  to->tree.parent = old.tree.parent;
  to->tree.key = to->key = old.key;
  from->tree = old.tree;
  from->text = old.text;
  from->origin = old.origin;
  from->index = old.index;
  for (size_t k = 0; k < base->children; k++)
    base->child[k]->parent = base;
  tree_free(over);
}

void tree_drop(struct tree *child)
{
  struct tree *parent = child->parent;
  size_t index = 0;
  while (parent->child[index] != child)
    index++;
  parent->children--;
  memmove(parent->child + index, parent->child + index + 1,
          (parent->children - index) * sizeof *parent->child);
  index_renew(parent);
  child->parent = NULL;
  tree_free(child);
}

void tree_clear(struct tree *tree)
{
  while (tree->children > 0)
    tree_free(tree->child[--tree->children]);
  index_renew(tree);
}

void tree_merge(struct tree *base, struct tree *over)
{
  assert(over->parent == NULL);
  if (base->kind != TREE_MAPPING || over->kind != TREE_MAPPING) {
    replace(base, over);
    return;
  }
  for (size_t k = 0; k < over->children; k++) {
    struct tree *child = over->child[k];
    struct tree *present = tree_get(base, child->key);
    child->parent = NULL;
    if (present != NULL)
      tree_merge(present, child);
    else if (!node_attach(base, child))
      memory_ended(); /* a scene with a part lost in silence would be worse */
  }
  over->children = 0;
  tree_free(over);
}

static gamut_status refuse(struct trace *trace, const struct tree *value, const char *path,
                           const char *expected, const char *text)
{
  return trace_fail_at(trace, GAMUT_USAGE, &value->place, path, expected, "%s", text);
}

/* Counts the steps of a path; 0 if it is malformed. */
static int count_steps(const char *path)
{
  struct step step;
  int count = 0;
  for (const char *rest = path; *rest != '\0'; count++) {
    rest = path_step(rest, rest == path, &step);
    if (rest == NULL || count > TREE_DEPTH_MAX)
      return 0;
  }
  return count;
}

/* Why nothing can be made at `step` below `at`; null if it can. */
static const char *obstacle(const struct tree *at, const struct step *step, const char *rest)
{
  if (at->kind == TREE_SEQUENCE)
    return "this list has no such item";
  if (at->kind == TREE_SCALAR)
    return "the path goes through a value that is no mapping";
  if (step->bracket || strchr(rest, '[') != NULL)
    return "there is no list here";
  return NULL;
}

static bool name_node(struct tree *tree, const struct step *step)
{
  struct node *node = (struct node *)tree;
  char *key = strndup(step->word, step->length);
  if (key == NULL)
    return false;
  free(node->key);
  tree->key = node->key = key;
  return true;
}

/* Makes the mappings that `rest` goes through below `at`, and seats the value at their end. */
static bool build(struct tree *at, struct step step, const char *rest, struct tree *value)
{
  struct origin *origin = ((struct node *)value)->origin;
  while (*rest != '\0') {
    struct tree *made = node_new(NULL, TREE_MAPPING, "", NULL, origin);
    if (made == NULL)
      return false;
    made->place = made->key_place = value->place;
    if (!name_node(made, &step) || !node_attach(at, made)) {
      tree_free(made);
      return false;
    }
    at = made;
    rest = path_step(rest, false, &step);
  }
  return name_node(value, &step) && node_attach(at, value);
}

gamut_status tree_put(struct tree *base, const char *path, struct tree *value, struct trace *trace)
{
  assert(value->parent == NULL);
  gamut_status status = GAMUT_OK;
  int steps = count_steps(path);
  if (steps == 0)
    TRY(refuse(trace, value, path, "a path is written a.b.c or a.b[0].c", "this is no scene path"));
  if (steps + node_depth(value) > TREE_DEPTH_MAX)
    TRY(refuse(trace, value, path, NULL, "the path and its value are nested too deep"));
  struct tree *at = base;
  struct step step;
  for (const char *rest = path; *rest != '\0';) {
    struct tree *child;
    rest = path_enter(at, rest, rest == path, &step, &child);
    if (child != NULL) {
      at = child;
      continue;
    }
    const char *why = obstacle(at, &step, rest);
    if (why != NULL)
      TRY(refuse(trace, value, path, NULL, why));
    if (!build(at, step, rest, value))
      TRY(trace_fail(trace, GAMUT_INTERNAL, "no memory left to set '%s'", path));
    return GAMUT_OK;
  }
  replace(at, value);
  return GAMUT_OK;
done:
  tree_free(value);
  return status;
}
