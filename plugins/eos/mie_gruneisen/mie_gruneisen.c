#include "mie_gruneisen.gamut.h"

static const double mie_gruneisen_guard = 0.05; /* the least D at which the Hugoniot is used */
static const double mie_gruneisen_close = 0.1;  /* D below this is noted */
static const double mie_gruneisen_unlimited =
    -1e300; /* Pa, the tension_limit where none is stated */

/* Coefficients at a point. S2 = S3 = 0 and known to be so where `curved` is false, a constant at
 * each call: the same bits in fewer operations. */
struct mie_gruneisen_hugoniot {
  bool curved;
  double S1, S2, S3, gamma0, a, K;
};

GAMUT_INLINE struct mie_gruneisen_hugoniot mie_gruneisen_hugoniot_of(const struct mie_gruneisen *b,
                                                                     size_t i, bool curved)
{
  struct mie_gruneisen_hugoniot h = {.curved = curved,
                                     .S1 = b->S1[i],
                                     .S2 = curved ? b->S2[i] : 0.0,
                                     .S3 = curved ? b->S3[i] : 0.0,
                                     .gamma0 = b->gamma0[i],
                                     .a = b->a[i],
                                     .K = b->reference_density[i] * b->C0[i] * b->C0[i]};
  return h;
}

/* D and dD/dmu; x = mu / (1 + mu) = 1 - V/V0. */
GAMUT_INLINE double mie_gruneisen_denominator(const struct mie_gruneisen_hugoniot *h, double mu,
                                              double *slope)
{
  double x = h->curved ? mu / (1.0 + mu) : 0.0;
  double bend = h->curved ? h->S2 * (x * (2.0 - x)) + h->S3 * (x * x * (3.0 - 2.0 * x)) : 0.0;
  *slope = 1.0 - h->S1 - bend;
  return 1.0 - mu * (h->S1 - 1.0 + (h->curved ? x * (h->S2 + h->S3 * x) : 0.0));
}

/* The least D on the way from 0 to mu, where D is `here`. D (1 - x) = 1 - S1 x - S2 x^2 - S3 x^3
 * can have a minimum on the way, and behind a pole it is zero or negative there. */
GAMUT_INLINE double mie_gruneisen_least_denominator(const struct mie_gruneisen_hugoniot *h,
                                                    double mu, double here)
{
  double under = h->S2 * h->S2 - 3.0 * h->S1 * h->S3;
  double below = sqrt(under > 0.0 ? under : 0.0) - h->S2;
  double lowest = h->S1 / (below > 0.0 ? below : 1.0); /* x of the minimum, if there is one */
  lowest = below > 0.0 ? lowest : 1.0;
  lowest = under > 0.0 ? lowest : 1.0;
  double x = lowest < mu / (1.0 + mu) ? lowest : 0.0, slope;
  double there = mie_gruneisen_denominator(h, x / (1.0 - x), &slope);
  return there < here ? there : here;
}

/* The pressure without the energy's part, over K, and its slope by mu. */
GAMUT_INLINE double mie_gruneisen_cold(const struct mie_gruneisen_hugoniot *h, double mu, double D,
                                       double D_slope, double *slope)
{
  double N = 1.0 + mu * (1.0 - 0.5 * h->gamma0 - 0.5 * h->a * mu);
  double N_slope = 1.0 - 0.5 * h->gamma0 - h->a * mu, square = D * D;
  *slope = (N + mu * (N_slope - 2.0 * N * (D_slope / D))) / square;
  return mu * N / square;
}

/* Writes what follows from the law's pressure and slope. Between zero pressure and a stated limit
 * the part p G / (1 + mu)^2 of the sound speed is left out: as material opens it takes any sound
 * speed away, while the limit says that the law holds there. What is left is the slope that the
 * cut-off has. */
