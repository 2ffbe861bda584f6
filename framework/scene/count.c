/* Counts that follow from numbers of a scene: how often something fits into something else. A slip
 * in one of them must not make a loop without end or take all memory. */
#include <math.h>

#include "scene/scene_private.h"

bool count_within(struct reading *reading, const struct tree *node, const char *what, double whole,
                  double part, double most)
{
  char expected[160];
  const double count = whole / part;
  if (part > 0 && count <= most)
    return true;
  snprintf(expected, sizeof expected, "at most %.6g, so at least %.3g", most, whole / most);
  blame_value(reading, node, expected, "that makes %.3g %s", count, what);
  return false;
}

double axis_length(const struct reading *reading)
{
  const struct value *end = values_find(reading->scene->solver.values, "end");
  return end && end->present && end->real > 0 && isfinite(end->real) ? end->real : 0.0;
}

bool every_within(struct reading *reading, const struct tree *node, const char *what, double every,
                  double most)
{
  enum { A_UNIT_MOST = 1000 };
  const struct instance *solver = &reading->scene->solver;
  const double whole = axis_length(reading);
  if (!solver->descriptor || (!(whole > 0) && values_find(solver->values, "end")))
    return true; /* what is wrong is reported already */
  if (whole > 0)
    return count_within(reading, node, what, whole, every, most);
  return count_within(reading, node, what, 1.0, every, A_UNIT_MOST);
}
