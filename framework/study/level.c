#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "study/study_private.h"

static const struct value *levels_of(const struct study *study)
{
  const struct values *values = study->scene->estimator.values;
  for (size_t i = 0; i < values->count; i++)
    if (values->value[i].levels)
      return &values->value[i];
  return NULL;
}

static bool side_by_side(const struct study *study)
{
  const struct value *combine = values_find(study->scene->estimator.values, "combine");
  return combine && combine->text && strcmp(combine->text, "zip") == 0;
}

static gamut_status count_levels(struct study *study, const struct tree *list, bool zip)
{
  enum { LEVELS_MAX = 100000 };
  study->levels = zip ? list->child[0]->children : 1;
  for (size_t k = 0; k < list->children; k++) {
    const struct tree *one = list->child[k];
    char path[512];
    if (zip && one->children != study->levels)
      return trace_fail_at(study->trace, GAMUT_SCENE, &one->place,
                           tree_path(one, path, sizeof path),
                           "lists of one length, or combine: grid",
                           "side by side, '%.200s' has %zu values where '%.200s' has %zu", one->key,
                           one->children, list->child[0]->key, study->levels);
    if (!zip)
      study->levels *= one->children;
    if (study->levels > LEVELS_MAX)
      return trace_fail_at(study->trace, GAMUT_SCENE, &list->place,
                           tree_path(list, path, sizeof path), NULL,
                           "that makes more than %d combinations", LEVELS_MAX);
  }
  return GAMUT_OK;
}

/* The last path of a grid varies fastest. */
static void combine(struct study *study, const struct tree *list, bool zip, size_t number)
{
  size_t rest = number;
  for (size_t k = list->children; k-- > 0;) {
    const struct tree *one = list->child[k];
    size_t index = zip ? number : rest % one->children;
    rest /= one->children;
    study->level[number].override[k] =
        (struct scene_override){.path = one->key, .node = one->child[index]};
  }
}

gamut_status level_scene(const struct study *study, size_t level, struct trace *trace,
                         struct scene **scene)
{
  return scene_vary(study->scene, study->varies ? study->level[level].override : NULL,
                    study->varies, study->registry, study->units, trace, scene);
}

/* Whether a path leads anywhere in a scene: what is set through a list or a value cannot be. */
static gamut_status check_path(struct study *study, const struct tree *list)
{
  char path[512];
  struct tree *copy = tree_copy(study->scene->tree);
  struct tree *value = tree_copy(list->child[0]);
  gamut_status put = copy && value ? tree_put(copy, list->key, value, NULL) : GAMUT_INTERNAL;
  tree_free(copy);
  if (put == GAMUT_OK)
    return GAMUT_OK;
  return trace_fail_at(study->trace, GAMUT_SCENE, &list->key_place,
                       tree_path(list, path, sizeof path), "a scene path such as solver.cell",
                       "'%.200s' leads to nothing that can be set", list->key);
}

static const char *unit_of(const struct quantity *quantity)
{
  return quantity->measure && quantity->measure->unit ? quantity->measure->unit : "";
}

static bool same_quantities(const struct scene *one, const struct scene *other)
{
  bool same = one->quantities == other->quantities;
  for (size_t i = 0; same && i < one->quantities; i++)
    same = strcmp(one->quantity[i].name, other->quantity[i].name) == 0 &&
           one->quantity[i].reduction.kind == other->quantity[i].reduction.kind &&
           strcmp(unit_of(&one->quantity[i]), unit_of(&other->quantity[i])) == 0;
  return same;
}

static bool knows_parameters(const struct scene *base, const struct scene *scene)
{
  for (size_t i = 0; i < scene->random_parameters; i++) {
    bool found = false;
    for (size_t k = 0; k < base->random_parameters; k++)
      found = found || strcmp(base->random_parameter[k].path, scene->random_parameter[i].path) == 0;
    if (!found)
      return false;
  }
  return true;
}

static gamut_status check_level(struct study *study, size_t number)
{
  const struct level *level = &study->level[number];
  struct scene *scene = NULL;
  gamut_status status = level_scene(study, number, study->trace, &scene);
  const struct tree *node = level->override[0].node;
  if (status == GAMUT_OK && !same_quantities(study->scene, scene))
    status = trace_fail_at(study->trace, GAMUT_SCENE, &node->place, level->override[0].path, NULL,
                           "every level of a study measures the same quantities, in one unit");
  if (status == GAMUT_OK && !knows_parameters(study->scene, scene))
    status = trace_fail_at(study->trace, GAMUT_SCENE, &node->place, level->override[0].path,
                           "state the spread in the scene itself",
                           "a level may make no parameter random");
  scene_free(scene);
  return status;
}

gamut_status levels_make(struct study *study)
{
  gamut_status status = GAMUT_OK;
  const struct value *value = levels_of(study);
  if (!value)
    return GAMUT_OK;
  const struct tree *list = value->levels;
  bool zip = side_by_side(study);
  TRY(count_levels(study, list, zip));
  for (size_t k = 0; k < list->children; k++)
    TRY(check_path(study, list->child[k]));
  study->varied = calloc(list->children, sizeof *study->varied);
  study->level = calloc(study->levels, sizeof *study->level);
  if (!study->varied || !study->level)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  study->varies = list->children;
  for (size_t k = 0; k < list->children; k++)
    study->varied[k] = list->child[k]->key;
  for (size_t i = 0; i < study->levels; i++) {
    study->level[i].override = calloc(study->varies, sizeof *study->level[i].override);
    if (!study->level[i].override)
      return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
    combine(study, list, zip, i);
    gamut_status checked = check_level(study, i);
    status = status ? status : checked;
  }
done:
  return status;
}

void levels_free(struct study *study)
{
  for (size_t i = 0; study->level && i < study->levels; i++)
    free(study->level[i].override);
  free(study->level);
  free(study->varied);
}

static void write_flow(const struct tree *node, FILE *file)
{
  if (node->kind == TREE_SCALAR) {
    fputs(node->text, file);
    return;
  }
  bool list = node->kind == TREE_SEQUENCE;
  fputc(list ? '[' : '{', file);
  for (size_t i = 0; i < node->children; i++) {
    fprintf(file, "%s%s%s", i ? ", " : "", list ? "" : node->child[i]->key, list ? "" : ": ");
    write_flow(node->child[i], file);
  }
  fputc(list ? ']' : '}', file);
}

char *level_label(const struct study *study, size_t level)
{
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return NULL;
  for (size_t k = 0; k < study->varies; k++) {
    const char *path = study->varied[k], *last = path;
    size_t same = 0;
    for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.'))
      last = dot + 1;
    for (size_t other = 0; other < study->varies; other++) {
      const size_t length = strlen(study->varied[other]), tail = strlen(last);
      same += length >= tail && strcmp(study->varied[other] + length - tail, last) == 0;
    }
    fprintf(file, "%s%s: ", k ? ", " : "", same > 1 ? path : last);
    write_flow(study->level[level].override[k].node, file);
  }
  if (study->varies == 0)
    fputs("the scene", file);
  return memory_close(file, &text);
}

char *level_text(const struct study *study, size_t level, size_t varied)
{
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return NULL;
  write_flow(study->level[level].override[varied].node, file);
  return memory_close(file, &text);
}
