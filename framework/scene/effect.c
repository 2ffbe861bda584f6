#include <stdlib.h>
#include <string.h>

#include "scene/reading.h"

static const char *const own_keys[] = {"enabled", "bodies", "materials"};

static void enabled_read(struct reading *reading, const struct tree *node, struct effect *effect)
{
  static const char *const word[] = {"auto", "on", "true", "yes", "off", "false", "no"};
  const struct tree *given = tree_get(node, "enabled");
  effect->enabled = EFFECT_AUTO;
  if (!given)
    return;
  const char *text = text_read(reading, given, "enabled");
  if (!text)
    return;
  for (size_t i = 0; i < COUNT_OF(word); i++)
    if (strcmp(word[i], text) == 0) {
      effect->enabled = i == 0 ? EFFECT_AUTO : i < 4 ? EFFECT_ON : EFFECT_OFF;
      return;
    }
  blame_value(reading, given, "auto, on or off", "'enabled' cannot be '%.40s'", text);
}

/* Names of a list that must be bodies (or materials) of the scene. */
static const char **select_read(struct reading *reading, const struct tree *node,
                                const char *const *known, size_t count, const char *what,
                                size_t *selected)
{
  char expected[WORDS_SIZE];
  const char **name = names_read(reading, node, node->key, selected);
  for (size_t i = 0; i < *selected && count; i++)
    if (!has_name(known, count, name[i])) {
      const struct tree *item = node;
      for (size_t k = 0; k < node->children; k++)
        if (strcmp(node->child[k]->text, name[i]) == 0)
          item = node->child[k];
      blame_value(reading, item, suggest(name[i], known, count, expected, sizeof expected),
                  "unknown %s '%.60s'", what, name[i]);
    }
  return name;
}

static void targets_read(struct reading *reading, const struct tree *node, struct effect *effect)
{
  const struct scene *scene = reading->scene;
  const struct tree *bodies = tree_get(node, "bodies"), *materials = tree_get(node, "materials");
  const char **body = NULL, **material = NULL;
  size_t body_count = 0, material_count = 0;
  const char **known = scene_take(scene->materials, sizeof *known);
  for (size_t i = 0; i < scene->materials; i++)
    known[i] = scene->material[i].name;
  if (bodies)
    body = select_read(reading, bodies, reading->body, reading->bodies, "body", &body_count);
  if (materials)
    material =
        select_read(reading, materials, known, scene->materials, "material", &material_count);
  for (size_t b = 0; b < scene->bodies; b++) {
    const struct gamut_body *one = &scene->body[b];
    effect->on_body[b] =
        (!body || has_name(body, body_count, one->name)) &&
        (!material || (scene->materials > one->material &&
                       has_name(material, material_count, scene->material[one->material].name)));
  }
  free(known);
}

static bool provided(const struct scene *scene, const char *name)
{
  const struct descriptor *solver = scene->solver.descriptor;
  bool found = solver && has_name(solver->provide, solver->provisions, name);
  for (size_t i = 0; i < scene->effects && !found; i++) {
    const struct descriptor *effect = scene->effect[i].instance.descriptor;
    found = effect && scene->effect[i].enabled != EFFECT_OFF &&
            has_name(effect->provide, effect->provisions, name);
  }
  return found;
}

static void requirements_check(struct reading *reading, const struct effect *effect)
{
  const struct descriptor *descriptor = effect->instance.descriptor;
  const struct descriptor *solver = reading->scene->solver.descriptor;
  if (!descriptor || !solver || effect->enabled == EFFECT_OFF)
    return;
  for (size_t i = 0; i < descriptor->requirements; i++)
    if (!provided(reading->scene, descriptor->require[i]))
      blame_key(reading, effect->instance.node, "another solver, or 'enabled: off'",
                "effect '%s' needs '%s', which neither solver '%s' nor another effect provides",
                effect->instance.name, descriptor->require[i], solver->name);
}

void effects_read(struct reading *reading, const struct tree *root)
{
  struct scene *scene = reading->scene;
  const struct tree *node = tree_get(root, "effects");
  if (!node || !expect_mapping(reading, node, "'effects'"))
    return;
  scene->effect = scene_take(node->children, sizeof *scene->effect);
  scene->effects = node->children;
  for (size_t i = 0; i < node->children; i++) {
    struct effect *effect = &scene->effect[i];
    const struct tree *child = node->child[i];
    effect->on_body = scene_take(scene->bodies, sizeof *effect->on_body);
    expect_name(reading, child, "an effect");
    instance_read(reading, GAMUT_KIND_EFFECT, child->key, child, own_keys, COUNT_OF(own_keys),
                  &effect->instance);
    enabled_read(reading, child, effect);
    targets_read(reading, child, effect);
  }
  for (size_t i = 0; i < scene->effects; i++)
    requirements_check(reading, &scene->effect[i]);
}
