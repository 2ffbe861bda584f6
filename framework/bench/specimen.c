#include "bench/specimen.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "catalogue/catalogue.h"

void settings_free(struct settings *settings)
{
  for (size_t i = 0; i < settings->count; i++)
    free(settings->item[i].text);
  free(settings->item);
  *settings = (struct settings){0};
}

void settings_put(struct settings *settings, const char *name, const char *text)
{
  for (size_t i = 0; i < settings->count; i++)
    if (strcmp(settings->item[i].name, name) == 0) {
      char *copy = strdup(text);
      free(settings->item[i].text);
      settings->item[i].text = copy;
      return;
    }
  if (settings->count == settings->capacity) {
    settings->capacity = 2 * settings->capacity + 8;
    settings->item = realloc(settings->item, settings->capacity * sizeof *settings->item);
    if (!settings->item)
      abort();
  }
  settings->item[settings->count++] = (struct setting){.name = name, .text = strdup(text)};
}

void settings_copy(struct settings *settings, const struct settings *from)
{
  settings->folder = from->folder;
  for (size_t i = 0; i < from->count; i++)
    settings_put(settings, from->item[i].name, from->item[i].text);
}

static bool is_pure(const char *unit)
{
  return !unit || unit[0] == 0 || strcmp(unit, "1") == 0;
}

void settings_number(struct settings *settings, const struct parameter *parameter, double si)
{
  char text[160];
  bool plain = is_pure(parameter->unit);
  snprintf(text, sizeof text, "%.17g%s%s", si, plain ? "" : " ", plain ? "" : parameter->unit);
  settings_put(settings, parameter->name, text);
}

const struct parameter *specimen_parameter(const struct descriptor *descriptor, const char *name)
{
  const struct parameter *table[2] = {descriptor->parameter, descriptor->material_parameter};
  const size_t count[2] = {descriptor->parameters, descriptor->material_parameters};
  for (int t = 0; t < 2; t++) {
    const struct parameter *found = parameter_named(table[t], count[t], name);
    if (found)
      return found;
  }
  for (int t = 0; t < 2; t++)
    for (size_t i = 0; i < count[t]; i++)
      if (table[t][i].symbol && strcmp(table[t][i].symbol, name) == 0)
        return &table[t][i];
  return NULL;
}

static gamut_status unknown_parameter(const struct descriptor *descriptor, const char *name,
                                      const char *what, struct trace *trace)
{
  const char *known[64];
  size_t count = 0;
  for (size_t i = 0; i < descriptor->parameters && count < 64; i++)
    known[count++] = descriptor->parameter[i].name;
  for (size_t i = 0; i < descriptor->material_parameters && count < 64; i++)
    known[count++] = descriptor->material_parameter[i].name;
  const char *near = nearest(name, known, count);
  if (near)
    return trace_fail(trace, GAMUT_USAGE, "%s: %s has no parameter '%s'; did you mean '%s'?", what,
                      descriptor->id, name, near);
  return trace_fail(trace, GAMUT_USAGE, "%s: %s has no parameter '%s'; 'gamut show %s' lists them",
                    what, descriptor->id, name, descriptor->id);
}

static gamut_status read_number(struct settings *settings, const struct parameter *parameter,
                                const char *text, const char *what, const struct units *units,
                                struct trace *trace)
{
  const char *unit = is_pure(parameter->unit) ? "1" : parameter->unit;
  double si;
  switch (unit_read_bare(units, text, unit, &si)) {
  case UNIT_OK:
    settings_number(settings, parameter, si);
    return GAMUT_OK;
  case UNIT_UNKNOWN:
    return trace_fail(trace, GAMUT_USAGE, "%s %s: the unit of '%s' is not known (expected %s)",
                      what, parameter->name, text, unit);
  case UNIT_DIMENSION:
  case UNIT_UNWANTED:
    return trace_fail(trace, GAMUT_USAGE, "%s %s: '%s' has another dimension than %s", what,
                      parameter->name, text, is_pure(unit) ? "a pure number" : unit);
  default:
    return trace_fail(trace, GAMUT_USAGE, "%s %s: '%s' is not a finite number", what,
                      parameter->name, text);
  }
}

/* In single quotes, so that YAML takes every character as it stands. */
static void put_quoted(struct settings *settings, const char *name, const char *text)
{
  char *quoted = malloc(2 * strlen(text) + 3), *to = quoted;
  if (!quoted)
    abort();
  *to++ = '\'';
  for (; *text; text++) {
    if (*text == '\'')
      *to++ = '\'';
    *to++ = *text;
  }
  *to++ = '\'';
  *to = 0;
  settings_put(settings, name, quoted);
  free(quoted);
}

gamut_status settings_read(struct settings *settings, const struct descriptor *descriptor,
                           const char *name, const char *text, const char *what,
                           const struct units *units, struct trace *trace)
{
  const struct parameter *parameter = specimen_parameter(descriptor, name);
  if (!parameter)
    return unknown_parameter(descriptor, name, what, trace);
  if (parameter->type == VALUE_REAL)
    return read_number(settings, parameter, text, what, units, trace);
  if (parameter->type == VALUE_TEXT || parameter->type == VALUE_BODY ||
      parameter->type == VALUE_FILE)
    put_quoted(settings, parameter->name, text);
  else
    settings_put(settings, parameter->name, text);
  return GAMUT_OK;
}

