/* An open result. */
#ifndef GAMUT_RESULT_STATE_H
#define GAMUT_RESULT_STATE_H

#include <hdf5.h>

#include "store/result.h"

struct result {
  char *path;
  hid_t file;
  size_t frames;
};

#endif
