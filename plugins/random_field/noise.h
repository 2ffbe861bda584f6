/* Independent random numbers that both random fields begin with: normal, or the signed Weibull
 * numbers of Desai (2023), Eq. 26. */
#ifndef GAMUT_NOISE_H
#define GAMUT_NOISE_H

#include <gamut/plugin.h>

struct noise {
  bool weibull;
  double scale, shape, divisor;
};

/* Reads the parameters `distribution` (normal, weibull), `scale`, `shape` and `divisor`. */
static inline struct noise noise_read(const struct gamut_values *values, bool weibull)
{
  struct noise noise = {.weibull = weibull,
                        .scale = gamut_real(values, "scale"),
                        .shape = gamut_real(values, "shape"),
                        .divisor = weibull ? 10.0 : 1.0};
  if (gamut_given(values, "divisor"))
    noise.divisor = gamut_real(values, "divisor");
  return noise;
}

static inline double noise_at(const struct noise *noise, const struct gamut_stream *stream,
                              uint64_t index)
{
  if (!noise->weibull)
    return noise->scale * stream->normal(stream, index) / noise->divisor;
  /* One number gives the sign by its half and the size by its place in that half. */
  double u = 2.0 * stream->uniform(stream, index) - 1.0;
  double weight = -log(fabs(u));
  double size = noise->shape == 2.0 ? sqrt(weight) : pow(weight, 1.0 / noise->shape);
  return copysign(noise->scale * size, u) / noise->divisor;
}

/* The noise's value at the probability of the standard normal number z. */
static inline double noise_of_normal(const struct noise *noise, double z)
{
  if (!noise->weibull)
    return noise->scale * z / noise->divisor;
  double size = pow(-log(erfc(fabs(z) / sqrt(2.0))), 1.0 / noise->shape);
  return copysign(noise->scale * size, z) / noise->divisor;
}

/* Probability below a value. */
static inline double noise_below(const struct noise *noise, double value)
{
  double x = value * noise->divisor / noise->scale;
  if (!noise->weibull)
    return 0.5 * erfc(-x / sqrt(2.0));
  double tail = 0.5 * exp(-pow(fabs(x), noise->shape));
  return x < 0.0 ? tail : 1.0 - tail;
}

/* Whether its values are standard normal as they are. */
static inline bool noise_is_standard(const struct noise *noise)
{
  return !noise->weibull && noise->scale == noise->divisor;
}

#endif
