#include "random/distribution_types.h"

#include <assert.h>
#include <math.h>

#include <gsl/gsl_cdf.h>

/* A law and whose it is. */
struct known_law {
  const struct distribution_type *type;
  struct law law;
};

static struct known_law law_of(const struct distribution *d)
{
  return (struct known_law){d->type, d->type->law(d)};
}

/* Probability below x, or above it. */
static double tail(const struct known_law *known, double x, bool above)
{
  const struct law *law = &known->law;
  if (x <= law->lower || x >= law->upper)
    return (x >= law->upper) != above ? 1 : 0;
  return known->type->tail(law, x, above);
}

/* The place where the tail is p. */
static double halve(const struct known_law *known, double p, bool above)
{
  const struct law *law = &known->law;
  double low = law->lower, high = law->upper;
  if (!isfinite(high))
    for (high = law->first * law->second;; high *= 2)
      if (above ? tail(known, high, true) <= p : tail(known, high, false) >= p)
        break;
  for (int i = 0; i < 1100; i++) {
    double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high)
      break;
    if ((tail(known, middle, above) > p) == above)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

static double inverse(const struct known_law *known, double p, bool above)
{
  const struct law *law = &known->law;
  if (p <= 0 || p >= 1)
    return (p >= 1) != above ? law->upper : law->lower;
  return known->type->inverse ? known->type->inverse(law, p, above) : halve(known, p, above);
}

static bool is_cut(const struct distribution *d)
{
  return d->truncated && !d->type->bounded;
}

double distribution_quantile(const struct distribution *d, double u)
{
  assert(u > 0 && u < 1);
  struct known_law law = law_of(d);
  if (!is_cut(d))
    return inverse(&law, u, false);
  double x;
  if (tail(&law, d->lower, false) < 0.5) {
    double from = tail(&law, d->lower, false), to = tail(&law, d->upper, false);
    x = inverse(&law, from + u * (to - from), false);
  } else {
    double from = tail(&law, d->lower, true), to = tail(&law, d->upper, true);
    x = inverse(&law, from + u * (to - from), true);
  }
  return fmin(fmax(x, d->lower), d->upper);
}

double distribution_of_normal(const struct distribution *d, double z)
{
  struct known_law law = law_of(d);
  bool truncated = is_cut(d), above = z > 0;
  double p = above ? gsl_cdf_ugaussian_Q(z) : gsl_cdf_ugaussian_P(z);
  if (!truncated && d->type->of_normal)
    return d->type->of_normal(&law.law, z);
  if (!truncated)
    return inverse(&law, p, above);
  bool high = tail(&law, d->lower, false) >= 0.5;
  double within = fabs(tail(&law, d->upper, high) - tail(&law, d->lower, high));
  double x = inverse(&law, tail(&law, above ? d->upper : d->lower, above) + p * within, above);
  return fmin(fmax(x, d->lower), d->upper);
}

double distribution_below(const struct distribution *d, double x)
{
  struct known_law law = law_of(d);
  if (!is_cut(d))
    return tail(&law, x, false);
  if (x <= d->lower || x >= d->upper)
    return x >= d->upper ? 1 : 0;
  bool above = tail(&law, d->lower, false) >= 0.5;
  double from = tail(&law, d->lower, above), to = tail(&law, d->upper, above);
  return (tail(&law, x, above) - from) / (to - from);
}

double distribution_cut(const struct distribution *d)
{
  if (!is_cut(d))
    return 0;
  const struct known_law law = law_of(d);
  return tail(&law, d->lower, false) + tail(&law, d->upper, true);
}
