/* JSON Schema of scenes (draft 2020-12). It helps an editor to complete and to explain; what it
 * cannot say (dimensions, constraints, names that must exist) `gamut check` says. */
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "scene/scene_private.h"

static json_t *described(json_t *schema, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static json_t *described(json_t *schema, const char *format, ...)
{
  char text[WORDS_SIZE];
  va_list list;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  if (text[0])
    json_object_set_new(schema, "description", json_string_nocheck(text));
  return schema;
}

static json_t *reference(const char *name)
{
  return json_pack("{s:o}", "$ref", json_sprintf("#/$defs/%s", name));
}

static json_t *words(const char *const *name, size_t count)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(list, json_string(name[i]));
  return list;
}

static json_t *list_of(json_t *item, size_t least, size_t most)
{
  json_t *schema =
      json_pack("{s:s, s:o, s:I}", "type", "array", "items", item, "minItems", (json_int_t)least);
  if (most)
    json_object_set_new(schema, "maxItems", json_integer((json_int_t)most));
  return schema;
}

static json_t *object(json_t *properties, bool closed)
{
  return json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties,
                   "additionalProperties", !closed);
}

/* Any keys, each with the same content: materials, bodies. */
static json_t *named(json_t *item)
{
  return json_pack("{s:s, s:o}", "type", "object", "additionalProperties", item);
}

static json_t *number(const struct parameter *parameter)
{
  if (parameter->unit_of) /* a scene decides whether it is a pure number */
    return json_pack("{s:[o, o]}", "anyOf", reference("number"), reference("quantity"));
  bool pure = unit_is_pure(parameter->unit);
  if (!parameter->random || parameter->type != VALUE_REAL)
    return reference(pure ? "number" : "quantity");
  return json_pack("{s:[o, o]}", "anyOf", reference(pure ? "number" : "quantity"),
                   reference("random"));
}

static json_t *table(const struct parameter *parameter)
{
  json_t *file = object(json_pack("{s:{s:s}}", "file", "type", "string"), true);
  json_t *forms = json_pack("[{s:s}, o]", "type", "array", file);
  if (parameter->choices == 2)
    json_array_append_new(
        forms, reference(unit_is_pure(parameter->choice_unit[1]) ? "number" : "quantity"));
  return json_pack("{s:o}", "anyOf", forms);
}

static json_t *parameters_schema(const struct parameter *, size_t count, json_t *into);
static json_t *parameter_schema(const struct parameter *);

/* A word alone is a list of one. */
static json_t *list_schema(const struct parameter *parameter)
{
  json_t *list = list_of(parameter_schema(parameter->of), parameter->size_min, parameter->size_max);
  if (!(parameter_forms(parameter) >> TREE_SCALAR & 1U))
    return list;
  return json_pack("{s:[{s:s}, o]}", "anyOf", "type", "string", list);
}

static json_t *map_schema(const struct parameter *parameter)
{
  json_t *map = named(parameter_schema(parameter->of));
  json_object_set_new(map, "minProperties", json_integer((json_int_t)parameter->size_min));
  json_object_set_new(map, "maxProperties", json_integer((json_int_t)parameter->size_max));
  return map;
}

static json_t *forms_schema(const struct parameter *parameter)
{
  json_t *forms = json_array();
  for (size_t i = 0; i < parameter->members; i++)
    json_array_append_new(forms, parameter_schema(&parameter->member[i]));
  return json_pack("{s:o}", "anyOf", forms);
}

/* Members of one alternative do not stand beside those of another. */
static json_t *group_schema(const struct parameter *group)
{
  json_t *schema = object(parameters_schema(group->member, group->members, NULL), true);
  json_t *pairs = json_array();
  for (size_t i = 0; i < group->members; i++)
    for (size_t k = i + 1; k < group->members; k++)
      if (group->member[i].set && group->member[k].set &&
          group->member[i].set != group->member[k].set)
        json_array_append_new(pairs, json_pack("{s:[s, s]}", "required", group->member[i].name,
                                               group->member[k].name));
  if (json_array_size(pairs))
    json_object_set_new(schema, "not", json_pack("{s:O}", "anyOf", pairs));
  json_decref(pairs);
  return schema;
}

