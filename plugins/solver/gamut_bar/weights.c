/* Weights of the nonlocal bonds: w = a G a V with a such that every row sums to one; then
 * V_p w_pq = V_q w_qp as well. */
#include "bar.h"

enum { BLOCK = 64 };

/* Pair potential U_pq = (e_p + e_q) / 2 d^-m; only differences of logarithms matter. */
struct potential {
  const double *place, *energy;
  double exponent, least, most; /* least and most energy of all bonds */
  double *block_least;          /* of each block of bonds */
  size_t bonds;
};

static double log_potential(const struct potential *u, size_t p, double other, double distance)
{
  return log(0.5 * (u->energy[p] + other)) - u->exponent * log(distance);
}

static double distance_of(const struct potential *u, size_t p, size_t q)
{
  return fabs(u->place[p] - u->place[q]);
}

/* Goes outward from p until no farther bond can have a larger potential. */
static double largest_potential(const struct potential *u, size_t p)
{
  double best = -HUGE_VAL;
  for (int side = 0; side < 2; side++)
    for (size_t k = 1; side ? k <= p : p + k < u->bonds; k++) {
      size_t q = side ? p - k : p + k;
      double d = distance_of(u, p, q);
      if (log_potential(u, p, u->most, d) <= best)
        break;
      best = fmax(best, log_potential(u, p, u->energy[q], d));
    }
  return best;
}

static double least_in_block(const struct potential *u, size_t p, size_t block, double best)
{
  size_t from = block * BLOCK, to = from + BLOCK < u->bonds ? from + BLOCK : u->bonds;
  double far = fmax(distance_of(u, p, from), distance_of(u, p, to - 1));
  if (log_potential(u, p, u->block_least[block], far) >= best)
    return best;
  for (size_t q = from; q < to; q++)
    if (q != p)
      best = fmin(best, log_potential(u, p, u->energy[q], distance_of(u, p, q)));
  return best;
}

/* Goes inward from both ends until no nearer bond can have a smaller one. */
static double least_potential(const struct potential *u, size_t p)
{
  size_t left = 0, right = (u->bonds - 1) / BLOCK;
  double best = HUGE_VAL;
  for (;;) {
    size_t last = right * BLOCK + BLOCK <= u->bonds ? right * BLOCK + BLOCK - 1 : u->bonds - 1;
    double from_left = distance_of(u, p, left * BLOCK), from_right = distance_of(u, p, last);
    double far = fmax(from_left, from_right);
    if (far > 0.0 && log_potential(u, p, u->least, far) >= best)
      return best;
    best = least_in_block(u, p, from_left >= from_right ? left : right, best);
    if (left == right)
      return best;
    if (from_left >= from_right)
      left++;
    else
      right--;
  }
}

static double spread_of(const struct potential *u, size_t p)
{
  double far = fmax(distance_of(u, p, 0), distance_of(u, p, u->bonds - 1));
  double left = p > 0 ? distance_of(u, p, p - 1) : HUGE_VAL;
  double right = p + 1 < u->bonds ? distance_of(u, p, p + 1) : HUGE_VAL;
  double near = fmin(left, right);
  double logs = largest_potential(u, p) - least_potential(u, p);
  return sqrt((far - near) * (far + near) / (2.0 * logs));
}

static void find_spreads(struct bar *bar)
{
  if (gamut_given(bar->values, "weight_deviation")) {
    for (size_t p = 0; p < bar->bonds; p++)
      bar->spread[p] = gamut_real(bar->values, "weight_deviation");
    return;
  }
  struct potential u = {.place = bar->place,
                        .energy = bar->work[0],
                        .least = HUGE_VAL,
                        .exponent = gamut_real(bar->values, "pair_exponent"),
                        .block_least = bar->work[1],
                        .bonds = bar->bonds};
  for (size_t i = 0; i < bar->bonds; i++) {
    double energy = 0.5 * bar->softness[i] * bar->stiffness[i];
    double *block = &u.block_least[i / BLOCK];
    bar->work[0][i] = energy;
    *block = i % BLOCK ? fmin(*block, energy) : energy;
    u.least = fmin(u.least, energy);
    u.most = fmax(u.most, energy);
  }
#pragma omp parallel for schedule(dynamic, 64) num_threads(bar->threads) if (bar->threads > 1)
  for (size_t p = 0; p < bar->bonds; p++)
    bar->spread[p] = spread_of(&u, p);
}

