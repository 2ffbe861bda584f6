#include "random/stream.h"

#include <gsl/gsl_cdf.h>

#include <Random123/philox.h>

/* FNV-1a, 64 bits: names become numbers that do not depend on the order of anything. */
static uint64_t hash(const char *text)
{
  uint64_t h = UINT64_C(0xcbf29ce484222325);
  for (; *text; text++)
    h = (h ^ (unsigned char)*text) * UINT64_C(0x100000001b3);
  return h;
}

/* The upper 52 bits, in the middle of their interval: never 0, never 1. */
static double stream_uniform(const struct gamut_stream *stream, uint64_t index)
{
  const philox4x64_ctr_t counter = {{index, stream->realisation, 0, 0}};
  const philox4x64_key_t key = {{stream->seed, stream->name}};
  const philox4x64_ctr_t out = philox4x64(counter, key);
  return ((double)(out.v[0] >> 12) + 0.5) * 0x1p-52;
}

/* By the quantile function: one number an index, whatever else is drawn. */
static double stream_normal(const struct gamut_stream *stream, uint64_t index)
{
  return gsl_cdf_ugaussian_Pinv(stream_uniform(stream, index));
}

struct gamut_stream stream_make(uint64_t seed, uint64_t realisation, const char *name)
{
  return (struct gamut_stream){.seed = seed,
                               .realisation = realisation,
                               .name = hash(name),
                               .normal = stream_normal,
                               .uniform = stream_uniform};
}
