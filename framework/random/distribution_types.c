/* The distributions that a random parameter may have: one struct each, and the list at the end. */
#include <float.h>
#include <math.h>
#include <string.h>

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>

#include "base/array.h"
#include "random/distribution_types.h"

static struct law normal_law(const struct distribution *d)
{
  return (struct law){d->mean, d->deviation, -INFINITY, INFINITY};
}

static double normal_tail(const struct law *law, double x, bool above)
{
  const double from = x - law->first;
  return above ? gsl_cdf_gaussian_Q(from, law->second) : gsl_cdf_gaussian_P(from, law->second);
}

static double normal_inverse(const struct law *law, double p, bool above)
{
  const double b = law->second;
  return law->first + (above ? gsl_cdf_gaussian_Qinv(p, b) : gsl_cdf_gaussian_Pinv(p, b));
}

static double normal_of_normal(const struct law *law, double z)
{
  return law->first + law->second * z;
}

static const struct distribution_type normal = {.name = "normal",
                                                .law = normal_law,
                                                .tail = normal_tail,
                                                .inverse = normal_inverse,
                                                .of_normal = normal_of_normal};

static struct law lognormal_law(const struct distribution *d)
{
  const double ratio = d->deviation / d->mean, width = sqrt(log1p(ratio * ratio));
  return (struct law){log(d->mean) - 0.5 * width * width, width, 0, INFINITY};
}

static double lognormal_tail(const struct law *law, double x, bool above)
{
  return above ? gsl_cdf_lognormal_Q(x, law->first, law->second)
               : gsl_cdf_lognormal_P(x, law->first, law->second);
}

static double lognormal_inverse(const struct law *law, double p, bool above)
{
  return above ? gsl_cdf_lognormal_Qinv(p, law->first, law->second)
               : gsl_cdf_lognormal_Pinv(p, law->first, law->second);
}

static double lognormal_of_normal(const struct law *law, double z)
{
  return exp(law->first + law->second * z);
}

static const struct distribution_type lognormal = {.name = "lognormal",
                                                   .positive = true,
                                                   .law = lognormal_law,
                                                   .tail = lognormal_tail,
                                                   .inverse = lognormal_inverse,
                                                   .of_normal = lognormal_of_normal};

static const char *uniform_complete(struct distribution *d, const char **expected)
{
  (void)expected;
  d->mean = 0.5 * (d->lower + d->upper);
  d->deviation = (d->upper - d->lower) / sqrt(12.);
  return NULL;
}

static struct law uniform_law(const struct distribution *d)
{
  return (struct law){0, 0, d->lower, d->upper};
}

static double uniform_tail(const struct law *law, double x, bool above)
{
  return above ? gsl_cdf_flat_Q(x, law->lower, law->upper)
               : gsl_cdf_flat_P(x, law->lower, law->upper);
}

static double uniform_inverse(const struct law *law, double p, bool above)
{
  const double width = law->upper - law->lower;
  return above ? law->upper - p * width : law->lower + p * width;
}

static const struct distribution_type uniform = {.name = "uniform",
                                                 .bounded = true,
                                                 .states = DISTRIBUTION_ENDS,
                                                 .complete = uniform_complete,
                                                 .law = uniform_law,
                                                 .tail = uniform_tail,
                                                 .inverse = uniform_inverse};

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

static struct law weibull_law(const struct distribution *d)
{
  const double shape = weibull_shape(d->mean, d->deviation);
  return (struct law){d->mean / exp(gsl_sf_lngamma(1 + 1 / shape)), shape, 0, INFINITY};
}

static double weibull_tail(const struct law *law, double x, bool above)
{
  return above ? gsl_cdf_weibull_Q(x, law->first, law->second)
               : gsl_cdf_weibull_P(x, law->first, law->second);
}

static double weibull_inverse(const struct law *law, double p, bool above)
{
  return above ? gsl_cdf_weibull_Qinv(p, law->first, law->second)
               : gsl_cdf_weibull_Pinv(p, law->first, law->second);
}

static const struct distribution_type weibull = {.name = "weibull",
                                                 .positive = true,
                                                 .law = weibull_law,
                                                 .tail = weibull_tail,
                                                 .inverse = weibull_inverse};

