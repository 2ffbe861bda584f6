#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "catalogue/catalogue.h"
#include "registry/guard.h"
#include "run/host.h"

enum {
  CHUNK_BY_DEFAULT = 128,
  POINTS_PER_THREAD = 8192,
  THREADS_MAX = 1024 /* the OpenMP library keeps a word per thread on the stack */
};

/* Values and bodies carry the table, so that a plugin needs nothing else to ask them. */
static void attach_host(struct scene *scene)
{
  host_of_values(scene->solver.values, &run_host);
  for (size_t i = 0; i < scene->bodies; i++) {
    scene->body[i].host = &run_host;
    host_of_values(scene->body[i].solver_values, &run_host);
  }
  for (size_t i = 0; i < scene->effects; i++)
    host_of_values(scene->effect[i].instance.values, &run_host);
  for (size_t i = 0; i < scene->materials; i++) {
    host_of_values(scene->material[i].eos.values, &run_host);
    host_of_values(scene->material[i].strength.values, &run_host);
    host_of_values(scene->material[i].elasticity.values, &run_host);
    host_of_values(scene->material[i].extra, &run_host);
  }
  for (size_t i = 0; i < scene->quantities; i++)
    host_of_values(scene->quantity[i].arguments, &run_host);
}

static size_t chunk_of(const struct scene *scene)
{
  const struct value *block = values_find(scene->solver.values, "block");
  size_t chunk = block && block->present ? (size_t)block->real : CHUNK_BY_DEFAULT;
  chunk = (chunk + GAMUT_LANES - 1) / GAMUT_LANES * GAMUT_LANES;
  return chunk < GAMUT_LANES ? GAMUT_LANES : chunk > GAMUT_CHUNK_MAX ? GAMUT_CHUNK_MAX : chunk;
}

static gamut_status bind_materials(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  struct scene *scene = run->scene;
  if (scene->solver.descriptor->laws)
    return GAMUT_OK; /* it calls the laws itself */
  for (size_t b = 0; b < scene->bodies; b++) {
    size_t m = scene->body[b].material;
    if (!run->material[m])
      TRY(material_new(&scene->material[m], run, run->registry, run->arena, run->fields, run->chunk,
                       run->threads, run->trace, &run->material[m]));
  }
done:
  return status;
}

/* Fields of the solver's own at points. */
static gamut_status declare_outputs(struct gamut_run *run)
{
  const struct descriptor *d = run->scene->solver.descriptor;
  for (size_t i = 0; i < d->outputs; i++) {
    const struct field_use *use = &d->output[i];
    if (!catalogue_find(use->name) &&
        !fields_add(run->fields, use->name, GAMUT_AT_POINT, use->components, use->unit, use->name,
                    run->trace))
      return GAMUT_PLUGIN;
  }
  return GAMUT_OK;
}

static gamut_status create_solver(struct gamut_run *run)
{
  gamut_status status;
  const struct instance *instance = &run->scene->solver;
  const struct gamut_plugin *plugin;
  TRY(registry_open(run->registry, instance->descriptor, run->trace, &plugin));
  const struct solver_operations *ops = plugin->ops;
  if (!ops->create || !ops->destroy || !ops->start || !ops->next) {
    status = trace_fail(run->trace, GAMUT_PLUGIN,
                        "%s lacks one of the operations create, destroy, start, next",
                        instance->descriptor->id);
    goto done;
  }
  TRY(declare_outputs(run));
  TRY(declare_states(run, &run->scene->solver));
  TRY(GUARDED(instance->descriptor->id, ops->create(run, instance->values, &run->solver_self)));
  run->solver = ops;
  if ((run->scene->checkpoint_every > 0.0 || run->scene->checkpoint_wall > 0.0) &&
      !run_can_stop(run))
    status =
        trace_fail_at(run->trace, GAMUT_SCENE, NULL, "outputs.checkpoint", "leave it out",
                      "%s has no `save`: its runs leave no checkpoints", instance->descriptor->id);
done:
  return status;
}

