#include "report/body_points.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A disc reaches three quarters of the way to the third nearest neighbour: discs of a lattice then
 * cover the plane, also where it is stretched two to one or sheared, and stand over the surface by
 * a quarter of a spacing only. */
enum { NEIGHBOURS = 3 };
static const double reach = 0.75;

static void bounds(const struct result_body *body, double lower[3], double upper[3])
{
  for (int k = 0; k < 3; ++k) {
    for (size_t i = 0; i < body->count; ++i) {
      double x = body->position[3 * i + (size_t)k];
      if (!isfinite(x))
        continue;
      lower[k] = fmin(lower[k], x);
      upper[k] = fmax(upper[k], x);
    }
  }
}

struct view view_of(const struct result_frame *frame)
{
  double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
  int axes = 1;
  for (size_t b = 0; b < frame->bodies; ++b) {
    bounds(&frame->body[b], lower, upper);
    axes = frame->body[b].axes > axes ? frame->body[b].axes : axes;
  }
  if (axes < 3)
    return (struct view){0, 1, -1};
  bool along_z =
      upper[2] - lower[2] > upper[1] - lower[1] && upper[2] - lower[2] > upper[0] - lower[0];
  return along_z ? (struct view){0, 2, 1} : (struct view){0, 1, 2};
}

/* The points to show: all, or those of a slice one layer thick. A body cut at a plane of symmetry
 * shows the layer beside that plane, a whole one the two layers in its middle. */
static size_t choose(const struct result_body *body, const struct view *view, struct disc *disc)
{
  double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
  double middle = 0, half = INFINITY;
  size_t count = 0;
  bounds(body, lower, upper);
  if (view->normal >= 0) {
    int n = view->normal;
    double volume = 1;
    for (int k = 0; k < 3; ++k)
      volume *= fmax(upper[k] - lower[k], 1e-300);
    double spacing = cbrt(volume / (double)body->count);
    half = 0.6 * spacing;
    middle = fabs(lower[n]) < spacing ? lower[n] : 0.5 * (lower[n] + upper[n]);
  }
  for (size_t i = 0; i < body->count; ++i) {
    const double *x = body->position + 3 * i;
    if (!isfinite(x[view->x]) || !isfinite(x[view->y]))
      continue;
    if (view->normal >= 0 && !(fabs(x[view->normal] - middle) <= half))
      continue;
    disc[count++] = (struct disc){
        .x = x[view->x], .y = x[view->y], .value = body->value ? body->value[i] : NAN};
  }
  return count;
}

/* Square bins, so that neighbours are found without looking at all points. */
struct bins {
  double x, y, size;
  size_t across, up;
  size_t *head, *next; /* lists of discs, index + 1; 0 ends */
};

static size_t bin_of(double x, double origin, double size, size_t count)
{
  double number = (x - origin) / size;
  return number <= 0 ? 0 : number >= (double)count ? count - 1 : (size_t)number;
}

static bool bins_make(struct bins *bins, const struct cloud *cloud, double size)
{
  double width = cloud->upper[0] - cloud->lower[0], height = cloud->upper[1] - cloud->lower[1];
  *bins = (struct bins){.x = cloud->lower[0], .y = cloud->lower[1], .size = size};
  bins->across = (size_t)(width / size) + 1;
  bins->up = (size_t)(height / size) + 1;
  bins->head = calloc(bins->across * bins->up, sizeof *bins->head);
  bins->next = calloc(cloud->count + 1, sizeof *bins->next);
  if (!bins->head || !bins->next)
    return false;
  for (size_t i = 0; i < cloud->count; ++i) {
    size_t bin = bin_of(cloud->disc[i].x, bins->x, size, bins->across) +
                 bins->across * bin_of(cloud->disc[i].y, bins->y, size, bins->up);
    bins->next[i] = bins->head[bin];
    bins->head[bin] = i + 1;
  }
  return true;
}

/* Keeps the smallest distances in order. */
static void insert(double nearest[NEIGHBOURS], double distance)
{
  for (int k = 0; k < NEIGHBOURS; ++k) {
    if (distance < nearest[k]) {
      double larger = nearest[k];
      nearest[k] = distance;
      distance = larger;
    }
  }
}

/* Points closer than `twin` are one: two layers of a slice lie upon each other. */
static double neighbour_distance(const struct cloud *cloud, size_t index, const struct bins *bins,
                                 double twin)
{
  const struct disc *own = &cloud->disc[index];
  double nearest[NEIGHBOURS];
  size_t column = bin_of(own->x, bins->x, bins->size, bins->across);
  size_t row = bin_of(own->y, bins->y, bins->size, bins->up);
  for (int k = 0; k < NEIGHBOURS; ++k)
    nearest[k] = INFINITY;
  for (size_t r = row ? row - 1 : 0; r <= row + 1 && r < bins->up; ++r) {
    for (size_t c = column ? column - 1 : 0; c <= column + 1 && c < bins->across; ++c) {
      for (size_t j = bins->head[c + bins->across * r]; j; j = bins->next[j - 1]) {
        double distance = hypot(cloud->disc[j - 1].x - own->x, cloud->disc[j - 1].y - own->y);
        if (distance > twin)
          insert(nearest, distance);
      }
    }
  }
  return nearest[NEIGHBOURS - 1];
}

static bool size_discs(struct cloud *cloud)
{
  struct bins bins;
  double width = cloud->upper[0] - cloud->lower[0], height = cloud->upper[1] - cloud->lower[1];
  double spacing = sqrt(fmax(width, 1e-12) * fmax(height, 1e-12) / (double)cloud->count);
  bool good = bins_make(&bins, cloud, 2.5 * spacing);
  for (size_t i = 0; i < cloud->count && good; ++i) {
    double distance = neighbour_distance(cloud, i, &bins, 0.05 * spacing);
    /* a point that has flown off is no larger than the others */
    cloud->disc[i].radius = reach * fmin(distance, 1.5 * spacing);
  }
  free(bins.head);
  free(bins.next);
  return good;
}

bool cloud_make(const struct result_body *body, const struct view *view, struct cloud *cloud)
{
  *cloud = (struct cloud){.lower = {INFINITY, INFINITY}, .upper = {-INFINITY, -INFINITY}};
  cloud->disc = calloc(body->count + 1, sizeof *cloud->disc);
  if (!cloud->disc)
    return false;
  cloud->count = choose(body, view, cloud->disc);
  for (int pass = 0; pass < 2; ++pass) {
    for (size_t i = 0; i < cloud->count; ++i) {
      const struct disc *t = &cloud->disc[i];
      cloud->lower[0] = fmin(cloud->lower[0], t->x - t->radius);
      cloud->upper[0] = fmax(cloud->upper[0], t->x + t->radius);
      cloud->lower[1] = fmin(cloud->lower[1], t->y - t->radius);
      cloud->upper[1] = fmax(cloud->upper[1], t->y + t->radius);
    }
    if (pass == 0 && cloud->count > 0 && !size_discs(cloud))
      return false;
  }
  return true;
}

void cloud_free(struct cloud *cloud)
{
  free(cloud->disc);
}
