/* Sorts the points of each body by block and by cell, and builds the grid around them anew. Threads
 * work on ranges of slots or on blocks; the order that comes out is one and the same. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

static const uint32_t padding = UINT32_C(1) << 31;

/* Below so many slots threads cost more than they give. */
enum { FEW_SLOTS = 1 << 14, PIECE = 128, CELLS = 64 };

/* What only a sort needs; the boxes' memory makes room for it. */
struct sorting {
  size_t slots, most; /* of all sets, and of the largest */
  size_t blocks;      /* of nodes, as numbered before the sort */
  int32_t *block;     /* that a slot's point lies in, or one of the two below */
  uint16_t *cell;     /* in the block */
  int32_t *count;     /* of points, by range of slots and block; then where the next one goes */
  uint32_t *plain;    /* slots of one set by block, */
  uint32_t *sorted;   /* and by cell as well */
  size_t room;        /* slots in each of these */
};
enum { NO_POINT = -1, NO_BLOCK = -2 };

struct place {
  int32_t at[3], block;
};

static size_t slots_of(const struct gamut_set *set)
{
  return set->blocks > 0 ? set->slots : set->points;
}

static int ranges_of(const struct model *m, size_t slots)
{
  return slots < FEW_SLOTS ? 1 : m->threads;
}

static size_t range_start(size_t slots, int range, int ranges)
{
  return slots * (size_t)range / (size_t)ranges / PIECE * PIECE;
}

static size_t range_end(size_t slots, int range, int ranges)
{
  return range + 1 == ranges ? slots : range_start(slots, range + 1, ranges);
}

static size_t aligned(size_t bytes)
{
  return (bytes + 63) & ~(size_t)63;
}

/* Room for all; what `block` and `cell` hold already is kept. */
static gamut_status make_room(struct model *m, struct sorting *s)
{
  const size_t block = aligned(s->slots * sizeof *s->block);
  const size_t kept = block + aligned(s->slots * sizeof *s->cell);
  const size_t count = aligned((size_t)m->threads * s->blocks * sizeof *s->count);
  s->room = s->blocks > 0 ? s->most + GAMUT_LANES * s->blocks : 0;
  const size_t list = aligned(s->room * sizeof *s->plain);
  char *memory = grid_lend(&m->grid, kept + count + 2 * list, s->blocks > 0 ? kept : 0);
  if (memory == NULL)
    return GAMUT_INTERNAL;
  s->block = (int32_t *)(void *)memory;
  s->cell = (uint16_t *)(void *)(memory + block);
  s->count = (int32_t *)(void *)(memory + kept);
  s->plain = (uint32_t *)(void *)(memory + kept + count);
  s->sorted = (uint32_t *)(void *)(memory + kept + count + list);
  return GAMUT_OK;
}

/* ---- where points are -------------------------------------------------------------------------
 */

/* Places of blocks of `count` points and their cells in them; false where one lies nowhere. */
static bool place_points(const struct model *m, double *const x[3], size_t slot, size_t count,
                         int32_t at[3][PIECE], uint16_t *restrict cell)
{
  const struct grid *g = &m->grid;
  const double scale = g->inverse_cell, shift = g->shift;
  int far = 0;
  memset(at, 0, 3 * sizeof *at);
  memset(cell, 0, count * sizeof *cell);
  for (unsigned k = 0; k < m->dimension; k++) {
    const double *restrict from = x[k] + slot, origin = g->origin[k];
    int32_t *restrict to = at[k];
    const int bits = g->side_bits, last = g->side - 1, up = (int)k * bits;
#pragma omp simd reduction(| : far)
    for (size_t i = 0; i < count; i++) {
      const double place = (from[i] - origin) * scale - shift;
      const int good = fabs(place) < GRID_REACH;
      const int32_t global = (int32_t)floor(good ? place : 0.0);
      far |= !good;
      to[i] = global >> bits;
      cell[i] = (uint16_t)(cell[i] + ((global & last) << up));
    }
  }
  return far == 0;
}

