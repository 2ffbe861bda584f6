/* A node's line as vectors of the width that the target has in registers: wider ones are taken
 * apart badly by the compiler. */
#ifndef MATERIAL_POINT_METHOD_LINE_H
#define MATERIAL_POINT_METHOD_LINE_H

#include "grid/grid.h"

#if defined(__AVX512F__)
#define WIDTH 8
#elif defined(__AVX__)
#define WIDTH 4
#else
#define WIDTH 2
#endif
typedef double vector __attribute__((vector_size(8 * WIDTH)));
/* Vectors of doubles alias arrays of doubles in GNU C only through may_alias; `loose` ones may lie
 * anywhere. */
typedef vector aliased __attribute__((may_alias));
typedef vector loose __attribute__((may_alias, aligned(8)));

enum { PARTS = NODE_SIZE / WIDTH };

struct line {
  vector part[PARTS];
};

#define INLINE static inline __attribute__((always_inline))

INLINE vector vector_read(const double *p)
{
  return *(const loose *)(const void *)p;
}
INLINE void vector_write(double *p, vector a)
{
  *(loose *)(void *)p = a;
}

typedef int64_t mask __attribute__((vector_size(8 * WIDTH)));

INLINE vector vector_lower(vector a, vector b)
{
  const mask take = a < b;
  return (vector)(((mask)a & take) | ((mask)b & ~take));
}
INLINE vector vector_higher(vector a, vector b)
{
  const mask take = a > b;
  return (vector)(((mask)a & take) | ((mask)b & ~take));
}

INLINE void line_clear(struct line *a)
{
  for (int k = 0; k < PARTS; k++)
    a->part[k] = (vector){0};
}
INLINE void line_read(struct line *a, const double *p)
{
  for (int k = 0; k < PARTS; k++)
    a->part[k] = ((const aliased *)(const void *)p)[k];
}
INLINE void line_write(const struct line *a, double *p)
{
  for (int k = 0; k < PARTS; k++)
    ((aliased *)(void *)p)[k] = a->part[k];
}
/* a -= b */
INLINE void line_subtract(struct line *a, const struct line *b)
{
  for (int k = 0; k < PARTS; k++)
    a->part[k] -= b->part[k];
}
/* a += s b */
INLINE void line_add(struct line *a, double s, const struct line *b)
{
  for (int k = 0; k < PARTS; k++)
    a->part[k] += s * b->part[k];
}
/* a = s b */
INLINE void line_scale(struct line *a, double s, const struct line *b)
{
  for (int k = 0; k < PARTS; k++)
    a->part[k] = s * b->part[k];
}

/* Blocks of three dimensions, as the transfers by cell see them. */
enum { CELL_SIDE = 4, TILE_LINEAR = CELL_SIDE + 3 };

/* One past the last point that follows `i` in its cell. */
INLINE size_t run_end(const int32_t *node, size_t i, size_t count)
{
  const int32_t cell = node[i];
  do
    i++;
  while (i < count && node[i] == cell);
  return i;
}

#endif
