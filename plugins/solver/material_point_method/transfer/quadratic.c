/* The transfers with quadratic shape functions. */
#include "transfer/transfer.h"

#include <string.h>

#include "transfer/formulas.h"

#define SHAPE quadratic
#define DIMENSION 1
#include "transfer/kernels.h"
#define DIMENSION 2
#include "transfer/kernels.h"
#define DIMENSION 3
#include "transfer/kernels.h"

const struct transfer transfers_quadratic[3] = {
    TRANSFER_ENTRY(quadratic, 1), TRANSFER_ENTRY(quadratic, 2), TRANSFER_ENTRY(quadratic, 3)};
