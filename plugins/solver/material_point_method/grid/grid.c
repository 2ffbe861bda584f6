#include "grid/grid.h"

#include <math.h>
#include <string.h>

/* Open addressing on a key made of three places of 21 bits each. */
struct place_table {
  size_t size;   /* a power of two */
  uint64_t *key; /* 0: free */
  int32_t *number;
};

static uint64_t key_of(const int32_t at[3])
{
  uint64_t key = 1;
  for (int k = 2; k >= 0; k--)
    key = key << 21 | (uint64_t)(at[k] + (1 << 20));
  return key;
}

static uint64_t mix(uint64_t x)
{
  x ^= x >> 31;
  x *= UINT64_C(0x7fb5d329728ea185);
  x ^= x >> 27;
  x *= UINT64_C(0x81dadef4bc2dd44d);
  return x ^ x >> 33;
}

static size_t table_slot(const struct place_table *t, uint64_t key)
{
  size_t s = mix(key) & (t->size - 1);
  while (t->key[s] != 0 && t->key[s] != key)
    s = (s + 1) & (t->size - 1);
  return s;
}

int32_t places_find(const struct place_table *t, const int32_t at[3])
{
  if (t == NULL || t->size == 0)
    return -1;
  const size_t s = table_slot(t, key_of(at));
  return t->key[s] == 0 ? -1 : t->number[s];
}

void places_put(struct place_table *t, const int32_t at[3], int32_t number)
{
  const uint64_t key = key_of(at);
  const size_t s = table_slot(t, key);
  t->key[s] = key;
  t->number[s] = number;
}

void places_free(struct gamut_run *run, struct place_table *t)
{
  if (t == NULL)
    return;
  gamut_release(run, t->key);
  gamut_release(run, t->number);
  gamut_release(run, t);
}

static gamut_status table_new(struct gamut_run *run, size_t size, struct place_table **table)
{
  struct place_table *t = gamut_allocate(run, "grid", sizeof *t);
  if (t != NULL) {
    t->size = size;
    t->key = gamut_allocate(run, "grid", size * sizeof *t->key);
    t->number = gamut_allocate(run, "grid", size * sizeof *t->number);
  }
  if (t == NULL || t->key == NULL || t->number == NULL) {
    places_free(run, t);
    return GAMUT_INTERNAL;
  }
  *table = t;
  return GAMUT_OK;
}

gamut_status places_clear(struct gamut_run *run, struct place_table **table, size_t places)
{
  size_t size = 64;
  while (size < 2 * places)
    size *= 2;
  if (*table != NULL && (*table)->size >= size) {
    memset((*table)->key, 0, (*table)->size * sizeof *(*table)->key);
    return GAMUT_OK;
  }
  places_free(run, *table);
  *table = NULL;
  return table_new(run, size, table);
}

gamut_status grid_create(struct grid *g, struct gamut_run *run, unsigned dimension, int nodes,
                         double shift, double cell)
{
  static const int bits[] = {0, 6, 3, 2};
  memset(g, 0, sizeof *g);
  g->run = run;
  g->dimension = dimension;
  g->nodes = nodes;
  g->side_bits = bits[dimension];
  g->side = 1 << g->side_bits;
  g->tile = g->side + 1 + nodes;
  g->neighbours = 1;
  g->block_nodes = g->tile_nodes = 1;
  for (unsigned k = 0; k < dimension; k++) {
    g->neighbours *= 3;
    g->block_nodes *= (size_t)g->side;
    g->tile_nodes *= (size_t)g->tile;
  }
  g->cell = cell;
  g->inverse_cell = 1.0 / cell;
  g->shift = shift;
  return GAMUT_OK;
}

/* Lines of some blocks, taken from the machine at once. */
struct line_page {
  struct line_page *next;
  double line[] __attribute__((aligned(64)));
};
enum { PAGE_BLOCKS = 16 };

void grid_destroy(struct grid *g)
{
  if (g->run == NULL)
    return;
  gamut_release(g->run, g->block);
  places_free(g->run, g->table);
  gamut_release(g->run, g->spare_block);
  places_free(g->run, g->spare_table);
  gamut_release(g->run, g->source);
  while (g->page != NULL) {
    struct line_page *next = g->page->next;
    gamut_release(g->run, g->page);
    g->page = next;
  }
  boxes_destroy(g);
}

/* Free lines hang together by their first bytes. */
static void free_lines(struct grid *g, double *line)
{
  memcpy(line, &g->free_line, sizeof g->free_line);
  g->free_line = line;
}

