/* Counts that follow from numbers of a scene: how often something fits into something else. A slip
 * in one of them must not make a loop without end or take all memory. */
#include <math.h>

#include "scene/scene_private.h"

bool count_within(struct scene_reader *reader, const struct tree *node, const char *what,
                  double whole, double part, double most)
{
  char expected[160];
  const double count = whole / part;
  if (part > 0 && count <= most)
    return true;
  snprintf(expected, sizeof expected, "at most %.6g, so at least %.3g", most, whole / most);
  error_at_value(reader, node, expected, "that makes %.3g %s", count, what);
  return false;
}

double axis_length(const struct scene_reader *reader)
{
  const struct value *end = values_find(reader->scene->solver.values, "end");
  return end && end->present && end->real > 0 && isfinite(end->real) ? end->real : 0.0;
}

bool every_within(struct scene_reader *reader, const struct tree *node, const char *what,
                  double every, double most)
{
  enum { A_UNIT_MOST = 1000 };
  const struct instance *solver = &reader->scene->solver;
  const double whole = axis_length(reader);
  if (!solver->descriptor || (!(whole > 0) && values_find(solver->values, "end")))
    return true; /* what is wrong is reported already */
  if (whole > 0)
    return count_within(reader, node, what, whole, every, most);
  return count_within(reader, node, what, 1.0, every, A_UNIT_MOST);
}
