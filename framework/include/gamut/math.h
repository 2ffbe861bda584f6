/* exp, log, pow, expm1, log1p for kernels: inline, no branches, no tables, so that loops over
 * points vectorise with plain flags (-O3 -fno-math-errno -fno-trapping-math -fopenmp-simd). Within
 * 1 ulp over the whole range of doubles (tests/unit/test_math.c prints the figures), with the
 * limits of C99: exp runs out to 0 or infinity, log(0) is -infinity, log of a negative number is
 * NaN, NaN goes through. Never to be compiled with -ffast-math.
 *
 * Method. log: x = 2^k (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)), log(1 + f) = 2 atanh(s) with
 * s = f / (2 + f), the tail of the series in s^2 by a minimax polynomial. exp: x = k log 2 + r with
 * |r| <= log(2) / 2, Taylor's series for exp(r) - 1, which is below 2^-57 at the 13th term. The
 * coefficients of log and the split of log 2 are those of fdlibm (Sun Microsystems 1993, e_log.c).
 * pow takes the logarithm with about 67 bits: the first two terms of atanh as pairs of doubles.
 */
#ifndef GAMUT_MATH_H
#define GAMUT_MATH_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* For the functions that kernels call in their loops: a call that is not inlined keeps the loop
 * from vectorising. */
#if defined(__GNUC__)
#define GAMUT_INLINE static inline __attribute__((always_inline))
#else
#define GAMUT_INLINE static inline
#endif

/* log 2 = high + low; the high part has 21 trailing zero bits, so that k * high is exact. */
#define GAMUT_LN2_HIGH 6.93147180369123816490e-01
#define GAMUT_LN2_LOW 1.90821492927058770002e-10
#define GAMUT_1_LN2 1.4426950408889634074
#define GAMUT_ROUNDER 6755399441055744.0 /* 1.5 * 2^52: adding it rounds to an integer */

