#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"
#include "registry/guard.h"
#include "run/host.h"

static const char *owner_of(const struct gamut_run *run)
{
  return run->creating ? run->creating->label : "solver";
}

/* What a plugin that names no place of its own is blamed at. */
static const struct tree *node_of(const struct gamut_run *run)
{
  return run->sampling    ? run->sampling->node
         : run->creating  ? run->creating->effect->instance.node
         : run->measuring ? run->measuring->node
                          : run->scene->solver.node;
}

static gamut_status host_fail(struct gamut_run *run, gamut_status status, const char *format, ...)
{
  const struct tree *node = node_of(run);
  va_list list;
  va_start(list, format);
  status = host_messages_fail(run->trace, status, node, format, list);
  va_end(list);
  return status;
}

static gamut_status host_fail_plane(struct gamut_run *run, const struct gamut_reaction *reaction,
                                    gamut_status status, const char *format, ...)
{
  char named[1024];
  const struct effect *effect = NULL;
  va_list list;
  for (size_t i = 0; i < run->planes; i++)
    if (run->plane[i].reaction == reaction)
      effect = run->plane[i].effect;
  snprintf(named, sizeof named, "effect %s: %s", effect ? effect->instance.name : "unknown",
           format);
  va_start(list, format);
  status = host_messages_fail(run->trace, status, effect ? effect->instance.node : NULL,
                              effect ? named : format, list);
  va_end(list);
  return status;
}

static gamut_status host_fail_at(struct gamut_run *run, const struct gamut_values *values,
                                 const char *path, const char *expected, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  gamut_status status = host_messages_fail_at(run->trace, values, path, expected, format, list);
  va_end(list);
  return status;
}

static gamut_status host_fail_in_file(struct gamut_run *run, const struct gamut_values *values,
                                      const char *path, size_t line, const char *expected,
                                      const char *format, ...)
{
  va_list list;
  va_start(list, format);
  gamut_status status =
      host_messages_fail_in_file(run->trace, values, path, line, expected, format, list);
  va_end(list);
  return status;
}

static void host_warn(struct gamut_run *run, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  host_messages_warn(run->trace, format, list);
  va_end(list);
}

static void host_note(struct gamut_run *run, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  host_messages_note(run->trace, format, list);
  va_end(list);
}

static size_t host_bodies(const struct gamut_run *run)
{
  return run->scene->bodies;
}

static const struct gamut_body *host_body(const struct gamut_run *run, size_t index)
{
  return &run->scene->body[index];
}

static const char *host_body_name(const struct gamut_body *body)
{
  return body->name;
}

static const struct gamut_values *host_body_values(const struct gamut_body *body)
{
  return body->solver_values;
}

static bool host_body_bounds(const struct gamut_body *body, double lower[3], double upper[3])
{
  if (body->shape.kind == SHAPE_NONE)
    return false;
  shape_bounds(&body->shape, lower, upper);
  return true;
}

static bool host_body_contains(const struct gamut_body *body, const double x[3])
{
  return body->shape.kind != SHAPE_NONE && shape_contains(&body->shape, x);
}

static double host_body_volume(const struct gamut_body *body, unsigned dimension, bool revolved)
{
  return shape_volume(&body->shape, dimension, revolved);
}

static size_t host_body_points(const struct gamut_body *body, const double **place,
                               const double **volume)
{
  const struct shape_points *points = &body->shape.points;
  *place = points->place;
  *volume = points->volume;
  return body->shape.kind == SHAPE_POINTS ? points->count : 0;
}

static void host_body_velocity(const struct gamut_body *body, const double x[3], double v[3])
{
  for (int k = 0; k < 3; k++)
    v[k] = body->velocity_expression[k] ? expression_value(body->velocity_expression[k], x)
                                        : body->velocity[k];
}

static double host_body_density(const struct gamut_run *run, const struct gamut_body *body)
{
  return run->scene->material[body->material].density;
}

static const char *host_body_strength(const struct gamut_run *run, const struct gamut_body *body)
{
  const struct descriptor *d = run->scene->material[body->material].strength.descriptor;
  return d && d->needs ? d->name : NULL; /* needs of its caller are how a law acts */
}

static gamut_status host_points(struct gamut_run *run, const struct gamut_body *body, size_t points,
                                struct gamut_set **set)
{
  if (run->set[body->index])
    return trace_fail(run->trace, GAMUT_PLUGIN, "the solver makes points of body '%s' twice",
                      body->name);
  struct point_set *made = set_new(run->arena, body->name, body->index, body->material, points);
  if (!made)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  run->set[body->index] = made;
  *set = &made->open;
  return GAMUT_OK;
}

/* The effect that is made or that measures now, and means its own states; or null. */
static const struct instance *asking(const struct gamut_run *run)
{
  const struct running_effect *effect = run->creating   ? run->creating
                                        : run->measured ? run->measured->effect
                                                        : NULL;
  return effect ? &effect->effect->instance : NULL;
}

