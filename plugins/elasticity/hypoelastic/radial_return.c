/* The radial return: d > 0 with s - 3 G d - y(plastic_strain + d, d / dt) = 0, s the size of the
 * trial deviator, y the flow stress. Each point iterates for itself and is then left alone, so that
 * results do not depend on what else is in the block. */
#include "hypoelastic.h"

enum { HYPOELASTIC_RETURN_ITERATIONS = 80, HYPOELASTIC_SAFE_AFTER = 30 };

size_t hypoelastic_lanes(const double *active, size_t count, uint32_t *lane)
{
  size_t lanes = 0;
  for (size_t i = 0; i < count; i++) {
    lane[lanes] = (uint32_t)i;
    lanes += active[i] > 0.0;
  }
  return lanes;
}

static void hypoelastic_propose(const struct hypoelastic *b, double *increment)
{
  const struct gamut_strength_law *law = b->strength;
  GAMUT_EACH (i, b) {
    double dt = b->time_step[i];
    law->plastic_strain[i] = b->plastic_strain_begin[i] + increment[i];
    law->plastic_strain_rate[i] = dt > 0.0 ? increment[i] / dt : 0.0;
  }
}

/* From the flow stress without flow: which points yield, and where each starts. */
static void hypoelastic_return_begin(const struct hypoelastic *b)
{
  const double *shear = hypoelastic_shear(b);
  GAMUT_EACH (i, b) {
    double s = b->scratch[HYPOELASTIC_TRIAL_SIZE][i], flow = b->strength->flow_stress[i];
    double excess = s - flow, stiffness = 3.0 * shear[i];
    double divisor = stiffness > 0.0 ? stiffness : 1.0;
    double active = excess > 0.0 ? stiffness > 0.0 ? 1.0 : 0.0 : 0.0;
    /* Steady flow takes the whole strain; the increment is never more than the excess asks for
     * while the law hardens, and never zero, where a slope may be infinite. */
    double most = excess / divisor, steady = b->scratch[HYPOELASTIC_STRAIN_SIZE][i];
    double least = 1e-3 * most;
    double start = steady < most ? steady : most;
    start = start > least ? start : least;
    b->scratch[HYPOELASTIC_EXCESS][i] = excess;
    b->scratch[HYPOELASTIC_FLOW][i] = flow;
    b->scratch[HYPOELASTIC_LOWER][i] = 0.0;
    b->scratch[HYPOELASTIC_UPPER][i] = s / divisor;
    b->scratch[HYPOELASTIC_ACTIVE][i] = active;
    b->scratch[HYPOELASTIC_INCREMENT][i] = active > 0.0 ? start : 0.0;
  }
}

/* One Newton step for the points that iterate; marks those whose step leaves the bracket. */
static void hypoelastic_return_newton(const struct hypoelastic *b)
{
  const double *shear = hypoelastic_shear(b);
  const struct gamut_strength_law *law = b->strength;
  GAMUT_EACH (i, b) {
    double d = b->scratch[HYPOELASTIC_INCREMENT][i], active = b->scratch[HYPOELASTIC_ACTIVE][i],
           dt = b->time_step[i];
    double stiffness = 3.0 * shear[i], flow = law->flow_stress[i];
    double by_rate = law->flow_stress_slope_plastic_strain_rate[i];
    double hardening = law->flow_stress_slope_plastic_strain[i] + (dt > 0.0 ? by_rate / dt : 0.0);
    double slope = stiffness + hardening, excess = b->scratch[HYPOELASTIC_EXCESS][i];
    double f = b->scratch[HYPOELASTIC_TRIAL_SIZE][i] - stiffness * d - flow, step = f / slope;
    double lower = hypoelastic_choose(f > 0.0 ? 1.0 : 0.0, d, b->scratch[HYPOELASTIC_LOWER][i]);
    double upper = hypoelastic_choose(f < 0.0 ? 1.0 : 0.0, d, b->scratch[HYPOELASTIC_UPPER][i]);
    /* Onto the far end of the bracket counts as outside: around a kink of the law steps could
     * otherwise go back and forth between both ends. */
    double low_side = d + step <= lower ? 1.0 : 0.0, high_side = d + step >= upper ? 1.0 : 0.0;
    double far_side = hypoelastic_choose(f < 0.0 ? 1.0 : 0.0, low_side, f > 0.0 ? high_side : 0.0);
    double outside = slope > 0.0 ? far_side : 1.0;
    /* Newton's step squares the relative error, so 1e-6 before it leaves 1e-12 or so. A residual
     * of a few ulps of the stress, or a bracket of as many, is all that round-off allows: there
     * steps may lead anywhere. */
    double close = fabs(f) <= 1e-6 * excess ? 1.0 : 0.0;
    close = outside > 0.0 ? 0.0 : close;
    double narrow = upper - lower <= 4e-16 * upper ? 1.0 : 0.0;
    double exact = fabs(f) <= 1e-15 * b->scratch[HYPOELASTIC_TRIAL_SIZE][i] ? 1.0 : 0.0;
    /* A step that leaves the bracket is not taken, nor one of a point that is done or elastic. */
    step = outside > 0.0 ? 0.0 : step;
    step = active > 0.0 ? step : 0.0;
    double still = active * (close + narrow + exact > 0.0 ? 0.0 : 1.0);
    outside = still > 0.0 ? outside : 0.0;
    b->scratch[HYPOELASTIC_FLOW][i] =
        hypoelastic_choose(active, flow + hardening * step, b->scratch[HYPOELASTIC_FLOW][i]);
    b->scratch[HYPOELASTIC_LOWER][i] = lower;
    b->scratch[HYPOELASTIC_UPPER][i] = upper;
    b->scratch[HYPOELASTIC_OUTSIDE][i] = outside;
    b->scratch[HYPOELASTIC_ACTIVE][i] = still;
    b->scratch[HYPOELASTIC_INCREMENT][i] = d + step;
    double softens = slope <= 0.0 ? active : 0.0;
    GAMUT_FLAG(b, i, softens > 0.0, HYPOELASTIC_UNSTABLE);
  }
}

