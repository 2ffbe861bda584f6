#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

/* The node that names the plugin: the value of `model`, or the scalar itself. */
static const struct tree *model_node(const struct tree *node)
{
  return node && node->kind == TREE_MAPPING ? tree_get(node, "model") : node;
}

const char *standard_model(enum gamut_kind kind)
{
  return kind == GAMUT_KIND_ELASTICITY ? "hypoelastic" : NULL;
}

const struct descriptor *instance_peek(const struct scene_reader *reader, enum gamut_kind kind,
                                       const struct tree *node)
{
  char id[160];
  const struct tree *model = model_node(node);
  const char *name = model ? model->text : standard_model(kind);
  if ((model && model->kind != TREE_SCALAR) || !name)
    return NULL;
  snprintf(id, sizeof id, "%s/%.120s", kind_name(kind), name);
  return registry_find(reader->registry, id);
}

static void error_at_model(struct scene_reader *reader, enum gamut_kind kind,
                           const struct tree *node, const char *what)
{
  char expected[WORDS_SIZE] = "", list[WORDS_SIZE - 64];
  size_t count = 0, all = registry_count(reader->registry);
  const char **name = scene_take(all, sizeof *name);
  for (size_t i = 0; i < all; i++) {
    const struct descriptor *descriptor = registry_at(reader->registry, i);
    if (descriptor->kind == kind)
      name[count++] = descriptor->name;
  }
  if (is_typo_of(reader, node, "model")) {
    free(name);
    return;
  }
  snprintf(expected, sizeof expected, "installed: %s", list_text(name, count, list, sizeof list));
  char path[PATH_SIZE - 16], model[PATH_SIZE];
  tree_path(node, path, sizeof path);
  snprintf(model, sizeof model, "%s.model", path);
  error_at_missing(reader, node, model, expected, "'model' is missing in '%s'", what);
  free(name);
}

/* Kernels get a parameter as an array; everybody else as one number. */
static bool seen_by_kernels(const struct descriptor *descriptor)
{
  return descriptor->kind == GAMUT_KIND_EOS || descriptor->kind == GAMUT_KIND_STRENGTH ||
         descriptor->kind == GAMUT_KIND_ELASTICITY ||
         (descriptor->kind == GAMUT_KIND_EFFECT && descriptor->tasks > 0);
}

bool plugin_read(struct scene_reader *reader, enum gamut_kind kind, const struct tree *node,
                 struct value *value)
{
  struct instance instance;
  size_t faults = reader->faults;
  if (!reader->registry) {
    error_at_value(reader, node, "give it in a scene", "no plugin can be named here");
    return false;
  }
  instance_read(reader, kind, kind_name(kind), node, NULL, 0, &instance);
  value->model = instance.descriptor;
  value->group = instance.values;
  return reader->faults == faults;
}

void instance_read(struct scene_reader *reader, enum gamut_kind kind, const char *name,
                   const struct tree *node, const char *const *also, size_t others,
                   struct instance *instance)
{
  char path[PATH_SIZE], what[160];
  const struct tree *model = model_node(node), *here = reader->here;
  const char *text = model ? model->text : standard_model(kind);
  *instance = (struct instance){.name = name, .node = node};
  if (node->kind == TREE_SEQUENCE) {
    expect_mapping(reader, node, name);
    return;
  }
  if (!text || text[0] == 0 || (model && model->kind != TREE_SCALAR)) {
    error_at_model(reader, kind, node, name);
    return;
  }
  tree_path(model ? model : node, path, sizeof path);
  const struct descriptor *descriptor = registry_expect(
      reader->registry, kind, text, model ? &model->place : &node->place, path, reader->trace);
  if (!descriptor) {
    reader->faults++;
    reader->first = reader->first ? reader->first : GAMUT_SCENE;
    return;
  }
  instance->descriptor = descriptor;
  const char **known = scene_take(others + 1, sizeof *known);
  known[0] = "model";
  for (size_t i = 0; i < others; i++)
    known[i + 1] = also[i];
  snprintf(what, sizeof what, "%s '%s'", kind_name(kind), descriptor->name);
  tree_path(node, path, sizeof path);
  reader->here = node;
  struct section section = {.descriptor = descriptor,
                            .parameter = descriptor->parameter,
                            .count = descriptor->parameters,
                            .node = node->kind == TREE_MAPPING ? node : NULL,
                            .path = path,
                            .what = what,
                            .also = known,
                            .others = others + 1,
                            .pointwise = seen_by_kernels(descriptor),
                            .one_of = &descriptor->one_of};
  instance->values = section_read(reader, &section);
  reader->here = here;
  free(known);
}

/* The geometry counts the components of the solver's own vectors, so it is looked up before. */
static void geometry_peek(struct scene_reader *reader, const struct tree *node)
{
  const struct descriptor *descriptor = instance_peek(reader, GAMUT_KIND_SOLVER, node);
  const struct parameter *parameter =
      descriptor ? parameter_named(descriptor->parameter, descriptor->parameters, "geometry")
                 : NULL;
  if (!parameter || parameter->type != VALUE_CHOICE)
    return;
  const struct tree *given = tree_get(node, "geometry");
  if (!given)
    given = parameter->standard;
  if (!given || !has_name(parameter->choice, parameter->choices, given->text))
    return;
  const struct geometry *geometry = geometry_named(given->text);
  if (!geometry) /* a descriptor that offers it was refused */
    return;
  reader->axes = geometry->axes;
  reader->axisymmetric = geometry->axisymmetric;
}

bool is_card(const struct tree *root)
{
  static const char *const more[] = {"solver",     "bodies",  "effects",
                                     "quantities", "outputs", "uncertainty"};
  bool card = tree_get(root, "materials") != NULL;
  for (size_t i = 0; i < ARRAY_SIZE(more); i++)
    card = card && !tree_get(root, more[i]);
  return card;
}

/* A machine that takes a million steps a second needs ten days for them. */
static const double steps_most = 1e12;

void solver_read(struct scene_reader *reader, const struct tree *root)
{
  const struct tree *node = tree_get(root, "solver");
  struct scene *scene = reader->scene;
  if (!node) {
    reader->geometry_unknown = true;
    if (!is_card(root) && !is_typo_of(reader, root, "solver"))
      error_at_missing(reader, root, "solver", "solver: {model: NAME, ...}", "'solver' is missing");
    return;
  }
  geometry_peek(reader, node);
  instance_read(reader, GAMUT_KIND_SOLVER, "solver", node, NULL, 0, &scene->solver);
  const struct descriptor *solver = scene->solver.descriptor;
  reader->geometry_unknown =
      !solver || (reader->axes == 0 && descriptor_parameter(solver, "geometry") >= 0);
  const struct value *end = values_find(scene->solver.values, "end");
  if (end && end->present && end->parameter->type == VALUE_REAL && !(end->real > 0))
    error_at_value(reader, end->node, "greater than 0", "the run ends before it begins");
  const struct value *step = values_find(scene->solver.values, "step");
  if (step && step->given && step->present && step->parameter->type == VALUE_REAL &&
      axis_length(reader) > 0)
    count_within(reader, step->node, "steps", end->real, step->real, steps_most);
}

const char *axis_unit(const struct scene_reader *reader)
{
  const struct descriptor *solver = reader->scene->solver.descriptor;
  return solver && solver->axis_unit ? solver->axis_unit : "s";
}