static gamut_status host_field(struct gamut_run *run, const char *name, struct gamut_field *handle)
{
  if (asking(run))
    name = instance_field(asking(run), name);
  const struct field_info *info = catalogue_find(name);
  struct field *field = fields_find(run->fields, name);
  bool derived = false;
  if (run->measured && wants_derive(run, name, &derived) != GAMUT_OK)
    return GAMUT_INTERNAL;
  if (derived) {
    *handle = (struct gamut_field){.first = SET_DERIVED, .components = 1};
    return GAMUT_OK;
  }
  unsigned component;
  const struct field *whole =
      run->measured && !field ? fields_component(run->fields, name, &component) : NULL;
  if (whole) {
    *handle = (struct gamut_field){.first = whole->handle.first + component, .components = 1};
    return GAMUT_OK;
  }
  if (!field && info)
    field = fields_add(run->fields, info->name, info->where, info->components, info->unit,
                       info->meaning, run->trace);
  if (!field && run->measuring && run->measuring->node)
    return trace_fail_at(run->trace, GAMUT_SCENE, &run->measuring->node->place,
                         run->measuring->name, NULL, "there is no field '%s' in this scene", name);
  if (!field)
    return trace_fail(run->trace, GAMUT_PLUGIN, "%s asks for the field '%s', which nobody declares",
                      owner_of(run), name);
  *handle = field->handle;
  return GAMUT_OK;
}

static double *host_stored(const struct gamut_set *set, struct gamut_field field,
                           unsigned component)
{
  return set_stored(set_inside(set), field, component);
}

static gamut_status host_arrange(struct gamut_run *run, struct gamut_set *set,
                                 const uint32_t *source, size_t slots, const size_t *first,
                                 size_t blocks)
{
  set_inside(set)->threads = run->threads;
  return set_arrange(set_inside(set), source, slots, first, blocks, run->trace);
}

/* A state that the elasticity does not know (an effect's temperature) begins as it was set. */
static void carry_all(const struct gamut_run *run, const struct gamut_chunk *chunk)
{
  for (size_t k = 0; k < fields_components(run->fields); k++)
    if (run->start_source[k] == SOURCE_FRESH && chunk->begin[k])
      memcpy(chunk->end[k], chunk->begin[k], chunk->count * sizeof(double));
}

static gamut_status host_start_material(struct gamut_run *run, struct gamut_set *open)
{
  gamut_status status;
  struct point_set *set = set_inside(open);
  struct bound_material *material = run->material[set->material];
  struct gamut_chunk chunk = {.set = open};
  given_start(set);
  TRY(random_scatter(run, set));
  TRY(material_initial(material, set, &run->scene->body[open->index], run->trace));
  for (size_t slot = 0; slot < open->slots; slot += run->chunk) {
    size_t count = open->slots - slot < run->chunk ? open->slots - slot : run->chunk;
    scratch_bind(run->scratch[0], set, run->start_source, run->uniform, slot, count, &chunk);
    carry_all(run, &chunk);
    material_start(material, &chunk);
    material_tally(material, &chunk);
    scratch_commit(run->scratch[0], run->start_source, &chunk);
  }
done:
  return status;
}

static gamut_status host_update_material(struct gamut_run *run, const struct gamut_chunk *chunk)
{
  material_update(run->material[set_inside(chunk->set)->material], chunk);
  return GAMUT_OK;
}

static gamut_status host_task(struct gamut_run *run, const struct gamut_task *task)
{
  return run_add_task(run, owner_of(run), task, SIZE_MAX,
                      run->creating ? run->creating->effect->on_body : NULL);
}

static void host_set_uniform(struct gamut_run *run, struct gamut_field field, double value)
{
  double *array = run->uniform_row[field.first];
  for (size_t i = 0; array && i < run->chunk; i++)
    array[i] = value;
  run->uniform[field.first] = array;
}

static void *host_allocate(struct gamut_run *run, const char *label, size_t bytes)
{
  size_t room = arena_room(run->arena);
  void *memory = arena_take(run->arena, label, bytes);
  if (!memory && bytes > room) {
    const struct tree *node =
        run->creating ? run->creating->effect->instance.node : run->scene->solver.node;
    run->too_large = true;
    trace_fail_at(run->trace, GAMUT_SCENE, node ? &node->place : NULL, NULL,
                  "a smaller scene, or a machine with more memory",
                  "%s take %.3g GB, this machine has %.3g GB", label, 1e-9 * (double)bytes,
                  1e-9 * (double)room);
  } else if (!memory) {
    trace_fail(run->trace, GAMUT_INTERNAL, "no memory for %zu bytes of %s", bytes, label);
  }
  return memory;
}

static void host_release(struct gamut_run *run, void *memory)
{
  arena_give(run->arena, memory);
}

