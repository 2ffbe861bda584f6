#include "transfer.h"

#include "grid.h"
#include "model.h"
#include "shapes.h"

/* A node's line as vectors of the width that the target has in registers: wider ones are taken
 * apart badly by the compiler. */
#if defined(__AVX512F__)
enum { WIDTH = 8 };
typedef double vector __attribute__((vector_size(64)));
#elif defined(__AVX__)
enum { WIDTH = 4 };
typedef double vector __attribute__((vector_size(32)));
#else
enum { WIDTH = 2 };
typedef double vector __attribute__((vector_size(16)));
#endif
enum { PARTS = LINE / WIDTH };

struct line {
  vector part[PARTS];
};

#define INLINE static inline __attribute__((always_inline))

/* The casts are to vectors of doubles, which alias arrays of doubles in GNU C only through
 * may_alias. */
typedef vector aliased __attribute__((may_alias));

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

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)
#define NAMED(name) JOIN(name, SUFFIX)

#define DIMENSION 1
#define ORDER 1
#define SUFFIX linear_1
#include "transfer_kernels.h"
#define DIMENSION 1
#define ORDER 2
#define SUFFIX quadratic_1
#include "transfer_kernels.h"
#define DIMENSION 2
#define ORDER 1
#define SUFFIX linear_2
#include "transfer_kernels.h"
#define DIMENSION 2
#define ORDER 2
#define SUFFIX quadratic_2
#include "transfer_kernels.h"
#define DIMENSION 3
#define ORDER 1
#define SUFFIX linear_3
#include "transfer_kernels.h"
#define DIMENSION 3
#define ORDER 2
#define SUFFIX quadratic_3
#include "transfer_kernels.h"

#define ENTRY(suffix)                                                                              \
  {                                                                                                \
    JOIN(locate, suffix), JOIN(gather, suffix), JOIN(gather_gradient, suffix),                     \
        JOIN(scatter, suffix), JOIN(scatter_momentum, suffix)                                      \
  }

const struct transfer *transfer_of(unsigned dimension, unsigned order)
{
  static const struct transfer table[3][2] = {{ENTRY(linear_1), ENTRY(quadratic_1)},
                                              {ENTRY(linear_2), ENTRY(quadratic_2)},
                                              {ENTRY(linear_3), ENTRY(quadratic_3)}};
  return &table[dimension - 1][order - 1];
}