/* Where Newton's step left the bracket: the excess taken up by an increment, 3 G d + y(d) - y(0),
 * is near a power of d, exactly so for plastic strain 0 and y = A + B d^n. If that fails,
 * bisection. */
GAMUT_INLINE void hypoelastic_rescue_point(const struct hypoelastic *b, double shear, size_t i,
                                           double bisect)
{
  const struct gamut_strength_law *law = b->strength;
  double d = b->scratch[HYPOELASTIC_INCREMENT][i], dt = b->time_step[i];
  double lower = b->scratch[HYPOELASTIC_LOWER][i], upper = b->scratch[HYPOELASTIC_UPPER][i];
  double stiffness = 3.0 * shear, excess = b->scratch[HYPOELASTIC_EXCESS][i];
  double taken =
      excess - (b->scratch[HYPOELASTIC_TRIAL_SIZE][i] - stiffness * d - law->flow_stress[i]);
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
  double outside = b->scratch[HYPOELASTIC_OUTSIDE][i];
  b->scratch[HYPOELASTIC_INCREMENT][i] = outside > 0.0 ? next : d;
}

/* Few points need it: whole vectors without one are passed over. */
static void hypoelastic_rescue(const struct hypoelastic *b, double bisect)
{
  const double *shear = hypoelastic_shear(b);
  for (size_t from = 0; from < b->count; from += GAMUT_LANES) {
    const double *outside = b->scratch[HYPOELASTIC_OUTSIDE] + from;
    const size_t count = b->count - from < GAMUT_LANES ? b->count - from : GAMUT_LANES;
    double most = 0.0;
    for (size_t l = 0; l < count; l++)
      most = outside[l] > most ? outside[l] : most;
    if (most == 0.0)
      continue;
    if (count < GAMUT_LANES) {
      for (size_t l = 0; l < count; l++)
        hypoelastic_rescue_point(b, shear[from + l], from + l, bisect);
      continue;
    }
#pragma omp simd
    for (size_t l = 0; l < GAMUT_LANES; l++)
      hypoelastic_rescue_point(b, shear[from + l], from + l, bisect);
  }
}

static bool hypoelastic_any(const struct hypoelastic *b, enum hypoelastic_scratch which)
{
  const double *mark = b->scratch[which];
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (size_t i = 0; i < b->count; i++)
    most = mark[i] > most ? mark[i] : most;
  return most > 0.0;
}

