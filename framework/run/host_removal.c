/* Points that leave a run: effects ask for it, the solver does it, and it is reported. */
#include <math.h>
#include <string.h>

#include "registry/guard.h"
#include "run/host.h"

/* One effect that takes points out. */
struct leaving {
  struct leaving *next;
  const struct running_effect *effect;
  struct gamut_removal rule;
  const struct gamut_removed *sum;
  char name[200]; /* of its lines in the ledger: "erosion frame" */
};

static struct leaving *new_leaving(struct gamut_run *run, const struct gamut_removal *rule)
{
  struct leaving *leaving = arena_take(run->arena, "removal", sizeof *leaving);
  if (!leaving)
    return NULL;
  leaving->effect = run->creating;
  leaving->rule = *rule;
  snprintf(leaving->name, sizeof leaving->name, "%s %s",
           run->creating->effect->instance.descriptor->name, run->creating->effect->instance.name);
  struct leaving **end = &run->leaving;
  while (*end)
    end = &(*end)->next;
  *end = leaving;
  return leaving;
}

/* Flagged points of these bodies go with this mark; the first effect that asks has them. */
static gamut_status spare_flagged(struct gamut_run *run, double mark)
{
  size_t bodies = run->scene->bodies;
  if (!run->spare.mark)
    run->spare.mark = arena_take(run->arena, "removal", bodies * sizeof *run->spare.mark);
  if (!run->spare.mark)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t b = 0; b < bodies; b++)
    if (run->creating->effect->on_body[b] && !(run->spare.mark[b] > 0.0))
      run->spare.mark[b] = mark;
  return GAMUT_OK;
}

gamut_status host_removal(struct gamut_run *run, const struct gamut_removal *rule,
                          const struct gamut_removed **sum, double *mark)
{
  gamut_status status;
  struct gamut_field field;
  if (!run->creating)
    return trace_fail(run->trace, GAMUT_PLUGIN, "only an effect's create may ask for removal");
  if (!run->solver->removal)
    return trace_fail(run->trace, GAMUT_SCENE,
                      "%s lets points leave the run, which %s does not offer",
                      run->creating->label, run->scene->solver.descriptor->id);
  TRY(run_host.field(run, "removal", &field));
  struct leaving *leaving = new_leaving(run, rule);
  if (!leaving)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  TRY(GUARDED(run->scene->solver.descriptor->id,
              run->solver->removal(run->solver_self, leaving->name, run->creating->effect->on_body,
                                   &leaving->rule, &leaving->sum, mark)));
  run->spare.component = field.first;
  if (rule->flagged)
    TRY(spare_flagged(run, *mark));
  *sum = leaving->sum;
done:
  return status;
}

void host_drop(struct gamut_run *run, struct gamut_set *set, const uint32_t *slot, size_t count)
{
  (void)run;
  set_drop(set_inside(set), slot, count);
}

void removal_start(struct gamut_run *run)
{
  if (!run->spare.mark)
    return;
  for (size_t m = 0; m < run->scene->materials; m++)
    if (run->material[m])
      material_spare(run->material[m], &run->spare);
  for (size_t e = 0; e < run->effects; e++)
    if (run->effect[e].bound)
      effect_spare(run->effect[e].bound, &run->spare);
}

void removal_warn(const struct gamut_run *run, struct trace *trace)
{
  for (const struct leaving *l = run->leaving; l; l = l->next) {
    char text[256];
    if (!(l->sum->points > 0.0))
      continue;
    snprintf(text, sizeof text,
             "%.0f point%s out of the run: %.6g kg with %.6g J of kinetic and %.6g J of internal "
             "energy",
             l->sum->points, l->sum->points > 1.0 ? "s" : "", l->sum->mass, l->sum->kinetic,
             l->sum->internal);
    if (l->rule.expected)
      trace_note(trace, "%s took %s", l->name, text);
    else
      trace_warn_at(trace, NULL, NULL, NULL, "%s took %s", l->name, text);
  }
}
