#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "catalogue/catalogue.h"
#include "material/material_private.h"
#include "registry/guard.h"

/* Arguments of a law are set by its caller; only other inputs come from fields. */
static bool is_argument(int role, const char *name)
{
  static const char *const strength[] = {"plastic_strain", "plastic_strain_rate", "temperature",
                                         "pressure", "compression"};
  static const char *const eos[] = {"compression", "energy"};
  const char *const *list = role == STRENGTH ? strength : eos;
  size_t count = role == STRENGTH ? ARRAY_SIZE(strength) : ARRAY_SIZE(eos);
  for (size_t i = 0; role != ELASTICITY && i < count; i++)
    if (strcmp(list[i], name) == 0)
      return true;
  return false;
}

static bool is_result(int role, const struct slot *slot)
{
  return role != ELASTICITY && slot->kind == SLOT_OUTPUT;
}

/* Links of a law leave out arguments and results, which live in its own rows. */
static void drop_own_rows(const struct kernel *kernel, int role, struct links *links)
{
  size_t kept = 0;
  for (size_t i = 0; i < links->count; i++) {
    const struct slot *slot = &kernel->slot[links->link[i].slot];
    bool argument = slot->kind == SLOT_INPUT && is_argument(role, slot->name);
    if (!argument && !is_result(role, slot))
      links->link[kept++] = links->link[i];
  }
  links->count = kept;
}

static void add_use(struct bound_material *bound, const char *field, enum gamut_access access)
{
  for (size_t i = 0; i < bound->uses; i++)
    if (strcmp(bound->use[i].field, field) == 0 && bound->use[i].access == access)
      return;
  bound->use[bound->uses++] = (struct gamut_use){field, access};
}

/* A body gives every point a temperature, so it can be read though no task writes it. */
static enum gamut_access input_access(const struct field_use *input)
{
  if (strcmp(input->name, "temperature") == 0)
    return GAMUT_READ_BEGIN;
  return input->optional ? GAMUT_READ_IF : GAMUT_READ;
}

static void collect_uses(struct bound_material *bound, int role)
{
  const struct descriptor *d = bound->kernel[role]->descriptor;
  for (size_t i = 0; i < d->inputs; i++) {
    const struct field_info *info = catalogue_find(d->input[i].name);
    bool point = !info || info->where == GAMUT_AT_POINT;
    bool temperature = strcmp(d->input[i].name, "temperature") == 0;
    if (point && (temperature || !is_argument(role, d->input[i].name)))
      add_use(bound, d->input[i].name, input_access(&d->input[i]));
  }
  for (size_t i = 0; i < d->states; i++) {
    add_use(bound, d->state[i].name, GAMUT_READ_BEGIN);
    add_use(bound, d->state[i].name, GAMUT_WRITE);
  }
  for (size_t i = 0; role == ELASTICITY && i < d->outputs; i++)
    add_use(bound, d->output[i].name, GAMUT_WRITE);
  for (size_t s = 0; s < bound->kernel[role]->slots; s++)
    if (slot_varies(bound->kernel[role], s))
      add_use(bound, bound->kernel[role]->path[s], GAMUT_READ_BEGIN);
}

static size_t uses_at_most(const struct material *material)
{
  const struct instance *part[ROLES] = {&material->elasticity, &material->strength, &material->eos};
  size_t most = 1;
  for (int role = 0; role < ROLES; role++) {
    const struct descriptor *d = part[role]->descriptor;
    most += d ? d->inputs + 2 * d->states + d->outputs + d->parameters + d->material_parameters : 0;
  }
  return most;
}

static gamut_status make_kernel(struct bound_material *bound, int role,
                                const struct instance *instance, struct registry *registry,
                                struct fields *fields, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  if (!instance->descriptor)
    return GAMUT_OK;
  TRY(kernel_new(instance, registry, bound->arena, bound->chunk, bound->material->extra,
                 bound->material->density, bound->run, trace, &bound->kernel[role]));
  if (role != ELASTICITY)
    TRY(kernel_try(bound->kernel[role], trace));
  TRY(links_new(bound->kernel[role], fields, trace, &bound->links[role]));
  drop_own_rows(bound->kernel[role], role, &bound->links[role]);
  collect_uses(bound, role);
done:
  return status;
}

static bool wants_law(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->laws; i++)
    if (strcmp(d->law[i].name, name) == 0)
      return true;
  return false;
}