GAMUT_INLINE uint64_t gamut_bits(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}
GAMUT_INLINE double gamut_double(uint64_t bits)
{
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* 2^k for an integer -1022 <= k <= 1023 held in a double. */
GAMUT_INLINE double gamut_power_of_two(double k)
{
  return gamut_double((gamut_bits(k + GAMUT_ROUNDER) + 1023) << 52);
}

/* x = 2^k m with m in [sqrt(1/2), sqrt(2)), for any positive finite x. */
GAMUT_INLINE double gamut_split(double x, double *k)
{
  const double tiny = 2.2250738585072014e-308;
  double scaled = x < tiny ? x * 18014398509481984.0 : x; /* 2^54: denormals */
  uint64_t bits = gamut_bits(scaled);
  uint64_t above = bits - UINT64_C(0x3fe6a09e667f3bcd); /* of sqrt(1/2) */
  /* The exponent, biased by 1023 to stay positive, is put into the low bits of 2^52. */
  uint64_t exponent = (above + UINT64_C(0x3ff0000000000000)) >> 52;
  *k = gamut_double(exponent | UINT64_C(0x4330000000000000)) - (4503599627370496.0 + 1023.0) -
       (x < tiny ? 54.0 : 0.0);
  return gamut_double(bits - (above & UINT64_C(0xfff0000000000000)));
}

/* k log 2 + log(1 + f) + rest, for a small rest. */
GAMUT_INLINE double gamut_log_sum(double k, double f, double rest)
{
  double s = f / (2.0 + f), z = s * s, w = z * z;
  double odd = w * (3.999999999940941908e-01 +
                    w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  double even = z * (6.666666666666735130e-01 +
                     w * (2.857142874366239149e-01 +
                          w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  double halved = 0.5 * f * f;
  double tail = s * (halved + (odd + even)) + (k * GAMUT_LN2_LOW + rest);
  return k * GAMUT_LN2_HIGH - ((halved - tail) - f);
}

GAMUT_INLINE double gamut_log(double x)
{
  double k, f = gamut_split(x, &k) - 1.0;
  double y = gamut_log_sum(k, f, 0.0);
  y = x < HUGE_VAL ? y : x; /* infinity and NaN */
  return x > 0.0 ? y : x == 0.0 ? -HUGE_VAL : x < 0.0 ? (double)NAN : y;
}

GAMUT_INLINE double gamut_log1p(double x)
{
  double u = 1.0 + x, part = u - 1.0;
  double lost = (1.0 - (u - part)) + (x - part); /* u + lost = 1 + x exactly */
  double k, f = gamut_split(u, &k) - 1.0;
  double y = gamut_log_sum(k, f, lost / u);
  y = x < HUGE_VAL ? y : x;
  /* Near 0 from the series, as 1 + x may be rounded away from 1; keeps the sign of zero. */
  y = fabs(x) < 1e-7 ? x - x * x * (0.5 - x * (1.0 / 3)) : y;
  y = fabs(x) < 1e-290 ? x : y;
  return x > -1.0 ? y : x == -1.0 ? -HUGE_VAL : x < -1.0 ? (double)NAN : y;
}

/* x + x_low = k log 2 + r with |r| <= log(2) / 2; exp(r) - 1 = r + *tail. */
GAMUT_INLINE double gamut_exp_reduce(double x, double x_low, double n, double *tail)
{
  double high = x - n * GAMUT_LN2_HIGH, low = n * GAMUT_LN2_LOW - x_low;
  double r = high - low, rounding = (high - r) - low;
  double r2 = r * r, r4 = r2 * r2;
  double p0 = 1.0 / 6 + r * (1.0 / 24), p1 = 1.0 / 120 + r * (1.0 / 720);
  double p2 = 1.0 / 5040 + r * (1.0 / 40320), p3 = 1.0 / 362880 + r * (1.0 / 3628800);
  double p4 = 1.0 / 39916800 + r * (1.0 / 479001600 + r * (1.0 / 6227020800.0));
  double p = (p0 + r2 * p1) + r4 * ((p2 + r2 * p3) + r4 * p4);
  *tail = 0.5 * r2 + (r * r2 * p + (rounding + rounding * r));
  return r;
}

/* exp(x + x_low) for |x_low| far below |x|. */
GAMUT_INLINE double gamut_exp_sum(double x, double x_low)
{
  x = x < -746.0 ? -746.0 : x > 710.0 ? 710.0 : x;
  double k = (x * GAMUT_1_LN2 + GAMUT_ROUNDER) - GAMUT_ROUNDER;
  double tail, r = gamut_exp_reduce(x, x_low, k, &tail);
  double y = 1.0 + (r + tail);
  /* In two factors: 2^k alone would overflow, or lose bits twice among the denormals. */
  double first = (k * 0.5 + GAMUT_ROUNDER) - GAMUT_ROUNDER;
  return (y * gamut_power_of_two(first)) * gamut_power_of_two(k - first);
}

GAMUT_INLINE double gamut_exp(double x)
{
  return gamut_exp_sum(x, 0.0);
}

GAMUT_INLINE double gamut_expm1(double x)
{
  double bounded = x < -60.0 ? -60.0 : x > 710.0 ? 710.0 : x;
  /* The nearest whole number in every rounding mode: near 0 any other would cost all digits. */
  double powers = bounded * GAMUT_1_LN2, k = (powers + GAMUT_ROUNDER) - GAMUT_ROUNDER;
  double off = powers - k;
  k += off > 0.5 ? 1.0 : off < -0.5 ? -1.0 : 0.0;
  double tail, r = gamut_exp_reduce(bounded, 0.0, k, &tail);
  /* Half the result, as 2^1024 is no double: (scale - 1/2) + scale r + scale tail, the first sum
   * with its rounding error kept. */
  double scale = gamut_power_of_two(k - 1.0), base = scale - 0.5, step = scale * r;
  double sum = base + step, part = sum - base;
  double lost = ((scale - base) - 0.5) + ((base - (sum - part)) + (step - part));
  double y = 2.0 * (sum + (lost + scale * tail));
  return fabs(x) < 1e-290 ? x : y; /* halving a denormal would lose a bit */
}

/* The upper 26 bits; what is left has 27. Products of such halves are exact. */
GAMUT_INLINE double gamut_upper(double x)
{
  return gamut_double(gamut_bits(x) & UINT64_C(0xfffffffff8000000));
}

/* The rounding error of p = a * b. */
GAMUT_INLINE double gamut_product_error(double a, double b, double p)
{
  double ah = gamut_upper(a), al = a - ah, bh = gamut_upper(b), bl = b - bh;
  return ((ah * bh - p) + (ah * bl + al * bh)) + al * bl;
}

/* log(x) = result + *low with a relative error of about 2^-67, for positive finite x. */
GAMUT_INLINE double gamut_log_pair(double x, double *low)
{
  double k, m = gamut_split(x, &k);
  /* m = c (1 + s) / (1 - s) with |s| < 0.07; log c in two parts, the high one with short mantissa.
   */
  double above = m > 1.118 ? 1.0 : 0.0, below = m < 0.9 ? 1.0 : 0.0;
  double c = 1.0 + above * 0.25 - below * 0.1875;
  double start = k * GAMUT_LN2_HIGH + (above * 0.22314355126582086 + below * -0.20763936475850642);
  double start_low =
      k * GAMUT_LN2_LOW + (above * 4.838889490356316e-11 + below * -1.9738084340965946e-11);
  double top = m - c, bottom = m + c, part = bottom - m;
  double bottom_low = (m - (bottom - part)) + (c - part);
  double s = top / bottom, back = s * bottom;
  double s_low = ((top - back) - gamut_product_error(s, bottom, back) - s * bottom_low) / bottom;
  /* 2 atanh(s) = 2 s + 2/3 s^3 + s^5 (2/5 + 2/7 s^2 + ...), the first two terms in pairs. */
  double z = s * s, z_low = gamut_product_error(s, s, z) + 2.0 * s * s_low;
  double cube = s * z, cube_low = gamut_product_error(s, z, cube) + (s * z_low + s_low * z);
  const double third = 2.0 / 3, third_low = 3.7007434154171886e-17;
  double term = third * cube;
  double term_low = gamut_product_error(third, cube, term) + (third * cube_low + third_low * cube);
  double series = 2.0 / 11 + z * (2.0 / 13 + z * (2.0 / 15 + z * (2.0 / 17)));
  series = 2.0 / 5 + z * (2.0 / 7 + z * (2.0 / 9 + z * series));
  double two_s = 2.0 * s, first = start + two_s, second = first + term;
  double rest = ((two_s - (first - start)) + (term - (second - first))) +
                (2.0 * s_low + term_low + start_low + cube * z * series);
  double sum = second + rest;
  *low = (second - sum) + rest;
  return sum;
}

GAMUT_INLINE double gamut_whole(double x) /* the nearest whole number to x >= 0 */
{
  return x < 4503599627370496.0 ? (x + 4503599627370496.0) - 4503599627370496.0 : x;
}

GAMUT_INLINE double gamut_pow(double x, double y)
{
  double size = fabs(x), low, log_x = gamut_log_pair(size, &low);
  /* Beyond 2^80 the result is 0, 1 or infinite all the same. */
  double bounded = y > 1.2089258196146292e24 ? 1.2089258196146292e24 : y;
  bounded = bounded < -1.2089258196146292e24 ? -1.2089258196146292e24 : bounded;
  double product = bounded * log_x;
  double product_low = gamut_product_error(bounded, log_x, product) + bounded * low;
  product_low = fabs(product) < 800.0 ? product_low : 0.0;
  double p = gamut_exp_sum(product, product_low);
  p = size == 1.0 ? 1.0 : p;
  p = size == 0.0 ? (y > 0.0 ? 0.0 : HUGE_VAL) : p;
  p = size == HUGE_VAL ? (y > 0.0 ? HUGE_VAL : 0.0) : p;
  /* A negative base: NaN but for whole exponents, where odd ones give the sign. */
  double exponent = fabs(y), halved = 0.5 * exponent;
  double whole = gamut_whole(exponent) == exponent ? 1.0 : 0.0;
  double odd = whole > 0.0 && gamut_whole(halved) != halved ? 1.0 : 0.0;
  p = x < 0.0 && whole == 0.0 && size > 0.0 && size < HUGE_VAL ? (double)NAN : p;
  p = odd > 0.0 ? copysign(p, x) : p;
  p = x != x || y != y ? x + y : p;
  return y == 0.0 || x == 1.0 ? 1.0 : p;
}

/* Principal values of a symmetric 3x3, components xx yy zz xy yz zx, the largest first: cyclic
 * Jacobi rotations (Golub and Van Loan, Matrix Computations, 8.5). Within a few roundings of the
 * largest, equal ones too, where closed forms by angles lose half the digits. No number in, no
 * number out; no overflow unless a value itself is too large. */
GAMUT_INLINE void gamut_principal(const double s[6], double value[3])
{
  double largest = 0.0;
  for (int k = 0; k < 6; k++)
    largest = fabs(s[k]) > largest ? fabs(s[k]) : largest;
  const double scale = largest > 0.0 && largest < HUGE_VAL ? largest : 1.0;
  double a[3] = {s[0] / scale, s[1] / scale, s[2] / scale}; /* the diagonal */
  double b[3] = {s[4] / scale, s[5] / scale, s[3] / scale}; /* opposite to it: yz zx xy */
  for (int sweep = 0; sweep < 6; sweep++)
    for (int k = 0; k < 3; k++) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      /* the rotation of axes i and j that makes b[k] zero, by the smaller angle */
      const double off = b[k], apart = 0.5 * (a[j] - a[i]);
      const double reach = fabs(apart) + sqrt(apart * apart + off * off);
      const double t = reach > 0.0 ? copysign(1.0, apart) * off / reach : 0.0;
      const double c = 1.0 / sqrt(1.0 + t * t), turn = t * c;
      const double bi = b[i], bj = b[j];
      a[i] -= t * off;
      a[j] += t * off;
      b[k] = 0.0;
      b[i] = c * bi + turn * bj;
      b[j] = c * bj - turn * bi;
    }
  const double high = a[0] > a[1] ? a[0] : a[1], low = a[0] > a[1] ? a[1] : a[0];
  const double all = a[0] + a[1] + a[2] + b[0] + b[1] + b[2];
  const double wrong = all - all; /* NaN where an entry is no finite number, else 0 */
  value[0] = scale * (high > a[2] ? high : a[2]) + wrong;
  value[2] = scale * (low < a[2] ? low : a[2]) + wrong;
  value[1] = scale * (high < a[2] ? high : low > a[2] ? low : a[2]) + wrong;
}
#endif
