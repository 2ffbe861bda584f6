/* Levels of a study: what each sets in the scene. */
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

/* Keys of a scene that a level may change. */
static bool may_vary(const char *path)
{
  static const char *const fixed[] = {"gamut", "title", "include", "uncertainty"};
  for (size_t i = 0; i < ARRAY_SIZE(fixed); i++) {
    size_t length = strlen(fixed[i]);
    if (strncmp(path, fixed[i], length) == 0 && (path[length] == 0 || path[length] == '.'))
      return false;
  }
  return true;
}

bool levels_read(struct scene_reader *reader, const struct parameter *parameter,
                 const struct tree *node, struct value *value)
{
  bool fine = true;
  value->levels = node;
  if (node->kind != TREE_MAPPING || node->children == 0) {
    error_at_value(reader, node, "such as {solver.cell: [0.8 mm, 0.4 mm]}",
                   "'%s' is no mapping of scene paths to lists of values", parameter->name);
    return false;
  }
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *list = node->child[i];
    if (!may_vary(list->key)) {
      error_at_key(reader, list, "a path such as solver.cell", "'%.200s' cannot be varied",
                   list->key);
      fine = false;
    } else if (list->kind != TREE_SEQUENCE || list->children == 0) {
      error_at_value(reader, list, "[0.8 mm, 0.4 mm]; a vector is a list within the list",
                     "'%.200s' is no list of values", list->key);
      fine = false;
    }
  }
  return fine;
}

/* The mapping of paths to lists of a study whose runs stand for themselves; null for none. */
static const struct tree *listed(const struct scene_reader *reader, const struct tree *root,
                                 const struct parameter **parameter)
{
  const struct tree *estimator = tree_get(tree_get(root, "uncertainty"), "estimator");
  const struct descriptor *descriptor =
      estimator ? instance_peek(reader, GAMUT_KIND_ESTIMATOR, estimator) : NULL;
  if (!descriptor || !descriptor->yields_table)
    return NULL;
  for (size_t i = 0; i < descriptor->parameters; i++) {
    *parameter = &descriptor->parameter[i];
    if ((*parameter)->type == VALUE_LEVELS)
      return tree_get(estimator, (*parameter)->name);
  }
  return NULL;
}

bool levels_of_members(const struct scene_reader *reader, const struct tree *root)
{
  const struct parameter *parameter;
  return listed(reader, root, &parameter) != NULL;
}

void first_level_put(const struct scene_reader *reader, struct tree *root)
{
  const struct parameter *parameter;
  struct value value = {0};
  struct scene_reader unheard = {
      .units = reader->units, .registry = reader->registry, .trace = trace_new()};
  struct tree *list = tree_copy(listed(reader, root, &parameter)); /* the root changes below it */
  if (list && levels_read(&unheard, parameter, list, &value)) {
    struct scene_override *first = scene_take(list->children, sizeof *first);
    for (size_t i = 0; i < list->children; i++)
      first[i] =
          (struct scene_override){.path = list->child[i]->key, .node = list->child[i]->child[0]};
    overrides_put(&unheard, root, first, list->children);
    free(first);
  }
  tree_free(list);
  trace_free(unheard.trace);
}