/* Scratch rows and laws of the elasticity's image. */
static gamut_status allocate_scratch(struct bound_material *bound, struct thread_state *state)
{
  const struct kernel *kernel = bound->kernel[ELASTICITY];
  size_t stride = bound->chunk + ARRAY_PAD, row = 0;
  for (size_t s = 0; s < kernel->slots; s++)
    row += kernel->slot[s].kind == SLOT_SCRATCH;
  state->scratch =
      arena_take(bound->arena, "scratch of kernels", (row + 2) * stride * sizeof(double));
  state->image = image_new(kernel, bound->arena, bound->chunk, "scratch of kernels");
  if (!state->scratch || !state->image)
    return GAMUT_INTERNAL;
  state->zero = state->scratch;
  state->sink = state->scratch + stride;
  row = 2;
  for (size_t s = 0; s < kernel->slots; s++) {
    if (kernel->slot[s].kind == SLOT_SCRATCH)
      state->image->pointer[s] = state->scratch + stride * row++;
    if (kernel->slot[s].kind != SLOT_LAW)
      continue;
    bool strength = strcmp(kernel->slot[s].name, "strength") == 0;
    struct law *law = state->law[strength ? STRENGTH : EOS];
    if (law)
      state->image->pointer[s] = strength ? (void *)&law->strength : (void *)&law->eos;
  }
  return GAMUT_OK;
}

static gamut_status make_thread_states(struct bound_material *bound, struct trace *trace)
{
  bound->per_thread =
      arena_take(bound->arena, "scratch of kernels", bound->threads * sizeof *bound->per_thread);
  bool good = bound->per_thread != NULL;
  for (size_t t = 0; good && t < bound->threads; t++) {
    for (int role = STRENGTH; good && role < ROLES; role++)
      if (bound->kernel[role])
        good = law_new(bound->kernel[role], bound->arena, bound->chunk,
                       &bound->per_thread[t].law[role]) == GAMUT_OK;
    good = good && allocate_scratch(bound, &bound->per_thread[t]) == GAMUT_OK;
    bound->per_thread[t].step_factor = INFINITY;
  }
  return good ? GAMUT_OK : trace_fail(trace, GAMUT_INTERNAL, "out of memory");
}

static size_t component_or_none(const struct fields *fields, const char *name)
{
  const struct field *field = fields_find(fields, name);
  return field ? field->handle.first : SIZE_MAX;
}

static gamut_status check_laws(const struct bound_material *bound, struct trace *trace)
{
  const struct material *m = bound->material;
  const struct descriptor *d = m->elasticity.descriptor;
  for (size_t i = 0; i < d->laws; i++) {
    bool strength = strcmp(d->law[i].name, "strength") == 0;
    if (!d->law[i].optional && !bound->kernel[strength ? STRENGTH : EOS])
      return trace_fail_at(trace, GAMUT_SCENE, &m->node->place, NULL,
                           "give the material one; `gamut list` shows what there is",
                           "%s needs an `%s:`, material '%s' has none", d->id, d->law[i].name,
                           m->name);
  }
  return bound->kernel[STRENGTH] ? strength_fits(m, d, trace) : GAMUT_OK;
}

gamut_status material_new(const struct material *material, struct gamut_run *run,
                          struct registry *registry, struct arena *arena, struct fields *fields,
                          size_t chunk, int threads, struct trace *trace,
                          struct bound_material **out)
{
  gamut_status status;
  struct bound_material *bound = calloc(1, sizeof *bound);
  if (!bound)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  bound->material = material;
  bound->run = run;
  bound->arena = arena;
  bound->chunk = chunk;
  bound->threads = (size_t)threads;
  bound->use = calloc(uses_at_most(material), sizeof *bound->use);
  if (!bound->use) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  TRY(make_kernel(bound, ELASTICITY, &material->elasticity, registry, fields, trace));
  /* What a card gives and this elasticity does not call is not opened. */
  if (wants_law(material->elasticity.descriptor, "strength"))
    TRY(make_kernel(bound, STRENGTH, &material->strength, registry, fields, trace));
  if (wants_law(material->elasticity.descriptor, "eos"))
    TRY(make_kernel(bound, EOS, &material->eos, registry, fields, trace));
  TRY(check_laws(bound, trace));
  TRY(deformation_declare(fields, trace));
  bound->deformation.gradient = SIZE_MAX;
  bound->temperature = component_or_none(fields, "temperature");
  bound->plastic_strain = component_or_none(fields, "plastic_strain");
  bound->step_factor = component_or_none(fields, "step_factor");
  bound->flow_stress_factor = SIZE_MAX;
  TRY(make_thread_states(bound, trace));
  TRY(elasticity_try(bound->kernel[ELASTICITY], bound->per_thread[0].law[STRENGTH],
                     bound->per_thread[0].law[EOS], trace));
done:
  if (status != GAMUT_OK) {
    material_free(bound);
    bound = NULL;
  }
  *out = bound;
  return status;
}

