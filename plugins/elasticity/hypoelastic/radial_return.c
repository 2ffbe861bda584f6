/* The radial return: d > 0 with s - 3 G d - y(plastic_strain + d, d / dt) = 0, s the size of the
 * trial deviator, y the flow stress. Each point iterates for itself and is then left alone, so that
 * results do not depend on what else is in the block. */
#include "hypoelastic.h"

enum { ITERATIONS = 80, SAFE_AFTER = 30 };

size_t hypoelastic_lanes(const double *active, size_t count, uint32_t *lane)
{
  size_t lanes = 0;
  for (size_t i = 0; i < count; i++) {
    lane[lanes] = (uint32_t)i;
    lanes += active[i] > 0.0;
  }
  return lanes;
}

static void propose(const struct hypoelastic *b, double *increment)
{
  const struct gamut_strength_law *law = b->strength;
  GAMUT_EACH (i, b) {
    double dt = b->time_step[i];
    law->plastic_strain[i] = b->plastic_strain_begin[i] + increment[i];
    law->plastic_strain_rate[i] = dt > 0.0 ? increment[i] / dt : 0.0;
  }
}

/* From the flow stress without flow: which points yield, and where each starts. */
static void begin(const struct hypoelastic *b)
{
  const double *shear = hypoelastic_shear(b);
  GAMUT_EACH (i, b) {
    double s = b->scratch[TRIAL_SIZE][i], flow = b->strength->flow_stress[i];
    double excess = s - flow, stiffness = 3.0 * shear[i];
    double divisor = stiffness > 0.0 ? stiffness : 1.0;
    double active = excess > 0.0 ? stiffness > 0.0 ? 1.0 : 0.0 : 0.0;
    /* Steady flow takes the whole strain; the increment is never more than the excess asks for
     * while the law hardens, and never zero, where a slope may be infinite. */
    double most = excess / divisor, steady = b->scratch[STRAIN_SIZE][i];
    double least = 1e-3 * most;
    double start = steady < most ? steady : most;
    start = start > least ? start : least;
    b->scratch[EXCESS][i] = excess;
    b->scratch[FLOW][i] = flow;
    b->scratch[LOWER][i] = 0.0;
    b->scratch[UPPER][i] = s / divisor;
    b->scratch[ACTIVE][i] = active;
    b->scratch[INCREMENT][i] = active > 0.0 ? start : 0.0;
  }
}

/* One Newton step for the points that iterate; marks those whose step leaves the bracket. */
static void newton(const struct hypoelastic *b)
{
  const double *shear = hypoelastic_shear(b);
  const struct gamut_strength_law *law = b->strength;
  GAMUT_EACH (i, b) {
    double d = b->scratch[INCREMENT][i], active = b->scratch[ACTIVE][i], dt = b->time_step[i];
    double stiffness = 3.0 * shear[i], flow = law->flow_stress[i];
    double by_rate = law->flow_stress_slope_plastic_strain_rate[i];
    double hardening = law->flow_stress_slope_plastic_strain[i] + (dt > 0.0 ? by_rate / dt : 0.0);
    double slope = stiffness + hardening, excess = b->scratch[EXCESS][i];
    double f = b->scratch[TRIAL_SIZE][i] - stiffness * d - flow, step = f / slope;
    double lower = choose(f > 0.0 ? 1.0 : 0.0, d, b->scratch[LOWER][i]);
    double upper = choose(f < 0.0 ? 1.0 : 0.0, d, b->scratch[UPPER][i]);
    /* Onto the far end of the bracket counts as outside: around a kink of the law steps could
     * otherwise go back and forth between both ends. */
    double low_side = d + step <= lower ? 1.0 : 0.0, high_side = d + step >= upper ? 1.0 : 0.0;
    double far_side = choose(f < 0.0 ? 1.0 : 0.0, low_side, f > 0.0 ? high_side : 0.0);
    double outside = slope > 0.0 ? far_side : 1.0;
    /* Newton's step squares the relative error, so 1e-6 before it leaves 1e-12 or so. A residual
     * of a few ulps of the stress, or a bracket of as many, is all that round-off allows: there
     * steps may lead anywhere. */
    double close = fabs(f) <= 1e-6 * excess ? 1.0 : 0.0;
    close = outside > 0.0 ? 0.0 : close;
    double narrow = upper - lower <= 4e-16 * upper ? 1.0 : 0.0;
    double exact = fabs(f) <= 1e-15 * b->scratch[TRIAL_SIZE][i] ? 1.0 : 0.0;
    /* A step that leaves the bracket is not taken, nor one of a point that is done or elastic. */
    step = outside > 0.0 ? 0.0 : step;
    step = active > 0.0 ? step : 0.0;
    double still = active * (close + narrow + exact > 0.0 ? 0.0 : 1.0);
    outside = still > 0.0 ? outside : 0.0;
    b->scratch[FLOW][i] = choose(active, flow + hardening * step, b->scratch[FLOW][i]);
    b->scratch[LOWER][i] = lower;
    b->scratch[UPPER][i] = upper;
    b->scratch[OUTSIDE][i] = outside;
    b->scratch[ACTIVE][i] = still;
    b->scratch[INCREMENT][i] = d + step;
    double softens = slope <= 0.0 ? active : 0.0;
    GAMUT_FLAG(b, i, softens > 0.0, HYPOELASTIC_UNSTABLE);
  }
}