/* A wall that all bodies leave behind does nothing, most often by a slip of a sign. */
static void warn_left_behind(const struct gamut_run *run, const struct gamut_plane *plane)
{
  const struct effect *effect = run->creating ? run->creating->effect : NULL;
  bool all = effect && plane->unilateral;
  for (size_t b = 0; all && b < run->scene->bodies; b++) {
    const struct gamut_body *body = &run->scene->body[b];
    double lower[3], upper[3], x[3], v[3], away = 0.0;
    if (!host_body_bounds(body, lower, upper))
      return;
    for (int k = 0; k < 3; k++)
      x[k] = isfinite(lower[k]) && isfinite(upper[k]) ? 0.5 * (lower[k] + upper[k]) : 0.0;
    host_body_velocity(body, x, v);
    for (int k = 0; k < 3; k++)
      away += (v[k] - plane->velocity[k]) * plane->normal[k];
    all = away > 0.0;
  }
  if (all)
    trace_warn_at(run->trace, &effect->instance.node->place, NULL,
                  "a normal towards the material, a velocity against it",
                  "%s: every body moves away from this wall", run->creating->label);
}

static gamut_status host_plane(struct gamut_run *run, const struct gamut_plane *plane,
                               const struct gamut_reaction **reaction)
{
  if (!run->solver->plane)
    return trace_fail(run->trace, GAMUT_SCENE, "%s needs planes, which %s does not offer",
                      owner_of(run), run->scene->solver.descriptor->id);
  const struct gamut_reaction *made = NULL;
  gamut_status status = GUARDED(run->scene->solver.descriptor->id,
                                run->solver->plane(run->solver_self, plane, &made));
  if (status == GAMUT_OK)
    warn_left_behind(run, plane);
  if (reaction)
    *reaction = made;
  if (status != GAMUT_OK || !run->creating)
    return status;
  struct plane_owner *more = realloc(run->plane, (run->planes + 1) * sizeof *more);
  if (!more)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  run->plane = more;
  run->plane[run->planes++] = (struct plane_owner){made, run->creating->effect};
  return GAMUT_OK;
}

static gamut_status host_ledger(struct gamut_run *run, const char *account, const char *name,
                                const char *unit, enum gamut_ledger_role role, double **value)
{
  return ledger_open(run, account, name, unit, role, value);
}

static double host_time(const struct gamut_run *run)
{
  return run->time;
}

static double host_time_step(const struct gamut_run *run)
{
  return run->step;
}

static uint64_t host_step(const struct gamut_run *run)
{
  return run->steps;
}

static void host_fixed_steps(struct gamut_run *run)
{
  run->fixed_steps = true;
}

static bool host_given_steps(const struct gamut_run *run)
{
  return run->options.given.count > 0 && run->end > 0.0;
}

static int host_threads(const struct gamut_run *run)
{
  return run->threads;
}

static size_t host_chunk(const struct gamut_run *run)
{
  return run->chunk;
}

static const struct gamut_set *host_set(const struct gamut_run *run, size_t index)
{
  return run->set[index] ? &run->set[index]->open : NULL;
}

static gamut_status host_grid_pass(struct gamut_run *run, const struct gamut_grid_pass *pass)
{
  if (!run->solver->grid_pass)
    return trace_fail(run->trace, GAMUT_SCENE,
                      "a pass over the grid is asked of %s, which has none",
                      run->scene->solver.descriptor->id);
  return GUARDED(run->scene->solver.descriptor->id, run->solver->grid_pass(run->solver_self, pass));
}

const struct gamut_host run_host = {.size = sizeof(struct gamut_host),
                                    .fail = host_fail,
                                    .fail_at = host_fail_at,
                                    .fail_in_file = host_fail_in_file,
                                    .warn = host_warn,
                                    HOST_OF_VALUES,
                                    .bodies = host_bodies,
                                    .body = host_body,
                                    .body_name = host_body_name,
                                    .body_values = host_body_values,
                                    .body_bounds = host_body_bounds,
                                    .body_contains = host_body_contains,
                                    .body_velocity = host_body_velocity,
                                    .body_density = host_body_density,
                                    .points = host_points,
                                    .field = host_field,
                                    .stored = host_stored,
                                    .arrange = host_arrange,
                                    .start_material = host_start_material,
                                    .update_material = host_update_material,
                                    .task = host_task,
                                    .set_uniform = host_set_uniform,
                                    .allocate = host_allocate,
                                    .release = host_release,
                                    .plane = host_plane,
                                    .ledger = host_ledger,
                                    .time = host_time,
                                    .time_step = host_time_step,
                                    .step = host_step,
                                    .threads = host_threads,
                                    .chunk = host_chunk,
                                    .body_volume = host_body_volume,
                                    .law = host_law,
                                    .law_array = host_law_array,
                                    .law_call = host_law_call,
                                    .law_message = host_law_message,
                                    .stream = host_stream,
                                    .realisation = host_realisation,
                                    .sample = host_sample,
                                    .domain = host_domain,
                                    .note = host_note,
                                    .law_places = host_law_places,
                                    .body_points = host_body_points,
                                    .formula = host_formula,
                                    .formula_value = host_formula_value,
                                    .formula_uses = host_formula_uses,
                                    .removal = host_removal,
                                    .drop = host_drop,
                                    .fail_plane = host_fail_plane,
                                    .count = work_open,
                                    .body_strength = host_body_strength,
                                    .fixed_steps = host_fixed_steps,
                                    .given_steps = host_given_steps,
                                    .set = host_set,
                                    .grid_pass = host_grid_pass,
                                    HOST_OF_SUMS};