/* r = a (G V a), the row sums of w. */
static void row_sums(const struct bar *bar, double *r, double *work)
{
  for (size_t i = 0; i < bar->bonds; i++)
    work[i] = bar->volume[i] * bar->scale[i];
  bar->kernel.apply(bar->kernel.self, work, r);
  for (size_t i = 0; i < bar->bonds; i++)
    r[i] *= bar->scale[i];
}

static gamut_status scale_rows(struct bar *bar)
{
  enum { ROUNDS = 1000 };
  static const double enough = 4e-16, enough_of_rounding = 1e-12;
  double *r = bar->work[0], *work = bar->work[1], worst = 0.0, before = HUGE_VAL;
  for (size_t i = 0; i < bar->bonds; i++)
    bar->scale[i] = 1.0 / sqrt(bar->area);
  for (bar->scalings = 0; bar->scalings < ROUNDS; bar->scalings++) {
    row_sums(bar, r, work);
    worst = 0.0;
    for (size_t i = 0; i < bar->bonds; i++) {
      if (!(r[i] > 0.0))
        return gamut_fail(bar->run, GAMUT_NUMERICS,
                          "bond %zu has no nonlocal bond within its reach of %g m", i,
                          3.0 * bar->spread[i]);
      worst = fmax(worst, fabs(r[i] - 1.0));
    }
    if (worst < enough || (worst < enough_of_rounding && worst >= before))
      return GAMUT_OK;
    before = worst;
    for (size_t i = 0; i < bar->bonds; i++)
      bar->scale[i] /= sqrt(r[i]);
  }
  return gamut_fail(
      bar->run, GAMUT_NUMERICS,
      "no weights of sum 1 are the same both ways: sums are off by %g after %d rounds. "
      "The reach (3 standard deviations, %g m at bond 0) must span two bonds at least",
      worst, ROUNDS, 3.0 * bar->spread[0]);
}

void weights_apply(const struct bar *bar, const double *x, double *y, double *work)
{
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    work[i] = bar->scale[i] * bar->volume[i] * x[i];
  bar->kernel.apply(bar->kernel.self, work, y);
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    y[i] *= bar->scale[i];
}

void weights_apply_symmetric(const struct bar *bar, const double *x, double *y, double *work)
{
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    work[i] = bar->root[i] * x[i];
  bar->kernel.apply(bar->kernel.self, work, y);
#pragma omp simd
  for (size_t i = 0; i < bar->bonds; i++)
    y[i] *= bar->root[i];
}

static gamut_status choose_kernel(struct bar *bar)
{
  enum { DENSE_MOST = 2000 };
  double *noise;
  bool given;
  gamut_status status = noise_of_pairs(bar, &noise, &given);
  if (status != GAMUT_OK)
    return status;
  bool dense = false;
  switch (gamut_bar_operator_of(bar->values)) {
  case GAMUT_BAR_OPERATOR_AUTO:
    dense = given || bar->bonds <= DENSE_MOST;
    break;
  case GAMUT_BAR_OPERATOR_DENSE:
    dense = true;
    break;
  case GAMUT_BAR_OPERATOR_INTERPOLATED:
    break;
  }
  if (given && !dense)
    return gamut_fail_at(bar->run, bar->values, "operator", "dense",
                         "the interpolated operator knows no noise of weights");
  bar->operator_name = dense ? "dense" : "interpolated";
  status = dense ? dense_new(bar, noise, &bar->kernel) : interpolated_new(bar, &bar->kernel);
  if (noise)
    gamut_release(bar->run, noise);
  return status;
}

gamut_status weights_new(struct bar *bar)
{
  find_spreads(bar);
  gamut_status status = choose_kernel(bar);
  if (status == GAMUT_OK)
    status = scale_rows(bar);
  if (status != GAMUT_OK)
    return status;
  for (size_t i = 0; i < bar->bonds; i++)
    bar->root[i] = bar->scale[i] * sqrt(bar->volume[i]);
  weights_apply(bar, bar->stiffness, bar->softening, bar->work[0]);
  return GAMUT_OK;
}