/* Where Newton's step left the bracket: the excess taken up by an increment, 3 G d + y(d) - y(0),
 * is near a power of d, exactly so for plastic strain 0 and y = A + B d^n. If that fails,
 * bisection. */
GAMUT_INLINE void rescue_point(const struct hypoelastic *b, double shear, size_t i,
                               double bisect)
{
  const struct gamut_strength_law *law = b->strength;
  double d = b->scratch[INCREMENT][i], dt = b->time_step[i];
  double lower = b->scratch[LOWER][i], upper = b->scratch[UPPER][i];
  double stiffness = 3.0 * shear, excess = b->scratch[EXCESS][i];
  double taken = excess - (b->scratch[TRIAL_SIZE][i] - stiffness * d - law->flow_stress[i]);
  double by_rate = law->flow_stress_slope_plastic_strain_rate[i];
  double slope =
      stiffness + law->flow_stress_slope_plastic_strain[i] + (dt > 0.0 ? by_rate / dt : 0.0);
  double exponent = taken / (d * slope);
  double ratio = excess / taken;
  ratio = ratio > 0.0 ? ratio : 1.0;
  double next = d * gamut_exp(exponent * gamut_log(ratio));
  double least = 1e-6 * upper, middle = sqrt((lower > least ? lower : least) * upper);
  next = bisect > 0.0 ? middle : next;
  next = next > lower ? next : middle;
  next = next < upper ? next : middle;
  double outside = b->scratch[OUTSIDE][i];
  b->scratch[INCREMENT][i] = outside > 0.0 ? next : d;
}

/* Few points need it: whole vectors without one are passed over. */
static void rescue(const struct hypoelastic *b, double bisect)
{
  const double *shear = hypoelastic_shear(b);
  for (size_t from = 0; from < b->count; from += GAMUT_LANES) {
    const double *outside = b->scratch[OUTSIDE] + from;
    const size_t count = b->count - from < GAMUT_LANES ? b->count - from : GAMUT_LANES;
    double most = 0.0;
    for (size_t l = 0; l < count; l++)
      most = outside[l] > most ? outside[l] : most;
    if (most == 0.0)
      continue;
    if (count < GAMUT_LANES) {
      for (size_t l = 0; l < count; l++)
        rescue_point(b, shear[from + l], from + l, bisect);
      continue;
    }
#pragma omp simd
    for (size_t l = 0; l < GAMUT_LANES; l++)
      rescue_point(b, shear[from + l], from + l, bisect);
  }
}