static gamut_status run_inner(const struct material_job *job, const struct gamut_chunk *chunk)
{
  const char *before = guard_enter(job->run->scene->solver.descriptor->id);
  gamut_status status = job->inner(job->self, chunk);
  guard_leave(before);
  return status;
}

/* A strength that is less than none, or no number, would pass for no flow at all. */
static gamut_status check_factor(struct gamut_run *run, const struct gamut_chunk *chunk)
{
  double factor;
  const size_t i = material_bad_factor(run->material[set_material(chunk->set)], chunk, &factor);
  if (i == SIZE_MAX)
    return GAMUT_OK;
  return trace_fail(run->trace, GAMUT_NUMERICS,
                    "effects leave point %lld of body '%s' a flow_stress_factor of %g, where a "
                    "number of at least 0 is due",
                    (long long)chunk->set->id[chunk->slot + i], chunk->set->body, factor);
}

static gamut_status run_material_job(void *self, const struct gamut_chunk *chunk)
{
  struct material_job *job = self;
  struct bound_material *material = job->run->material[set_material(chunk->set)];
  gamut_status status = check_factor(job->run, chunk);
  if (status != GAMUT_OK)
    return status;
  if (job->inner)
    status = run_inner(job, chunk);
  else
    material_update(material, chunk);
  material_tally(material, chunk);
  return status;
}

/* Where the scene names the effect that is made now. */
static const struct place *place_of_owner(const struct gamut_run *run)
{
  return run->creating ? &run->creating->effect->instance.node->place : NULL;
}

/* A task that updates materials is registered once a set, since each set's material has fields of
 * its own. */
static gamut_status add_material_task(struct gamut_run *run, const char *owner,
                                      const struct gamut_task *task, size_t set)
{
  size_t count;
  const struct gamut_use *uses = material_uses(run->material[run->set[set]->material], &count);
  struct gamut_use *all = calloc(task->use_count + count + 1, sizeof *all);
  struct material_job *job = calloc(1, sizeof *job);
  struct material_job **grown = realloc(run->job, (run->jobs + 1) * sizeof(*grown));
  if (grown)
    run->job = grown;
  if (!all || !job || !grown) {
    free(all);
    free(job);
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  }
  run->job[run->jobs++] = job;
  *job = (struct material_job){run, task->run, task->self};
  if (task->use_count)
    memcpy(all, task->uses, task->use_count * sizeof *all);
  memcpy(all + task->use_count, uses, count * sizeof *all);
  struct gamut_task whole = *task;
  whole.uses = all;
  whole.use_count = task->use_count + count;
  whole.run = run_material_job;
  whole.self = job;
  gamut_status status = schedule_add(run->schedule, owner, place_of_owner(run), &whole, run->fields,
                                     set, NULL, run->trace);
  free(all);
  const struct bound_material *material = run->material[run->set[set]->material];
  const struct gamut_use *offer;
  for (size_t i = 0; status == GAMUT_OK && (offer = material_offers(material, i, &count)); i++)
    schedule_offer(run->schedule, offer, count);
  return status;
}

static gamut_status declare_used(struct gamut_run *run, const struct gamut_task *task)
{
  gamut_status status = GAMUT_OK;
  struct gamut_field unused;
  for (size_t i = 0; i < task->use_count; i++)
    TRY(run_host.field(run, task->uses[i].field, &unused));
done:
  return status;
}

/* Whose code a task is that is added now. */
static const char *adding(const struct gamut_run *run)
{
  return run->creating ? run->creating->effect->instance.descriptor->id
                       : run->scene->solver.descriptor->id;
}

/* An effect's task names states of its own. */
static struct gamut_use *resolved_uses(const struct gamut_run *run, const struct gamut_task *task)
{
  struct gamut_use *uses = calloc(task->use_count + 1, sizeof *uses);
  for (size_t i = 0; uses && i < task->use_count; i++) {
    uses[i] = task->uses[i];
    if (run->creating)
      uses[i].field = instance_field(&run->creating->effect->instance, uses[i].field);
  }
  return uses;
}

