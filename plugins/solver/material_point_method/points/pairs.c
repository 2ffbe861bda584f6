/* Bodies that share nodes. All points have one velocity field: where points of two bodies reach the
 * same node, the bodies move as one there. That is reported before the run. */
#include <math.h>
#include <stdio.h>

#include "model.h"

/* Points of a body within a box, hashed by bins as wide as the reach. */
struct bins {
  struct place_table *table; /* the first point of a bin; further ones by `next` */
  double (*place)[3];
  int32_t *next;
  size_t count;
  double width, from[3];
};

/* The closest points of a pair so far: their distance in reaches, and what lies between. */
struct closest {
  double reaches, gap;
};

/* A look at the points of a body that lie within a box, one by one. */
struct walk {
  const struct model *model;
  const struct body *body;
  const double *listed; /* null: a lattice */
  size_t listed_count, listed_next;
  long first[3], last[3], at[3];
  double lower[3], upper[3];
  bool done;
};

/* Distance along one axis from which on points of two bodies share no node. */
static double reach_of(const struct model *m, const struct body *a, const struct body *b,
                       unsigned axis)
{
  if (m->shape == SHAPE_GIMP)
    return 2.0 * m->cell + 0.5 * (a->spacing[axis] + b->spacing[axis]);
  return m->cell * m->grid.nodes;
}

static double upper_of(const struct body *b, unsigned axis)
{
  return b->lower[axis] + b->spacing[axis] * (double)b->count[axis];
}

static void walk_begin(const struct model *m, const struct body *b, const double lower[3],
                       const double upper[3], struct walk *w)
{
  const double *volume;
  *w = (struct walk){.model = m, .body = b};
  w->listed_count = layout_listed(m, b, &w->listed, &volume);
  for (unsigned k = 0; k < 3; k++) {
    w->lower[k] = k < m->dimension ? lower[k] : -HUGE_VAL;
    w->upper[k] = k < m->dimension ? upper[k] : HUGE_VAL;
    if (k >= m->dimension || w->listed_count > 0)
      continue;
    const double last = (double)(b->count[k] - 1);
    w->first[k] = (long)fmin(fmax(floor((lower[k] - b->lower[k]) / b->spacing[k]), 0.0), last);
    w->last[k] = (long)fmin(fmax(ceil((upper[k] - b->lower[k]) / b->spacing[k]), 0.0), last);
    w->at[k] = w->first[k];
  }
}

static void walk_on(struct walk *w)
{
  for (unsigned k = 0; k < 3; k++) {
    if (++w->at[k] <= w->last[k])
      return;
    w->at[k] = w->first[k];
  }
  w->done = true;
}

static bool walk_next(struct walk *w, double x[3])
{
  const struct model *m = w->model;
  while (w->listed_count > 0 ? w->listed_next < w->listed_count : !w->done) {
    bool inside = true;
    if (w->listed_count > 0) {
      for (unsigned k = 0; k < 3; k++)
        x[k] = w->listed[3 * w->listed_next + k];
      w->listed_next++;
    } else {
      layout_place(w->body, m->dimension, w->at, x);
      walk_on(w);
    }
    for (unsigned k = 0; k < m->dimension; k++)
      inside = inside && x[k] >= w->lower[k] && x[k] <= w->upper[k];
    if (inside && (w->listed_count > 0 || m->host->body_contains(w->body->scene, x)))
      return true;
  }
  return false;
}

static void bin_of(const struct model *m, const struct bins *bins, const double x[3], int32_t at[3])
{
  for (unsigned k = 0; k < 3; k++)
    at[k] = k < m->dimension ? (int32_t)floor((x[k] - bins->from[k]) / bins->width) : 0;
}

static gamut_status fill_bins(struct model *m, const struct body *b, const double lower[3],
                              const double upper[3], struct bins *bins)
{
  static const char label[] = "pairs of bodies";
  struct walk w;
  double x[3];
  size_t count = 0;
  for (walk_begin(m, b, lower, upper, &w); walk_next(&w, x);)
    count++;
  if (count == 0)
    return GAMUT_OK;
  bins->place = gamut_allocate(m->run, label, count * sizeof *bins->place);
  bins->next = gamut_allocate(m->run, label, count * sizeof *bins->next);
  if (bins->place == NULL || bins->next == NULL ||
      places_clear(m->run, &bins->table, count) != GAMUT_OK)
    return GAMUT_INTERNAL;
  for (walk_begin(m, b, lower, upper, &w); bins->count < count && walk_next(&w, x);) {
    int32_t at[3];
    bin_of(m, bins, x, at);
    for (unsigned k = 0; k < 3; k++)
      bins->place[bins->count][k] = x[k];
    bins->next[bins->count] = places_find(bins->table, at);
    places_put(bins->table, at, (int32_t)bins->count++);
  }
  return GAMUT_OK;
}