/* Names the point of a piece that lies nowhere, if it is one. */
static gamut_status find_far(struct model *m, const struct gamut_set *set, size_t slot,
                             size_t count)
{
  for (size_t i = slot; i < slot + count; i++) {
    double x[3], v[3];
    bool far = false;
    for (unsigned k = 0; k < 3; k++) {
      x[k] = m->host->stored(set, m->field.position, k)[i];
      v[k] = m->host->stored(set, m->field.velocity, k)[i];
      far |= k < m->dimension && !(fabs((x[k] - m->grid.origin[k]) * m->grid.inverse_cell -
                                        m->grid.shift) < GRID_REACH);
    }
    if (far && !(set->blocks > 0 && set->id[i] < 0))
      return point_failed(m, set, i, x, v, "it is a million cells away");
  }
  return GAMUT_OK;
}

/* Blocks and cells of the points of a range, by the grid as it is; false where it lacks a block. */
static bool locate_range(const struct model *m, const struct gamut_set *set, size_t slot,
                         size_t end, int32_t *block, uint16_t *cell)
{
  int32_t at[3][PIECE], last[3] = {0, 0, 0}, number = NO_BLOCK;
  bool all = true;
  double *x[3];
  for (unsigned k = 0; k < 3; k++)
    x[k] = m->host->stored(set, m->field.position, k);
  for (size_t count; slot < end; slot += count) {
    count = end - slot < PIECE ? end - slot : PIECE;
    all &= place_points(m, x, slot, count, at, cell + slot);
    for (size_t i = 0; i < count; i++) {
      const int32_t here[3] = {at[0][i], at[1][i], at[2][i]};
      if (number < 0 || here[0] != last[0] || here[1] != last[1] || here[2] != last[2]) {
        number = places_find(m->grid.table, here);
        number = number < 0 ? NO_BLOCK : number;
        memcpy(last, here, sizeof last);
      }
      block[slot + i] = set->blocks > 0 && set->id[slot + i] < 0 ? NO_POINT : number;
      all &= block[slot + i] != NO_BLOCK;
    }
  }
  return all;
}

/* Gives the grid the blocks that points of a set lack in it. */
static gamut_status add_blocks(struct model *m, const struct gamut_set *set, int32_t *block,
                               uint16_t *cell)
{
  double *x[3];
  for (unsigned k = 0; k < 3; k++)
    x[k] = m->host->stored(set, m->field.position, k);
  for (size_t slot = 0, end = slots_of(set), count; slot < end; slot += count) {
    int32_t at[3][PIECE];
    count = end - slot < PIECE ? end - slot : PIECE;
    if (!place_points(m, x, slot, count, at, cell + slot)) {
      const gamut_status status = find_far(m, set, slot, count);
      if (status != GAMUT_OK)
        return status;
    }
    for (size_t i = 0; i < count; i++) {
      const int32_t here[3] = {at[0][i], at[1][i], at[2][i]};
      if (block[slot + i] == NO_BLOCK &&
          grid_block(&m->grid, here, &block[slot + i]) != GAMUT_OK)
        return GAMUT_INTERNAL;
    }
  }
  return GAMUT_OK;
}

/* The block, as numbered so far, and the cell of every point of all sets. */
static gamut_status locate_all(struct model *m, struct sorting *s)
{
  gamut_status status = GAMUT_OK;
  size_t from = 0;
  for (size_t i = 0; i < m->bodies && status == GAMUT_OK; i++) {
    const struct gamut_set *set = m->body[i].set;
    const size_t slots = slots_of(set);
    const int ranges = ranges_of(m, slots);
    int32_t *block = s->block + from;
    uint16_t *cell = s->cell + from;
    int lacking = 0;
#pragma omp parallel for schedule(static, 1) num_threads(ranges) reduction(| : lacking)
    for (int r = 0; r < ranges; r++)
      lacking |= !locate_range(m, set, range_start(slots, r, ranges), range_end(slots, r, ranges),
                               block, cell);
    if (lacking)
      status = add_blocks(m, set, block, cell);
    from += slots;
  }
  s->blocks = m->grid.blocks;
  return status;
}

