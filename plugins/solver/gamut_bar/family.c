/* Families of nonlocal bonds: each follows the law's curve with Masing's memory of where it turned.
 *
 * Backbone: s + E~ pi(s) = T. A branch begins at the last point (T, s, pi) where the family turned
 * and is the backbone twice as large. It ends where it meets the branch before, which is then
 * followed on. */
#include <string.h>

#include "bar.h"

enum { TURN_T, TURN_S, TURN_PI };
enum { THREADED = 16 }; /* chunks from which threads are worth waking */

static gamut_status law_new(struct bar *bar, size_t from, struct family_law *law)
{
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  law->from = from;
  law->count = bar->bonds - from < FAMILY_CHUNK ? bar->bonds - from : FAMILY_CHUNK;
  gamut_status status = host->law(bar->run, bar->body, "strength", law->count, &law->law);
  if (status != GAMUT_OK)
    return status;
  law->given = host->law_array(law->law, "flow_stress_given");
  law->inverse = host->law_array(law->law, "plastic_strain_inverse");
  law->strain = host->law_array(law->law, "plastic_strain");
  law->flow = host->law_array(law->law, "flow_stress");
  law->slope = host->law_array(law->law, "flow_stress_slope_plastic_strain");
  law->modulus = host->law_array(law->law, "youngs_modulus");
  law->yield = host->law_array(law->law, "yield_stress");
  law->n = host->law_array(law->law, "n");
  law->K = host->law_array(law->law, "K");
  if (!law->given || !law->inverse || !law->strain || !law->flow || !law->slope)
    return gamut_fail_at(bar->run, host->body_values(bar->body), "material",
                         "a strength with `inverse: true` in its descriptor, as ramberg_osgood",
                         "solver/gamut_bar needs the plastic strain at a stress, which the "
                         "strength '%s' of this material does not give",
                         host->body_strength(bar->run, bar->body));
  return GAMUT_OK;
}

/* The first law is asked for figures; the others are made when the bar starts, so that a plan of it
 * takes no memory. What they will take is asked for and given back. */
gamut_status families_new(struct bar *bar, size_t depth)
{
  enum { LAW_BYTES = 160 };
  static const char label[] = "families";
  struct families *f = &bar->families;
  size_t n = bar->bonds;
  f->depth = depth;
  f->laws = (n + FAMILY_CHUNK - 1) / FAMILY_CHUNK;
  f->law = gamut_allocate(bar->run, label, f->laws * sizeof *f->law);
  if (!f->law)
    return GAMUT_INTERNAL;
  gamut_status status = law_new(bar, 0, &f->law[0]);
  if (status != GAMUT_OK)
    return status;
  void *room = gamut_allocate(bar->run, "laws of families", LAW_BYTES * n);
  gamut_release(bar->run, room);
  if (!room)
    return GAMUT_INTERNAL;
  for (int k = 0; k < 3; k++)
    if (!(f->turn[k] = gamut_allocate(bar->run, "memory of families", n * depth * sizeof(double))))
      return GAMUT_INTERNAL;
  double **array[] = {&f->internal,     &f->stress,        &f->plastic,    &f->direction,
                      &f->trial_stress, &f->trial_plastic, &f->trial_slope};
  for (size_t k = 0; k < sizeof array / sizeof array[0]; k++)
    if (!(*array[k] = bar_array(bar, label)))
      return GAMUT_INTERNAL;
  f->count = gamut_allocate(bar->run, label, n);
  f->trial_count = gamut_allocate(bar->run, label, n);
  f->below = gamut_allocate(bar->run, label, n);
  return f->count && f->trial_count && f->below ? GAMUT_OK : GAMUT_INTERNAL;
}

gamut_status families_start(struct bar *bar)
{
  struct families *f = &bar->families;
  for (size_t c = 1; c < f->laws; c++) {
    gamut_status status = law_new(bar, c * FAMILY_CHUNK, &f->law[c]);
    if (status != GAMUT_OK)
      return status;
  }
  return GAMUT_OK;
}

