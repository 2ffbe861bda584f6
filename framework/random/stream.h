/* Counter-based random streams: Philox 4x64 of Random123 (Salmon et al., SC11, 2011). */
#ifndef GAMUT_STREAM_H
#define GAMUT_STREAM_H

#include <gamut/host.h>

/* The stream of a name in one realisation of a seed. */
struct gamut_stream stream_make(uint64_t seed, uint64_t realisation, const char *name);

#endif