static json_t *bare_schema(const struct parameter *parameter)
{
  switch (parameter->type) {
  case VALUE_REAL:
    return number(parameter);
  case VALUE_INTEGER:
    return json_pack("{s:s}", "type", "integer");
  case VALUE_BOOLEAN:
    return json_pack("{s:s}", "type", "boolean");
  case VALUE_CHOICE:
    return json_pack("{s:o}", "enum", words(parameter->choice, parameter->choices));
  case VALUE_TEXT:
  case VALUE_BODY:
  case VALUE_FILE:
  case VALUE_ENTRY:
    return json_pack("{s:s}", "type", "string");
  case VALUE_EXPRESSION:
    return json_pack("{s:[s, s]}", "type", "string", "number");
  case VALUE_VECTOR:
    return list_of(reference(unit_is_pure(parameter->unit) ? "number" : "quantity"),
                   parameter->size_min, parameter->size_max);
  case VALUE_TABLE:
    return table(parameter);
  case VALUE_LEVELS:
    return named(json_pack("{s:s}", "type", "array"));
  case VALUE_PLUGIN:
    return reference(kind_name(parameter->kind));
  case VALUE_LIST:
    return list_schema(parameter);
  case VALUE_MAP:
    return map_schema(parameter);
  case VALUE_ONE_OF:
    return forms_schema(parameter);
  case VALUE_GROUP:
    return group_schema(parameter);
  }
  return json_object();
}

static json_t *parameter_schema(const struct parameter *parameter)
{
  char range[128], physical[160] = "";
  bool pure = unit_is_pure(parameter->unit);
  json_t *schema = bare_schema(parameter);
  if (parameter->physical.stated) {
    range_text(&parameter->physical, parameter->unit, range, sizeof range);
    snprintf(physical, sizeof physical, "; %s", range);
  }
  if (parameter->standard && parameter->standard->kind == TREE_SCALAR)
    json_object_set_new(schema, "default", json_string(parameter->standard->text));
  return described(schema, "%s%s%s%s%s", parameter->doc ? parameter->doc : "", pure ? "" : " [",
                   pure ? "" : parameter->unit, pure ? "" : "]", physical);
}

/* Several plugins may mean different things by one name: then each of them will do. */
static void add_property(json_t *properties, const char *name, json_t *schema)
{
  json_t *known = json_object_get(properties, name);
  if (!known || json_equal(known, schema))
    json_object_set_new(properties, name, schema);
  else
    json_object_set_new(properties, name, json_pack("{s:[O, o]}", "anyOf", known, schema));
}

/* Properties of parameters, added to `into` or to a new object. */
static json_t *parameters_schema(const struct parameter *parameter, size_t count, json_t *into)
{
  json_t *properties = into ? into : json_object();
  for (size_t i = 0; i < count; i++)
    add_property(properties, parameter[i].name, parameter_schema(&parameter[i]));
  return properties;
}

/* A plugin of one kind: `model` decides which parameters may follow. A plain name will do too. */
static json_t *plugin_schema(const struct registry *registry, enum gamut_kind kind,
                             json_t *(*common)(void))
{
  json_t *models = json_array(), *branches = json_array();
  for (size_t i = 0; i < registry_count(registry); i++) {
    const struct descriptor *d = registry_at(registry, i);
    if (d->kind != kind)
      continue;
    json_array_append_new(models, json_string(d->name));
    json_t *properties =
        parameters_schema(d->parameter, d->parameters, common ? common() : json_object());
    json_object_set_new(properties, "model", json_pack("{s:s}", "const", d->name));
    json_t *then = described(object(properties, true), "%s", d->summary ? d->summary : "");
    json_t *branch = json_pack("{s:{s:{s:{s:s}}}, s:o}", "if", "properties", "model", "const",
                               d->name, "then", then);
    const char *standard = standard_model(kind);
    if (!standard || strcmp(standard, d->name) != 0) /* a key that is absent holds: the default */
      json_object_set_new(json_object_get(branch, "if"), "required", json_pack("[s]", "model"));
    json_array_append_new(branches, branch);
  }
  json_t *mapping =
      json_pack("{s:s, s:{s:{s:O}}}", "type", "object", "properties", "model", "enum", models);
  if (json_array_size(branches))
    json_object_set(mapping, "allOf", branches);
  json_decref(branches);
  return json_pack("{s:[{s:o}, o]}", "anyOf", "enum", models, mapping);
}

static json_t *effect_keys(void)
{
  return json_pack("{s:{s:[s, s, s, b, b]}, s:o, s:o}", "enabled", "enum", "auto", "on", "off", 1,
                   0, "bodies", reference("names"), "materials", reference("names"));
}

