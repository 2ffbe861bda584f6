/* Counts of work: what a run did, apart from any clock. They do not depend on threads, so a test
 * can hold them. */
#include "run/run_private.h"

uint64_t *work_open(struct gamut_run *run, const char *name)
{
  struct work_count *count = arena_take(run->arena, "counts of work", sizeof *count);
  if (!count) {
    trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
    return NULL;
  }
  count->name = name;
  struct work_count **end = &run->count;
  while (*end)
    end = &(*end)->next;
  *end = count;
  return &count->value;
}

json_t *work_json(const struct gamut_run *run)
{
  json_t *entry = json_object();
  uint64_t strength = 0, eos = 0;
  for (size_t m = 0; m < run->scene->materials; m++)
    if (run->material[m]) {
      strength += material_evaluations(run->material[m], GAMUT_KIND_STRENGTH);
      eos += material_evaluations(run->material[m], GAMUT_KIND_EOS);
    }
  json_object_set_new(entry, "point_steps", json_integer((json_int_t)run->work));
  json_object_set_new(entry, "strength_points", json_integer((json_int_t)strength));
  json_object_set_new(entry, "eos_points", json_integer((json_int_t)eos));
  for (const struct work_count *c = run->count; c; c = c->next)
    json_object_set_new(entry, c->name, json_integer((json_int_t)c->value));
  return entry;
}
