/* The transfers with cubic shape functions. */
#include "transfer/transfer.h"

#include <string.h>

#include "transfer/formulas.h"

#define SHAPE cubic
#define DIMENSION 1
#include "transfer/kernels.h"
#define DIMENSION 2
#include "transfer/kernels.h"
#define DIMENSION 3
#include "transfer/kernels.h"

const struct transfer transfers_cubic[3] = {TRANSFER_ENTRY(cubic, 1), TRANSFER_ENTRY(cubic, 2),
                                            TRANSFER_ENTRY(cubic, 3)};
