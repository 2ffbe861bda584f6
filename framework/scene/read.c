#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const char *const top_keys[] = {"gamut",  "title",   "include",    "solver",  "materials",
                                       "bodies", "effects", "quantities", "outputs", "uncertainty"};

/* Where a key at the top that is none may belong. */
static void top_check(struct scene_reader *reader, const struct tree *root)
{
  static const char *const material[] = {"density", "eos", "strength", "elasticity"};
  static const char *const body[] = {"material", "shape", "velocity", "temperature"};
  const struct descriptor *solver =
      instance_peek(reader, GAMUT_KIND_SOLVER, tree_get(root, "solver"));
  if (solver)
    neighbour_add(reader, "under 'solver:'", solver->parameter, solver->parameters, NULL, 0);
  neighbour_add(reader, "under a material", NULL, 0, material, ARRAY_SIZE(material));
  neighbour_add(reader, "under a body", NULL, 0, body, ARRAY_SIZE(body));
  expect_keys(reader, root, top_keys, ARRAY_SIZE(top_keys), "the scene");
  reader->neighbours = 0;
}

/* Names of the bodies, so that whatever is read before them can refer to them. */
static void body_names(struct scene_reader *reader, const struct tree *root)
{
  const struct tree *bodies = tree_get(root, "bodies");
  if (!bodies || bodies->kind != TREE_MAPPING)
    return;
  const char **name = scene_keep(reader, bodies->children, sizeof *name);
  for (size_t i = 0; i < bodies->children; i++)
    name[i] = bodies->child[i]->key;
  reader->body = name;
  reader->bodies = bodies->children;
  reader->bodies_node = bodies;
}

static void sections_read(struct scene_reader *reader, struct scene *scene)
{
  const struct tree *root = scene->tree, *title = tree_get(root, "title");
  top_check(reader, root);
  scene->title = title ? text_read(reader, title, "title") : NULL;
  body_names(reader, root);
  solver_read(reader, root);
  materials_read(reader, root);
  bodies_read(reader, root);
  effects_read(reader, root);
  effect_states_name(reader);
  material_needs(reader);
  quantities_read(reader, root);
  outputs_read(reader, root);
  uncertainty_read(reader, root);
  bodies_check(reader);
  scene->random = reader->random;
}

static gamut_status make(const char *, const struct scene *, const struct scene_override *, size_t,
                         struct scene_reader, struct scene **);

/* The scene below the levels of a sweep is no member: where it cannot be read, the first level
 * stands for it. */
static void stand_in(const struct scene_reader *reader, const char *file, struct scene *scene)
{
  struct scene *alone = NULL;
  const struct scene_reader unheard = {
      .units = reader->units, .registry = reader->registry, .trace = trace_new()};
  if (make(file, scene, NULL, 0, unheard, &alone) != GAMUT_OK)
    first_level_put(reader, scene->tree);
  scene_free(alone);
  trace_free(unheard.trace);
}

/* The file, or the tree of `base` where it is given, with the overrides. */
static gamut_status make(const char *file, const struct scene *base,
                         const struct scene_override *override, size_t overrides,
                         struct scene_reader reader, struct scene **scene)
{
  struct scene_store *store = scene_take(1, sizeof *store);
  reader.scene = &store->shown;
  *scene = NULL;
  char *name = scene_keep(&reader, strlen(file) + 1, 1);
  store->shown.file = strcpy(name, file);
  if (!base) {
    store->shown.tree = include_read(&reader, file, override, overrides);
  } else if ((store->shown.tree = tree_copy(base->tree))) {
    overrides_put(&reader, store->shown.tree, override, overrides);
  } else {
    reader.faults++;
    reader.first = trace_fail(reader.trace, GAMUT_INTERNAL, "out of memory");
  }
  if (!base && reader.faults == 0 && levels_of_members(&reader, store->shown.tree))
    stand_in(&reader, name, &store->shown);
  if (store->shown.tree && reader.faults == 0) /* without an include much would seem missing */
    sections_read(&reader, &store->shown);
  if (reader.faults == 0)
    *scene = &store->shown;
  else
    scene_free(&store->shown);
  return reader.first;
}

gamut_status scene_read(const char *file, const struct scene_override *override, size_t overrides,
                        struct registry *registry, const struct units *units, struct trace *trace,
                        struct scene **scene)
{
  const struct scene_reader reader = {.units = units, .trace = trace, .registry = registry};
  return make(file, NULL, override, overrides, reader, scene);
}

gamut_status scene_vary(const struct scene *base, const struct scene_override *override,
                        size_t overrides, struct registry *registry, const struct units *units,
                        struct trace *trace, struct scene **scene)
{
  const struct scene_reader reader = {.units = units, .trace = trace, .registry = registry};
  return make(base->file, base, override, overrides, reader, scene);
}

static void clear_material(struct material *material)
{
  free(material->density_random);
  values_free(material->eos.values);
  values_free(material->strength.values);
  values_free(material->elasticity.values);
  values_free(material->extra);
}

static void clear_body(struct gamut_body *body)
{
  for (int k = 0; k < 3; k++)
    expression_free(body->velocity_expression[k]);
  values_free(body->solver_values);
}

void scene_free(struct scene *scene)
{
  if (!scene)
    return;
  values_free(scene->solver.values);
  values_free(scene->estimator.values);
  for (size_t i = 0; i < scene->materials; i++)
    clear_material(&scene->material[i]);
  for (size_t i = 0; i < scene->bodies; i++)
    clear_body(&scene->body[i]);
  for (size_t i = 0; i < scene->effects; i++) {
    values_free(scene->effect[i].instance.values);
    free(scene->effect[i].on_body);
  }
  for (size_t i = 0; i < scene->quantities; i++)
    values_free(scene->quantity[i].arguments);
  free(scene->input_file);
  free(scene->material);
  free(scene->body);
  free(scene->effect);
  free(scene->quantity);
  tree_free(scene->tree);
  struct scene_store *store = (struct scene_store *)(void *)scene;
  while (store->piece) {
    struct scene_piece *piece = store->piece;
    store->piece = piece->next;
    free(piece);
  }
  free(store);
}