GAMUT_INLINE void mie_gruneisen_finish(const struct mie_gruneisen *b, size_t i,
                                       double mie_gruneisen_pressure, double slope)
{
  double mu = b->compression[i], ratio = 1.0 + mu;
  double gamma = b->gamma0[i] + b->a[i] * mu, limit = b->tension_limit[i];
  bool cut = mie_gruneisen_pressure < limit;
  double p = cut ? limit : mie_gruneisen_pressure;
  bool stated = limit > mie_gruneisen_unlimited;
  double part = p * gamma / (ratio * ratio), opened = stated ? 0.0 : part;
  double square = slope + (p < 0.0 ? opened : part);
  b->pressure[i] = p;
  b->pressure_slope_compression[i] = cut ? 0.0 : slope;
  b->pressure_slope_energy[i] = cut ? 0.0 : gamma;
  b->sound_speed[i] = sqrt((square <= 0.0 ? 0.0 : square) / b->reference_density[i]);
  GAMUT_FLAG(b, i, cut, MIE_GRUNEISEN_AT_TENSION_LIMIT);
  GAMUT_FLAG(b, i, square <= 0.0, MIE_GRUNEISEN_NO_SOUND_SPEED);
  GAMUT_FLAG(b, i, p != p, MIE_GRUNEISEN_NOT_FINITE);
  GAMUT_FLAG(b, i, ratio <= 0.0, MIE_GRUNEISEN_VACUUM);
}

/* A point up to the guard; beyond it the sound speed is left at -1 as a mark. */
GAMUT_INLINE void mie_gruneisen_regular(const struct mie_gruneisen *b, size_t i, bool curved)
{
  struct mie_gruneisen_hugoniot h = mie_gruneisen_hugoniot_of(b, i, curved);
  double mu = b->compression[i], e = b->energy[i], D_slope, slope;
  bool compressed = mu > 0.0;
  double squeezed = compressed ? mu : 0.0;
  double D = mie_gruneisen_denominator(&h, squeezed, &D_slope);
  double least = curved ? mie_gruneisen_least_denominator(&h, squeezed, D) : D;
  bool beyond = least <= mie_gruneisen_guard;
  D = beyond ? mie_gruneisen_guard : D;
  mie_gruneisen_cold(&h, squeezed, D, D_slope, &slope);
  double gamma = h.gamma0 + h.a * mu, over = h.K * squeezed / (D * D);
  double p = over * (1.0 + squeezed) + gamma * (e - 0.5 * over * squeezed);
  p = compressed ? p : h.K * mu + gamma * e;
  slope = h.K * (compressed ? slope : 1.0) + h.a * e;
  mie_gruneisen_finish(b, i, beyond ? 0.0 : p, beyond ? h.K : slope);
  b->sound_speed[i] = beyond ? -1.0 : b->sound_speed[i];
  GAMUT_FLAG(b, i, least < mie_gruneisen_close, MIE_GRUNEISEN_NEAR_POLE);
}

/* The compression at which D has fallen to the guard: bisection between 0 and a mu beyond it. */
static double mie_gruneisen_guarded_compression(const struct mie_gruneisen_hugoniot *h, double mu)
{
  double low = 0.0, high = mu, middle, slope;
  while (middle = 0.5 * (low + high), low < middle && middle < high) {
    bool beyond =
        mie_gruneisen_least_denominator(h, middle, mie_gruneisen_denominator(h, middle, &slope)) <=
        mie_gruneisen_guard;
    low = beyond ? low : middle;
    high = beyond ? middle : high;
  }
  return low;
}

static void mie_gruneisen_extrapolate(const struct mie_gruneisen *b, size_t i)
{
  struct mie_gruneisen_hugoniot h = mie_gruneisen_hugoniot_of(b, i, true);
  double mu = b->compression[i], e = b->energy[i], D_slope, slope;
  bool stop = b->beyond[i] < MIE_GRUNEISEN_BEYOND_EXTRAPOLATE;
  double last = mie_gruneisen_guarded_compression(&h, mu),
         D = mie_gruneisen_denominator(&h, last, &D_slope);
  double value = mie_gruneisen_cold(&h, last, D, D_slope, &slope) + slope * (mu - last);
  double p = h.K * value + (h.gamma0 + h.a * mu) * e;
  mie_gruneisen_finish(b, i, stop ? 0.0 : p, stop ? h.K : h.K * slope + h.a * e);
  b->pressure[i] = stop ? (double)NAN : b->pressure[i];
  GAMUT_FLAG(b, i, !stop, MIE_GRUNEISEN_EXTRAPOLATED);
  GAMUT_FLAG(b, i, stop, MIE_GRUNEISEN_BEYOND_POLE);
}

