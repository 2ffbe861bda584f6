/* Shapes: bounds, depth and volume of each, against formulas and against counting. */
#include <math.h>

#include "scene/scene_private.h"
#include "tests/tap.h"

static const double pi = 3.14159265358979323846;

/* Volume by counting the places of a lattice in the bounds. */
static double counted(const struct shape *shape, unsigned dimension)
{
  double lower[3], upper[3], cell = 1;
  size_t n = dimension == 3 ? 80 : 600, all = 1, inside = 0;
  shape_bounds(shape, lower, upper);
  for (unsigned k = 0; k < dimension; k++) {
    cell *= (upper[k] - lower[k]) / (double)n;
    all *= n;
  }
  for (size_t i = 0; i < all; i++) {
    double x[3] = {0};
    size_t rest = i;
    for (unsigned k = 0; k < dimension; k++, rest /= n)
      x[k] = lower[k] + (upper[k] - lower[k]) * ((double)(rest % n) + 0.5) / (double)n;
    inside += shape_contains(shape, x);
  }
  return cell * (double)inside;
}

static void test_bounds(const char *name, const struct shape *shape, const double low[3],
                        const double high[3])
{
  double lower[3], upper[3], off = 0;
  shape_bounds(shape, lower, upper);
  for (int k = 0; k < 3; k++)
    off = fmax(off, fmax(fabs(lower[k] - low[k]), fabs(upper[k] - high[k])));
  tap_ok(off < 1e-15, "%s: bounds off by %.3g (allowed 1e-15)", name, off);
}

static void test_round(void)
{
  const struct shape tube = {.kind = SHAPE_TUBE, .radius = 2, .inner_radius = 1, .length = 3,
                             .axis = 0, .centre = {1, 0, 0}};
  const struct shape cone = {.kind = SHAPE_CONE, .radius = 2, .top_radius = 0.5, .length = 3,
                             .axis = 1};
  test_bounds("tube", &tube, (double[]){1, -2, -2}, (double[]){4, 2, 2});
  test_bounds("cone", &cone, (double[]){-2, 0, -2}, (double[]){2, 3, 2});
  tap_relative("tube: volume", shape_volume(&tube, 3, false), 9 * pi, 1e-15);
  tap_relative("tube: volume by counting", counted(&tube, 3), 9 * pi, 3e-3);
  tap_relative("cone: volume", shape_volume(&cone, 3, false), 5.25 * pi, 1e-15);
  tap_relative("cone: volume by counting", counted(&cone, 3), 5.25 * pi, 3e-3);
  tap_ok(!shape_contains(&tube, (double[]){2, 0.9, 0}) &&
             shape_contains(&tube, (double[]){2, 1, 0}),
         "a tube is closed and has a hole");
  tap_relative("cone: depth at its middle is across the side",
               shape_depth(&cone, (double[]){0, 1.5, 0}), 1.25 * 2 / sqrt(5), 1e-15);
  tap_ok(!shape_inside(&cone, (double[]){1.24, 1.5, 0}, 0.01) &&
             shape_inside(&cone, (double[]){1.24, 1.5, 0}, 0.005),
         "a margin is a distance from the surface");
}

static void test_revolved(void)
{
  const struct shape tube = {.kind = SHAPE_TUBE, .radius = 2, .inner_radius = 1, .length = 3,
                             .axis = 1, .revolved = true};
  const struct shape ring = {.kind = SHAPE_TUBE, .radius = 2, .inner_radius = 1,
                             .length = INFINITY, .axis = 2};
  double lower[3], upper[3];
  shape_bounds(&tube, lower, upper);
  tap_relative("revolved tube: lowest radius", lower[0], 1, 0);
  tap_relative("revolved tube: volume", shape_volume(&tube, 2, true), 9 * pi, 1e-15);
  tap_relative("tube in a plane: area", shape_volume(&ring, 2, false), 3 * pi, 1e-15);
  tap_relative("tube in a plane: area by counting", counted(&ring, 2), 3 * pi, 1e-3);
}

static void test_joined(void)
{
  struct shape part[] = {{.kind = SHAPE_BOX, .lower = {0, 0, 0}, .upper = {2, 1, 1}},
                         {.kind = SHAPE_BOX, .lower = {2, 0, 0}, .upper = {3, 2, 1}},
                         {.kind = SHAPE_SPHERE, .radius = 0.25, .centre = {1, 0.5, 0.5}}};
  const struct shape both = {.kind = SHAPE_UNION, .part = part, .parts = 2};
  const struct shape all = {.kind = SHAPE_UNION, .part = part, .parts = 3};
  struct shape cut[] = {both, part[2]};
  const struct shape holed = {.kind = SHAPE_DIFFERENCE, .part = cut, .parts = 2};
  test_bounds("union", &both, (double[]){0, 0, 0}, (double[]){3, 2, 1});
  test_bounds("difference", &holed, (double[]){0, 0, 0}, (double[]){3, 2, 1});
  tap_relative("union: volume of parts that touch", shape_volume(&both, 3, false), 4, 1e-15);
  tap_ok(shape_volume(&all, 3, false) == 0 && shape_volume(&holed, 3, false) == 0,
         "no formula where parts overlap, or for a difference");
  tap_relative("union: by counting", counted(&both, 3), 4, 1e-2);
  tap_relative("difference: by counting", counted(&holed, 3), 4 - 4.0 / 3 * pi / 64, 1e-2);
  tap_ok(shape_contains(&both, (double[]){2, 0.5, 0.5}), "parts that touch have no gap");
  tap_ok(!shape_contains(&holed, (double[]){1, 0.5, 0.5}) &&
             shape_contains(&holed, (double[]){1.25, 0.5, 0.5}),
         "what is taken away is gone, its surface stays");
}

static void test_points(void)
{
  double place[] = {0, 0, 0, 1, 0, 0}, volume[] = {1, 0.125}, half[] = {0.5, 0.25};
  const struct shape points = {.kind = SHAPE_POINTS,
                               .points = {.count = 2, .place = place, .volume = volume,
                                          .half = half}};
  test_bounds("points", &points, (double[]){-0.5, -0.5, -0.5}, (double[]){1.25, 0.5, 0.5});
  tap_relative("points: volume", shape_volume(&points, 3, false), 1.125, 0);
  tap_ok(shape_contains(&points, (double[]){0.5, 0.4, 0}) &&
             !shape_contains(&points, (double[]){0.6, 0, 0}),
         "a point stands for its cube");
}

int main(void)
{
  test_round();
  test_revolved();
  test_joined();
  test_points();
  return tap_done();
}
