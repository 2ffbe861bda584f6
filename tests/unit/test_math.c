/* <gamut/math.h> against the long double functions of the C library: errors in ulps over wide
 * ranges, the limits, and the same bits from a vectorised loop as from single calls. */
#include <gamut/math.h>

#include <fenv.h>
#include <float.h>
#include <stdbool.h>
#include <stdio.h>

#include "tests/tap.h"

enum { SAMPLES = 400000, LANES = 1024 };

static void report(bool good, const char *what, double figure, double tolerance)
{
  tap_ok(good, "%s: %.3f (allowed %.3f)", what, figure, tolerance);
}

static uint64_t state = 88172645463325252u;
static double uniform(void)
{
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) * 0x1p-53;
}
static double between(double low, double high)
{
  return low + (high - low) * uniform();
}
static double any_size(double low, double high) /* uniform in the logarithm to base 2 */
{
  return exp2(between(low, high));
}

/* Distance of got from exact in units of the last place of exact. */
static double ulps(double got, long double exact)
{
  double near = (double)exact;
  if (isnan(near))
    return isnan(got) ? 0 : 1e9;
  if (isinf(near))
    return got == near || fabs(got) == DBL_MAX ? 0 : 1e9;
  if (isinf(got) || isnan(got))
    return 1e9;
  int exponent;
  frexp(near, &exponent);
  double unit = near == 0 || exponent < -1021 ? 0x1p-1074 : ldexp(1.0, exponent - 53);
  return (double)(fabsl((long double)got - exact) / (long double)unit);
}

struct function {
  const char *name;
  double (*ours)(double);
  long double (*exact)(long double);
};
static double ours_exp(double x)
{
  return gamut_exp(x);
}
static double ours_log(double x)
{
  return gamut_log(x);
}
static double ours_expm1(double x)
{
  return gamut_expm1(x);
}
static double ours_log1p(double x)
{
  return gamut_log1p(x);
}

static void sweep(const struct function *f, const char *range, double low, double high, int sign)
{
  double worst = 0, at = 0;
  for (int i = 0; i < SAMPLES; i++) {
    double x = sign ? sign * any_size(low, high) : between(low, high);
    double error = ulps(f->ours(x), f->exact((long double)x));
    if (error > worst) {
      worst = error;
      at = x;
    }
  }
  char text[120];
  snprintf(text, sizeof text, "%s, %s: ulps (worst at %.17g)", f->name, range, at);
  report(worst < 1.0, text, worst, 1.0);
}

static void sweep_pow(const char *range, double x_low, double x_high, double y_low, double y_high)
{
  double worst = 0, at = 0, power = 0;
  for (int i = 0; i < SAMPLES; i++) {
    double x = any_size(x_low, x_high), y = between(y_low, y_high);
    double error = ulps(gamut_pow(x, y), powl((long double)x, (long double)y));
    if (error > worst) {
      worst = error;
      at = x;
      power = y;
    }
  }
  char text[160];
  snprintf(text, sizeof text, "pow, %s: ulps (worst at %.17g ^ %.17g)", range, at, power);
  report(worst < 1.0, text, worst, 1.0);
}

static bool same(double a, double b)
{
  return gamut_bits(a) == gamut_bits(b) || (isnan(a) && isnan(b));
}

static void limits(void)
{
  static const double odd[] = {
      0.0,    -0.0,   INFINITY, -INFINITY, NAN,    1.0,     -1.0,
      2.0,    -2.0,   3.0,      -3.0,      0.5,    -0.5,    1e308,
      -1e308, 1e-310, -1e-310,  5e-324,    745.5,  -745.5,  709.7,
      -746.5, 710.5,  -708.5,   0x1p53,    0x1p52, -0x1p52, 4503599627370497.0,
      1e300,  -1e300, 1e-17};
  const int count = (int)(sizeof odd / sizeof odd[0]);
  double worst = 0;
  for (int i = 0; i < count; i++) {
    double x = odd[i];
    const double got[] = {gamut_exp(x), gamut_log(x), gamut_expm1(x), gamut_log1p(x)};
    const long double due[] = {expl(x), logl(x), expm1l(x), log1pl(x)};
    for (int f = 0; f < 4; f++) {
      double error = ulps(got[f], due[f]);
      if (error >= 1)
        printf("# function %d of %.17g: %.17g, not %.17Lg\n", f, x, got[f], due[f]);
      worst = error > worst ? error : worst;
    }
    for (int k = 0; k < count; k++) {
      double error = ulps(gamut_pow(x, odd[k]), powl(x, odd[k]));
      if (error >= 1)
        printf("# pow(%.17g, %.17g): %.17g, not %.17Lg\n", x, odd[k], gamut_pow(x, odd[k]),
               powl(x, odd[k]));
      worst = error > worst ? error : worst;
    }
  }
  report(worst < 1, "limits: zeros, infinities, NaN, denormals, whole exponents", worst, 1);
}

