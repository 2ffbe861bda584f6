/* The points of a set without the padding of its blocks, as a checkpoint has them. */
#include <stdlib.h>
#include <string.h>

#include "run/restart.h"

void packed_free(struct packed *p)
{
  free(p->first);
  free(p->count);
  *p = (struct packed){0};
}

static gamut_status make_room(struct packed *p, size_t blocks, struct trace *trace)
{
  *p = (struct packed){.blocks = blocks};
  p->first = calloc(blocks + 1, sizeof *p->first);
  p->count = calloc(blocks + 1, sizeof *p->count);
  if (p->first && p->count)
    return GAMUT_OK;
  packed_free(p);
  return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
}

/* Points stand first in a block. One that all have left keeps a row, from which its slots are made
 * again. */
static size_t rows_of(const struct gamut_set *set, size_t first, size_t end)
{
  size_t rows = end - first;
  while (rows > 1 && set->id[first + rows - 1] < 0)
    rows--;
  return rows;
}

gamut_status packed_of(const struct gamut_set *set, struct packed *p, struct trace *trace)
{
  gamut_status status;
  TRY(make_room(p, set->blocks, trace));
  for (size_t b = 0; b < set->blocks; b++) {
    p->first[b] = set->first[b];
    p->count[b] = (int64_t)rows_of(set, set->first[b], set->first[b + 1]);
    p->rows += (size_t)p->count[b];
  }
  p->first[p->blocks] = set->slots;
  if (set->blocks == 0)
    p->rows = set->slots;
done:
  return status;
}

gamut_status packed_from(const int64_t *count, size_t blocks, size_t rows, struct packed *p,
                         struct trace *trace)
{
  gamut_status status;
  size_t slot = 0, left = rows;
  TRY(make_room(p, blocks, trace));
  for (size_t b = 0; b < blocks; b++) {
    if (count[b] < 1 || (size_t)count[b] > left) {
      packed_free(p);
      return trace_fail(trace, GAMUT_OUTPUT, "the blocks of points in the checkpoint are damaged");
    }
    p->first[b] = slot;
    p->count[b] = count[b];
    left -= (size_t)count[b];
    slot += ((size_t)count[b] + GAMUT_LANES - 1) / GAMUT_LANES * GAMUT_LANES;
  }
  p->rows = rows;
  p->first[blocks] = blocks > 0 ? slot : rows;
  if (blocks > 0 && left > 0) {
    packed_free(p);
    return trace_fail(trace, GAMUT_OUTPUT, "the blocks of points in the checkpoint are damaged");
  }
done:
  return status;
}

void pack(const struct packed *p, const void *from, void *to)
{
  const uint64_t *slot = from;
  uint64_t *row = to;
  if (p->blocks == 0)
    memcpy(row, slot, p->rows * sizeof *row);
  for (size_t b = 0; b < p->blocks; row += p->count[b++])
    memcpy(row, slot + p->first[b], (size_t)p->count[b] * sizeof *row);
}

void unpack(const struct packed *p, const void *from, void *to)
{
  const uint64_t *row = from;
  uint64_t *slot = to;
  if (p->blocks == 0)
    memcpy(slot, row, p->rows * sizeof *slot);
  for (size_t b = 0; b < p->blocks; row += p->count[b++]) {
    memcpy(slot + p->first[b], row, (size_t)p->count[b] * sizeof *slot);
    for (size_t i = p->first[b] + (size_t)p->count[b]; i < p->first[b + 1]; i++)
      slot[i] = row[p->count[b] - 1];
  }
}