static json_t *shape_schema(void)
{
  json_t *place = reference("place"), *length = reference("quantity");
  json_t *box = object(
      json_pack("{s:O, s:O, s:O, s:O}", "min", place, "max", place, "size", place, "centre", place),
      true);
  json_t *cylinder =
      object(json_pack("{s:O, s:O, s:{s:[s, s, s]}, s:O}", "radius", length, "length", length,
                       "axis", "enum", "x", "y", "z", "base", place),
             true);
  json_t *sphere = object(json_pack("{s:O, s:O}", "radius", length, "centre", place), true);
  json_t *tube =
      object(json_pack("{s:O, s:O, s:O, s:{s:[s, s, s]}, s:O}", "radius", length, "inner_radius",
                       length, "length", length, "axis", "enum", "x", "y", "z", "base", place),
             true);
  json_t *cone =
      object(json_pack("{s:O, s:O, s:O, s:{s:[s, s, s]}, s:O}", "radius", length, "top_radius",
                       length, "length", length, "axis", "enum", "x", "y", "z", "base", place),
             true);
  json_t *points =
      object(json_pack("{s:{s:s}, s:O}", "file", "type", "string", "spacing", length), true);
  json_t *difference = object(json_pack("{s:o, s:o}", "from", reference("shape"), "remove",
                                        list_of(reference("shape"), 1, 0)),
                              true);
  json_decref(place);
  json_decref(length);
  json_t *shape = object(json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "box", box,
                                   "cylinder", cylinder, "sphere", sphere, "tube", tube, "cone",
                                   cone, "union", list_of(reference("shape"), 1, 0), "difference",
                                   difference, "points", points),
                         true);
  json_object_set_new(shape, "minProperties", json_integer(1));
  json_object_set_new(shape, "maxProperties", json_integer(1));
  return described(shape, "one shape");
}

static json_t *material_schema(const struct registry *registry)
{
  json_t *properties =
      json_pack("{s:o, s:{s:s}}", "source", reference("names"), "scaled", "type", "boolean");
  json_object_set_new(
      properties, "density",
      described(json_pack("{s:[o, o]}", "anyOf", reference("quantity"), reference("random")),
                "density at zero compression [kg/m3]; greater than 0 kg/m3"));
  json_object_set_new(properties, "eos", plugin_schema(registry, GAMUT_KIND_EOS, NULL));
  json_object_set_new(properties, "strength", plugin_schema(registry, GAMUT_KIND_STRENGTH, NULL));
  json_object_set_new(properties, "elasticity",
                      described(plugin_schema(registry, GAMUT_KIND_ELASTICITY, NULL),
                                "hypoelastic where it is not stated"));
  for (size_t i = 0; i < registry_count(registry); i++) {
    const struct descriptor *d = registry_at(registry, i);
    parameters_schema(d->material_parameter, d->material_parameters, properties);
  }
  return object(properties, true);
}

static json_t *body_schema(const struct registry *registry)
{
  json_t *component = json_pack("{s:[s, s]}", "type", "string", "number");
  json_t *properties =
      json_pack("{s:{s:s}, s:o, s:o, s:o, s:o, s:o}", "material", "type", "string", "shape",
                reference("shape"), "velocity",
                described(list_of(component, 1, 3),
                          "numbers with units, or arithmetic in x, y, z (metres) that gives m/s"),
                "temperature", described(reference("quantity"), "298 K where it is not stated [K]"),
                "pressure", described(reference("quantity"), "initial pressure [Pa]"), "energy",
                described(reference("quantity"), "initial energy per reference volume [J/m3]"));
  for (size_t i = 0; i < registry_count(registry); i++) {
    const struct descriptor *d = registry_at(registry, i);
    parameters_schema(d->body_parameter, d->body_parameters, properties);
  }
  return object(properties, true);
}

/* An interval of what the solver advances along: time with its unit, or a pure number. */
static json_t *along_axis(void)
{
  return json_pack("{s:[o, o]}", "anyOf", reference("quantity"), reference("number"));
}

static json_t *quantity_schema(const struct registry *registry)
{
  json_t *line = object(json_pack("{s:o, s:o, s:{s:s}}", "from", reference("place"), "to",
                                  reference("place"), "points", "type", "integer"),
                        true);
  json_t *at =
      object(json_pack("{s:{s:s}, s:o, s:o, s:o, s:{s:[s, s]}}", "body", "type", "string", "point",
                       reference("place"), "points", list_of(reference("place"), 1, 0), "line",
                       line, "follow", "enum", "material", "space"),
             true);
  json_t *properties = json_pack(
      "{s:{s:s}, s:{s:s}, s:{s:s}, s:o, s:o, s:o}", "measure", "type", "string", "effect", "type",
      "string", "body", "type", "string", "at", at, "reduce",
      described(json_pack("{s:[s, s]}", "type", "string", "object"),
                "at end, at 12 us, max, min, mean, {mean: [t0, t1]}, {time_of: VALUE}, ...; "
                "absent: a history"),
      "every", along_axis());
  for (size_t i = 0; i < registry_count(registry); i++) {
    const struct descriptor *d = registry_at(registry, i);
    for (size_t k = 0; k < d->measures; k++)
      parameters_schema(d->measure[k].argument, d->measure[k].arguments, properties);
  }
  return object(properties, true);
}

