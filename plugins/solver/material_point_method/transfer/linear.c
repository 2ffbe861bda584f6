/* The transfers with linear shape functions. */
#include "transfer/transfer.h"

#include <string.h>

#include "transfer/formulas.h"

#define SHAPE linear
#define DIMENSION 1
#include "transfer/kernels.h"
#define DIMENSION 2
#include "transfer/kernels.h"
#define DIMENSION 3
#include "transfer/kernels.h"

const struct transfer transfers_linear[3] = {TRANSFER_ENTRY(linear, 1), TRANSFER_ENTRY(linear, 2),
                                             TRANSFER_ENTRY(linear, 3)};
