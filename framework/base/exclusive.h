/* Libraries that keep variables of their own (HDF5, UDUNITS, libltdl, muParser) are called by one
 * thread of the process at a time: sessions of a program that embeds us, and runs of a study, share
 * them. The lock is the process's, not an object's, as those variables are. */
#ifndef GAMUT_EXCLUSIVE_H
#define GAMUT_EXCLUSIVE_H

#include <stdbool.h>

void exclusive_begin(void);
void exclusive_end(const int *);

/* Whether this thread is within such a block. */
bool exclusive_is_mine(void);

/* As the first line of a block: this thread alone until the block is left, in whatever way. May be
 * nested. No plugin is called and no team of threads is started within. */
#define EXCLUSIVE                                                                                  \
  __attribute__((cleanup(exclusive_end), unused)) const int exclusive_here = (exclusive_begin(), 0)

#endif
