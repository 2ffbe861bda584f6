/* The transfers with gimp shape functions. */
#include "transfer/transfer.h"

#include <string.h>

#include "transfer/formulas.h"

#define SHAPE gimp
#define DIMENSION 1
#include "transfer/kernels.h"
#define DIMENSION 2
#include "transfer/kernels.h"
#define DIMENSION 3
#include "transfer/kernels.h"

const struct transfer transfers_gimp[3] = {TRANSFER_ENTRY(gimp, 1), TRANSFER_ENTRY(gimp, 2),
                                           TRANSFER_ENTRY(gimp, 3)};