static void compare(const struct model *m, const struct body *a, const struct body *b,
                    const double x[3], const double y[3], struct closest *found)
{
  double reaches = 0.0, gap = 0.0;
  for (unsigned k = 0; k < m->dimension; k++) {
    const double apart = fabs(x[k] - y[k]);
    reaches = fmax(reaches, apart / reach_of(m, a, b, k));
    gap = fmax(gap, apart - 0.5 * (a->spacing[k] + b->spacing[k]));
  }
  if (reaches < found->reaches)
    *found = (struct closest){reaches, gap};
}

/* Compares a point with those in its bin and in the bins around. */
static void search(const struct model *m, const struct body *a, const struct body *b,
                   const struct bins *bins, const double x[3], struct closest *found)
{
  int32_t middle[3];
  bin_of(m, bins, x, middle);
  const int wide[3] = {3, m->dimension > 1 ? 3 : 1, m->dimension > 2 ? 3 : 1};
  for (int n = 0; n < wide[0] * wide[1] * wide[2]; n++) {
    const int32_t at[3] = {middle[0] + n % 3 - 1, middle[1] + (wide[1] > 1 ? n / 3 % 3 - 1 : 0),
                           middle[2] + (wide[2] > 1 ? n / 9 - 1 : 0)};
    for (int32_t i = places_find(bins->table, at); i >= 0; i = bins->next[i])
      compare(m, a, b, bins->place[i], x, found);
  }
}

/* The closest points of two bodies, as far as they are within reach; touching ones are not looked
 * for any further. */
static gamut_status find_closest(struct model *m, const struct body *a, const struct body *b,
                                 struct closest *found)
{
  double lower[3] = {0.0}, upper[3] = {0.0}, x[3];
  struct bins bins = {.width = 0.0};
  *found = (struct closest){1.0 - 1e-9, 0.0};
  for (unsigned k = 0; k < m->dimension; k++) {
    const double reach = reach_of(m, a, b, k);
    lower[k] = fmax(a->lower[k], b->lower[k]) - reach;
    upper[k] = fmin(upper_of(a, k), upper_of(b, k)) + reach;
    bins.width = fmax(bins.width, reach);
    bins.from[k] = lower[k];
    if (!(lower[k] < upper[k]))
      return GAMUT_OK;
  }
  gamut_status status = fill_bins(m, a, lower, upper, &bins);
  if (status == GAMUT_OK && bins.count > 0) {
    struct walk w;
    walk_begin(m, b, lower, upper, &w);
    while ((found->gap > 1e-9 * m->cell || !(found->reaches < 0.5)) && walk_next(&w, x))
      search(m, a, b, &bins, x, found);
  }
  places_free(m->run, bins.table);
  gamut_release(m->run, bins.place);
  gamut_release(m->run, bins.next);
  return status;
}

static void tell(struct model *m, const struct body *a, const struct body *b, double gap)
{
  double reach = 0.0;
  for (unsigned k = 0; k < m->dimension; k++)
    reach = fmax(reach, reach_of(m, a, b, k) - 0.5 * (a->spacing[k] + b->spacing[k]));
  char apart[64] = "touch";
  if (gap > 1e-9 * m->cell)
    snprintf(apart, sizeof apart, "are %.4g m apart", gap);
  gamut_warn(m->run,
             "bodies '%s' and '%s' %s: closer than %.4g m (%.3g cells) bodies share nodes of the "
             "grid and are welded there, so that they neither slide on each other nor part, also "
             "in tension. Bodies that come so close in flight stick together. A smaller cell makes "
             "that distance smaller",
             m->host->body_name(a->scene), m->host->body_name(b->scene), apart, reach,
             reach / m->cell);
}

gamut_status pairs_warn(struct model *m)
{
  for (size_t i = 0; i < m->bodies; i++)
    for (size_t k = i + 1; k < m->bodies; k++) {
      struct closest found;
      const gamut_status status = find_closest(m, &m->body[i], &m->body[k], &found);
      if (status != GAMUT_OK)
        return status;
      if (found.reaches < 1.0 - 1e-9)
        tell(m, &m->body[i], &m->body[k], found.gap);
    }
  return GAMUT_OK;
}