static void signs(void)
{
  bool good = same(gamut_expm1(-0.0), -0.0) && same(gamut_log1p(-0.0), -0.0) &&
              same(gamut_pow(-0.0, 3), -0.0) && same(gamut_pow(-0.0, -3), -INFINITY) &&
              same(gamut_exp(-INFINITY), 0.0) && same(gamut_log(1.0), 0.0) &&
              same(gamut_exp(0.0), 1.0) && same(gamut_pow(0.0, 0.0), 1.0);
  report(good, "signs of zero", good ? 0 : 1, 0);
}

/* Near 0, where exp(x) - 1 and log(1 + x) live by what rounding leaves, in one rounding mode:
 * within `allowed` ulps, of the argument's sign, 0 at 0. */
static void near_zero(const struct function *f, int mode, const char *mode_name, double high,
                      double allowed)
{
  double worst = 0, at = 0;
  int wrong_sign = 0;
  for (int i = 0; i < SAMPLES; i++) {
    const double size = any_size(i % 2 ? -1074 : -60, high);
    volatile double x = i % 4 < 2 ? size : -size, y;
    const long double exact = f->exact((long double)x);
    fesetround(mode);
    y = f->ours(x);
    fesetround(FE_TONEAREST);
    const double error = ulps(y, exact);
    wrong_sign += (y > 0) != (x > 0) || (y < 0) != (x < 0);
    if (error > worst) {
      worst = error;
      at = x;
    }
  }
  volatile double zero = 0;
  fesetround(mode);
  volatile double y = f->ours(zero);
  fesetround(FE_TONEAREST);
  wrong_sign += y != 0;
  char text[160];
  snprintf(text, sizeof text, "%s up to 2^%g, rounding %s: ulps (worst at %.17g)", f->name, high,
           mode_name, at);
  report(worst <= allowed, text, worst, allowed);
  snprintf(text, sizeof text, "%s up to 2^%g, rounding %s: of another sign than x", f->name, high,
           mode_name);
  report(wrong_sign == 0, text, wrong_sign, 0);
}

/* A directed rounding of the last sum is off by less than 1 ulp. Up to 1/4 the terms beside x make
 * up to an eighth of the sum, and three of their roundings count: 3/8 more. The exact value is
 * itself known to 2^-11 ulp only. */
static void rounding_modes(const struct function *f)
{
  near_zero(f, FE_TONEAREST, "to nearest", -2, 1.0);
  near_zero(f, FE_UPWARD, "upward", -2, 1.375);
  near_zero(f, FE_DOWNWARD, "downward", -2, 1.375);
  near_zero(f, FE_TOWARDZERO, "towards zero", -2, 1.375);
  near_zero(f, FE_UPWARD, "upward", -20, 1.0 + 0x1p-10);
  near_zero(f, FE_DOWNWARD, "downward", -20, 1.0 + 0x1p-10);
  near_zero(f, FE_TOWARDZERO, "towards zero", -20, 1.0 + 0x1p-10);
}

static void lanes(void)
{
  static double x[LANES], y[LANES], a[LANES], b[LANES], c[LANES], d[LANES], e[LANES];
  for (int i = 0; i < LANES; i++) {
    x[i] = any_size(-1074, 1023);
    y[i] = between(-800, 800);
  }
  x[3] = 0, x[5] = INFINITY, x[9] = NAN, y[11] = INFINITY;
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    a[i] = gamut_exp(y[i]);
    b[i] = gamut_log(x[i]);
    c[i] = gamut_pow(x[i], y[i] * 0.01);
    d[i] = gamut_expm1(y[i]);
    e[i] = gamut_log1p(x[i]);
  }
  int different = 0;
  for (int i = 0; i < LANES; i++) {
    volatile double one = x[i], two = y[i];
    different += !same(a[i], gamut_exp(two)) || !same(b[i], gamut_log(one)) ||
                 !same(c[i], gamut_pow(one, two * 0.01)) || !same(d[i], gamut_expm1(two)) ||
                 !same(e[i], gamut_log1p(one));
  }
  report(different == 0, "the same bits in a vectorised loop and alone", different, 0);
}