/* What family i remembers at `level`, with the turn under way on top. */
static double remembered(const struct families *f, size_t bonds, size_t i, size_t level, int what)
{
  if (level < f->below[i])
    return f->turn[what][level * bonds + i];
  return what == TURN_T ? f->internal[i] : what == TURN_S ? f->stress[i] : f->plastic[i];
}

/* Entries that stay below a turn made here. A turn at the end of the branch closes a loop, though
 * rounding may leave it short of that: what the loop began with is then replaced, not kept. */
static size_t below_turn(const struct families *f, size_t bonds, size_t i)
{
  static const double same = 1e-9;
  size_t count = f->count[i];
  if (count == 0)
    return 0;
  double last = f->turn[TURN_T][(count - 1) * bonds + i];
  double before = count > 1 ? f->turn[TURN_T][(count - 2) * bonds + i] : -last;
  if (fabs(f->internal[i] - before) > same * fabs(before - last))
    return count;
  return count > 1 ? count - 2 : 0;
}

/* How many turns still count at T: closed loops are forgotten. Equal ends close a loop, but for
 * rounding. Back past the last turn, the branch before it goes on. */
static size_t turns_left(const struct families *f, size_t bonds, size_t i, size_t count, double T)
{
  static const double rounding = 1e-13;
  while (count > 0) {
    double last = remembered(f, bonds, i, count - 1, TURN_T);
    double before = count > 1 ? remembered(f, bonds, i, count - 2, TURN_T) : -last;
    if ((T - last) * (before - last) < 0.0)
      count--;
    else if (fabs(T - last) > fabs(before - last) * (1.0 + rounding))
      count = count > 1 ? count - 2 : 0;
    else
      break;
  }
  return count;
}

/* A turn counts once the branch has left its straight part: small vibrations leave no memory. */
static bool turns(const struct families *f, size_t bonds, size_t i, double T)
{
  static const double straight = 1e-15; /* plastic strain */
  size_t count = f->count[i];
  double begin = count ? f->turn[TURN_PI][(count - 1) * bonds + i] : 0.0;
  return (T - f->internal[i]) * f->direction[i] < 0.0 && fabs(f->plastic[i] - begin) > straight;
}

/* One chunk's work: bonds from to from + count; t and s of the curve, both positive. */
struct curve {
  size_t from, count;
  double t[FAMILY_CHUNK], s[FAMILY_CHUNK], plastic[FAMILY_CHUNK], compliance[FAMILY_CHUNK];
  bool fixed[FAMILY_CHUNK];
};

/* Plastic strain and its slope by the stress at the present s. A law whose slope is zero has no
 * plastic strain there yet. */
static void look_up(const struct gamut_host *host, const struct family_law *law, struct curve *c)
{
  memcpy(law->given, c->s, c->count * sizeof(double));
  host->law_call(law->law, "inverse", c->count, NULL);
  memcpy(law->strain, law->inverse, c->count * sizeof(double));
  host->law_call(law->law, "flow_stress", c->count, NULL);
#pragma omp simd
  for (size_t i = 0; i < c->count; i++)
    c->compliance[i] = law->slope[i] > 0.0 ? 1.0 / law->slope[i] : 0.0;
}

/* s + E~ pi(s) = t is convex and increasing: Newton comes down from the right, and stops where
 * rounding does. Each family stops by itself, so that its bits do not depend on its neighbours. */
static bool follow_curve(const struct gamut_host *host, const struct family_law *law,
                         const double *softening, struct curve *c)
{
  enum { ROUNDS = 100 };
  static const double enough = 4e-15;
  for (size_t i = 0; i < c->count; i++)
    law->strain[i] = c->t[i] / softening[c->from + i];
  host->law_call(law->law, "flow_stress", c->count, NULL);
  for (size_t i = 0; i < c->count; i++) {
    c->s[i] = fmin(c->t[i], law->flow[i]);
    c->fixed[i] = false;
  }
  for (int round = 0; round < ROUNDS; round++) {
    bool all = true;
    look_up(host, law, c);
    for (size_t i = 0; i < c->count; i++) {
      double E = softening[c->from + i];
      double step = (c->s[i] + E * law->inverse[i] - c->t[i]) / (1.0 + E * c->compliance[i]);
      bool now = fabs(step) <= enough * c->s[i];
      c->plastic[i] = c->fixed[i] ? c->plastic[i] : law->inverse[i];
      c->s[i] -= c->fixed[i] || now ? 0.0 : step;
      c->fixed[i] |= now;
      all &= c->fixed[i];
    }
    if (all)
      return true;
  }
  return false;
}

