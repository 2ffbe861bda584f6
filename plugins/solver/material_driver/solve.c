/* One step of one point. A chunk holds the point once and seven times as padding, and all lanes are
 * computed anyway: so one update of the material gives the stress and its slopes by up to six
 * components, and another one tries eight lengths of Newton's step. */
#include <string.h>

#include "driver.h"

enum { LANES = GAMUT_LANES, ITERATIONS = 60 };

static const double wanted_share = 1e-13, enough_share = 1e-10;       /* of the largest stress */
static const double wanted_rounding = 2e-16, enough_rounding = 1e-14; /* of the stiffness */

/* The equations of a step. */
struct system {
  struct driver *driver;
  const struct gamut_chunk *chunk;
  double dt;
  double fixed[9]; /* A of what is prescribed */
  size_t unknowns, component[SYMMETRIC];
  double wanted[SYMMETRIC]; /* stresses */
  double slope[SYMMETRIC][SYMMETRIC];
};

static void place_lane(const struct system *s, size_t lane, const double move[SYMMETRIC])
{
  double A[9], G[9];
  memcpy(A, s->fixed, sizeof A);
  for (size_t k = 0; k < s->unknowns; k++)
    path_move(&s->driver->path, s->component[k], move[k], A);
  exponential_less_one(A, G);
  for (unsigned k = 0; k < 9; k++)
    gamut_end(s->chunk, s->driver->velocity_gradient, k)[lane] = G[k] / s->dt;
}

static gamut_status update(const struct system *s)
{
  struct gamut_run *run = s->driver->run;
  return GAMUT_HOST(run)->update_material(run, s->chunk);
}

static double stress_of(const struct system *s, size_t component, size_t lane)
{
  return gamut_end(s->chunk, s->driver->stress, (unsigned)component)[lane];
}

/* What the stresses of a lane lack, and the largest of it; infinity where it is not a number. */
static double residual(const struct system *s, size_t lane, double lack[SYMMETRIC])
{
  double most = 0.0;
  for (size_t k = 0; k < s->unknowns; k++) {
    lack[k] = s->wanted[k] - stress_of(s, s->component[k], lane);
    if (!(fabs(lack[k]) <= most))
      most = fabs(lack[k]) < HUGE_VAL ? fabs(lack[k]) : HUGE_VAL;
  }
  return most;
}

/* Stresses at `move` and slopes there; the lack of stress in lane 0. */
static gamut_status linearise(struct system *s, const double move[SYMMETRIC],
                              double lack[SYMMETRIC], double *most)
{
  double size = 0.0, beside[SYMMETRIC];
  for (size_t k = 0; k < 9; k++)
    size = fmax(size, fabs(s->fixed[k]));
  for (size_t k = 0; k < s->unknowns; k++)
    size = fmax(size, fabs(move[k]));
  double by = 1e-6 * size + 1e-10;
  for (size_t lane = 0; lane < LANES; lane++) {
    memcpy(beside, move, sizeof beside);
    if (lane > 0 && lane <= s->unknowns)
      beside[lane - 1] += by;
    place_lane(s, lane, beside);
  }
  gamut_status status = update(s);
  *most = residual(s, 0, lack);
  for (size_t k = 0; k < s->unknowns; k++)
    for (size_t j = 0; j < s->unknowns; j++)
      s->slope[k][j] =
          (stress_of(s, s->component[k], j + 1) - stress_of(s, s->component[k], 0)) / by;
  return status;
}

/* Gauss with pivots; false if the slopes are singular. */
static bool newton_step(const struct system *s, const double lack[SYMMETRIC],
                        double step[SYMMETRIC])
{
  double a[SYMMETRIC][SYMMETRIC + 1], largest = 0.0;
  size_t n = s->unknowns;
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++)
      largest = fmax(largest, fabs(a[i][j] = s->slope[i][j]));
    a[i][n] = lack[i];
  }
  for (size_t p = 0; p < n; p++) {
    size_t best = p;
    for (size_t i = p + 1; i < n; i++)
      if (fabs(a[i][p]) > fabs(a[best][p]))
        best = i;
    for (size_t j = 0; j <= n; j++) {
      double other = a[p][j];
      a[p][j] = a[best][j];
      a[best][j] = other;
    }
    if (!(fabs(a[p][p]) > 1e-9 * largest))
      return false;
    for (size_t i = p + 1; i < n; i++)
      for (size_t j = n + 1; j-- > p;)
        a[i][j] -= a[i][p] / a[p][p] * a[p][j];
  }
  for (size_t i = n; i-- > 0;) {
    step[i] = a[i][n];
    for (size_t j = i + 1; j < n; j++)
      step[i] -= a[i][j] * step[j];
    step[i] /= a[i][i];
  }
  return true;
}

/* Tries the step and its halves: takes the first that helps enough, else the best, if any. */
static gamut_status line_search(struct system *s, const double step[SYMMETRIC], double now,
                                double move[SYMMETRIC], bool *better)
{
  double lack[SYMMETRIC], best = now, chosen = 0.0, share = 1.0, tried[SYMMETRIC];
  for (size_t lane = 0; lane < LANES; lane++, share *= 0.5) {
    for (size_t k = 0; k < s->unknowns; k++)
      tried[k] = move[k] + share * step[k];
    place_lane(s, lane, tried);
  }
  gamut_status status = update(s);
  share = 1.0;
  for (size_t lane = 0; lane < LANES; lane++, share *= 0.5) {
    double most = residual(s, lane, lack);
    if (!(most < best))
      continue;
    best = most;
    chosen = share;
    if (most <= (1.0 - 0.5 * share) * now)
      break;
  }
  *better = chosen > 0.0;
  for (size_t k = 0; k < s->unknowns; k++)
    move[k] += chosen * step[k];
  return status;
}