/* ---- order ------------------------------------------------------------------------------------
 */

/* Whether the highest bit of `a` lies below that of `b`. */
static bool bit_below(uint32_t a, uint32_t b)
{
  return a < b && a < (a ^ b);
}

/* Morton order, which keeps neighbours near each other in every direction: the axis in which two
 * places differ in the highest bit decides, the last of several (Chan, Closest-point problems
 * simplified on the RAM, 2002). */
static int compare(const void *one, const void *other)
{
  static const uint32_t sign = UINT32_C(1) << 31; /* places may be negative */
  const struct place *a = one, *b = other;
  uint32_t most = 0;
  int axis = 0;
  for (int k = 2; k >= 0; k--) {
    const uint32_t differ = (uint32_t)a->at[k] ^ (uint32_t)b->at[k];
    if (bit_below(most, differ)) {
      most = differ;
      axis = k;
    }
  }
  const uint32_t left = (uint32_t)a->at[axis] ^ sign, right = (uint32_t)b->at[axis] ^ sign;
  return (left > right) - (left < right);
}

static size_t points_in(const struct sorting *s, size_t block, int ranges)
{
  size_t points = 0;
  for (int r = 0; r < ranges; r++)
    points += (size_t)s->count[(size_t)r * s->blocks + block];
  return points;
}

/* Blocks that hold points of the set, in order. */
static size_t order_blocks(const struct model *m, const struct sorting *s, int ranges,
                           struct place *list)
{
  size_t count = 0;
  for (size_t b = 0; b < s->blocks; b++) {
    if (points_in(s, b, ranges) == 0)
      continue;
    memcpy(list[count].at, m->grid.block[b].at, sizeof list[count].at);
    list[count++].block = (int32_t)b;
  }
  qsort(list, count, sizeof *list, compare);
  return count;
}

static void count_range(const struct sorting *s, const int32_t *block, size_t slot, size_t end,
                        int32_t *count)
{
  memset(count, 0, s->blocks * sizeof *count);
  for (; slot < end; slot++)
    if (block[slot] >= 0)
      count[block[slot]]++;
}

/* Where blocks begin, and where in them the points of each range go. */
static void deal(const struct sorting *s, const struct place *list, size_t blocks, int ranges,
                 size_t *first)
{
  size_t at = 0;
  for (size_t b = 0; b < blocks; b++) {
    size_t next = at;
    first[b] = at;
    for (int r = 0; r < ranges; r++) {
      int32_t *count = &s->count[(size_t)r * s->blocks + (size_t)list[b].block];
      const size_t points = (size_t)*count;
      *count = (int32_t)next;
      next += points;
    }
    at += (next - at + GAMUT_LANES - 1) / GAMUT_LANES * GAMUT_LANES;
  }
  first[blocks] = at;
}

/* Stable order of one block's slots by cell, and its padding. */
static void sort_cells(const struct sorting *s, const uint16_t *cell, size_t first, size_t count,
                       size_t end)
{
  const uint32_t *from = s->plain + first;
  uint32_t *to = s->sorted + first, start[CELLS + 1] = {0};
  for (size_t i = 0; i < count; i++)
    start[cell[from[i]] + 1]++;
  for (int c = 0; c < CELLS; c++)
    start[c + 1] += start[c];
  for (size_t i = 0; i < count; i++)
    to[start[cell[from[i]]]++] = from[i];
  for (size_t i = count; first + i < end; i++)
    to[i] = to[count - 1] | padding;
}

/* Sorts one set, whose slots begin at `from` among those of all. On return list holds its blocks
 * of nodes in order. */
