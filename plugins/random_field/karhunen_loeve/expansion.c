#include <stdlib.h>
#include <string.h>

#include "expansion.h"

/* A heap of products, the largest share on top. */
struct heap {
  struct mode *item;
  size_t count, room;
};

/* Of equal shares the lower number comes first, so that the order is one everywhere. */
static bool before(const struct mode *a, const struct mode *b)
{
  if (a->share != b->share)
    return a->share > b->share;
  for (int k = 0; k < AXES; k++)
    if (a->index[k] != b->index[k])
      return a->index[k] < b->index[k];
  return false;
}

static void swap(struct mode *a, struct mode *b)
{
  struct mode kept = *a;
  *a = *b;
  *b = kept;
}

static bool heap_put(struct heap *heap, struct mode mode)
{
  if (heap->count == heap->room) {
    size_t room = 2 * heap->room + 64;
    struct mode *grown = realloc(heap->item, room * sizeof *grown);
    if (!grown)
      return false;
    heap->item = grown;
    heap->room = room;
  }
  size_t at = heap->count++;
  heap->item[at] = mode;
  for (; at > 0 && before(&heap->item[at], &heap->item[(at - 1) / 2]); at = (at - 1) / 2)
    swap(&heap->item[at], &heap->item[(at - 1) / 2]);
  return true;
}

static struct mode heap_take(struct heap *heap)
{
  struct mode top = heap->item[0];
  heap->item[0] = heap->item[--heap->count];
  for (size_t at = 0;;) {
    size_t first = at;
    for (size_t child = 2 * at + 1; child < 2 * at + 3 && child < heap->count; child++)
      if (before(&heap->item[child], &heap->item[first]))
        first = child;
    if (first == at)
      return top;
    swap(&heap->item[at], &heap->item[first]);
    at = first;
  }
}

static double share_of(const struct expansion *expansion, const struct mode *mode)
{
  double share = 1.0;
  for (int k = 0; k < AXES; k++)
    if (expansion->axis[k].modes)
      share *= expansion->axis[k].share[mode->index[k]];
  return share;
}

/* Every product but the first has one parent: itself with its last nonzero index less by one. */
static bool put_children(const struct expansion *expansion, struct heap *heap,
                         const struct mode *mode)
{
  bool good = true;
  int last = AXES - 1;
  while (last > 0 && mode->index[last] == 0)
    last--;
  for (int k = last; good && k < AXES; k++) {
    struct mode child = *mode;
    if (++child.index[k] >= expansion->axis[k].modes)
      continue;
    child.share = share_of(expansion, &child);
    good = heap_put(heap, child);
  }
  return good;
}

static bool choose_modes(struct expansion *expansion, double energy, size_t modes_max)
{
  struct heap heap = {0};
  struct mode first = {{0}, 0.0};
  first.share = share_of(expansion, &first);
  bool good = (expansion->mode = calloc(modes_max, sizeof *expansion->mode)) != NULL &&
              heap_put(&heap, first);
  while (good && heap.count && expansion->modes < modes_max && expansion->held < energy) {
    struct mode mode = heap_take(&heap);
    expansion->mode[expansion->modes++] = mode;
    expansion->held += mode.share;
    for (int k = 0; k < AXES; k++)
      if (expansion->axis[k].modes && mode.index[k] >= expansion->along[k])
        expansion->along[k] = mode.index[k] + 1;
    good = put_children(expansion, &heap, &mode);
  }
  free(heap.item);
  return good;
}

bool expansion_new(struct expansion *expansion, enum covariance covariance,
                   const double lower[AXES], const double upper[AXES], const double length[AXES],
                   double energy, size_t modes_max)
{
  size_t most = modes_max < MODES_OF_AXIS ? modes_max : MODES_OF_AXIS;
  bool good = true;
  for (int k = 0; good && k < AXES; k++)
    if (upper[k] > lower[k])
      good = axis_new(&expansion->axis[k], covariance, lower[k], upper[k], length[k], most);
  return good && choose_modes(expansion, energy, modes_max);
}

void expansion_free(struct expansion *expansion)
{
  for (int k = 0; k < AXES; k++)
    axis_free(&expansion->axis[k]);
  free(expansion->mode);
}

/* The number that a mode's random variable is keyed by: its place among all products, whatever else
 * is kept. */
static uint64_t key_of(const struct mode *mode)
{
  return mode->index[0] + MODES_OF_AXIS * (mode->index[1] + MODES_OF_AXIS * mode->index[2]);
}

bool expansion_sample(const struct expansion *expansion, const struct gamut_stream *stream,
                      size_t count, const double *const position[AXES], double *value)
{
  const struct axis *axis = expansion->axis;
  size_t room = 0;
  for (int k = 0; k < AXES; k++)
    room = axis[k].nodes > room ? axis[k].nodes : room;
  double *number = calloc(expansion->modes + 1, sizeof *number);
  double *scratch = calloc(2 * room + 1, sizeof *scratch), *along[AXES] = {0};
  bool good = number && scratch;
  for (int k = 0; k < AXES; k++) {
    along[k] = calloc(expansion->along[k] + 1, sizeof(double));
    good = good && along[k];
    if (good && !axis[k].modes)
      along[k][0] = 1.0;
  }
  for (size_t m = 0; good && m < expansion->modes; m++)
    number[m] = stream->normal(stream, key_of(&expansion->mode[m]));
  for (size_t i = 0; good && i < count; i++) {
    double sum = 0.0, variance = 0.0;
    for (int k = 0; k < AXES; k++)
      if (axis[k].modes)
        axis_modes(&axis[k], position[k][i], expansion->along[k], scratch, along[k]);
    for (size_t m = 0; m < expansion->modes; m++) {
      const size_t *index = expansion->mode[m].index;
      double mode = along[0][index[0]] * along[1][index[1]] * along[2][index[2]];
      sum += mode * number[m];
      variance += mode * mode;
    }
    value[i] = expansion->unit_variance ? sum / sqrt(variance) : sum;
  }
  for (int k = 0; k < AXES; k++)
    free(along[k]);
  free(scratch);
  free(number);
  return good;
}