static void put_flow(FILE *file, const struct tree *node)
{
  const bool mapping = node->kind == TREE_MAPPING;
  if (node->kind == TREE_SCALAR) {
    fprintf(file, "%s%s%s", node->quoted ? "\"" : "", node->text, node->quoted ? "\"" : "");
    return;
  }
  fputc(mapping ? '{' : '[', file);
  for (size_t i = 0; i < node->children; i++) {
    fprintf(file, "%s%s%s", i ? ", " : "", mapping ? node->child[i]->key : "", mapping ? ": " : "");
    put_flow(file, node->child[i]);
  }
  fputc(mapping ? '}' : ']', file);
}

gamut_status settings_node(struct settings *settings, const struct descriptor *descriptor,
                           const struct tree *node, const char *what, const struct units *units,
                           struct trace *trace)
{
  char *text = NULL;
  size_t size = 0;
  if (node->kind == TREE_SCALAR)
    return settings_read(settings, descriptor, node->key, node->text, what, units, trace);
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  put_flow(file, node);
  memory_close(file, &text);
  const struct parameter *parameter = specimen_parameter(descriptor, node->key);
  if (parameter)
    settings_put(settings, parameter->name, text);
  free(text);
  return parameter ? GAMUT_OK : unknown_parameter(descriptor, node->key, what, trace);
}

/* The settings of one table of parameters as a YAML mapping. */
static gamut_status mapping_of(const struct settings *settings, const struct parameter *parameter,
                               size_t count, const char *source, struct trace *trace,
                               struct tree **tree)
{
  char *text = NULL;
  size_t size = 0, entries = 0;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < settings->count; i++)
    if (parameter_named(parameter, count, settings->item[i].name)) {
      fprintf(file, "%s: %s\n", settings->item[i].name, settings->item[i].text);
      entries++;
    }
  if (entries == 0)
    fputs("{}\n", file);
  memory_close(file, &text);
  gamut_status status = tree_parse(text, size, source, GAMUT_SCENE, trace, tree);
  free(text);
  return status;
}

gamut_status specimen_values(struct specimen *specimen, const struct descriptor *descriptor,
                             const struct settings *settings, const char *source,
                             const struct units *units, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct tree *extra = NULL;
  char beside[PATH_MAX];
  if (settings->folder) { /* files are looked for where their namer stands */
    snprintf(beside, sizeof beside, "%s/%s", settings->folder, source);
    source = beside;
  }
  *specimen = (struct specimen){.descriptor = descriptor};
  TRY(mapping_of(settings, descriptor->parameter, descriptor->parameters, source, trace,
                 &specimen->tree));
  TRY(values_read(descriptor, descriptor->parameter, descriptor->parameters, specimen->tree,
                  descriptor->id, NULL, 0, units, trace, &specimen->values));
  if (descriptor->material_parameters == 0)
    goto done;
  TRY(mapping_of(settings, descriptor->material_parameter, descriptor->material_parameters, source,
                 trace, &extra));
  tree_put(specimen->tree, "material", extra, trace);
  TRY(values_read(NULL, descriptor->material_parameter, descriptor->material_parameters,
                  tree_get(specimen->tree, "material"), descriptor->id, NULL, 0, units, trace,
                  &specimen->extra));
done:
  return status;
}

gamut_status specimen_open(struct specimen *specimen, struct registry *registry, size_t count,
                           double density, struct trace *trace)
{
  specimen->instance = (struct instance){.name = kind_name(specimen->descriptor->kind),
                                         .descriptor = specimen->descriptor,
                                         .values = specimen->values,
                                         .node = specimen->tree};
  specimen->arena = arena_new();
  if (!specimen->arena)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  lone_run_open(&specimen->lone, trace, specimen->arena);
  lone_run_values(specimen->values);
  return kernel_new(&specimen->instance, registry, specimen->arena, count, specimen->extra, density,
                    lone_run_handle(&specimen->lone), trace, &specimen->kernel);
}

void specimen_close(struct specimen *specimen)
{
  if (specimen->kernel)
    kernel_free(specimen->kernel);
  if (specimen->arena)
    arena_free(specimen->arena);
  if (specimen->values)
    values_free(specimen->values);
  if (specimen->extra)
    values_free(specimen->extra);
  tree_free(specimen->tree);
  *specimen = (struct specimen){0};
}

char *slot_label(const struct slot *slot, char *buffer, size_t size)
{
  const char *component =
      slot->components > 1 ? component_name(slot->components, slot->component) : "";
  snprintf(buffer, size, "%s%s%s", slot->name, component[0] ? "_" : "", component);
  return buffer;
}

bool slot_is_input(const struct slot *slot)
{
  return slot->kind == SLOT_PARAMETER || slot->kind == SLOT_MATERIAL_PARAMETER ||
         slot->kind == SLOT_INPUT || slot->kind == SLOT_STATE_BEGIN ||
         slot->kind == SLOT_INVERSE_INPUT;
}

bool slot_is_output(const struct slot *slot)
{
  return slot->kind == SLOT_OUTPUT || slot->kind == SLOT_STATE_END;
}