/* GSL's own inverses of gamma and beta may not converge. */
static struct law gamma_law(const struct distribution *d)
{
  const double ratio = d->deviation / d->mean;
  return (struct law){1 / (ratio * ratio), d->mean * ratio * ratio, 0, INFINITY};
}

static double gamma_tail(const struct law *law, double x, bool above)
{
  return above ? gsl_cdf_gamma_Q(x, law->first, law->second)
               : gsl_cdf_gamma_P(x, law->first, law->second);
}

static const struct distribution_type gamma_type = {
    .name = "gamma", .positive = true, .law = gamma_law, .tail = gamma_tail};

static const char *beta_complete(struct distribution *d, const char **expected)
{
  if (d->mean > d->lower && d->mean < d->upper &&
      d->deviation * d->deviation < (d->mean - d->lower) * (d->upper - d->mean) &&
      d->upper - d->lower > 0)
    return NULL;
  *expected = "the mean between the ends, the spread smaller than their distance";
  return "no beta distribution has this mean, spread and ends";
}

static struct law beta_law(const struct distribution *d)
{
  const double share = (d->mean - d->lower) / (d->upper - d->lower);
  const double ratio = d->deviation / (d->upper - d->lower);
  const double sum = share * (1 - share) / (ratio * ratio) - 1;
  return (struct law){share * sum, (1 - share) * sum, d->lower, d->upper};
}

static double beta_tail(const struct law *law, double x, bool above)
{
  x = (x - law->lower) / (law->upper - law->lower);
  return above ? gsl_cdf_beta_Q(x, law->first, law->second)
               : gsl_cdf_beta_P(x, law->first, law->second);
}

static const struct distribution_type beta = {
    .name = "beta", .bounded = true, .complete = beta_complete, .law = beta_law, .tail = beta_tail};

static const char *triangular_complete(struct distribution *d, const char **expected)
{
  const double mode = 3 * d->mean - d->lower - d->upper;
  if (mode >= d->lower && mode <= d->upper) {
    d->deviation = sqrt((d->lower * d->lower + d->upper * d->upper + mode * mode -
                         d->lower * d->upper - d->lower * mode - d->upper * mode) /
                        18);
    return NULL;
  }
  *expected = "in the middle third between the ends";
  return "no triangular distribution has this mean";
}

/* `first` is the mode. */
static struct law triangular_law(const struct distribution *d)
{
  return (struct law){3 * d->mean - d->lower - d->upper, 0, d->lower, d->upper};
}

static double triangular_tail(const struct law *law, double x, bool above)
{
  const double a = law->first, width = law->upper - law->lower;
  double left = (x - law->lower) * (x - law->lower) / (width * (a - law->lower));
  double right = (law->upper - x) * (law->upper - x) / (width * (law->upper - a));
  if (above)
    return x > a ? right : 1 - left;
  return x <= a ? left : 1 - right;
}

static double triangular_inverse(const struct law *law, double p, bool above)
{
  const double a = law->first, width = law->upper - law->lower;
  double below_mode = (a - law->lower) / width;
  double below = above ? 1 - p : p, beyond = above ? p : 1 - p;
  if (below <= below_mode)
    return law->lower + sqrt(below * width * (a - law->lower));
  return law->upper - sqrt(beyond * width * (law->upper - a));
}

static const struct distribution_type triangular = {.name = "triangular",
                                                    .bounded = true,
                                                    .states = DISTRIBUTION_MEAN,
                                                    .complete = triangular_complete,
                                                    .law = triangular_law,
                                                    .tail = triangular_tail,
                                                    .inverse = triangular_inverse};

/* The first is meant where a scene names none. */
static const struct distribution_type *const types[] = {
    &normal, &lognormal, &uniform, &weibull, &gamma_type, &beta, &triangular};

size_t distribution_names(const char *name[DISTRIBUTIONS_MAX])
{
  _Static_assert(ARRAY_SIZE(types) <= DISTRIBUTIONS_MAX, "room for all names");
  for (size_t i = 0; i < ARRAY_SIZE(types); i++)
    name[i] = types[i]->name;
  return ARRAY_SIZE(types);
}

const struct distribution_type *distribution_named(const char *name)
{
  for (size_t i = 0; i < ARRAY_SIZE(types); i++)
    if (!name || strcmp(types[i]->name, name) == 0)
      return types[i];
  return NULL;
}