static json_t *definitions(const struct registry *registry)
{
  const char *names[DISTRIBUTIONS_MAX];
  const size_t count = distribution_names(names);
  json_t *pure = json_pack("{s:[s, s]}", "type", "number", "string");
  json_t *value = json_pack("{s:[s, s]}", "type", "number", "string");
  json_t *random =
      object(json_pack("{s:O, s:O, s:O, s:{s:o}, s:O, s:O, s:{s:[s, s]}, s:o}", "mean", value, "cv",
                       value, "sd", value, "distribution", "enum", words(names, count), "lower",
                       value, "upper", value, "truncate", "type", "boolean", "array", "field",
                       reference(kind_name(GAMUT_KIND_RANDOM_FIELD))),
             true);
  json_decref(value);
  return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "shape", shape_schema(), "number", pure,
                   "quantity",
                   json_pack("{s:s, s:s, s:[s]}", "type", "string", "pattern",
                             "^[-+]?[0-9.]+([eE][-+]?[0-9]+)? ", "examples", "0.4 mm"),
                   "random", random, kind_name(GAMUT_KIND_RANDOM_FIELD),
                   plugin_schema(registry, GAMUT_KIND_RANDOM_FIELD, NULL), "place",
                   list_of(reference("quantity"), 1, 3), "names",
                   json_pack("{s:[{s:s}, o]}", "anyOf", "type", "string",
                             list_of(json_pack("{s:s}", "type", "string"), 0, 0)));
}

/* A part of what an include may hold the rest of has no keys that it must have. */
static json_t *members_need(const char *key)
{
  return json_pack("{s:{s:s, s:[s]}}", "additionalProperties", "type", "object", "required", key);
}

static json_t *needs_of_a_whole(void)
{
  json_t *parts = json_pack("{s:o, s:o, s:o}", "materials", members_need("density"), "bodies",
                            members_need("material"), "quantities", members_need("measure"));
  return json_pack("{s:{s:{s:[s]}}, s:{s:o}}", "if", "not", "required", "include", "then",
                   "properties", parts);
}

void schema_write(const struct registry *registry, FILE *file)
{
  json_t *checkpoint = json_pack("{s:[o, o]}", "anyOf", reference("quantity"),
                                 object(json_pack("{s:o}", "every", along_axis()), true));
  json_t *outputs =
      object(json_pack("{s:o, s:{s:s}, s:o, s:o}", "every", along_axis(), "frames", "type",
                       "integer", "fields", reference("names"), "checkpoint", checkpoint),
             true);
  json_t *uncertainty =
      object(json_pack("{s:o, s:{s:s}, s:{s:s}, s:{s:s}, s:{s:[{s:s}, {s:s}]}}", "estimator",
                       plugin_schema(registry, GAMUT_KIND_ESTIMATOR, NULL), "correlation", "type",
                       "array", "seed", "type", "integer", "failures", "type", "number",
                       "step_margin", "anyOf", "type", "number", "const", "off"),
             true);
  json_t *properties =
      json_pack("{s:{s:i}, s:{s:s}, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "gamut", "const", 1,
                "title", "type", "string", "include", reference("names"), "solver",
                plugin_schema(registry, GAMUT_KIND_SOLVER, NULL), "materials",
                named(material_schema(registry)), "bodies", named(body_schema(registry)), "effects",
                named(plugin_schema(registry, GAMUT_KIND_EFFECT, effect_keys)), "quantities",
                named(quantity_schema(registry)), "outputs", outputs, "uncertainty", uncertainty);
  json_t *schema = json_pack("{s:s, s:s, s:s, s:o, s:b, s:[s], s:o}", "$schema",
                             "https://json-schema.org/draft/2020-12/schema", "title", "gamut scene",
                             "type", "object", "properties", properties, "additionalProperties", 0,
                             "required", "gamut", "$defs", definitions(registry));
  json_t *needs = needs_of_a_whole();
  json_object_update(schema, needs);
  json_decref(needs);
  json_dumpf(schema, file, JSON_INDENT(2));
  fputc('\n', file);
  json_decref(schema);
}