static double largest_stress(const struct system *s)
{
  double most = 0.0;
  for (size_t c = 0; c < SYMMETRIC; c++)
    most = fmax(most, fabs(stress_of(s, c, 0)));
  for (size_t k = 0; k < s->unknowns; k++)
    most = fmax(most, fabs(s->wanted[k]));
  return most;
}

static double stiffness(const struct system *s)
{
  double most = 0.0;
  for (size_t i = 0; i < s->unknowns; i++)
    for (size_t j = 0; j < s->unknowns; j++)
      most = fmax(most, fabs(s->slope[i][j]));
  return most;
}

static void note_failure(const struct system *s, struct point *point, const double lack[SYMMETRIC],
                         double most)
{
  size_t worst = 0;
  for (size_t k = 1; k < s->unknowns; k++)
    if (fabs(lack[k]) > fabs(lack[worst]))
      worst = k;
  point->failed = s->driver->path.curve[s->component[worst]].name;
  point->left = lack[worst];
  point->wanted = s->wanted[worst];
  point->finite = most < HUGE_VAL;
}

static gamut_status solve(struct system *s, struct point *point, double move[SYMMETRIC])
{
  double lack[SYMMETRIC] = {0}, step[SYMMETRIC], most = 0.0, enough = 0.0;
  gamut_status status = GAMUT_OK;
  bool better = true;
  for (int i = 0; i < ITERATIONS && better && status == GAMUT_OK; i++) {
    status = linearise(s, move, lack, &most);
    double large = largest_stress(s), stiff = stiffness(s);
    enough = fmax(enough_share * large, enough_rounding * stiff);
    if (status != GAMUT_OK || most <= fmax(wanted_share * large, wanted_rounding * stiff))
      return status;
    better = most < HUGE_VAL && newton_step(s, lack, step);
    if (better)
      status = line_search(s, step, most, move, &better);
  }
  if (!(most <= enough))
    note_failure(s, point, lack, most);
  return status;
}

/* Without a step before to go by, a long step may end at a root far from the path: shares of the
 * step lead there, from one that is as good as linear. */
static gamut_status approach(const struct system *whole, struct point *point,
                             double move[SYMMETRIC])
{
  static const double share[] = {1e-4, 1e-3, 1e-2, 0.1, 0.3, 1.0};
  enum { SHARES = sizeof share / sizeof share[0] };
  gamut_status status = GAMUT_OK;
  for (size_t k = 0; k < whole->unknowns; k++)
    move[k] = 0.0;
  for (size_t i = 0; i < SHARES && status == GAMUT_OK; i++) {
    struct system part = *whole;
    for (size_t k = 0; k < 9; k++)
      part.fixed[k] *= share[i];
    for (size_t k = 0; k < whole->unknowns; k++) {
      double begin =
          gamut_begin(whole->chunk, whole->driver->stress, (unsigned)whole->component[k])[0];
      part.wanted[k] =
          share[i] < 1.0 ? begin + share[i] * (whole->wanted[k] - begin) : whole->wanted[k];
      move[k] *= i ? share[i] / share[i - 1] : 0.0;
    }
    point->failed = NULL;
    status = solve(&part, point, move);
  }
  return status;
}

static gamut_status find(struct system *s, struct point *point, double move[SYMMETRIC])
{
  gamut_status status = GAMUT_OK;
  if (!s->unknowns)
    return GAMUT_OK;
  if (!point->moved)
    return approach(s, point, move);
  for (size_t k = 0; k < s->unknowns; k++)
    move[k] = point->rate[s->component[k]] * s->dt;
  status = solve(s, point, move);
  if (status == GAMUT_OK && point->failed)
    status = approach(s, point, move);
  return status;
}

/* Work of the stress in the step, from J stress at both ends. */
static double work_of(const struct driver *driver, const struct gamut_chunk *chunk,
                      const struct point *point)
{
  const double *A = point->A;
  double J0 = 1.0 + volume_change(point->H), J1 = 1.0 + volume_change(point->H_end), sum = 0.0;
  double strain[SYMMETRIC] = {A[0], A[4], A[8], A[1] + A[3], A[5] + A[7], A[6] + A[2]};
  for (unsigned c = 0; c < SYMMETRIC; c++)
    sum += strain[c] * (J0 * gamut_begin(chunk, driver->stress, c)[0] +
                        J1 * gamut_end(chunk, driver->stress, c)[0]);
  return 0.5 * sum;
}

gamut_status drive(void *self, const struct gamut_chunk *chunk)
{
  struct driver *driver = self;
  struct point *point = &driver->point[chunk->set->index];
  struct system s = {.driver = driver, .chunk = chunk, .dt = gamut_time_step(driver->run)};
  double from = gamut_time(driver->run), move[SYMMETRIC] = {0}, G[9];
  path_increment(&driver->path, from, s.dt, s.fixed);
  s.unknowns = path_stresses(&driver->path, from + s.dt, s.component, s.wanted);
  gamut_status status = find(&s, point, move);
  if (status != GAMUT_OK)
    return status;
  for (size_t lane = 0; lane < chunk->count; lane++)
    place_lane(&s, lane, move);
  status = update(&s);
  memcpy(point->A, s.fixed, sizeof point->A);
  for (size_t k = 0; k < s.unknowns; k++) {
    path_move(&driver->path, s.component[k], move[k], point->A);
    point->rate[s.component[k]] = move[k] / s.dt;
  }
  point->moved = true;
  exponential_less_one(point->A, G);
  compose(G, point->H, point->H_end);
  const double *energy = chunk->end[driver->energy.first];
  point->energy = energy ? energy[0] : 0.0;
  point->work_step = work_of(driver, chunk, point);
  return status;
}
