#include <string.h>

#include "run/inside.h"

/* "position 0.001 0.002 0 m, velocity ..., temperature 298 K": the state that the point had. */
static void describe_state(const struct gamut_run *run, const struct point_set *set, size_t slot,
                           char *text, size_t size)
{
  static const char *const shown[] = {"position", "velocity", "volume_ratio", "stress",
                                      "plastic_strain", "energy", "temperature"};
  *text = '\0';
  for (size_t f = 0; f < sizeof shown / sizeof shown[0]; f++) {
    const struct field *field = fields_find(run->fields, shown[f]);
    if (!field || !field->stored)
      continue;
    size_t used = strlen(text);
    if (used + 1 < size)
      snprintf(text + used, size - used, "%s%s", used ? "; " : "", field->name);
    for (unsigned k = 0; k < field->handle.components; k++) {
      const double *array = set_stored(set, field->handle, k);
      used = strlen(text);
      if (array && used + 1 < size)
        snprintf(text + used, size - used, " %.6g", array[slot]);
    }
    used = strlen(text);
    if (used + 1 < size)
      snprintf(text + used, size - used, " %s", strcmp(field->unit, "1") ? field->unit : "");
  }
}

static gamut_status report(struct gamut_run *run, const struct flag_stop *stop)
{
  char state[768] = "";
  const struct point_set *set = run->set[stop->set];
  size_t slot = set_find(set, stop->id);
  if (slot != SIZE_MAX)
    describe_state(run, set, slot, state, sizeof state);
  return trace_fail(run->trace, GAMUT_NUMERICS,
                    "%s stopped the run at t = %.6g s, step %llu: %s. Point %lld of body '%s' "
                    "(material '%s'): %s",
                    stop->plugin->id, run->time, (unsigned long long)run->steps,
                    stop->message ? stop->message->text : "a point may not go on",
                    (long long)stop->id, set->open.body,
                    run->scene->material[set->material].name, state);
}

gamut_status stop_check(struct gamut_run *run)
{
  struct flag_stop stop;
  for (size_t m = 0; m < run->scene->materials; m++)
    if (run->material[m] && material_stopped(run->material[m], &stop))
      return report(run, &stop);
  for (size_t i = 0; i < run->effects; i++)
    if (run->effect[i].bound && effect_stopped(run->effect[i].bound, &stop))
      return report(run, &stop);
  return GAMUT_OK;
}