/* The rare points: beyond the guard, or pulled until no sound speed is left while nothing limits
 * the tension. */
static void mie_gruneisen_settle_rare(const struct mie_gruneisen *b)
{
  for (size_t i = 0; i < b->count; i++) {
    if (b->sound_speed[i] > 0.0)
      continue;
    if (b->sound_speed[i] < 0.0)
      mie_gruneisen_extrapolate(b, i);
    if (b->status[i] == MIE_GRUNEISEN_NO_SOUND_SPEED && b->pressure[i] < 0.0 &&
        b->tension_limit[i] <= mie_gruneisen_unlimited)
      b->status[i] = MIE_GRUNEISEN_PULLED_BEYOND;
  }
}

static void mie_gruneisen_pressure(const struct mie_gruneisen *b)
{
  GAMUT_EACH (i, b)
    mie_gruneisen_regular(b, i, true);
  mie_gruneisen_settle_rare(b);
}

/* With S2 = S3 = 0. */
static void mie_gruneisen_straight(const struct mie_gruneisen *b)
{
  GAMUT_EACH (i, b)
    mie_gruneisen_regular(b, i, false);
  mie_gruneisen_settle_rare(b);
}

/* f = K mu N / D^2 and its derivatives by S1 (the others follow by w2/w1, w3/w1), gamma0 and a. */
struct mie_gruneisen_terms {
  double scale; /* 1, 0 where tension is cut off, NaN beyond the guard */
  double C0, rho0, mu, e;
  double f, w1, w2, w3, D, square; /* dD/dS_j = -w_j; square = K mu^2 / D^2, zero when expanded */
};

GAMUT_INLINE struct mie_gruneisen_terms mie_gruneisen_terms_of(const struct mie_gruneisen *b,
                                                               size_t i)
{
  struct mie_gruneisen_hugoniot h = mie_gruneisen_hugoniot_of(b, i, true);
  double mu = b->compression[i], e = b->energy[i], D_slope, slope;
  bool compressed = mu > 0.0;
  double squeezed = compressed ? mu : 0.0, x = squeezed / (1.0 + squeezed);
  double D = mie_gruneisen_denominator(&h, squeezed, &D_slope);
  bool beyond = mie_gruneisen_least_denominator(&h, squeezed, D) <= mie_gruneisen_guard;
  double f = h.K * (compressed ? mie_gruneisen_cold(&h, squeezed, D, D_slope, &slope) : mu);
  bool cut = f + (h.gamma0 + h.a * mu) * e < b->tension_limit[i];
  struct mie_gruneisen_terms t = {.scale = beyond ? (double)NAN
                                           : cut  ? 0.0
                                                  : 1.0,
                                  .C0 = b->C0[i],
                                  .rho0 = b->reference_density[i],
                                  .mu = mu,
                                  .e = e,
                                  .f = f,
                                  .w1 = squeezed,
                                  .w2 = squeezed * x,
                                  .w3 = squeezed * x * x,
                                  .D = D,
                                  .square = h.K * squeezed * squeezed / (D * D)};
  return t;
}

/* Arrays that the core does not want are null; each loop fills one that it does. */
#define MIE_GRUNEISEN_FILL(array, value)                                                           \
  do {                                                                                             \
    if (b->array)                                                                                  \
      GAMUT_EACH (i, b) {                                                                          \
        struct mie_gruneisen_terms t = mie_gruneisen_terms_of(b, i);                               \
        b->array[i] = t.scale * (value);                                                           \
      }                                                                                            \
  } while (0)

