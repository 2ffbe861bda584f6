#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const char *const own_keys[] = {"material",    "shape",    "velocity",
                                       "temperature", "pressure", "energy"};
static const char *const space[] = {"x", "y", "z"};

static const struct parameter initial_parameters[] = {
    {.name = "temperature",
     .unit = "K",
     .type = VALUE_REAL,
     .optional = true,
     .physical = {true, 0, INFINITY, true, true}},
    {.name = "pressure", .unit = "Pa", .type = VALUE_REAL, .optional = true},
    {.name = "energy", .unit = "J/m3", .type = VALUE_REAL, .optional = true},
};

/* One component: a number with its unit, or arithmetic in x, y, z. Text in quotes without a unit is
 * arithmetic; so is what cannot be a quantity but can be computed. */
static void component_read(struct scene_reader *reader, const struct tree *node,
                           struct gamut_body *body, size_t k)
{
  char why[256] = "";
  enum unit_result result = UNIT_NOT_A_NUMBER;
  if (node->kind == TREE_SCALAR)
    result = unit_read(reader->units, node->text, "m/s", &body->velocity[k]);
  bool arithmetic = result == UNIT_NOT_A_NUMBER || result == UNIT_UNKNOWN ||
                    (result == UNIT_MISSING && node->quoted);
  if (result == UNIT_OK)
    return;
  if (node->kind == TREE_SCALAR && arithmetic) {
    body->velocity_expression[k] = expression_new(node->text, space, 3, why, sizeof why);
    if (body->velocity_expression[k])
      return;
  }
  if (node->quoted && arithmetic)
    error_at_value(reader, node, "arithmetic in x, y, z (metres) that gives m/s",
                   "cannot read the velocity '%.60s': %s", node->text, why);
  else
    amount_read(reader, node, "velocity", "m/s", &body->velocity[k]);
}

static void velocity_read(struct scene_reader *reader, const struct tree *node,
                          struct gamut_body *body)
{
  unsigned axes = reader->axes ? reader->axes : 3;
  static const char *const example[] = {"", "[100 m/s]", "[0 m/s, -100 m/s]",
                                        "[0 m/s, 0 m/s, -100 m/s]"};
  char expected[160];
  snprintf(expected, sizeof expected, "%u component%s in brackets, such as %s", axes,
           axes == 1 ? "" : "s", example[axes]);
  if (node->kind != TREE_SEQUENCE)
    error_at_value(reader, node, expected, "'velocity' is %s where a vector is due",
                   node->kind == TREE_MAPPING ? "a mapping"
                   : node->text[0]            ? "a number"
                                              : "empty");
  else if (node->children != axes)
    error_at_value(reader, node, expected, "'velocity' has %zu component%s", node->children,
                   node->children == 1 ? "" : "s");
  else
    for (size_t k = 0; k < axes; k++)
      component_read(reader, node->child[k], body, k);
}

static void material_find(struct scene_reader *reader, const struct tree *node, const char *what,
                          struct gamut_body *body)
{
  const struct scene *scene = reader->scene;
  char expected[WORDS_SIZE], path[PATH_SIZE];
  const struct tree *given = tree_get(node, "material");
  if (!given) {
    if (is_typo_of(reader, node, "material"))
      return;
    snprintf(path, sizeof path, "bodies.%s.material", body->name);
    error_at_missing(reader, node, path, "the name of one of the materials",
                     "'material' is missing in %s", what);
    return;
  }
  const char *name = text_read(reader, given, "material");
  const size_t number = name ? tree_number(scene->materials_node, name) : SIZE_MAX;
  if (number < scene->materials)
    body->material = number;
  else if (name && scene->materials)
    error_at_value(reader, given,
                   suggest_key(reader, name, scene->materials_node, expected, sizeof expected),
                   "unknown material '%.60s'", name);
}

static void initial_read(struct scene_reader *reader, const struct tree *node, const char *path,
                         const char *what, struct gamut_body *body)
{
  struct section section = {.parameter = initial_parameters,
                            .count = ARRAY_SIZE(initial_parameters),
                            .node = node,
                            .path = path,
                            .what = what,
                            .open = true}; /* they are checked with those of the solver */
  struct values *own = section_read(reader, &section);
  body->temperature = own->value[0].present ? own->value[0].real : 298;
  body->has_pressure = own->value[1].present;
  body->pressure = own->value[1].real;
  body->has_energy = own->value[2].present;
  body->energy = own->value[2].real;
  if (own->value[1].given && own->value[2].given)
    error_at_key(reader, own->value[2].node, "one of them; the eos gives the other",
                 "'pressure' and 'energy' are both given in %s", what);
  values_free(own);
}

static void body_read(struct scene_reader *reader, const struct tree *node, struct gamut_body *body)
{
  char path[PATH_SIZE], what[160];
  const struct descriptor *solver = reader->scene->solver.descriptor;
  expect_name(reader, node, "a body");
  snprintf(what, sizeof what, "body '%s'", node->key);
  if (!expect_mapping(reader, node, what))
    return;
  tree_path(node, path, sizeof path);

  if (solver) {
    struct section section = {.parameter = solver->body_parameter,
                              .count = solver->body_parameters,
                              .node = node,
                              .path = path,
                              .what = what,
                              .also = own_keys,
                              .others = ARRAY_SIZE(own_keys)};
    neighbour_add(reader, "under 'solver:'", solver->parameter, solver->parameters, NULL, 0);
    body->solver_values = section_read(reader, &section);
    reader->neighbours = 0;
  }
  material_find(reader, node, what, body);
  initial_read(reader, node, path, what, body);

  const struct tree *velocity = tree_get(node, "velocity"), *shape = tree_get(node, "shape");
  if (velocity && !reader->geometry_unknown)
    velocity_read(reader, velocity, body);
  if (shape && !reader->geometry_unknown) {
    shape_read(reader, shape, &body->shape);
  } else if (reader->axes && !is_typo_of(reader, node, "shape")) {
    char missing[PATH_SIZE + 8];
    snprintf(missing, sizeof missing, "%s.shape", path);
    error_at_missing(reader, node, missing, "shape: {box:}, {cylinder:} or {sphere:}",
                     "'shape' is missing in %s", what);
  }
}

void bodies_read(struct scene_reader *reader, const struct tree *root)
{
  struct scene *scene = reader->scene;
  const struct tree *node = tree_get(root, "bodies");
  if (!node) {
    if (!is_card(root) && !is_typo_of(reader, root, "bodies"))
      error_at_missing(reader, root, "bodies", "bodies: {NAME: {material:, shape:, ...}}",
                       "'bodies' is missing");
    return;
  }
  if (!expect_members(reader, node, "'bodies'", "NAME: {material:, shape:, ...}", true, BODIES_MAX))
    return;
  scene->body = scene_take(node->children, sizeof *scene->body);
  scene->bodies = node->children;
  for (size_t i = 0; i < node->children; i++) {
    scene->body[i] = (struct gamut_body){
        .name = node->child[i]->key, .index = i, .temperature = 298, .node = node->child[i]};
    body_read(reader, node->child[i], &scene->body[i]);
  }
}