static gamut_status sort_set(struct model *m, const struct sorting *s, size_t from,
                             struct gamut_set *set, struct place *list, size_t *first)
{
  const size_t slots = slots_of(set);
  const int ranges = ranges_of(m, slots);
  const int32_t *block = s->block + from;
#pragma omp parallel for schedule(static, 1) num_threads(ranges)
  for (int r = 0; r < ranges; r++)
    count_range(s, block, range_start(slots, r, ranges), range_end(slots, r, ranges),
                s->count + (size_t)r * s->blocks);
  const size_t blocks = order_blocks(m, s, ranges, list);
  deal(s, list, blocks, ranges, first);
#pragma omp parallel for schedule(static, 1) num_threads(ranges)
  for (int r = 0; r < ranges; r++) {
    int32_t *next = s->count + (size_t)r * s->blocks;
    const size_t end = range_end(slots, r, ranges);
    for (size_t i = range_start(slots, r, ranges); i < end; i++)
      if (block[i] >= 0)
        s->plain[next[block[i]]++] = (uint32_t)i;
  }
  const int32_t *last = s->count + (size_t)(ranges - 1) * s->blocks;
#pragma omp parallel for schedule(dynamic, 8) num_threads(ranges)
  for (size_t b = 0; b < blocks; b++)
    sort_cells(s, s->cell + from, first[b], (size_t)last[list[b].block] - first[b], first[b + 1]);
  return m->host->arrange(m->run, set, s->sorted, first[blocks], first, blocks);
}

/* Sorts every set; `list` then has, source by source, the places they lie in. */
static gamut_status sort_sets(struct model *m, const struct sorting *s, struct place *list,
                              size_t *sources)
{
  size_t *first = gamut_allocate(m->run, "sort", (s->blocks + 1) * sizeof *first), from = 0;
  gamut_status status = first == NULL ? GAMUT_INTERNAL : GAMUT_OK;
  for (size_t i = 0; i < m->bodies && status == GAMUT_OK; i++) {
    struct gamut_set *set = m->body[i].set;
    const size_t slots = slots_of(set);
    status = sort_set(m, s, from, set, list + *sources, first);
    from += slots;
    *sources += set->blocks;
  }
  gamut_release(m->run, first);
  return status;
}

/* ---- the grid ---------------------------------------------------------------------------------
 */

/* The grid around these places, with a source in each. */
static gamut_status build_grid(struct model *m, const struct place *list, size_t sources)
{
  struct grid *g = &m->grid;
  int32_t number = -1;
  grid_take_back(g);
  gamut_status status = grid_begin(g);
  for (size_t i = 0; i < sources && status == GAMUT_OK; i++)
    status = grid_block(g, list[i].at, &number);
  if (status == GAMUT_OK)
    status = grid_finish(g);
  if (status == GAMUT_OK)
    status = grid_sources(g, sources);
  for (size_t i = 0; i < sources && status == GAMUT_OK; i++)
    grid_source(g, i, places_find(g->table, list[i].at));
  return status;
}

gamut_status sort_points(struct model *m)
{
  struct sorting s = {0};
  size_t sources = 0;
  for (size_t i = 0; i < m->bodies; i++) {
    const size_t slots = slots_of(m->body[i].set);
    s.slots += slots;
    s.most = slots > s.most ? slots : s.most;
  }
  gamut_status status = make_room(m, &s);
  if (status == GAMUT_OK)
    status = locate_all(m, &s);
  if (status == GAMUT_OK)
    status = make_room(m, &s);
  struct place *list =
      gamut_allocate(m->run, "sort", (m->bodies * s.blocks + 1) * sizeof *list);
  if (status == GAMUT_OK)
    status = list == NULL ? GAMUT_INTERNAL : sort_sets(m, &s, list, &sources);
  if (status == GAMUT_OK)
    status = build_grid(m, list, sources);
  gamut_release(m->run, list);
  if (status == GAMUT_OK)
    status = totals_room(m);
  if (status == GAMUT_OK)
    status = planes_find(m);
  m->moved = 0.0;
  *m->counts.sorts += 1;
  return status;
}
