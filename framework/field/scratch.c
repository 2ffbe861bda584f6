#include "field/field.h"

#include <string.h>

#include "base/array.h"

struct lane_scratch {
  size_t chunk, stride, components;
  double *memory; /* one row a component */
  double *zero;
  double **begin, **end;
};

static size_t row_stride(size_t chunk)
{
  return chunk + ARRAY_PAD;
}

size_t scratch_bytes(const struct fields *fields, size_t chunk)
{
  size_t components = fields_components(fields);
  return sizeof(struct lane_scratch) + (components + 1) * row_stride(chunk) * sizeof(double) +
         2 * components * sizeof(double *);
}

struct lane_scratch *scratch_new(struct arena *arena, const struct fields *fields, size_t chunk)
{
  static const char label[] = "scratch of threads";
  size_t components = fields_components(fields), stride = row_stride(chunk);
  struct lane_scratch *scratch = arena_take(arena, label, sizeof *scratch);
  double *memory = arena_take(arena, label, (components + 1) * stride * sizeof(double));
  double **table = arena_take(arena, label, 2 * components * sizeof *table);
  if (!scratch || !memory || !table)
    return NULL;
  *scratch = (struct lane_scratch){.chunk = chunk,
                                   .stride = stride,
                                   .components = components,
                                   .memory = memory,
                                   .zero = memory + components * stride,
                                   .begin = table,
                                   .end = table + components};
  return scratch;
}

void scratch_bind(struct lane_scratch *scratch, const struct point_set *set,
                  const unsigned char *source, double *const *uniform, size_t slot, size_t count,
                  struct gamut_chunk *chunk)
{
  for (size_t k = 0; k < scratch->components; k++) {
    double *row = scratch->memory + k * scratch->stride;
    double *array = set->array[k] ? set->array[k] + slot : NULL;
    double *begin = NULL, *end = NULL;
    switch ((enum source)source[k]) {
    case SOURCE_NONE: break;
    case SOURCE_ARRAY: begin = end = array; break;
    case SOURCE_FRESH: begin = array; end = row; break;
    case SOURCE_SCRATCH: begin = end = row; break;
    case SOURCE_ZERO: begin = end = scratch->zero; break;
    case SOURCE_UNIFORM: begin = end = uniform[k]; break;
    }
    scratch->begin[k] = begin;
    scratch->end[k] = end;
  }
  chunk->slot = slot;
  chunk->count = count;
  chunk->begin = scratch->begin;
  chunk->end = scratch->end;
}

void scratch_commit(const struct lane_scratch *scratch, const unsigned char *source,
                    const struct gamut_chunk *chunk)
{
  for (size_t k = 0; k < scratch->components; k++)
    if (source[k] == SOURCE_FRESH)
      memcpy(chunk->begin[k], chunk->end[k], chunk->count * sizeof(double));
}
