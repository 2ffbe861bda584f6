/* Sorts the points of each body by block and by cell, and builds the grid around them anew. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

static const uint32_t padding = UINT32_C(1) << 31;

static gamut_status room_for_points(struct model *m, size_t slots)
{
  if (slots <= m->scratch_capacity)
    return GAMUT_OK;
  const size_t capacity = slots + slots / 64 + 64;
  gamut_release(m->run, m->scratch_source);
  gamut_release(m->run, m->scratch_block);
  gamut_release(m->run, m->scratch_cell);
  m->scratch_source = gamut_allocate(m->run, "sort", 2 * capacity * sizeof *m->scratch_source);
  m->scratch_block = gamut_allocate(m->run, "sort", capacity * sizeof *m->scratch_block);
  m->scratch_cell = gamut_allocate(m->run, "sort", capacity * sizeof *m->scratch_cell);
  const bool good =
      m->scratch_source != NULL && m->scratch_block != NULL && m->scratch_cell != NULL;
  m->scratch_capacity = good ? capacity : 0;
  return good ? GAMUT_OK : GAMUT_INTERNAL;
}

/* Counts of points by block of nodes; kept when there are more blocks. */
static gamut_status room_for_blocks(struct model *m, size_t blocks)
{
  if (blocks <= m->scratch_blocks)
    return GAMUT_OK;
  const size_t capacity = 2 * blocks + 64;
  int32_t *larger = gamut_allocate(m->run, "sort", capacity * sizeof *larger);
  if (larger == NULL)
    return GAMUT_INTERNAL;
  if (m->scratch_blocks > 0)
    memcpy(larger, m->scratch_count, m->scratch_blocks * sizeof *larger);
  gamut_release(m->run, m->scratch_count);
  m->scratch_count = larger;
  m->scratch_blocks = capacity;
  return GAMUT_OK;
}

/* The block and the cell in it of each point of a set. */
static gamut_status locate_set(struct model *m, const struct gamut_set *set, size_t slots)
{
  struct grid *g = &m->grid;
  const double *x[3], *v[3];
  for (unsigned k = 0; k < 3; k++) {
    x[k] = m->host->stored(set, m->field.position, k);
    v[k] = m->host->stored(set, m->field.velocity, k);
  }
  int32_t last[3] = {0, 0, 0}, number = -1;
  for (size_t i = 0; i < slots; i++) {
    if (set->blocks > 0 && set->id[i] < 0) {
      m->scratch_block[i] = -1;
      continue;
    }
    int32_t at[3] = {0, 0, 0}, cell = 0;
    for (unsigned k = 0; k < m->dimension; k++) {
      const double place = (x[k][i] - g->origin[k]) * g->inverse_cell - g->shift;
      if (!(fabs(place) < GRID_REACH)) {
        const double p[3] = {x[0][i], x[1][i], x[2][i]}, s[3] = {v[0][i], v[1][i], v[2][i]};
        return point_failed(m, set, i, p, s, "it is a million cells away");
      }
      const int32_t global = (int32_t)floor(place);
      at[k] = grid_block_of(g, global);
      cell += (global - at[k] * g->side) << (k * (unsigned)g->side_bits);
    }
    if (number < 0 || memcmp(at, last, sizeof at) != 0) {
      if (grid_block(g, at, &number) != GAMUT_OK || room_for_blocks(m, g->blocks) != GAMUT_OK)
        return GAMUT_INTERNAL;
      memcpy(last, at, sizeof at);
    }
    m->scratch_block[i] = number;
    m->scratch_cell[i] = (uint16_t)cell;
  }
  return GAMUT_OK;
}

/* Stable order of one block's slots by cell: counting sort from `from` to `to`. */
static void sort_cells(const struct model *m, const uint32_t *from, size_t count, uint32_t *to)
{
  uint32_t start[65] = {0};
  for (size_t i = 0; i < count; i++)
    start[m->scratch_cell[from[i]] + 1]++;
  for (int c = 0; c < 64; c++)
    start[c + 1] += start[c];
  for (size_t i = 0; i < count; i++)
    to[start[m->scratch_cell[from[i]]]++] = from[i];
}

/* Blocks of a set in the order of their places: x fastest. */
static size_t order_blocks(struct model *m, int32_t *list)
{
  const struct node_block *block = m->grid.block;
  size_t count = 0;
  for (size_t b = 0; b < m->grid.blocks; b++) {
    if (m->scratch_count[b] == 0)
      continue;
    size_t at = count++;
    for (; at > 0; at--) {
      const int32_t *a = block[b].at, *c = block[list[at - 1]].at;
      if (a[2] > c[2] || (a[2] == c[2] && (a[1] > c[1] || (a[1] == c[1] && a[0] > c[0]))))
        break;
      list[at] = list[at - 1];
    }
    list[at] = (int32_t)b;
  }
  return count;
}

