/* Levels of a study: what each sets in the scene. */
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

/* Keys of a scene that a level may change. */
static bool may_vary(const char *path)
{
  static const char *const fixed[] = {"gamut", "title", "include", "uncertainty"};
  for (size_t i = 0; i < COUNT_OF(fixed); i++) {
    size_t length = strlen(fixed[i]);
    if (strncmp(path, fixed[i], length) == 0 && (path[length] == 0 || path[length] == '.'))
      return false;
  }
  return true;
}

bool levels_read(struct reading *reading, const struct parameter *parameter,
                 const struct tree *node, struct value *value)
{
  bool fine = true;
  value->levels = node;
  if (node->kind != TREE_MAPPING || node->children == 0) {
    blame_value(reading, node, "such as {solver.cell: [0.8 mm, 0.4 mm]}",
                "'%s' is no mapping of scene paths to lists of values", parameter->name);
    return false;
  }
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *list = node->child[i];
    if (!may_vary(list->key)) {
      blame_key(reading, list, "a path such as solver.cell", "'%.200s' cannot be varied",
                list->key);
      fine = false;
    } else if (list->kind != TREE_SEQUENCE || list->children == 0) {
      blame_value(reading, list, "[0.8 mm, 0.4 mm]; a vector is a list within the list",
                  "'%.200s' is no list of values", list->key);
      fine = false;
    }
  }
  return fine;
}

/* The mapping of paths to lists of a study whose runs stand for themselves; null for none. */
static const struct tree *listed(const struct reading *reading, const struct tree *root,
                                 const struct parameter **parameter)
{
  const struct tree *estimator = tree_get(tree_get(root, "uncertainty"), "estimator");
  const struct descriptor *descriptor =
      estimator ? instance_peek(reading, GAMUT_KIND_ESTIMATOR, estimator) : NULL;
  if (!descriptor || !descriptor->yields_table)
    return NULL;
  for (size_t i = 0; i < descriptor->parameters; i++) {
    *parameter = &descriptor->parameter[i];
    if ((*parameter)->type == VALUE_LEVELS)
      return tree_get(estimator, (*parameter)->name);
  }
  return NULL;
}

bool levels_of_members(const struct reading *reading, const struct tree *root)
{
  const struct parameter *parameter;
  return listed(reading, root, &parameter) != NULL;
}

void first_level_put(const struct reading *reading, struct tree *root)
{
  const struct parameter *parameter;
  struct value value = {0};
  struct reading unheard = {
      .units = reading->units, .registry = reading->registry, .trace = trace_new()};
  struct tree *list = tree_copy(listed(reading, root, &parameter)); /* the root changes below it */
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