void material_free(struct bound_material *bound)
{
  if (!bound)
    return;
  for (size_t t = 0; bound->per_thread && t < bound->threads; t++) {
    struct thread_state *state = &bound->per_thread[t];
    for (int role = 0; role < ROLES; role++)
      law_free(state->law[role], bound->arena);
    if (state->image)
      arena_give(bound->arena, state->image->status);
    arena_give(bound->arena, state->image);
    arena_give(bound->arena, state->scratch);
  }
  arena_give(bound->arena, bound->per_thread);
  for (int role = 0; role < ROLES; role++) {
    links_free(&bound->links[role]);
    kernel_free(bound->kernel[role]);
  }
  free(bound->use);
  free(bound);
}

const struct gamut_use *material_uses(const struct bound_material *bound, size_t *count)
{
  *count = bound->uses;
  return bound->use;
}

const struct gamut_use *material_offers(const struct bound_material *bound, size_t number,
                                        size_t *count)
{
  static const struct gamut_use deformation[] = {{"deformation_gradient", GAMUT_WRITE},
                                                 {"deformation_gradient", GAMUT_READ_BEGIN},
                                                 {"velocity_gradient", GAMUT_READ}};
  static const struct gamut_use factor[] = {{"flow_stress_factor", GAMUT_READ_IF}};
  const bool flows = bound->kernel[STRENGTH] != NULL;
  *count = number == 0 ? ARRAY_SIZE(deformation) : ARRAY_SIZE(factor);
  return number == 0 ? deformation : number == 1 && flows ? factor : NULL;
}

void material_resolve(struct bound_material *bound, const struct task *task,
                      const struct fields *fields)
{
  for (int role = 0; role < ROLES; role++)
    if (bound->kernel[role])
      links_resolve(bound->kernel[role], &bound->links[role], task);
  for (size_t u = 0; bound->kernel[STRENGTH] && u < task->uses; u++)
    if (strcmp(task->use[u].field->name, "flow_stress_factor") == 0)
      bound->flow_stress_factor = task->use[u].field->handle.first;
  deformation_resolve(bound, task, fields);
}

size_t material_bad_factor(const struct bound_material *bound, const struct gamut_chunk *chunk,
                           double *factor)
{
  const double *all =
      bound->flow_stress_factor != SIZE_MAX ? chunk->begin[bound->flow_stress_factor] : NULL;
  for (size_t i = 0; all && i < chunk->count; i++)
    if (!(all[i] >= 0.0 && all[i] < HUGE_VAL) && chunk->set->id[chunk->slot + i] >= 0) {
      *factor = all[i];
      return i;
    }
  return SIZE_MAX;
}

static void fill_argument(double *row, size_t component, const struct gamut_chunk *chunk)
{
  const double *from = component != SIZE_MAX ? chunk->begin[component] : NULL;
  if (from)
    memcpy(row, from, chunk->count * sizeof *row);
}

static void follow(struct bound_material *bound, struct thread_state *state,
                   const struct gamut_chunk *chunk)
{
  image_follow(state->image, bound->links[ELASTICITY].link, bound->links[ELASTICITY].count, chunk,
               state->zero, state->sink);
  memset(state->image->status, 0, chunk->count * sizeof *state->image->status);
  for (int role = STRENGTH; role < ROLES; role++) {
    if (!state->law[role])
      continue;
    image_follow(state->law[role]->image, bound->links[role].link, bound->links[role].count, chunk,
                 state->zero, state->sink);
    law_begin(state->law[role], chunk->count);
  }
  if (!state->law[STRENGTH])
    return;
  state->law[STRENGTH]->factor =
      bound->flow_stress_factor != SIZE_MAX ? chunk->begin[bound->flow_stress_factor] : NULL;
  const struct gamut_strength_law *strength = &state->law[STRENGTH]->strength;
  fill_argument(strength->temperature, bound->temperature, chunk);
  fill_argument(strength->plastic_strain, bound->plastic_strain, chunk);
}

static void call(const struct bound_material *bound, kernel_function function, struct image *image)
{
  const char *before = guard_enter(bound->kernel[ELASTICITY]->descriptor->id);
  function(image);
  guard_leave(before);
}

void material_update(struct bound_material *bound, const struct gamut_chunk *chunk)
{
  struct thread_state *state = &bound->per_thread[chunk->thread];
  deformation_update(bound, chunk);
  follow(bound, state, chunk);
  call(bound, bound->kernel[ELASTICITY]->main, state->image);
}