static bool any(const struct hypoelastic *b, enum scratch which)
{
  const double *mark = b->scratch[which];
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (size_t i = 0; i < b->count; i++)
    most = mark[i] > most ? mark[i] : most;
  return most > 0.0;
}

static void iterate(const struct hypoelastic *b)
{
  uint32_t lane[GAMUT_CHUNK_MAX];
  for (int k = 0; k < ITERATIONS; k++) {
    if (!any(b, ACTIVE))
      return;
    size_t lanes = b->count;
    if (b->count <= GAMUT_CHUNK_MAX)
      lanes = hypoelastic_lanes(b->scratch[ACTIVE], b->count, lane);
    propose(b, b->scratch[INCREMENT]);
    /* A list pays where few points are left. */
    bool few = 2 * lanes < b->count;
    gamut_evaluate_strength(b->strength, few ? lane : NULL, few ? lanes : b->count);
    newton(b);
    if (any(b, OUTSIDE))
      rescue(b, k < SAFE_AFTER ? 0.0 : 1.0);
  }
}

/* What follows from the increment: returned deviator, work, plastic strain and its heat. */
static void finish(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    double d = b->scratch[INCREMENT][i], flow = b->scratch[FLOW][i], dt = b->time_step[i];
    double s = b->scratch[TRIAL_SIZE][i], scale = b->scratch[EXCESS][i] > 0.0 ? flow / s : 1.0;
    double middle = b->volume_ratio_begin[i] + 0.5 * b->scratch[VOLUME_STEP][i];
    b->scratch[WORK_TRIAL][i] =
        0.5 * middle * (b->scratch[WORK_BEGIN][i] + scale * b->scratch[WORK_TRIAL][i]);
    b->scratch[TRIAL + 0][i] *= scale;
    b->scratch[TRIAL + 1][i] *= scale;
    b->scratch[TRIAL + 2][i] *= scale;
    b->scratch[TRIAL + 3][i] *= scale;
    b->scratch[TRIAL + 4][i] *= scale;
    b->scratch[TRIAL + 5][i] *= scale;
    b->plastic_strain[i] = b->plastic_strain_begin[i] + d;
    b->plastic_strain_rate[i] = dt > 0.0 ? d / dt : 0.0;
    b->plastic_dissipation[i] = middle * flow * d;
    GAMUT_FLAG(b, i, b->scratch[ACTIVE][i] > 0.0, HYPOELASTIC_RETURN_FAILED);
  }
}

static void remain_elastic(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    b->scratch[INCREMENT][i] = 0.0;
    b->scratch[FLOW][i] = 0.0;
    b->scratch[EXCESS][i] = 0.0;
    b->scratch[ACTIVE][i] = 0.0;
  }
}

/* The pressure of the eos at the end's compression and the begin's energy: the mean stress holds
 * viscous pressure and is a step late. */
static void put_pressure(const struct hypoelastic *b)
{
  const struct gamut_strength_law *law = b->strength;
  GAMUT_EACH (i, b) {
    b->eos->compression[i] = b->scratch[COMPRESSION][i];
    b->eos->energy[i] = b->energy_begin[i];
  }
  gamut_evaluate_eos(b->eos, NULL, b->count);
  GAMUT_EACH (i, b)
    law->pressure[i] = b->eos->pressure[i];
}

void hypoelastic_strength(const struct hypoelastic *b)
{
  const struct gamut_strength_law *law = b->strength;
  remain_elastic(b);
  if (!law)
    return;
  if (law->pressure)
    put_pressure(b);
  if (law->compression)
    GAMUT_EACH (i, b)
      law->compression[i] = b->scratch[COMPRESSION][i];
  propose(b, b->scratch[INCREMENT]);
  gamut_evaluate_strength(law, NULL, b->count);
  if (law->shear_modulus_factor)
    GAMUT_EACH (i, b)
      b->scratch[SHEAR][i] = b->shear_modulus[i] * law->shear_modulus_factor[i];
}

void hypoelastic_return(const struct hypoelastic *b)
{
  if (b->strength) {
    begin(b);
    iterate(b);
  }
  finish(b);
}