gamut_status run_add_task(struct gamut_run *run, const char *owner, const struct gamut_task *given,
                          size_t only_set, const bool *on_set)
{
  gamut_status status = GAMUT_OK;
  struct gamut_task named = *given, *task = &named;
  struct gamut_use *uses = resolved_uses(run, given);
  if (!uses)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  named.uses = uses;
  TRY(declare_used(run, task));
  if (!task->material) {
    TRY(schedule_add(run->schedule, owner, place_of_owner(run), task, run->fields, only_set, on_set,
                     run->trace));
    if (task->offer_count)
      schedule_offer(run->schedule, task->offers, task->offer_count);
    schedule_plugin(run->schedule, adding(run));
  }
  for (size_t s = 0; task->material && s < run->scene->bodies; s++)
    TRY(add_material_task(run, owner, task, s));
done:
  free(uses);
  return status;
}

static bool has_phase(const struct descriptor *d, const char *phase)
{
  for (size_t i = 0; i < d->phases; i++)
    if (strcmp(d->phase[i], phase) == 0)
      return true;
  return false;
}

static gamut_status add_own_material_tasks(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  char owner[160];
  if (!has_phase(run->scene->solver.descriptor, "material"))
    return GAMUT_OK;
  for (size_t s = 0; s < run->scene->bodies; s++) {
    const struct gamut_task task = {
        .name = "material", .phase = "material", .extent = GAMUT_PER_CHUNK, .material = true};
    snprintf(owner, sizeof owner, "material %s", run->scene->material[run->set[s]->material].name);
    TRY(add_material_task(run, owner, &task, s));
  }
done:
  return status;
}

static void resolve_materials(struct gamut_run *run)
{
  for (size_t i = 0; i < schedule_tasks(run->schedule); i++) {
    const struct task *task = schedule_task(run->schedule, i);
    if (task->live && task->run == run_material_job)
      material_resolve(run->material[run->set[task->only_set]->material], task, run->fields);
  }
}

static gamut_status check_sets(const struct gamut_run *run)
{
  for (size_t b = 0; b < run->scene->bodies; b++)
    if (!run->set[b])
      return trace_fail(run->trace, GAMUT_PLUGIN, "%s made no points of body '%s'",
                        run->scene->solver.descriptor->id, run->scene->body[b].name);
  return GAMUT_OK;
}

static bool make_uniform(struct gamut_run *run)
{
  for (size_t k = 0; k < fields_components(run->fields); k++) {
    if (fields_of_component(run->fields, k)->where != GAMUT_AT_RUN)
      continue;
    run->uniform_row[k] = arena_take(run->arena, "uniform fields", run->chunk * sizeof(double));
    if (!run->uniform_row[k])
      return false;
  }
  return true;
}

/* While a run starts every stored field is there, states with a fresh end. */
static void lead_start(struct gamut_run *run)
{
  for (size_t k = 0; k < fields_components(run->fields); k++) {
    const struct field *field = fields_of_component(run->fields, k);
    enum source source = SOURCE_NONE;
    if (field->where == GAMUT_AT_RUN)
      source = SOURCE_UNIFORM;
    else if (field->where == GAMUT_AT_POINT && field->stored)
      source = field->history ? SOURCE_FRESH : SOURCE_ARRAY;
    else if (field->where == GAMUT_AT_POINT && field->used)
      source = SOURCE_SCRATCH;
    run->start_source[k] = (unsigned char)source;
  }
}

static gamut_status allocate_all(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  size_t components = fields_components(run->fields);
  run->uniform = calloc(components + 1, sizeof(*run->uniform));
  run->uniform_row = calloc(components + 1, sizeof(*run->uniform_row));
  run->start_source = calloc(components + 1, 1);
  run->scratch = calloc((size_t)run->threads, sizeof(*run->scratch));
  bool good =
      run->uniform && run->uniform_row && run->start_source && run->scratch && make_uniform(run);
  for (int t = 0; good && t < run->threads; t++)
    good = (run->scratch[t] = scratch_new(run->arena, run->fields, run->chunk)) != NULL;
  if (!good)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t s = 0; s < run->scene->bodies; s++)
    TRY(set_allocate(run->set[s], run->fields, run->trace));
  given_fill(run);
  lead_start(run);
