#include "transfer/transfer.h"

#include "transfer/line.h"
#include "model.h"
#include "transfer/shapes.h"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b) JOIN_(a, b)
#define NAMED(name) JOIN(name, SUFFIX)

#define DIMENSION 1
#define ORDER 1
#define SUFFIX linear_1
#include "transfer/kernels.h"
#define DIMENSION 1
#define ORDER 2
#define SUFFIX quadratic_1
#include "transfer/kernels.h"
#define DIMENSION 2
#define ORDER 1
#define SUFFIX linear_2
#include "transfer/kernels.h"
#define DIMENSION 2
#define ORDER 2
#define SUFFIX quadratic_2
#include "transfer/kernels.h"
#define DIMENSION 3
#define ORDER 1
#define SUFFIX linear_3
#include "transfer/kernels.h"
#define DIMENSION 3
#define ORDER 2
#define SUFFIX quadratic_3
#include "transfer/kernels.h"

#define ENTRY(suffix)                                                                              \
  {                                                                                                \
    .locate = JOIN(locate, suffix), .gather = JOIN(gather, suffix),                                \
    .gather_gradient = JOIN(gather_gradient, suffix), .scatter = JOIN(scatter, suffix),            \
    .scatter_momentum = JOIN(scatter_momentum, suffix)                                             \
  }

/* The cells of three dimensions hold enough points for the lanes of vectors to be points and nodes
 * of one cell, which wastes fewer of them. */
struct transfer transfer_of(unsigned dimension, unsigned order)
{
  static const struct transfer table[3][2] = {{ENTRY(linear_1), ENTRY(quadratic_1)},
                                              {ENTRY(linear_2), ENTRY(quadratic_2)},
                                              {ENTRY(linear_3), ENTRY(quadratic_3)}};
  struct transfer t = table[dimension - 1][order - 1];
  if (dimension == 3)
    transfer_by_cell(&t, order);
  return t;
}