static void hypoelastic_return_iterate(const struct hypoelastic *b)
{
  uint32_t lane[GAMUT_CHUNK_MAX];
  for (int k = 0; k < HYPOELASTIC_RETURN_ITERATIONS; k++) {
    if (!hypoelastic_any(b, HYPOELASTIC_ACTIVE))
      return;
    size_t lanes = b->count;
    if (b->count <= GAMUT_CHUNK_MAX)
      lanes = hypoelastic_lanes(b->scratch[HYPOELASTIC_ACTIVE], b->count, lane);
    hypoelastic_propose(b, b->scratch[HYPOELASTIC_INCREMENT]);
    /* A list pays where few points are left. */
    bool few = 2 * lanes < b->count;
    gamut_evaluate_strength(b->strength, few ? lane : NULL, few ? lanes : b->count);
    hypoelastic_return_newton(b);
    if (hypoelastic_any(b, HYPOELASTIC_OUTSIDE))
      hypoelastic_rescue(b, k < HYPOELASTIC_SAFE_AFTER ? 0.0 : 1.0);
  }
}

/* What follows from the increment: returned deviator, work, plastic strain and its heat. */
static void hypoelastic_return_finish(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    double d = b->scratch[HYPOELASTIC_INCREMENT][i], flow = b->scratch[HYPOELASTIC_FLOW][i],
           dt = b->time_step[i];
    double s = b->scratch[HYPOELASTIC_TRIAL_SIZE][i],
           scale = b->scratch[HYPOELASTIC_EXCESS][i] > 0.0 ? flow / s : 1.0;
    double middle = b->volume_ratio_begin[i] + 0.5 * b->scratch[HYPOELASTIC_VOLUME_STEP][i];
    b->scratch[HYPOELASTIC_WORK_TRIAL][i] =
        0.5 * middle *
        (b->scratch[HYPOELASTIC_WORK_BEGIN][i] + scale * b->scratch[HYPOELASTIC_WORK_TRIAL][i]);
    b->scratch[HYPOELASTIC_TRIAL + 0][i] *= scale;
    b->scratch[HYPOELASTIC_TRIAL + 1][i] *= scale;
    b->scratch[HYPOELASTIC_TRIAL + 2][i] *= scale;
    b->scratch[HYPOELASTIC_TRIAL + 3][i] *= scale;
    b->scratch[HYPOELASTIC_TRIAL + 4][i] *= scale;
    b->scratch[HYPOELASTIC_TRIAL + 5][i] *= scale;
    b->plastic_strain[i] = b->plastic_strain_begin[i] + d;
    b->plastic_strain_rate[i] = dt > 0.0 ? d / dt : 0.0;
    b->plastic_dissipation[i] = middle * flow * d;
    GAMUT_FLAG(b, i, b->scratch[HYPOELASTIC_ACTIVE][i] > 0.0, HYPOELASTIC_RETURN_FAILED);
  }
}

static void hypoelastic_remain_elastic(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    b->scratch[HYPOELASTIC_INCREMENT][i] = 0.0;
    b->scratch[HYPOELASTIC_FLOW][i] = 0.0;
    b->scratch[HYPOELASTIC_EXCESS][i] = 0.0;
    b->scratch[HYPOELASTIC_ACTIVE][i] = 0.0;
  }
}

/* The pressure of the eos at the end's compression and the begin's energy: the mean stress holds
 * viscous pressure and is a step late. */
static void hypoelastic_put_pressure(const struct hypoelastic *b)
{
  const struct gamut_strength_law *law = b->strength;
  GAMUT_EACH (i, b) {
    b->eos->compression[i] = b->scratch[HYPOELASTIC_COMPRESSION][i];
    b->eos->energy[i] = b->energy_begin[i];
  }
  gamut_evaluate_eos(b->eos, NULL, b->count);
  GAMUT_EACH (i, b)
    law->pressure[i] = b->eos->pressure[i];
}

void hypoelastic_strength(const struct hypoelastic *b)
{
  const struct gamut_strength_law *law = b->strength;
  hypoelastic_remain_elastic(b);
  if (!law)
    return;
  if (law->pressure)
    hypoelastic_put_pressure(b);
  if (law->compression)
    GAMUT_EACH (i, b)
      law->compression[i] = b->scratch[HYPOELASTIC_COMPRESSION][i];
  hypoelastic_propose(b, b->scratch[HYPOELASTIC_INCREMENT]);
  gamut_evaluate_strength(law, NULL, b->count);
  if (law->shear_modulus_factor)
    GAMUT_EACH (i, b)
      b->scratch[HYPOELASTIC_SHEAR][i] = b->shear_modulus[i] * law->shear_modulus_factor[i];
}

void hypoelastic_return(const struct hypoelastic *b)
{
  if (b->strength) {
    hypoelastic_return_begin(b);
    hypoelastic_return_iterate(b);
  }
  hypoelastic_return_finish(b);
}