static gamut_status new_page(struct grid *g)
{
  const size_t doubles = g->block_nodes * NODE_SIZE;
  struct line_page *page =
      gamut_allocate(g->run, "grid", sizeof *page + PAGE_BLOCKS * doubles * sizeof(double));
  if (page == NULL)
    return GAMUT_INTERNAL;
  page->next = g->page;
  g->page = page;
  for (size_t b = PAGE_BLOCKS; b-- > 0;)
    free_lines(g, page->line + b * doubles);
  return GAMUT_OK;
}

gamut_status grid_open(struct grid *g, struct node_block *b)
{
  if (b->line != NULL)
    return GAMUT_OK;
  if (g->free_line == NULL && new_page(g) != GAMUT_OK)
    return GAMUT_INTERNAL;
  b->line = g->free_line;
  memcpy(&g->free_line, b->line, sizeof g->free_line);
  memset(b->line, 0, g->block_nodes * NODE_SIZE * sizeof *b->line);
  g->opened = true;
  return GAMUT_OK;
}

gamut_status grid_open_reached(struct grid *g)
{
  for (size_t i = 0; i < g->sources; i++) {
    struct point_block *s = &g->source[i];
    const uint32_t fresh = s->reach & ~s->opened;
    for (unsigned o = 0; fresh >> o != 0; o++)
      if ((fresh >> o & 1) != 0 &&
          grid_open(g, &g->block[g->block[s->block].neighbour[o]]) != GAMUT_OK)
        return GAMUT_INTERNAL;
    s->opened |= fresh;
  }
  return GAMUT_OK;
}

/* Makes room for `wanted` blocks of nodes, keeping those there are. */
static gamut_status grow(struct grid *g, size_t wanted)
{
  const size_t capacity = wanted + wanted / 8 + 32;
  size_t size = 64;
  while (size < 2 * capacity)
    size *= 2;
  struct place_table *table = NULL;
  if (table_new(g->run, size, &table) != GAMUT_OK)
    return GAMUT_INTERNAL;
  struct node_block *block = gamut_allocate(g->run, "grid", capacity * sizeof *block);
  if (block == NULL) {
    places_free(g->run, table);
    return GAMUT_INTERNAL;
  }
  for (size_t b = 0; b < g->blocks; b++) {
    block[b] = g->block[b];
    places_put(table, block[b].at, (int32_t)b);
  }
  gamut_release(g->run, g->block);
  places_free(g->run, g->table);
  g->block = block;
  g->table = table;
  g->capacity = capacity;
  return GAMUT_OK;
}

#define SWAP(type, a, b)                                                                           \
  do {                                                                                             \
    type swap_ = (a);                                                                              \
    (a) = (b);                                                                                     \
    (b) = swap_;                                                                                   \
  } while (0)

/* Lines that no box reaches are all zero. */
static void free_unreached(struct grid *g)
{
  for (size_t b = 0; b < g->blocks; b++)
    g->block[b].reached = false;
  for (size_t i = 0; i < g->sources; i++) {
    const struct point_block *s = &g->source[i];
    for (unsigned o = 0; s->reach >> o != 0; o++)
      if ((s->reach >> o & 1) != 0)
        g->block[g->block[s->block].neighbour[o]].reached = true;
  }
  for (size_t b = 0; b < g->blocks; b++) {
    struct node_block *block = &g->block[b];
    if (block->line == NULL || block->reached)
      continue;
    free_lines(g, block->line);
    block->line = NULL;
  }
}

gamut_status grid_begin(struct grid *g)
{
  free_unreached(g);
  SWAP(struct node_block *, g->block, g->spare_block);
  SWAP(struct place_table *, g->table, g->spare_table);
  SWAP(size_t, g->capacity, g->spare_capacity);
  g->spare_blocks = g->blocks;
  g->blocks = 0;
  if (g->table == NULL)
    return grow(g, 1);
  memset(g->table->key, 0, g->table->size * sizeof *g->table->key);
  return GAMUT_OK;
}

gamut_status grid_block(struct grid *g, const int32_t at[3], int32_t *number)
{
  *number = places_find(g->table, at);
  if (*number >= 0)
    return GAMUT_OK;
  if (g->blocks == g->capacity && grow(g, g->blocks + 1) != GAMUT_OK)
    return GAMUT_INTERNAL;
  struct node_block *b = &g->block[g->blocks];
  memset(b, 0, sizeof *b);
  for (int k = 0; k < 3; k++)
    b->at[k] = at[k];
  b->source = b->planes = -1;
  *number = (int32_t)g->blocks++;
  places_put(g->table, at, *number);
  return GAMUT_OK;
}

