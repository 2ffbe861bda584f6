#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const char *const own_keys[] = {"density",    "eos",    "strength",
                                       "elasticity", "source", "scaled"};

static const struct parameter density_parameter[] = {{
    .name = "density",
    .unit = "kg/m3",
    .doc = "density at zero compression",
    .type = VALUE_REAL,
    .random = true,
    .physical = {true, 0, INFINITY, true, true},
    .usual = {true, 1e-3, 3e4, false, false},
}};

const struct parameter *material_density(void)
{
  return density_parameter;
}

/* All material parameters that installed plugins declare, each name once; none is required here. */
static const struct parameter *extra_parameters(struct scene_reader *reader, size_t *count)
{
  size_t all = 0;
  for (size_t i = 0; i < registry_count(reader->registry); i++)
    all += registry_at(reader->registry, i)->material_parameters;
  struct parameter *extra = scene_keep(reader, all, sizeof *extra);
  *count = 0;
  for (size_t i = 0; i < registry_count(reader->registry); i++) {
    const struct descriptor *descriptor = registry_at(reader->registry, i);
    for (size_t k = 0; k < descriptor->material_parameters; k++) {
      if (parameter_named(extra, *count, descriptor->material_parameter[k].name))
        continue;
      extra[*count] = descriptor->material_parameter[k];
      extra[(*count)++].optional = true;
    }
  }
  return extra;
}

/* Where a key of one part of a material that stands in another part, or beside them, belongs. */
static void neighbours_of(struct scene_reader *reader, const struct tree *node, const char *part,
                          const struct parameter *extra, size_t extras)
{
  static const struct {
    const char *key, *where;
    enum gamut_kind kind;
  } parts[] = {{"eos", "under 'eos:'", GAMUT_KIND_EOS},
               {"strength", "under 'strength:'", GAMUT_KIND_STRENGTH},
               {"elasticity", "under 'elasticity:'", GAMUT_KIND_ELASTICITY}};
  reader->neighbours = 0;
  for (size_t i = 0; i < ARRAY_SIZE(parts); i++) {
    if (strcmp(parts[i].key, part) == 0)
      continue;
    const struct descriptor *d = instance_peek(reader, parts[i].kind, tree_get(node, parts[i].key));
    if (d)
      neighbour_add(reader, parts[i].where, d->parameter, d->parameters, NULL, 0);
  }
  if (part[0])
    neighbour_add(reader, "one level up, to the material", extra, extras, own_keys,
                  ARRAY_SIZE(own_keys));
}

/* A solver that calls laws itself binds no elasticity. A card may be meant for such a solver. */
static const struct descriptor *own_caller(const struct scene_reader *reader)
{
  const struct descriptor *solver = reader->scene->solver.descriptor;
  return solver && solver->laws ? solver : NULL;
}

static void elasticity_default(struct scene_reader *reader, struct material *material)
{
  char path[PATH_SIZE], what[160];
  const struct descriptor *descriptor = instance_peek(reader, GAMUT_KIND_ELASTICITY, NULL);
  if (!descriptor) {
    error_at_key(reader, material->node, "state 'elasticity:'",
                 "elasticity/%s, the default, is not installed",
                 standard_model(GAMUT_KIND_ELASTICITY));
    return;
  }
  snprintf(what, sizeof what, "elasticity '%s'", descriptor->name);
  snprintf(path, sizeof path, "materials.%s.elasticity", material->name);
  reader->here = material->node;
  struct section section = {.descriptor = descriptor,
                            .parameter = descriptor->parameter,
                            .count = descriptor->parameters,
                            .path = path,
                            .what = what,
                            .pointwise = true,
                            .one_of = &descriptor->one_of};
  material->elasticity = (struct instance){.name = "elasticity", .descriptor = descriptor};
  material->elasticity.values = section_read(reader, &section);
  reader->here = NULL;
}

/* What is usual for a key of a material depends on its eos: a gas is not as dense as a metal. */
static void usual_of_eos(struct scene_reader *reader, const struct material *material)
{
  const struct descriptor *eos = material->eos.descriptor;
  for (size_t i = 0; eos && i < eos->usuals; i++) {
    const struct tree *node = tree_get(material->node, eos->usual[i].parameter);
    if (strcmp(eos->usual[i].parameter, density_parameter->name) == 0 &&
        range_holds(&density_parameter->usual, material->density))
      usual_check(reader, density_parameter, &eos->usual[i].range, node, material->density);
  }
}