static void mie_gruneisen_first_derivatives(const struct mie_gruneisen *b)
{
  MIE_GRUNEISEN_FILL(pressure_by_C0, 2.0 * t.f / t.C0);
  MIE_GRUNEISEN_FILL(pressure_by_S1, 2.0 * t.f * t.w1 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S2, 2.0 * t.f * t.w2 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S3, 2.0 * t.f * t.w3 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_gamma0, t.e - 0.5 * t.square);
  MIE_GRUNEISEN_FILL(pressure_by_a, t.mu * (t.e - 0.5 * t.square));
  MIE_GRUNEISEN_FILL(pressure_by_reference_density, t.f / t.rho0);
}

static void mie_gruneisen_derivatives(const struct mie_gruneisen *b)
{
  mie_gruneisen_first_derivatives(b);
  MIE_GRUNEISEN_FILL(pressure_by_C0_C0, 2.0 * t.f / (t.C0 * t.C0));
  MIE_GRUNEISEN_FILL(pressure_by_C0_S1, 4.0 * t.f * t.w1 / (t.D * t.C0));
  MIE_GRUNEISEN_FILL(pressure_by_C0_S2, 4.0 * t.f * t.w2 / (t.D * t.C0));
  MIE_GRUNEISEN_FILL(pressure_by_C0_S3, 4.0 * t.f * t.w3 / (t.D * t.C0));
  MIE_GRUNEISEN_FILL(pressure_by_C0_gamma0, -t.square / t.C0);
  MIE_GRUNEISEN_FILL(pressure_by_C0_a, -t.mu * t.square / t.C0);
  MIE_GRUNEISEN_FILL(pressure_by_C0_reference_density, 2.0 * t.f / (t.C0 * t.rho0));
  MIE_GRUNEISEN_FILL(pressure_by_S1_S1, 6.0 * t.f * t.w1 * t.w1 / (t.D * t.D));
  MIE_GRUNEISEN_FILL(pressure_by_S1_S2, 6.0 * t.f * t.w1 * t.w2 / (t.D * t.D));
  MIE_GRUNEISEN_FILL(pressure_by_S1_S3, 6.0 * t.f * t.w1 * t.w3 / (t.D * t.D));
  MIE_GRUNEISEN_FILL(pressure_by_S2_S2, 6.0 * t.f * t.w2 * t.w2 / (t.D * t.D));
  MIE_GRUNEISEN_FILL(pressure_by_S2_S3, 6.0 * t.f * t.w2 * t.w3 / (t.D * t.D));
  MIE_GRUNEISEN_FILL(pressure_by_S3_S3, 6.0 * t.f * t.w3 * t.w3 / (t.D * t.D));
  MIE_GRUNEISEN_FILL(pressure_by_S1_gamma0, -t.square * t.w1 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S2_gamma0, -t.square * t.w2 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S3_gamma0, -t.square * t.w3 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S1_a, -t.mu * t.square * t.w1 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S2_a, -t.mu * t.square * t.w2 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S3_a, -t.mu * t.square * t.w3 / t.D);
  MIE_GRUNEISEN_FILL(pressure_by_S1_reference_density, 2.0 * t.f * t.w1 / (t.D * t.rho0));
  MIE_GRUNEISEN_FILL(pressure_by_S2_reference_density, 2.0 * t.f * t.w2 / (t.D * t.rho0));
  MIE_GRUNEISEN_FILL(pressure_by_S3_reference_density, 2.0 * t.f * t.w3 / (t.D * t.rho0));
  MIE_GRUNEISEN_FILL(pressure_by_gamma0_gamma0, 0.0);
  MIE_GRUNEISEN_FILL(pressure_by_gamma0_a, 0.0);
  MIE_GRUNEISEN_FILL(pressure_by_a_a, 0.0);
  MIE_GRUNEISEN_FILL(pressure_by_gamma0_reference_density, -0.5 * t.square / t.rho0);
  MIE_GRUNEISEN_FILL(pressure_by_a_reference_density, -0.5 * t.mu * t.square / t.rho0);
  MIE_GRUNEISEN_FILL(pressure_by_reference_density_reference_density, 0.0);
}

GAMUT_EOS(mie_gruneisen, .pressure = mie_gruneisen_pressure,
          .derivatives = mie_gruneisen_derivatives, .straight = mie_gruneisen_straight)