static bool evaluate_chunk(struct bar *bar, size_t chunk, const double *T)
{
  struct families *f = &bar->families;
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  size_t n = bar->bonds, from = f->law[chunk].from;
  struct curve c = {.from = from, .count = f->law[chunk].count};
  for (size_t k = 0; k < c.count; k++) {
    size_t i = from + k;
    bool turned = turns(f, n, i, T[i]);
    f->below[i] = turned ? (unsigned char)below_turn(f, n, i) : f->count[i];
    size_t count = turns_left(f, n, i, (size_t)f->below[i] + turned, T[i]);
    f->trial_count[i] = (unsigned char)count;
    double begin = count ? remembered(f, n, i, count - 1, TURN_T) : 0.0;
    c.t[k] = fabs(T[i] - begin) * (count ? 0.5 : 1.0);
  }
  bool good = follow_curve(host, &f->law[chunk], bar->softening, &c);
  for (size_t k = 0; k < c.count; k++) {
    size_t i = from + k, count = f->trial_count[i];
    double begin = count ? remembered(f, n, i, count - 1, TURN_T) : 0.0;
    double way = copysign(count ? 2.0 : 1.0, T[i] - begin);
    double s = count ? remembered(f, n, i, count - 1, TURN_S) : 0.0;
    double plastic = count ? remembered(f, n, i, count - 1, TURN_PI) : 0.0;
    f->trial_stress[i] = s + way * c.s[k];
    f->trial_plastic[i] = plastic + way * c.plastic[k];
    f->trial_slope[i] = c.compliance[k] / (1.0 + bar->softening[i] * c.compliance[k]);
  }
  return good;
}

gamut_status families_evaluate(struct bar *bar, const double *T)
{
  bool good = true;
#pragma omp parallel for schedule(static) num_threads(bar->threads) reduction(&& : good)           \
    if (bar->threads > 1 && bar->families.laws >= THREADED)
  for (size_t c = 0; c < bar->families.laws; c++)
    good = evaluate_chunk(bar, c, T) && good;
  return good ? GAMUT_OK
              : gamut_fail(bar->run, GAMUT_NUMERICS,
                           "the strength law gives no stress at load step %llu: the plastic strain "
                           "that it is asked for is beyond it, or not a number",
                           (unsigned long long)bar->load.step);
}

gamut_status families_commit(struct bar *bar, const double *T)
{
  struct families *f = &bar->families;
  size_t n = bar->bonds;
  for (size_t i = 0; i < n; i++) {
    size_t count = f->trial_count[i];
    /* The turn under way is kept if its branch is still followed. */
    if (count > f->below[i]) {
      if (count > f->depth)
        return gamut_fail(bar->run, GAMUT_NUMERICS,
                          "the load turns within itself more than %zu times at bond %zu", f->depth,
                          i);
      f->turn[TURN_T][(count - 1) * n + i] = f->internal[i];
      f->turn[TURN_S][(count - 1) * n + i] = f->stress[i];
      f->turn[TURN_PI][(count - 1) * n + i] = f->plastic[i];
    }
    f->count[i] = (unsigned char)count;
    double moved = T[i] - f->internal[i];
    f->direction[i] = moved != 0.0 ? copysign(1.0, moved) : f->direction[i];
    f->internal[i] = T[i];
    f->stress[i] = f->trial_stress[i];
    f->plastic[i] = f->trial_plastic[i];
  }
  return GAMUT_OK;
}