void material_tally(struct bound_material *bound, const struct gamut_chunk *chunk)
{
  struct thread_state *state = &bound->per_thread[chunk->thread];
  tally_block(&state->tally[ELASTICITY], state->image->status, chunk);
  for (int role = STRENGTH; role < ROLES; role++)
    if (state->law[role])
      tally_block(&state->tally[role], state->law[role]->image->status, chunk);
  const double *factor =
      bound->step_factor != SIZE_MAX ? chunk->end[bound->step_factor] : NULL;
  const double *removal = tally_spared(&state->tally[ELASTICITY], chunk);
  for (size_t i = 0; factor && i < chunk->count; i++)
    if (chunk->set->id[chunk->slot + i] >= 0 && !(removal && removal[i] > 0.0))
      state->step_factor = fmin(state->step_factor, factor[i]);
}

double material_step_factor(struct bound_material *bound)
{
  double factor = INFINITY;
  for (size_t t = 0; t < bound->threads; t++) {
    factor = fmin(factor, bound->per_thread[t].step_factor);
    bound->per_thread[t].step_factor = INFINITY;
  }
  return factor;
}

uint64_t material_evaluations(const struct bound_material *bound, enum gamut_kind kind)
{
  const int role = kind == GAMUT_KIND_STRENGTH ? STRENGTH : EOS;
  uint64_t evaluated = 0;
  for (size_t t = 0; t < bound->threads; t++)
    if (bound->per_thread[t].law[role])
      evaluated += bound->per_thread[t].law[role]->evaluated;
  return evaluated;
}

/* The end of every state is its beginning until the kernel says otherwise. */
static void carry_state(const struct bound_material *bound, const struct gamut_chunk *chunk)
{
  for (int role = 0; role < ROLES; role++)
    for (size_t i = 0; i < bound->links[role].count; i++) {
      const struct link *link = &bound->links[role].link[i];
      double *begin = chunk->begin[link->component], *end = chunk->end[link->component];
      if (link->written && begin && end && begin != end)
        memcpy(end, begin, chunk->count * sizeof *end);
    }
}

void material_start(struct bound_material *bound, const struct gamut_chunk *chunk)
{
  struct thread_state *state = &bound->per_thread[chunk->thread];
  kernel_function start = kernel_operation(bound->kernel[ELASTICITY], 1);
  carry_state(bound, chunk);
  follow(bound, state, chunk);
  if (start)
    call(bound, start, state->image);
}

const struct kernel *material_kernel(const struct bound_material *bound, enum gamut_kind kind)
{
  return bound->kernel[kind == GAMUT_KIND_EOS ? EOS : kind == GAMUT_KIND_STRENGTH ? STRENGTH
                                                                                   : ELASTICITY];
}

_Static_assert(MATERIAL_COUNTS == ROLES * FLAG_COUNTS, "one tally a role");

void material_counts(const struct bound_material *bound, int64_t count[MATERIAL_COUNTS])
{
  for (int role = 0; role < ROLES; role++)
    tally_counts(&bound->per_thread[0].tally[role], bound->threads, sizeof(struct thread_state),
                 count + role * FLAG_COUNTS);
}

void material_go_on(struct bound_material *bound, const int64_t count[MATERIAL_COUNTS])
{
  for (int role = 0; role < ROLES; role++)
    tally_go_on(&bound->per_thread[0].tally[role], bound->threads, sizeof(struct thread_state),
                count + role * FLAG_COUNTS);
}

void material_step_factor_keep(struct bound_material *bound, double factor)
{
  bound->per_thread[0].step_factor = factor;
}

void material_spare(struct bound_material *bound, const struct spare *spare)
{
  for (size_t t = 0; t < bound->threads; t++)
    for (int role = 0; role < ROLES; role++)
      bound->per_thread[t].tally[role].spare = spare;
}

bool material_flag(const struct bound_material *bound, size_t index, struct flag_report *report)
{
  for (int role = 0; role < ROLES; role++)
    if (bound->kernel[role] &&
        tally_report(&bound->per_thread[0].tally[role], bound->threads, sizeof(struct thread_state),
                     bound->kernel[role]->descriptor, &index, report))
      return true;
  return false;
}

/* A law that stops a point knows the cause; the elasticity around it sees only the consequence. */
bool material_stopped(struct bound_material *bound, struct flag_stop *stop)
{
  for (int role = ROLES - 1; role >= 0; role--)
    if (bound->kernel[role] &&
        tally_stopped(&bound->per_thread[0].tally[role], bound->threads,
                      sizeof(struct thread_state), bound->kernel[role]->descriptor, stop))
      return true;
  return false;
}