static void neighbour_place(const struct grid *g, const int32_t at[3], unsigned o, int32_t place[3])
{
  for (unsigned k = 0; k < 3; k++) {
    place[k] = k < g->dimension ? at[k] + (int32_t)(o % 3) - 1 : 0;
    o /= 3;
  }
}

gamut_status grid_finish(struct grid *g)
{
  const size_t filled = g->blocks;
  for (size_t b = 0; b < filled; b++) {
    for (unsigned o = 0; o < g->neighbours; o++) {
      int32_t place[3], number;
      neighbour_place(g, g->block[b].at, o, place);
      if (grid_block(g, place, &number) != GAMUT_OK)
        return GAMUT_INTERNAL;
    }
  }
  for (size_t b = 0; b < g->blocks; b++)
    for (unsigned o = 0; o < g->neighbours; o++) {
      int32_t place[3];
      neighbour_place(g, g->block[b].at, o, place);
      g->block[b].neighbour[o] = places_find(g->table, place);
    }
  for (size_t b = 0; b < g->spare_blocks; b++) {
    double *line = g->spare_block[b].line;
    const int32_t now = places_find(g->table, g->spare_block[b].at);
    if (line != NULL && now >= 0)
      g->block[now].line = line;
    else if (line != NULL)
      free_lines(g, line);
  }
  g->spare_blocks = 0;
  return GAMUT_OK;
}

gamut_status grid_sources(struct grid *g, size_t sources)
{
  g->sources = sources;
  if (g->box == NULL && boxes_create(g) != GAMUT_OK)
    return GAMUT_INTERNAL;
  if (sources <= g->source_capacity)
    return GAMUT_OK;
  const size_t capacity = sources + sources / 4 + 4;
  gamut_release(g->run, g->source);
  g->source = gamut_allocate(g->run, "grid", capacity * sizeof *g->source);
  g->source_capacity = g->source != NULL ? capacity : 0;
  return g->source_capacity == 0 ? GAMUT_INTERNAL : GAMUT_OK;
}

void grid_source(struct grid *g, size_t index, int32_t block)
{
  struct point_block *s = &g->source[index];
  s->block = block;
  s->next = -1;
  s->box = NULL;
  s->reach = s->opened = 0;
  for (unsigned k = 0; k < 3; k++) {
    s->lower[k] = 0;
    s->upper[k] = k < g->dimension ? g->tile : 1;
  }
  int32_t *link = &g->block[block].source;
  while (*link >= 0)
    link = &g->source[*link].next;
  *link = (int32_t)index;
}

struct node_block *grid_block_at(const struct grid *g, const int32_t node[3], size_t *index)
{
  int32_t at[3] = {0, 0, 0};
  size_t stride = 1;
  *index = 0;
  for (unsigned k = 0; k < g->dimension; k++) {
    at[k] = grid_block_of(g, node[k]);
    *index += stride * (size_t)(node[k] - at[k] * g->side);
    stride *= (size_t)g->side;
  }
  const int32_t b = places_find(g->table, at);
  return b < 0 ? NULL : &g->block[b];
}

bool grid_reachable(const struct grid *g, const struct node_block *b, int lower[3], int upper[3])
{
  bool any = false;
  for (unsigned k = 0; k < 3; k++) {
    lower[k] = k < g->dimension ? g->side : 0;
    upper[k] = k < g->dimension ? 0 : 1;
  }
  for (unsigned o = 0; o < g->neighbours; o++) {
    if (b->neighbour[o] < 0 || g->block[b->neighbour[o]].source < 0)
      continue;
    any = true;
    for (unsigned k = 0, rest = o; k < g->dimension; k++, rest /= 3) {
      /* the tile of points there, in nodes of this block */
      const int from = g->side * ((int)(rest % 3) - 1) - 1, to = from + g->tile;
      lower[k] = from < lower[k] ? from : lower[k];
      upper[k] = to > upper[k] ? to : upper[k];
    }
  }
  for (unsigned k = 0; k < g->dimension; k++) {
    lower[k] = lower[k] > 0 ? lower[k] : 0;
    upper[k] = upper[k] < g->side ? upper[k] : g->side;
    any = any && lower[k] < upper[k];
  }
  return any;
}

void grid_node(const struct grid *g, const struct node_block *b, size_t index, int32_t node[3])
{
  for (unsigned k = 0; k < 3; k++) {
    node[k] = k < g->dimension ? b->at[k] * g->side + (int32_t)(index % (size_t)g->side) : 0;
    index /= (size_t)g->side;
  }
}
