/* Fields that quantities and outputs may name: those of the catalogue that live at points, and the
 * states and own outputs of the plugins that the scene names. */
#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"
#include "scene/scene_private.h"

struct search {
  const char *wanted; /* null: collect all names */
  bool component;
  const char *unit; /* found */
  struct scene_reader *reader;
  const char **name;
  size_t names, capacity;
};

static void collect(struct search *search, const char *name)
{
  if (has_name(search->name, search->names, name))
    return;
  if (search->names == search->capacity) {
    search->capacity = 2 * search->capacity + 64;
    const char **more = scene_take(search->capacity, sizeof *more);
    if (search->names)
      memcpy(more, search->name, search->names * sizeof *more);
    free(search->name);
    search->name = more;
  }
  search->name[search->names++] = name;
}

static void visit(struct search *search, const char *field, unsigned components, const char *unit)
{
  if (components == 1 || !search->component) {
    if (!search->wanted)
      collect(search, field);
    else if (strcmp(search->wanted, field) == 0)
      search->unit = unit;
  }
  for (unsigned k = 0; components > 1 && k < components; k++) {
    char name[160];
    snprintf(name, sizeof name, "%.100s_%s", field, component_name(components, k));
    if (!search->wanted)
      collect(search, scene_text(search->reader, "%s", name));
    else if (strcmp(search->wanted, name) == 0)
      search->unit = unit;
  }
}

static void visit_plugin(struct search *search, const struct instance *instance)
{
  const struct descriptor *descriptor = instance->descriptor;
  if (!descriptor)
    return;
  for (size_t i = 0; i < descriptor->states; i++)
    visit(search, instance_state_field(instance, i), descriptor->state[i].components,
          descriptor->state[i].unit);
  for (size_t i = 0; i < descriptor->outputs; i++)
    if (descriptor->output[i].unit && !catalogue_find(descriptor->output[i].name))
      visit(search, descriptor->output[i].name, descriptor->output[i].components,
            descriptor->output[i].unit);
}

/* Parameters with a random field are fields at points, under their scene path. */
static void visit_parameters(struct search *search, const struct values *values,
                             const struct descriptor *descriptor)
{
  char path[PATH_SIZE];
  struct pointwise *points = pointwise_new(values, descriptor);
  for (size_t i = 0; points && i < values->count; i++) {
    if (!pointwise_varies(points, i))
      continue;
    snprintf(path, sizeof path, "%s.%s", values->path, values->parameter[i].name);
    visit(search, search->wanted ? path : scene_text(search->reader, "%s", path), 1,
          values->parameter[i].unit);
  }
  pointwise_free(points);
}

static void visit_instance(struct search *search, const struct instance *instance)
{
  visit_plugin(search, instance);
  if (instance->descriptor)
    visit_parameters(search, instance->values, instance->descriptor);
}

static void visit_all(struct search *search, const struct scene *scene)
{
  for (size_t i = 0; catalogue_at(i); i++)
    if (catalogue_at(i)->where == GAMUT_AT_POINT)
      visit(search, catalogue_at(i)->name, catalogue_at(i)->components, catalogue_at(i)->unit);
  for (size_t i = 0; i < scene->materials; i++) {
    visit_instance(search, &scene->material[i].eos);
    visit_instance(search, &scene->material[i].strength);
    visit_instance(search, &scene->material[i].elasticity);
    visit_parameters(search, scene->material[i].extra, NULL);
  }
  for (size_t i = 0; i < scene->effects; i++)
    visit_instance(search, &scene->effect[i].instance);
  visit_plugin(search, &scene->solver);
}

const char *field_unit(const struct scene_reader *reader, const char *name, bool component)
{
  struct search search = {.wanted = name, .component = component};
  visit_all(&search, reader->scene);
  return search.unit;
}

const char **field_names(struct scene_reader *reader, bool component, size_t *count)
{
  struct search search = {.component = component, .reader = reader};
  visit_all(&search, reader->scene);
  *count = search.names;
  return search.name;
}