/* What the elasticity calls must be there; what it does not call is left unused with a word. */
static void laws_check(struct scene_reader *reader, const struct material *material)
{
  const struct descriptor *solver = own_caller(reader);
  const struct descriptor *caller = solver ? solver : material->elasticity.descriptor;
  if (!caller)
    return;
  static const char *const law[] = {"eos", "strength"};
  for (size_t i = 0; i < ARRAY_SIZE(law); i++) {
    const struct tree *given = tree_get(material->node, law[i]);
    const struct field_use *use = NULL;
    for (size_t k = 0; k < caller->laws; k++)
      if (strcmp(caller->law[k].name, law[i]) == 0)
        use = &caller->law[k];
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "materials.%s.%s", material->name, law[i]);
    if (use && !use->optional && !given)
      error_at_missing(reader, material->node, path, NULL,
                       "'%s' is missing in material '%s': %s '%s' needs it", law[i], material->name,
                       solver ? "solver" : "elasticity", caller->name);
    /* A card serves several solvers: what one of them leaves aside is no mistake. */
    if (!use && given && !solver)
      warn_value(reader, given, NULL,
                 "'%s' of material '%s' is not used: elasticity '%s' takes none", law[i],
                 material->name, caller->name);
  }
}

/* Whether a problem is stated in numbers without a scale: what is usual is then no guide. */
static bool scaled_read(struct scene_reader *reader, const struct tree *material)
{
  const struct tree *node = tree_get(material, "scaled");
  if (!node || node->kind != TREE_SCALAR)
    return false;
  bool is = strcmp(node->text, "true") == 0;
  if (!is && strcmp(node->text, "false") != 0)
    error_at_value(reader, node, "true or false", "'scaled' is neither true nor false");
  return is;
}

static void source_check(struct scene_reader *reader, const struct tree *source)
{
  for (size_t i = 0; source && i < source->children && source->kind == TREE_SEQUENCE; i++)
    text_read(reader, source->child[i], "source");
  if (source && source->kind != TREE_SEQUENCE)
    text_read(reader, source, "source");
}

static void parts_read(struct scene_reader *reader, const struct tree *node,
                       struct material *material, const struct parameter *extra, size_t extras)
{
  const struct {
    const char *key;
    enum gamut_kind kind;
    struct instance *instance;
  } part[] = {{"eos", GAMUT_KIND_EOS, &material->eos},
              {"strength", GAMUT_KIND_STRENGTH, &material->strength},
              {"elasticity", GAMUT_KIND_ELASTICITY, &material->elasticity}};
  for (size_t i = 0; i < ARRAY_SIZE(part); i++) {
    const struct tree *given = tree_get(node, part[i].key);
    if (!given)
      continue;
    neighbours_of(reader, node, part[i].key, extra, extras);
    instance_read(reader, part[i].kind, part[i].key, given, NULL, 0, part[i].instance);
  }
  reader->neighbours = 0;
  if (!tree_get(node, "elasticity") && !own_caller(reader))
    elasticity_default(reader, material);
}

static void material_read(struct scene_reader *reader, const struct tree *node,
                          const struct parameter *extra, size_t extras, struct material *material)
{
  char path[PATH_SIZE], what[160];
  *material = (struct material){.name = node->key, .node = node};
  expect_name(reader, node, "a material");
  snprintf(what, sizeof what, "material '%s'", node->key);
  if (!expect_mapping(reader, node, what))
    return;
  tree_path(node, path, sizeof path);
  reader->scaled = scaled_read(reader, node);

  neighbours_of(reader, node, "", extra, extras);
  struct section section = {.parameter = extra,
                            .count = extras,
                            .node = node,
                            .path = path,
                            .what = what,
                            .also = own_keys,
                            .others = ARRAY_SIZE(own_keys),
                            .pointwise = true};
  material->extra = section_read(reader, &section);
  reader->neighbours = 0;

  /* Density is read like any parameter. */
  section = (struct section){.parameter = density_parameter,
                             .count = 1,
                             .node = node,
                             .path = path,
                             .what = what,
                             .open = true};
  struct values *own = section_read(reader, &section);
  material->density = own->value[0].real;
  material->density_random = own->value[0].random;
  own->value[0].random = NULL;
  values_free(own);

  source_check(reader, tree_get(node, "source"));
  parts_read(reader, node, material, extra, extras);
  usual_of_eos(reader, material);
  reader->scaled = false;
}