done:
  return status;
}

static gamut_status assemble(struct gamut_run *run)
{
  gamut_status status;
  const struct descriptor *solver = run->scene->solver.descriptor;
  run->schedule = schedule_new(solver->phase, solver->phases);
  TRY(random_open(run));
  TRY(bind_materials(run));
  TRY(create_solver(run));
  TRY(check_sets(run));
  TRY(effects_create(run));
  TRY(add_own_material_tasks(run));
  TRY(observe_create(run));
  TRY(frames_create(run));
  TRY(given_mark(run));
  TRY(schedule_plan(run->schedule, run->fields, run->scene->bodies, run->trace));
  TRY(effects_check(run));
  TRY(effects_resolve(run));
  resolve_materials(run);
  TRY(allocate_all(run));
done:
  return status;
}

/* A thread with few points waits for the others longer than it works, and on a busy machine much
 * longer. Bits do not depend on it. */
static void limit_threads(struct gamut_run *run)
{
  size_t points = 0;
  for (size_t b = 0; b < run->scene->bodies; b++)
    points += run->set[b]->open.points;
  size_t worth = 1 + points / POINTS_PER_THREAD;
  if ((size_t)run->threads > worth)
    run->threads = (int)worth;
}

gamut_status run_new(struct scene *scene, struct registry *registry,
                     const struct run_options *options, struct trace *trace, struct gamut_run **out)
{
  gamut_status status;
  struct gamut_run *run = calloc(1, sizeof *run);
  *out = NULL;
  if (!run)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  run->head.host = &run_host;
  run->scene = scene;
  run->registry = registry;
  run->options = *options;
  run->trace = trace;
  run->arena = arena_new();
  run->fields = fields_new();
  run->chunk = chunk_of(scene);
  run->threads = options->threads;
#ifdef _OPENMP
  if (run->threads <= 0)
    run->threads = omp_get_max_threads();
#endif
  run->threads = run->threads < 1 ? 1 : run->threads;
  if (run->threads > THREADS_MAX) {
    status = trace_fail(trace, GAMUT_USAGE, "%d threads are too many: at most %d", run->threads,
                        THREADS_MAX);
    goto done;
  }
  run->material = calloc(scene->materials + 1, sizeof(*run->material));
  run->set = calloc(scene->bodies + 1, sizeof(*run->set));
  const struct value *end = values_find(scene->solver.values, "end");
  run->end = end && end->present ? end->real : 0.0;
  attach_host(scene);
  if (!run->arena || !run->fields || !run->material || !run->set) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  status = assemble(run);
  if (status == GAMUT_INTERNAL && run->too_large)
    status = GAMUT_SCENE; /* the plugin knows only that it got none */
  TRY(status);
  if (options->threads <= 0)
    limit_threads(run);
done:
  if (status != GAMUT_OK) {
    run_free(run);
    run = NULL;
  }
  *out = run;
  return status;
}

void run_free(struct gamut_run *run)
{
  if (!run)
    return;
  effects_free(run);
  if (run->solver)
    run->solver->destroy(run->solver_self);
  host_laws_free(run);
  observe_free(run);
  frames_free(run);
  ledger_free(run);
  free(run->taken);
  for (size_t m = 0; run->material && m < run->scene->materials; m++)
    material_free(run->material[m]);
  for (size_t s = 0; run->set && s < run->scene->bodies; s++)
    set_free(run->set[s]);
  random_free(run);
  for (size_t i = 0; i < run->jobs; i++)
    free(run->job[i]);
  schedule_free(run->schedule);
  fields_free(run->fields);
  arena_free(run->arena);
  free(run->job);
  free(run->material);
  free(run->set);
  free(run->scratch);
  free(run->uniform);
  free(run->uniform_row);
  free(run->start_source);
  free(run);
}

void run_record(struct gamut_run *run, struct store *store)
{
  run->store = store;
}
