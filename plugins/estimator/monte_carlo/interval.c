/* Intervals that know of skewness and tails; docs/results/studies.md has what they cover.
 *
 * Mean: Student's t on Hall's monotone cubic transformation, which takes the skewness out (Hall
 * 1992). Variance: Bonett (2006), a t interval of log(variance) whose error follows from the
 * kurtosis. A small sample of a skewed law shows too small a kurtosis, since what makes it large is
 * rare: to the estimate is added a share of the squared skewness, which is seen sooner. The
 * share falls with the runs; how was chosen by measuring coverage. */
#include "interval.h"

#include <math.h>

#include <gsl/gsl_cdf.h>

static const double confidence_tail = 0.025;
static const double skewness_share = 4.5, skewness_runs = 20, skewness_fall = 0.65;
static const double doubtful_kurtosis = 10;

void sums_add(struct sums *sums, double value)
{
  if (!isfinite(value))
    return;
  if (sums->runs == 0.0)
    sums->origin = value;
  double x = value - sums->origin, power = 1.0;
  for (int k = 0; k < 4; k++)
    sums->power[k] += power *= x;
  sums->runs += 1.0;
}

struct sample sample_of(const struct sums *sums)
{
  double n = sums->runs, m = sums->power[0] / n;
  double p2 = sums->power[1] / n, p3 = sums->power[2] / n, p4 = sums->power[3] / n;
  double spread = fmax(p2 - m * m, 0.0);
  return (struct sample){.runs = n,
                         .mean = sums->origin + m,
                         .variance = spread * n / (n - 1),
                         .third = p3 - 3 * m * p2 + 2 * m * m * m,
                         .fourth = p4 - 4 * m * p3 + 6 * m * m * p2 - 3 * m * m * m * m};
}

/* Skewness and kurtosis as of the whole, not of the sample: both are too small there. */
static double skewness(const struct sample *s)
{
  double n = s->runs;
  return s->third * n * n / ((n - 1) * (n - 2)) / (s->variance * sqrt(s->variance));
}

static double kurtosis(const struct sample *s)
{
  double n = s->runs, spread = s->variance * (n - 1) / n;
  double own = s->fourth / (spread * spread);
  double whole = 3 + (n - 1) / ((n - 2) * (n - 3)) * ((n + 1) * (own - 3) + 6);
  return fmax(own, whole);
}

/* w of t = w + g w^2/3 + g^2 w^3/27 + g/6, g the skewness by the root of the runs. */
static double untransformed(double t, double g)
{
  return fabs(g) > 1e-9 ? 3 * (cbrt(1 + g * (t - g / 6)) - 1) / g : t;
}

struct interval mean_interval(const struct sample *s)
{
  double n = s->runs;
  if (!(n >= 3))
    return (struct interval){NAN, NAN};
  if (!(s->variance > 0))
    return (struct interval){s->mean, s->mean};
  double t = gsl_cdf_tdist_Qinv(confidence_tail, n - 1), error = sqrt(s->variance / n);
  double g = skewness(s) / sqrt(n);
  return (struct interval){s->mean - untransformed(t, g) * error,
                           s->mean - untransformed(-t, g) * error};
}

struct interval variance_interval(const struct sample *s)
{
  double n = s->runs;
  if (!(n >= 4))
    return (struct interval){NAN, NAN};
  if (!(s->variance > 0))
    return (struct interval){0, 0};
  double z = gsl_cdf_ugaussian_Qinv(confidence_tail),
         t = gsl_cdf_tdist_Qinv(confidence_tail, n - 1);
  double skew = skewness(s), share = skewness_share * pow(skewness_runs / n, skewness_fall);
  double wide = kurtosis(s) + share * skew * skew - (n - 3) / n;
  double centre = n / (n - z), width = t * centre * sqrt(fmax(wide, 0) / (n - 1));
  return (struct interval){centre * s->variance * exp(-width), centre * s->variance * exp(width)};
}

double heavy_tail(const struct sample *s)
{
  if (!(s->runs >= 4) || !(s->variance > 0))
    return 0;
  double k = kurtosis(s);
  return k > doubtful_kurtosis ? k : 0;
}