/* Sorts one set. On return list holds its blocks of nodes in order. */
static gamut_status sort_set(struct model *m, struct gamut_set *set, int32_t *list, size_t *first)
{
  const size_t slots = set->blocks > 0 ? set->slots : set->points;
  memset(m->scratch_count, 0, m->grid.blocks * sizeof *m->scratch_count);
  for (size_t i = 0; i < slots; i++)
    if (m->scratch_block[i] >= 0)
      m->scratch_count[m->scratch_block[i]]++;
  const size_t blocks = order_blocks(m, list);
  size_t at = 0;
  for (size_t b = 0; b < blocks; b++) {
    const size_t count = (size_t)m->scratch_count[list[b]];
    first[b] = at;
    m->scratch_count[list[b]] = (int32_t)at;
    at += (count + GAMUT_LANES - 1) / GAMUT_LANES * GAMUT_LANES;
  }
  first[blocks] = at;
  if (at > m->scratch_capacity)
    return gamut_fail(m->run, GAMUT_INTERNAL, "no room to sort");
  uint32_t *plain = m->scratch_source, *sorted = plain + m->scratch_capacity;
  for (size_t i = 0; i < slots; i++)
    if (m->scratch_block[i] >= 0)
      plain[m->scratch_count[m->scratch_block[i]]++] = (uint32_t)i;
  for (size_t b = 0; b < blocks; b++) {
    const size_t count = (size_t)m->scratch_count[list[b]] - first[b];
    sort_cells(m, plain + first[b], count, sorted + first[b]);
    for (size_t i = first[b] + count; i < first[b + 1]; i++)
      sorted[i] = sorted[first[b] + count - 1] | padding;
  }
  return m->host->arrange(m->run, set, sorted, at, first, blocks);
}

static gamut_status room_for_sums(struct model *m)
{
  if (m->grid.sources > m->block_capacity) {
    const size_t capacity = m->grid.sources + m->grid.sources / 2 + 16;
    gamut_release(m->run, m->block_sum);
    gamut_release(m->run, m->block_omega);
    m->block_sum = gamut_allocate(m->run, "sums", capacity * POINT_SUMS * sizeof *m->block_sum);
    m->block_omega = gamut_allocate(m->run, "sums", capacity * sizeof *m->block_omega);
    m->block_capacity = m->block_sum != NULL && m->block_omega != NULL ? capacity : 0;
    if (m->block_capacity == 0)
      return GAMUT_INTERNAL;
  }
  if (m->grid.blocks > m->node_capacity) {
    const size_t capacity = m->grid.blocks + m->grid.blocks / 2 + 16;
    gamut_release(m->run, m->node_sum);
    m->node_sum = gamut_allocate(m->run, "sums", capacity * sizeof *m->node_sum);
    m->node_capacity = m->node_sum != NULL ? capacity : 0;
    if (m->node_capacity == 0)
      return GAMUT_INTERNAL;
  }
  return removal_room(m);
}

/* Sorts every set and notes, source by source, the blocks of nodes they lie in. */
static gamut_status sort_sets(struct model *m, int32_t **list)
{
  size_t sources = 0, total = 0;
  for (size_t i = 0; i < m->bodies; i++)
    total += m->grid.blocks;
  size_t *first = gamut_allocate(m->run, "sort", (m->grid.blocks + 1) * sizeof *first);
  *list = gamut_allocate(m->run, "sort", (total + 1) * sizeof **list);
  gamut_status status = first == NULL || *list == NULL ? GAMUT_INTERNAL : GAMUT_OK;
  for (size_t i = 0; i < m->bodies && status == GAMUT_OK; i++) {
    struct gamut_set *set = m->body[i].set;
    const size_t slots = set->blocks > 0 ? set->slots : set->points;
    /* padding of every block of this set must fit, whatever their number becomes */
    const size_t room = m->scratch_capacity;
    status = room_for_points(m, slots + GAMUT_LANES * m->grid.blocks);
    /* of a single set find_blocks has left the places */
    const bool known = m->bodies == 1 && room == m->scratch_capacity;
    if (status == GAMUT_OK && !known)
      status = locate_set(m, set, slots);
    if (status == GAMUT_OK)
      status = sort_set(m, set, *list + sources, first);
    if (status == GAMUT_OK)
      sources += set->blocks;
  }
  gamut_release(m->run, first);
  if (status == GAMUT_OK)
    status = grid_sources(&m->grid, sources);
  return status;
}

/* Enters all blocks of all sets, so that their number is known. */
static gamut_status find_blocks(struct model *m)
{
  gamut_status status = grid_begin(&m->grid);
  for (size_t i = 0; i < m->bodies && status == GAMUT_OK; i++) {
    const struct gamut_set *set = m->body[i].set;
    const size_t slots = set->blocks > 0 ? set->slots : set->points;
    status = room_for_points(m, slots);
    if (status == GAMUT_OK)
      status = locate_set(m, set, slots);
  }
  return status;
}

gamut_status sort_points(struct model *m)
{
  int32_t *list = NULL;
  gamut_status status = find_blocks(m);
  if (status == GAMUT_OK)
    status = sort_sets(m, &list);
  if (status == GAMUT_OK)
    status = grid_finish(&m->grid);
  if (status == GAMUT_OK)
    for (size_t s = 0; s < m->grid.sources; s++)
      grid_source(&m->grid, s, list[s]);
  gamut_release(m->run, list);
  if (status == GAMUT_OK)
    status = room_for_sums(m);
  if (status == GAMUT_OK)
    status = planes_find(m);
  m->moved = 0.0;
  return status;
}
