#include "material/block_image.h"

#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"

struct image *image_new(const struct kernel *kernel, struct arena *arena, size_t rows,
                        const char *label)
{
  struct image *image =
      arena_take(arena, label, sizeof *image + kernel->slots * sizeof image->pointer[0]);
  if (!image)
    return NULL;
  image->status = arena_take(arena, label, rows * sizeof *image->status);
  for (size_t s = 0; s < kernel->slots; s++)
    image->pointer[s] = slot_constant(kernel, s);
  return image->status ? image : NULL;
}

void image_follow(struct image *image, const struct link *link, size_t links,
                  const struct gamut_chunk *chunk, double *zero, double *sink)
{
  image->count = chunk->count;
  for (size_t i = 0; i < links; i++) {
    double *array = (link[i].begin ? chunk->begin : chunk->end)[link[i].component];
    double *none = link[i].absent ? link[i].absent : link[i].written ? sink : zero;
    image->pointer[link[i].slot] = array ? array : none;
  }
}

struct field *slot_field(const struct kernel *kernel, size_t number, struct fields *fields,
                         struct trace *trace)
{
  const struct descriptor *d = kernel->descriptor;
  const struct slot *slot = &kernel->slot[number];
  const char *name = NULL, *unit = slot->unit, *meaning = "";
  if (slot_varies(kernel, number)) {
    struct field *drawn = fields_add(fields, kernel->path[number], GAMUT_AT_POINT, 1, unit,
                                     "parameter with a random field", trace);
    if (drawn)
      drawn->drawn = true;
    return drawn;
  }
  if (slot->kind == SLOT_INPUT)
    name = d->input[slot->index].name;
  else if (slot->kind == SLOT_OUTPUT)
    name = d->output[slot->index].name;
  else {
    name = instance_state_field(kernel->instance, slot->index);
    meaning = d->state[slot->index].doc ? d->state[slot->index].doc : "";
  }
  const struct field_info *info = catalogue_find(name);
  struct field *field =
      fields_add(fields, info ? info->name : name, info ? info->where : GAMUT_AT_POINT,
                 slot->components, info ? info->unit : unit, info ? info->meaning : meaning, trace);
  bool state = slot->kind == SLOT_STATE_BEGIN || slot->kind == SLOT_STATE_END;
  if (field && state) {
    field->history = true;
    field->initial = d->state[slot->index].initial;
  }
  return field;
}

void *slot_constant(const struct kernel *kernel, size_t slot)
{
  return kernel->slot[slot].kind == SLOT_DATA ? kernel->data : (void *)kernel->uniform[slot];
}

bool slot_is_array(const struct kernel *kernel, size_t slot)
{
  return kernel->slot[slot].kind != SLOT_LAW && kernel->slot[slot].kind != SLOT_DATA;
}

bool slot_varies(const struct kernel *kernel, size_t slot)
{
  return kernel->path[slot] != NULL;
}

static bool follows_chunk(const struct kernel *kernel, size_t slot)
{
  switch (kernel->slot[slot].kind) {
  case SLOT_PARAMETER:
  case SLOT_MATERIAL_PARAMETER: return slot_varies(kernel, slot);
  case SLOT_INPUT: return !kernel->uniform[slot];
  case SLOT_OUTPUT:
  case SLOT_STATE_BEGIN:
  case SLOT_STATE_END: return true;
  default: return false;
  }
}

gamut_status links_new(const struct kernel *kernel, struct fields *fields, struct trace *trace,
                       struct links *links)
{
  links->count = 0;
  links->link = calloc(kernel->slots + 1, sizeof *links->link);
  if (!links->link)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t s = 0; s < kernel->slots; s++) {
    const struct slot *slot = &kernel->slot[s];
    if (!follows_chunk(kernel, s))
      continue;
    const struct field *field = slot_field(kernel, s, fields, trace);
    if (!field)
      return GAMUT_PLUGIN;
    links->link[links->count++] =
        (struct link){.slot = s,
                      .component = field->handle.first + slot->component,
                      .begin = slot->kind == SLOT_STATE_BEGIN || slot->kind == SLOT_INPUT ||
                               slot_varies(kernel, s),
                      .written = slot->kind == SLOT_OUTPUT || slot->kind == SLOT_STATE_END,
                      .absent = kernel->absent[s]};
  }
  return GAMUT_OK;
}

void links_resolve(const struct kernel *kernel, struct links *links, const struct task *task)
{
  for (size_t i = 0; i < links->count; i++) {
    struct link *link = &links->link[i];
    if (kernel->slot[link->slot].kind != SLOT_INPUT)
      continue;
    link->begin = false;
    for (size_t u = 0; u < task->uses; u++) {
      const struct gamut_field handle = task->use[u].field->handle;
      if (link->component >= handle.first && link->component < handle.first + handle.components)
        link->begin |=
            task->use[u].access == GAMUT_READ_LAST || task->use[u].access == GAMUT_READ_BEGIN;
    }
  }
}

void links_free(struct links *links)
{
  free(links->link);
  *links = (struct links){NULL, 0};
}
