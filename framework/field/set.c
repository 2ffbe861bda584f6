#include "field/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Arrays begin at different offsets within a page: equal ones alias in the first-level cache. */
enum { STAGGER = 40, STAGGERS = 12, SLACK = STAGGER * STAGGERS };
#define PADDING UINT32_C(0x80000000)
/* Below so many slots threads cost more than they give. */
enum { FEW_SLOTS = 1 << 14 };

struct point_set *set_inside(const struct gamut_set *set)
{
  return (struct point_set *)(void *)((char *)(size_t)set - offsetof(struct point_set, open));
}

size_t set_material(const struct gamut_set *set)
{
  return set_inside(set)->material;
}

/* Slots for so many points and the padding that blocks of a usual size need. */
static size_t with_padding(size_t points)
{
  return (points + points / 128 + 2 * GAMUT_LANES - 1) / GAMUT_LANES * GAMUT_LANES;
}

struct point_set *set_new(struct arena *arena, const char *body, size_t index, size_t material,
                          size_t points)
{
  struct point_set *set = calloc(1, sizeof *set);
  if (!set)
    return NULL;
  set->arena = arena;
  set->material = material;
  set->capacity = with_padding(points);
  set->open = (struct gamut_set){.body = body, .index = index, .points = points};
  return set;
}

static void give_arrays(struct point_set *set)
{
  if (set->array)
    for (size_t k = 0; k < fields_components(set->fields); k++)
      if (set->array[k])
        arena_give(set->arena, set->array[k] - STAGGER * (k % STAGGERS));
  free(set->array);
  arena_give(set->arena, set->spare);
  arena_give(set->arena, set->id);
  set->array = NULL;
  set->spare = NULL;
  set->id = NULL;
}

void set_free(struct point_set *set)
{
  if (!set)
    return;
  give_arrays(set);
  free(set->first);
  free(set->derived);
  free(set);
}

static double *take_array(struct point_set *set, size_t component, const char *label)
{
  size_t offset = STAGGER * (component % STAGGERS);
  double *array = arena_take(set->arena, label, (set->capacity + SLACK) * sizeof *array);
  return array ? array + offset : NULL;
}

/* Bytes of all arrays of a set: asked for before any is touched. */
static size_t bytes_wanted(const struct point_set *set)
{
  size_t arrays = 2;
  for (size_t i = 0; i < fields_count(set->fields); i++)
    if (fields_at(set->fields, i)->stored)
      arrays += fields_at(set->fields, i)->handle.components;
  return arrays * (set->capacity + SLACK) * sizeof(double);
}

static gamut_status take_all(struct point_set *set, struct trace *trace)
{
  size_t components = fields_components(set->fields);
  size_t bytes = (set->capacity + SLACK) * sizeof(double);
  size_t wanted = bytes_wanted(set), room_before = arena_room(set->arena);
  bool room = wanted <= room_before;
  set->array = calloc(components ? components : 1, sizeof *set->array);
  set->id = room ? arena_take(set->arena, "point ids", bytes) : NULL;
  bool good = set->array && set->id;
  for (size_t i = 0; good && i < fields_count(set->fields); i++) {
    const struct field *field = fields_at(set->fields, i);
    for (unsigned k = 0; good && field->stored && k < field->handle.components; k++) {
      size_t component = field->handle.first + k;
      set->array[component] = take_array(set, component, field->name);
      good = set->array[component] != NULL;
    }
  }
  set->open.id = set->id;
  return good ? GAMUT_OK
              : trace_fail_at(trace, GAMUT_SCENE, NULL, NULL,
                              "fewer points: a larger cell, or fewer in a cell",
                              "the %zu points of body '%s' take %.3g GB, this machine has %.3g GB",
                              set->open.points, set->open.body, 1e-9 * (double)wanted,
                              1e-9 * (double)room_before);
}

gamut_status set_allocate(struct point_set *set, const struct fields *fields, struct trace *trace)
{
  set->fields = fields;
  gamut_status status = take_all(set, trace);
  if (status != GAMUT_OK)
    return status;
  for (size_t i = 0; i < set->capacity; i++)
    set->id[i] = i < set->open.points ? (int64_t)i : -1;
  for (size_t f = 0; f < fields_count(fields); f++) {
    const struct field *field = fields_at(fields, f);
    bool zero = !(fabs(field->initial) > 0.0); /* as the memory is */
    for (unsigned k = 0; field->stored && !zero && k < field->handle.components; k++)
      for (size_t i = 0; i < set->capacity; i++)
        set->array[field->handle.first + k][i] = field->initial;
  }
  return GAMUT_OK;
}

static bool longer(struct point_set *set, const char *label, size_t offset, size_t kept,
                   double **array)
{
  double *larger = arena_take(set->arena, label, (set->capacity + SLACK) * sizeof *larger);
  if (!larger)
    return false;
  memcpy(larger + offset, *array, kept * sizeof *larger);
  arena_give(set->arena, *array - offset);
  *array = larger + offset;
  return true;
}

/* Room for more slots: padding may need more than the points did at first. Array by array, so that
 * there are never two of all. */
static gamut_status grow(struct point_set *set, size_t slots, struct trace *trace)
{
  size_t kept = set->open.slots > set->open.points ? set->open.slots : set->open.points;
  double *id = (double *)(void *)set->id;
  set->capacity = with_padding(slots);
  bool good = longer(set, "point ids", 0, kept, &id);
  set->id = (int64_t *)(void *)id;
  for (size_t k = 0; good && k < fields_components(set->fields); k++)
    if (set->array[k])
      good = longer(set, fields_of_component(set->fields, k)->name, STAGGER * (k % STAGGERS), kept,
                    &set->array[k]);
  return good ? GAMUT_OK : trace_fail(trace, GAMUT_INTERNAL, "out of memory");
}

