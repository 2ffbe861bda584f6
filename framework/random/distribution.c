#include "random/distribution.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>

/* Parameters of the untruncated law as GSL wants them. */
struct law {
  enum distribution_kind kind;
  double first, second, lower, upper; /* lower and upper: the support */
};

/* Square of the coefficient of variation of a Weibull law of shape k. */
static double weibull_spread(double k)
{
  return expm1(gsl_sf_lngamma(1 + 2 / k) - 2 * gsl_sf_lngamma(1 + 1 / k));
}

static double weibull_shape(double mean, double deviation)
{
  double wanted = deviation / mean * (deviation / mean);
  double low = log(0.05), high = log(1e6); /* the spread falls as the shape grows */
  for (int i = 0; i < 200 && high - low > 4 * DBL_EPSILON; i++) {
    double middle = 0.5 * (low + high);
    if (weibull_spread(exp(middle)) > wanted)
      low = middle;
    else
      high = middle;
  }
  return exp(0.5 * (low + high));
}

static struct law law_of(const struct distribution *d)
{
  struct law law = {d->kind, d->mean, d->deviation, -INFINITY, INFINITY};
  double ratio = d->deviation / d->mean, share, sum;
  switch (d->kind) {
  case DISTRIBUTION_NORMAL:
    break;
  case DISTRIBUTION_LOGNORMAL:
    law.second = sqrt(log1p(ratio * ratio));
    law.first = log(d->mean) - 0.5 * law.second * law.second;
    law.lower = 0;
    break;
  case DISTRIBUTION_WEIBULL:
    law.second = weibull_shape(d->mean, d->deviation);
    law.first = d->mean / exp(gsl_sf_lngamma(1 + 1 / law.second));
    law.lower = 0;
    break;
  case DISTRIBUTION_GAMMA:
    law.first = 1 / (ratio * ratio);
    law.second = d->mean * ratio * ratio;
    law.lower = 0;
    break;
  case DISTRIBUTION_BETA:
    share = (d->mean - d->lower) / (d->upper - d->lower);
    ratio = d->deviation / (d->upper - d->lower);
    sum = share * (1 - share) / (ratio * ratio) - 1;
    law = (struct law){d->kind, share * sum, (1 - share) * sum, d->lower, d->upper};
    break;
  case DISTRIBUTION_TRIANGULAR:
    law = (struct law){d->kind, 3 * d->mean - d->lower - d->upper, 0, d->lower, d->upper};
    break;
  case DISTRIBUTION_UNIFORM:
    law = (struct law){d->kind, 0, 0, d->lower, d->upper};
    break;
  }
  return law;
}

/* Probability below x, or above it: each is exact in its own tail. */
static double tail(const struct law *law, double x, bool above)
{
  double a = law->first, b = law->second, width = law->upper - law->lower;
  if (x <= law->lower || x >= law->upper)
    return (x >= law->upper) != above ? 1 : 0;
  switch (law->kind) {
  case DISTRIBUTION_NORMAL:
    return above ? gsl_cdf_gaussian_Q(x - a, b) : gsl_cdf_gaussian_P(x - a, b);
  case DISTRIBUTION_LOGNORMAL:
    return above ? gsl_cdf_lognormal_Q(x, a, b) : gsl_cdf_lognormal_P(x, a, b);
  case DISTRIBUTION_WEIBULL:
    return above ? gsl_cdf_weibull_Q(x, a, b) : gsl_cdf_weibull_P(x, a, b);
  case DISTRIBUTION_GAMMA:
    return above ? gsl_cdf_gamma_Q(x, a, b) : gsl_cdf_gamma_P(x, a, b);
  case DISTRIBUTION_BETA:
    x = (x - law->lower) / width;
    return above ? gsl_cdf_beta_Q(x, a, b) : gsl_cdf_beta_P(x, a, b);
  case DISTRIBUTION_UNIFORM:
    return above ? gsl_cdf_flat_Q(x, law->lower, law->upper)
                 : gsl_cdf_flat_P(x, law->lower, law->upper);
  case DISTRIBUTION_TRIANGULAR:
    break;
  }
  double left = (x - law->lower) * (x - law->lower) / (width * (a - law->lower));
  double right = (law->upper - x) * (law->upper - x) / (width * (law->upper - a));
  if (above)
    return x > a ? right : 1 - left;
  return x <= a ? left : 1 - right;
}

