#include "transfer/transfer.h"

/* The cells of three dimensions hold enough points for the lanes of vectors to be points and nodes
 * of one cell, which wastes fewer of them. */
struct transfer transfer_of(unsigned dimension, enum shape shape, bool affine)
{
  static const struct transfer *const table[SHAPES] = {transfers_linear, transfers_gimp,
                                                       transfers_quadratic, transfers_cubic};
  struct transfer t = table[shape][dimension - 1];
  if (dimension == 3)
    gather_by_cell(&t, shape);
  if (dimension == 3 && shape == SHAPE_LINEAR && !affine)
    scatter_by_cell(&t);
  return t;
}