/* R diag(d) R' of a rotation made of three angles, in long double. */
static void compose(const long double d[3], const long double angle[3], double s[6])
{
  long double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const long double c = cosl(angle[k]), w = sinl(angle[k]);
    for (int row = 0; row < 3; row++) {
      const long double a = r[row][i], b = r[row][j];
      r[row][i] = c * a - w * b;
      r[row][j] = w * a + c * b;
    }
  }
  static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
  for (int k = 0; k < 6; k++) {
    long double sum = 0;
    for (int i = 0; i < 3; i++)
      sum += r[row[k]][i] * d[i] * r[column[k]][i];
    s[k] = (double)sum;
  }
}

static double principal_error(const long double d[3], const long double angle[3], double scale)
{
  double s[6], value[3];
  const long double scaled[3] = {d[0] * scale, d[1] * scale, d[2] * scale};
  compose(scaled, angle, s);
  gamut_principal(s, value);
  long double most = 0, off = 0;
  for (int k = 0; k < 3; k++) {
    most = fmaxl(most, fabsl(scaled[k]));
    off = fmaxl(off, fabsl(value[k] - scaled[k]));
  }
  return (double)(off / most);
}

static void principal_values(void)
{
  static const long double sets[][3] = {{3, 2, 1},      {1, 1, 1},       {2, 1, 1},
                                        {1, 1, -2},     {1, 0, 0},       {1, 1e-9L, -1e-9L},
                                        {1, 1, 1e-12L}, {5, -1e-3L, -7}, {1, 1 - 1e-14L, 0.5L}};
  static const double scale[] = {1, 1e200, 1e-200};
  for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
    double worst = 0;
    for (int n = 0; n < 500; n++) {
      const long double angle[3] = {0.37L * n, 1.13L * n + 0.2L, 2.71L * n};
      worst = fmax(worst, principal_error(sets[i], angle, scale[n % 3]));
    }
    char text[120];
    snprintf(text, sizeof text, "principal values %Lg %Lg %Lg, in roundings of the largest",
             sets[i][0], sets[i][1], sets[i][2]);
    report(worst <= 8 * DBL_EPSILON, text, worst / DBL_EPSILON, 8);
  }
  double value[3];
  const double none[6] = {0}, wrong[6] = {1, 2, (double)NAN, 0, 0, 0};
  const double plain[6] = {1e300, -3e300, 2e300, 0, 0, 0};
  gamut_principal(none, value);
  report(value[0] == 0 && value[1] == 0 && value[2] == 0, "of nothing: 0", value[0], 0);
  gamut_principal(plain, value);
  report(value[0] == 2e300 && value[1] == 1e300 && value[2] == -3e300, "of a diagonal: in order",
         value[2] / 1e300, -3);
  gamut_principal(wrong, value);
  report(isnan(value[0]) && isnan(value[1]) && isnan(value[2]), "of no number: no number", 0, 0);
}

int main(void)
{
  static const struct function exponential = {"exp", ours_exp, expl};
  static const struct function logarithm = {"log", ours_log, logl};
  static const struct function less_one = {"expm1", ours_expm1, expm1l};
  static const struct function plus_one = {"log1p", ours_log1p, log1pl};
  sweep(&exponential, "-745 to 709.8", -745, 709.8, 0);
  sweep(&exponential, "-1 to 1", -1, 1, 0);
  sweep(&exponential, "tiny", -1074, 0, -1);
  sweep(&logarithm, "all sizes", -1074, 1024, 1);
  sweep(&logarithm, "near 1", 0.5, 2, 0);
  sweep(&logarithm, "at 1", 1 - 1e-6, 1 + 1e-6, 0);
  sweep(&less_one, "-40 to 709.8", -40, 709.8, 0);
  sweep(&less_one, "-2 to 2", -2, 2, 0);
  sweep(&less_one, "tiny, negative", -1074, 0, -1);
  sweep(&less_one, "tiny, positive", -1074, 0, 1);
  sweep(&plus_one, "all sizes", -1074, 1024, 1);
  sweep(&plus_one, "-1 to 3", -1, 3, 0);
  sweep(&plus_one, "tiny, negative", -1074, -0.001, -1);
  sweep_pow("material laws", -40, 1, 0, 4);
  sweep_pow("near 1, large exponents", -0.001, 0.001, -1e6, 1e6);
  sweep_pow("all sizes", -1074, 1024, -1, 1);
  sweep_pow("wide", -300, 300, -3.4, 3.4);
  rounding_modes(&less_one);
  rounding_modes(&plus_one);
  limits();
  signs();
  lanes();
  principal_values();
  return tap_done();
}