/* The place where the tail is p, by halving: GSL's own inverses of gamma and beta may not converge.
 */
static double halve(const struct law *law, double p, bool above)
{
  double low = law->lower, high = law->upper;
  if (!isfinite(high))
    for (high = law->first * law->second;; high *= 2)
      if (above ? tail(law, high, true) <= p : tail(law, high, false) >= p)
        break;
  for (int i = 0; i < 1100; i++) {
    double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high)
      break;
    if ((tail(law, middle, above) > p) == above)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

static double inverse(const struct law *law, double p, bool above)
{
  double a = law->first, b = law->second, width = law->upper - law->lower;
  if (p <= 0 || p >= 1)
    return (p >= 1) != above ? law->upper : law->lower;
  switch (law->kind) {
  case DISTRIBUTION_NORMAL:
    return a + (above ? gsl_cdf_gaussian_Qinv(p, b) : gsl_cdf_gaussian_Pinv(p, b));
  case DISTRIBUTION_LOGNORMAL:
    return above ? gsl_cdf_lognormal_Qinv(p, a, b) : gsl_cdf_lognormal_Pinv(p, a, b);
  case DISTRIBUTION_WEIBULL:
    return above ? gsl_cdf_weibull_Qinv(p, a, b) : gsl_cdf_weibull_Pinv(p, a, b);
  case DISTRIBUTION_UNIFORM:
    return above ? law->upper - p * width : law->lower + p * width;
  case DISTRIBUTION_GAMMA:
  case DISTRIBUTION_BETA:
    return halve(law, p, above);
  case DISTRIBUTION_TRIANGULAR:
    break;
  }
  double below_mode = (a - law->lower) / width;
  double below = above ? 1 - p : p, beyond = above ? p : 1 - p;
  if (below <= below_mode)
    return law->lower + sqrt(below * width * (a - law->lower));
  return law->upper - sqrt(beyond * width * (law->upper - a));
}

/* The law has ends of its own, which `lower` and `upper` state. */
static bool bounded(enum distribution_kind kind)
{
  return kind == DISTRIBUTION_UNIFORM || kind == DISTRIBUTION_BETA ||
         kind == DISTRIBUTION_TRIANGULAR;
}

double distribution_quantile(const struct distribution *d, double u)
{
  assert(u > 0 && u < 1);
  struct law law = law_of(d);
  if (!d->truncated || bounded(d->kind))
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
  struct law law = law_of(d);
  bool truncated = d->truncated && !bounded(d->kind), above = z > 0;
  double p = above ? gsl_cdf_ugaussian_Q(z) : gsl_cdf_ugaussian_P(z);
  if (!truncated && law.kind == DISTRIBUTION_NORMAL)
    return law.first + law.second * z;
  if (!truncated && law.kind == DISTRIBUTION_LOGNORMAL)
    return exp(law.first + law.second * z);
  if (!truncated)
    return inverse(&law, p, above);
  bool high = tail(&law, d->lower, false) >= 0.5;
  double within = fabs(tail(&law, d->upper, high) - tail(&law, d->lower, high));
  double x = inverse(&law, tail(&law, above ? d->upper : d->lower, above) + p * within, above);
  return fmin(fmax(x, d->lower), d->upper);
}

double distribution_below(const struct distribution *d, double x)
{
  struct law law = law_of(d);
  if (!d->truncated || bounded(d->kind))
    return tail(&law, x, false);
  if (x <= d->lower || x >= d->upper)
    return x >= d->upper ? 1 : 0;
  bool above = tail(&law, d->lower, false) >= 0.5;
  double from = tail(&law, d->lower, above), to = tail(&law, d->upper, above);
  return (tail(&law, x, above) - from) / (to - from);
}

double distribution_cut(const struct distribution *d)
{
  if (!d->truncated || bounded(d->kind))
    return 0;
  const struct law law = law_of(d);
  return tail(&law, d->lower, false) + tail(&law, d->upper, true);
}
