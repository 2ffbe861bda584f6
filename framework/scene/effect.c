#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

enum { NAMES_MAX = 10000 };

static const char *const own_keys[] = {"enabled", "bodies", "materials"};

static void enabled_read(struct scene_reader *reader, const struct tree *node,
                         struct effect *effect)
{
  static const char *const word[] = {"auto", "on", "true", "yes", "off", "false", "no"};
  const struct tree *given = tree_get(node, "enabled");
  effect->enabled = EFFECT_AUTO;
  if (!given)
    return;
  const char *text = text_read(reader, given, "enabled");
  if (!text)
    return;
  for (size_t i = 0; i < ARRAY_SIZE(word); i++)
    if (strcmp(word[i], text) == 0) {
      effect->enabled = i == 0 ? EFFECT_AUTO : i < 4 ? EFFECT_ON : EFFECT_OFF;
      return;
    }
  error_at_value(reader, given, "auto, on or off", "'enabled' cannot be '%.40s'", text);
}

/* Marks which of the names of `all` (a mapping of the scene) the list names. */
static bool *select_read(struct scene_reader *reader, const struct tree *node,
                         const struct tree *all, const char *what)
{
  char expected[WORDS_SIZE];
  const size_t count = all ? all->children : 0;
  struct names names = names_read(reader, node, node->key, NAMES_MAX);
  bool *selected = scene_take(count, sizeof *selected);
  if (node->kind == TREE_SEQUENCE && node->children == 0)
    error_at_value(reader, node, "leave it out to mean all of them", "'%s' is an empty list",
                   node->key);
  for (size_t i = 0; i < names.count && count; i++) {
    const size_t number = tree_number(all, names.name[i]);
    if (number < count)
      selected[number] = true;
    else
      error_at_value(reader, names.node[i],
                     suggest_key(reader, names.name[i], all, expected, sizeof expected),
                     "unknown %s '%.60s'", what, names.name[i]);
  }
  return selected;
}

static void targets_read(struct scene_reader *reader, const struct tree *root,
                         const struct tree *node, struct effect *effect)
{
  const struct scene *scene = reader->scene;
  const struct tree *bodies = tree_get(node, "bodies"), *materials = tree_get(node, "materials");
  bool *body = NULL, *material = NULL;
  if (bodies)
    body = select_read(reader, bodies, tree_get(root, "bodies"), "body");
  if (materials)
    material = select_read(reader, materials, tree_get(root, "materials"), "material");
  for (size_t b = 0; b < scene->bodies; b++)
    effect->on_body[b] =
        (!body || body[b]) && (!material || (scene->materials > scene->body[b].material &&
                                             material[scene->body[b].material]));
  free(body);
  free(material);
}

static bool provided(const struct scene *scene, const char *name)
{
  const struct descriptor *solver = scene->solver.descriptor;
  bool found = solver && descriptor_provides(solver, name);
  for (size_t i = 0; i < scene->effects && !found; i++) {
    const struct descriptor *effect = scene->effect[i].instance.descriptor;
    found = effect && scene->effect[i].enabled != EFFECT_OFF &&
            descriptor_provides(effect, name);
  }
  return found;
}

static void requirements_check(struct scene_reader *reader, const struct effect *effect)
{
  const struct descriptor *descriptor = effect->instance.descriptor;
  const struct descriptor *solver = reader->scene->solver.descriptor;
  if (!descriptor || !solver || effect->enabled == EFFECT_OFF)
    return;
  for (size_t i = 0; i < descriptor->requirements; i++)
    if (!provided(reader->scene, descriptor->require[i]))
      error_at_key(reader, effect->instance.node, "another solver, or 'enabled: off'",
                   "effect '%s' needs '%s', which neither solver '%s' nor another effect provides",
                   effect->instance.name, descriptor->require[i], solver->name);
}

void effects_read(struct scene_reader *reader, const struct tree *root)
{
  struct scene *scene = reader->scene;
  const struct tree *node = tree_get(root, "effects");
  if (!node || !expect_members(reader, node, "'effects'", NULL, false, EFFECTS_MAX))
    return;
  scene->effect = scene_take(node->children, sizeof *scene->effect);
  scene->effects = node->children;
  scene->effects_node = node;
  for (size_t i = 0; i < node->children; i++) {
    struct effect *effect = &scene->effect[i];
    const struct tree *child = node->child[i];
    effect->on_body = scene_take(scene->bodies, sizeof *effect->on_body);
    expect_name(reader, child, "an effect");
    instance_read(reader, GAMUT_KIND_EFFECT, child->key, child, own_keys, ARRAY_SIZE(own_keys),
                  &effect->instance);
    enabled_read(reader, child, effect);
    targets_read(reader, root, child, effect);
  }
  for (size_t i = 0; i < scene->effects; i++)
    requirements_check(reader, &scene->effect[i]);
}
