/* Effects against the materials of the bodies that they work on: what a plan can know. */
#include <stdlib.h>
#include <string.h>

#include "run/run_private.h"

/* Sets or adds to the stress. */
static bool imposes_stress(const struct task *task, const char *owner)
{
  bool writes = false;
  for (size_t u = 0; u < task->uses; u++)
    writes |= strcmp(task->use[u].field->name, "stress") == 0 && access_writes(task->use[u].access);
  return task->live && writes && strcmp(task->owner, owner) == 0;
}

/* A stress that is set behind the back of an elasticity which works it out anew from other states
 * would act on the motion for one step and leave the strain energy as it was: energy from nowhere.
 */
static gamut_status check_imposed(const struct gamut_run *run, const struct running_effect *effect)
{
  const struct instance *asked = &effect->effect->instance;
  char path[256] = "";
  for (size_t b = 0; b < run->scene->bodies; b++) {
    const struct material *material = &run->scene->material[run->scene->body[b].material];
    const struct descriptor *elasticity = material->elasticity.descriptor;
    if (effect->effect->on_body[b] && elasticity &&
        !descriptor_provides(elasticity, "imposed_stress"))
      return trace_fail_at(
          run->trace, GAMUT_SCENE, asked->node ? &asked->node->place : NULL,
          asked->node ? tree_path(asked->node, path, sizeof path) : NULL,
          "another elasticity, or `bodies:` without this one",
          "effect '%s' (%s) sets the stress, but %s of material '%s' (body '%s') takes no stress "
          "from elsewhere: it does not provide 'imposed_stress'",
          asked->name, asked->descriptor->id, elasticity->id, material->name,
          run->scene->body[b].name);
  }
  return GAMUT_OK;
}

/* Calls the eos for material that is pulled apart, up to ten times its volume, without energy.
 * `word` is the worst status. */
static gamut_status ask_opened(struct gamut_run *run, const struct material *material,
                               int64_t *word, double *compression)
{
  gamut_status status;
  struct kernel *eos = NULL;
  struct bench *bench = NULL;
  enum { STATES = GAMUT_LANES };
  TRY(kernel_new(&material->eos, run->registry, run->arena, STATES, material->extra,
                 material->density, run, run->trace, &eos));
  TRY(bench_new(eos, NULL, NULL, STATES, run->trace, &bench));
  double *mu = bench_array(bench, "compression"), *energy = bench_array(bench, "energy");
  double *density = bench_array(bench, "reference_density");
  for (int i = 0; i < STATES; i++) {
    if (mu)
      mu[i] = -0.9 * (i + 1) / STATES;
    if (energy)
      energy[i] = 0.0;
    if (density)
      density[i] = material->density;
  }
  bench_call(bench, kernel_operation(eos, 0), STATES);
  *word = 0;
  for (int i = STATES - 1; mu && i >= 0; i--)
    if (bench_status(bench)[i] >= *word) {
      *word = bench_status(bench)[i];
      *compression = mu[i];
    }
done:
  bench_free(bench);
  kernel_free(eos);
  return status;
}

/* Material that an effect opens is still handed to its eos, which may have no answer there. */
static gamut_status check_opened(struct gamut_run *run, const struct running_effect *effect,
                                 bool *warned)
{
  gamut_status status = GAMUT_OK;
  const struct instance *asked = &effect->effect->instance;
  for (size_t b = 0; b < run->scene->bodies; b++) {
    const size_t m = run->scene->body[b].material;
    const struct material *material = &run->scene->material[m];
    const struct descriptor *eos = material->eos.descriptor;
    int64_t word = 0;
    double mu = 0.0;
    char path[256] = "";
    if (warned[m] || !effect->effect->on_body[b] || !eos)
      continue;
    TRY(ask_opened(run, material, &word, &mu));
    warned[m] = true;
    if (status_severity(word) != GAMUT_STOP)
      continue;
    const struct message *message = status_message(eos, word);
    trace_warn_at(run->trace, asked->node ? &asked->node->place : NULL,
                  asked->node ? tree_path(asked->node, path, sizeof path) : NULL, NULL,
                  "effect '%s' (%s) lets material open, but %s of material '%s' stops a run in "
                  "opened material (at compression %.3g: %s)",
                  asked->name, asked->descriptor->id, eos->id, material->name, mu,
                  message ? message->text : "no message");
  }
done:
  return status;
}

static bool uses_as(const struct task *task, const char *field, bool (*test)(enum gamut_access))
{
  for (size_t u = 0; u < task->uses; u++)
    if (test(task->use[u].access) && strcmp(task->use[u].field->name, field) == 0)
      return true;
  return false;
}

/* Heat that nobody takes up, or that finds no energy to go into, would be lost without a word. */
static gamut_status check_heat(const struct gamut_run *run, const struct running_effect *effect,
                               const struct task *task)
{
  const struct instance *asked = &effect->effect->instance;
  const struct descriptor *solver = run->scene->solver.descriptor;
  char path[256] = "";
  const struct place *place = asked->node ? &asked->node->place : NULL;
  if (asked->node)
    tree_path(asked->node, path, sizeof path);
  if (!uses_as(task, "transfer_heat", access_writes) || strcmp(task->owner, effect->label) != 0)
    return GAMUT_OK;
  if (!descriptor_provides(solver, "heat"))
    return trace_fail_at(run->trace, GAMUT_SCENE, place, path, "a solver that provides 'heat'",
                         "effect '%s' (%s) gives points heat, which %s does not take up",
                         asked->name, asked->descriptor->id, solver->id);
  for (size_t b = 0; b < run->scene->bodies; b++) {
    bool kept = !effect->effect->on_body[b];
    for (size_t i = 0; !kept && i < schedule_tasks(run->schedule); i++) {
      const struct task *other = schedule_task(run->schedule, i);
      kept = other->only_set == b && other->live && uses_as(other, "energy", access_writes);
    }
    if (!kept)
      return trace_fail_at(run->trace, GAMUT_SCENE, place, path, "`bodies:` without this one",
                           "effect '%s' (%s) gives points of body '%s' heat, but their material "
                           "keeps no energy",
                           asked->name, asked->descriptor->id, run->scene->body[b].name);
  }
  return GAMUT_OK;
}

gamut_status effects_check(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  bool *warned = calloc(run->scene->materials + 1, sizeof *warned);
  if (!warned)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t e = 0; e < run->effects; e++) {
    struct running_effect *effect = &run->effect[e];
    bool live = false;
    for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
      const struct task *task = schedule_task(run->schedule, i);
      live |= task->live && strcmp(task->owner, effect->label) == 0;
      if (imposes_stress(task, effect->label))
        TRY(check_imposed(run, effect));
      TRY(check_heat(run, effect, task));
    }
    if (live && descriptor_provides(effect->effect->instance.descriptor, "opened_material"))
      TRY(check_opened(run, effect, warned));
  }
done:
  free(warned);
  return status;
}