void materials_read(struct scene_reader *reader, const struct tree *root)
{
  struct scene *scene = reader->scene;
  const struct tree *node = tree_get(root, "materials");
  size_t extras;
  if (!node) {
    if (!is_typo_of(reader, root, "materials"))
      error_at_missing(reader, root, "materials", "materials: {NAME: {density:, eos:, ...}}",
                       "'materials' is missing");
    return;
  }
  if (!expect_members(reader, node, "'materials'", "NAME: {density:, eos:, ...}", true,
                      MATERIALS_MAX))
    return;
  const struct parameter *extra = extra_parameters(reader, &extras);
  scene->material = scene_take(node->children, sizeof *scene->material);
  scene->materials = node->children;
  scene->materials_node = node;
  for (size_t i = 0; i < node->children; i++)
    material_read(reader, node->child[i], extra, extras, &scene->material[i]);
}

static void needs_check(struct scene_reader *reader, const struct descriptor *plugin,
                        const char *who, const struct material *material)
{
  for (size_t i = 0; i < plugin->material_parameters; i++) {
    const struct parameter *parameter = &plugin->material_parameter[i];
    char path[PATH_SIZE], expected[WORDS_SIZE];
    if (parameter->standard || parameter->optional || !material->extra ||
        tree_get(material->node, parameter->name))
      continue;
    snprintf(path, sizeof path, "materials.%s.%s", material->name, parameter->name);
    snprintf(expected, sizeof expected, "%s%s%s, %s",
             unit_is_pure(parameter->unit) ? "a number" : "such as '",
             unit_is_pure(parameter->unit) ? "" : unit_example(parameter->unit),
             unit_is_pure(parameter->unit) ? "" : "'", parameter->doc ? parameter->doc : "");
    error_at_missing(reader, material->node, path, expected,
                     "'%s' is missing in material '%s': %s needs it", parameter->name,
                     material->name, who);
  }
}

static bool in_use(const struct scene *scene, size_t material)
{
  bool found = false;
  for (size_t b = 0; b < scene->bodies; b++)
    found = found || scene->body[b].material == material;
  return found;
}

/* Whether all that was given could be read: what follows from a fault is no fault. */
static bool understood(const struct instance *instance)
{
  const struct values *values = instance->values;
  for (size_t i = 0; i < values->count; i++)
    if (values->value[i].given && !values->value[i].present)
      return false;
  return instance->descriptor->givens == 0 || given_set_chosen(values, instance->descriptor);
}

/* What a law asks of whoever calls it: of the material's elasticity, or of a solver that calls laws
 * itself. A parameter that the caller does not have is none of its business. */
static void law_needs(struct scene_reader *reader, const struct instance *law,
                      const struct material *material)
{
  const struct descriptor *d = law->descriptor, *solver = own_caller(reader);
  const struct instance *caller = solver ? &reader->scene->solver : &material->elasticity;
  const char *kind = solver ? "solver" : "elasticity";
  char range[160], expected[WORDS_SIZE];
  for (size_t i = 0; d && caller->values && i < d->needs; i++) {
    const struct value *value = values_find(caller->values, d->need[i].parameter);
    if (!value || !understood(caller) ||
        (value->present && range_holds(&d->need[i].range, value->real)))
      continue;
    const struct parameter *p = value->parameter;
    range_text(&d->need[i].range, p->unit, range, sizeof range);
    snprintf(expected, sizeof expected, "%s: {%s: ..}, %s", kind, p->name, range);
    error_at_value(reader, value->node ? value->node : law->node, expected,
                   "%s '%s' of material '%s' has no effect where %s is %.6g%s%s", law->name,
                   d->name, material->name, p->name, value->present ? value->real : 0.0,
                   unit_is_pure(p->unit) ? "" : " ", unit_is_pure(p->unit) ? "" : p->unit);
  }
}

void material_needs(struct scene_reader *reader)
{
  const struct scene *scene = reader->scene;
  char who[160];
  for (size_t m = 0; m < scene->materials; m++) {
    const struct material *material = &scene->material[m];
    const struct descriptor *elasticity = material->elasticity.descriptor;
    if (in_use(scene, m)) {
      laws_check(reader, material);
      law_needs(reader, &material->eos, material);
      law_needs(reader, &material->strength, material);
    }
    if (elasticity) {
      snprintf(who, sizeof who, "elasticity '%s'", elasticity->name);
      needs_check(reader, elasticity, who, material);
    }
    for (size_t e = 0; e < scene->effects; e++) {
      const struct effect *effect = &scene->effect[e];
      bool touches = false;
      for (size_t b = 0; b < scene->bodies; b++)
        touches = touches || (effect->on_body[b] && scene->body[b].material == m);
      if (!touches || effect->enabled == EFFECT_OFF || !effect->instance.descriptor)
        continue;
      snprintf(who, sizeof who, "effect '%s'", effect->instance.name);
      needs_check(reader, effect->instance.descriptor, who, material);
    }
  }
}
