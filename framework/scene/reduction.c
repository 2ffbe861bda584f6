#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const char forms[] = "at end, at 12 us, max, min, mean, {max: [t0, t1]} (also min, mean, "
                            "slope, time_of_max), or {time_of: VALUE}";

struct form {
  const char *name;
  enum reduction_kind kind;
  bool time_of_max, alone; /* may stand without a window */
};
static const struct form form_list[] = {
    {"max", REDUCE_MAX, false, true},     {"min", REDUCE_MIN, false, true},
    {"mean", REDUCE_MEAN, false, true},   {"time_of_max", REDUCE_TIME_OF, true, true},
    {"slope", REDUCE_SLOPE, false, true}, {"time_of", REDUCE_TIME_OF, false, false},
};

static const struct form *form_named(const char *name)
{
  for (size_t i = 0; i < ARRAY_SIZE(form_list); i++)
    if (strcmp(form_list[i].name, name) == 0)
      return &form_list[i];
  return NULL;
}

static bool scalar_read(struct scene_reader *reader, const struct tree *node, const char *axis,
                        struct reduction *reduction)
{
  const char *text = node->text;
  const struct form *form = form_named(text);
  if (form && form->alone) {
    reduction->kind = form->kind;
    reduction->time_of_max = form->time_of_max;
    return true;
  }
  if (strcmp(text, "at end") == 0) {
    reduction->kind = REDUCE_AT;
    reduction->at_end = true;
    return true;
  }
  if (strncmp(text, "at ", 3) == 0 &&
      unit_read(reader->units, text + 3, axis, &reduction->from) == UNIT_OK) {
    reduction->kind = REDUCE_AT;
    reduction->to = reduction->from;
    return true;
  }
  error_at_value(reader, node, forms, "unknown reduction '%.60s'", text);
  return false;
}

bool reduction_read(struct scene_reader *reader, const struct tree *node,
                    const struct measure *measure, struct reduction *reduction)
{
  const char *unit = measure->unit;
  const char *axis = measure->against ? measure->against->unit : axis_unit(reader);
  *reduction = (struct reduction){.kind = REDUCE_NONE, .from = 0, .to = INFINITY};
  if (node->kind == TREE_SCALAR)
    return scalar_read(reader, node, axis, reduction);
  const struct tree *child = node->children == 1 ? node->child[0] : NULL;
  const struct form *form = child && child->key ? form_named(child->key) : NULL;
  if (!form && child && child->key) {
    const char *name[ARRAY_SIZE(form_list)];
    for (size_t i = 0; i < ARRAY_SIZE(form_list); i++)
      name[i] = form_list[i].name;
    error_at_unknown(reader, child, NULL, 0, name, ARRAY_SIZE(form_list), "'reduce'");
    return false;
  }
  if (!form) {
    error_at_value(reader, node, forms, "'reduce' is none of the known forms");
    return false;
  }
  reduction->kind = form->kind;
  reduction->time_of_max = form->time_of_max;
  if (form->kind == REDUCE_TIME_OF && !form->time_of_max)
    return amount_read(reader, child, form->name, unit, &reduction->level);
  size_t count;
  double *window = vector_read(reader, child, form->name, axis, 2, 2, &count);
  bool fine = window && window[0] < window[1];
  if (fine) {
    reduction->from = window[0];
    reduction->to = window[1];
  } else if (window) {
    error_at_value(reader, child, "[t0, t1] with t0 < t1", "the window of '%s' is empty",
                   form->name);
  }
  free(window);
  return fine;
}