/* Piece by piece an array goes into the spare one and leaves its own memory as the next one's
 * spare: every piece has room for the largest offset. All threads work on one array at a time. */
static void permute(struct point_set *set, const uint32_t *source, size_t slots)
{
  const size_t components = fields_components(set->fields);
#pragma omp parallel num_threads(set->threads > 0 ? set->threads : 1) if (slots >= FEW_SLOTS)
  {
    double *spare = set->spare;
    for (size_t k = 0; k < components; k++) {
      const double *restrict from = set->array[k];
      if (!from)
        continue;
      const size_t offset = STAGGER * (k % STAGGERS);
      double *restrict to = spare + offset;
#pragma omp for schedule(static)
      for (size_t i = 0; i < slots; i++)
        to[i] = from[source[i] & ~PADDING];
#pragma omp master
      set->array[k] = to;
      spare = (double *)(size_t)from - offset;
    }
    int64_t *to = (int64_t *)(void *)spare;
#pragma omp for schedule(static)
    for (size_t i = 0; i < slots; i++)
      to[i] = source[i] & PADDING ? -1 : set->id[source[i]];
#pragma omp master
    {
      set->spare = (double *)(void *)set->id;
      set->id = to;
    }
  }
}

static gamut_status keep_blocks(struct point_set *set, const size_t *first, size_t blocks,
                                struct trace *trace)
{
  if (blocks + 1 > set->blocks_capacity) {
    size_t *grown = realloc(set->first, 2 * (blocks + 1) * sizeof *grown);
    if (!grown)
      return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    set->first = grown;
    set->blocks_capacity = 2 * (blocks + 1);
  }
  memcpy(set->first, first, (blocks + 1) * sizeof *first);
  set->open.first = set->first;
  set->open.blocks = blocks;
  return GAMUT_OK;
}

gamut_status set_arrange(struct point_set *set, const uint32_t *source, size_t slots,
                         const size_t *first, size_t blocks, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  if (slots > set->capacity)
    TRY(grow(set, slots, trace));
  set->spare = arena_take(set->arena, "spare array for sorting",
                          (set->capacity + SLACK) * sizeof *set->spare);
  if (!set->spare)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  permute(set, source, slots);
  arena_give(set->arena, set->spare);
  set->spare = NULL;
  const struct field *mass = fields_find(set->fields, "mass");
  if (mass && mass->stored)
    for (size_t i = 0; i < slots; i++)
      if (source[i] & PADDING)
        set->array[mass->handle.first][i] = 0.0;
  set->open.id = set->id;
  set->open.slots = slots;
  TRY(keep_blocks(set, first, blocks, trace));
done:
  return status;
}

gamut_status set_reshape(struct point_set *set, size_t points, const int64_t *id, size_t slots,
                         const size_t *first, size_t blocks, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  if (slots > set->capacity)
    TRY(grow(set, slots, trace));
  memcpy(set->id, id, slots * sizeof *id);
  set->open.id = set->id;
  set->open.points = points;
  set->open.slots = slots;
  TRY(keep_blocks(set, first, blocks, trace));
done:
  return status;
}

static void copy_slot(struct point_set *set, size_t from, size_t to)
{
  for (size_t k = 0; k < fields_components(set->fields); k++)
    if (set->array[k])
      set->array[k][to] = set->array[k][from];
}

static void set_mass(struct point_set *set, size_t slot, double value)
{
  const struct field *mass = fields_find(set->fields, "mass");
  if (mass && mass->stored)
    set->array[mass->handle.first][slot] = value;
}

/* Points leave the block of slots first to end - 1; returns how many of the slots it saw. */
static size_t drop_from_block(struct point_set *set, size_t first, size_t end, const uint32_t *slot,
                              size_t count)
{
  size_t seen = 0, last = end;
  while (seen < count && slot[seen] < end)
    seen++;
  while (last > first && set->id[last - 1] < 0)
    last--;
  for (size_t i = seen; i-- > 0; last--) {
    if (slot[i] + 1 != last) {
      copy_slot(set, last - 1, slot[i]);
      set->id[slot[i]] = set->id[last - 1];
    }
    set->id[last - 1] = -1;
    set->open.points--;
  }
  for (size_t i = last; i < end && seen > 0; i++) {
    if (last > first)
      copy_slot(set, last - 1, i);
    set_mass(set, i, 0.0);
  }
  return seen;
}

void set_drop(struct point_set *set, const uint32_t *slot, size_t count)
{
  for (size_t b = 0; b < set->open.blocks && count > 0; b++) {
    size_t seen = drop_from_block(set, set->first[b], set->first[b + 1], slot, count);
    slot += seen;
    count -= seen;
  }
}

double *set_stored(const struct point_set *set, struct gamut_field field, unsigned component)
{
  if (field.first == SET_DERIVED)
    return set->derived;
  return set->array ? set->array[field.first + component] : NULL;
}

double *set_derive(struct point_set *set)
{
  if (set->derived_capacity < set->open.slots || !set->derived) {
    free(set->derived);
    set->derived_capacity = set->capacity > set->open.slots ? set->capacity : set->open.slots;
    set->derived = malloc((set->derived_capacity + 1) * sizeof *set->derived);
  }
  return set->derived;
}

size_t set_find(const struct point_set *set, int64_t id)
{
  for (size_t i = 0; i < set->open.slots; i++)
    if (set->id[i] == id)
      return i;
  return SIZE_MAX;
}
