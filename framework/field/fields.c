#include "field/field.h"

#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"

struct fields {
  struct field **field; /* one allocation each: handles to them stay good */
  size_t count, components;
};

struct fields *fields_new(void)
{
  return calloc(1, sizeof(struct fields));
}

void fields_free(struct fields *fields)
{
  if (!fields)
    return;
  for (size_t i = 0; i < fields->count; i++)
    free(fields->field[i]);
  free(fields->field);
  free(fields);
}

struct field *fields_find(const struct fields *fields, const char *name)
{
  for (size_t i = 0; i < fields->count; i++)
    if (strcmp(fields->field[i]->name, name) == 0)
      return fields->field[i];
  return NULL;
}

struct field *fields_add(struct fields *fields, const char *name, enum gamut_where where,
                         unsigned components, const char *unit, const char *meaning,
                         struct trace *trace)
{
  struct field *field = fields_find(fields, name);
  if (field) {
    if (field->where == where && field->handle.components == components)
      return field;
    trace_fail(trace, GAMUT_PLUGIN, "field '%s' is declared twice, with %u and with %u components",
               name, field->handle.components, components);
    return NULL;
  }
  struct field **grown = realloc(fields->field, (fields->count + 1) * sizeof(*grown));
  if (grown)
    fields->field = grown;
  field = calloc(1, sizeof *field);
  if (!grown || !field) {
    free(field);
    trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    return NULL;
  }
  *field = (struct field){.name = name,
                          .unit = unit,
                          .meaning = meaning,
                          .where = where,
                          .handle = {(uint32_t)fields->components, components}};
  fields->components += components;
  fields->field[fields->count++] = field;
  return field;
}

size_t fields_count(const struct fields *fields)
{
  return fields->count;
}

struct field *fields_at(const struct fields *fields, size_t index)
{
  return fields->field[index];
}

size_t fields_components(const struct fields *fields)
{
  return fields->components;
}

struct field *fields_of_component(const struct fields *fields, size_t component)
{
  for (size_t i = 0; i < fields->count; i++) {
    struct gamut_field handle = fields->field[i]->handle;
    if (component >= handle.first && component < handle.first + handle.components)
      return fields->field[i];
  }
  return NULL;
}

struct field *fields_component(const struct fields *fields, const char *name, unsigned *component)
{
  struct field *field = fields_find(fields, name);
  if (field && field->handle.components == 1) {
    *component = 0;
    return field;
  }
  for (size_t i = 0; i < fields->count; i++) {
    field = fields->field[i];
    size_t stem = strlen(field->name);
    if (strncmp(field->name, name, stem) != 0 || name[stem] != '_')
      continue;
    for (unsigned k = 0; k < field->handle.components; k++)
      if (strcmp(component_name(field->handle.components, k), name + stem + 1) == 0) {
        *component = k;
        return field;
      }
  }
  return NULL;
}
