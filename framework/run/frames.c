#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/run_private.h"

/* The `at: point` measure of that name among a material's elasticity and the solver; or null. */
static const struct measure *point_measure(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; d && i < d->measures; i++)
    if (d->measure[i].formula && strcmp(d->measure[i].name, name) == 0)
      return &d->measure[i];
  return NULL;
}

static const struct measure *measure_of_material(const struct gamut_run *run, size_t material,
                                                 const char *name)
{
  const struct measure *found =
      point_measure(run->scene->material[material].elasticity.descriptor, name);
  return found ? found : point_measure(run->scene->solver.descriptor, name);
}

/* Where outputs.fields names it; null where it does not by itself. */
static const struct place *place_of_field(const struct gamut_run *run, const char *name)
{
  const struct tree *fields = tree_get(tree_get(run->scene->tree, "outputs"), "fields");
  for (size_t i = 0; fields && i < fields->children; i++)
    if (fields->child[i]->text && strcmp(fields->child[i]->text, name) == 0)
      return &fields->child[i]->place;
  return fields ? &fields->place : NULL;
}

static const char why[] = "'outputs.fields'";

static gamut_status measure_column(struct gamut_run *run, const char *name,
                                   struct frame_column *column, bool *found)
{
  gamut_status status = GAMUT_OK;
  column->formula = calloc(run->scene->materials + 1, sizeof *column->formula);
  if (!column->formula)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t m = 0; m < run->scene->materials; m++) {
    const struct measure *measure = measure_of_material(run, m, name);
    if (!measure || !run->material[m])
      continue;
    *found = true;
    column->unit = measure->unit;
    column->meaning = measure->doc;
    TRY(formula_new(run, measure, &column->formula[m]));
    formula_want(&column->formula[m], run, SIZE_MAX, why, place_of_field(run, name));
  }
done:
  return status;
}

static gamut_status create_column(struct gamut_run *run, const char *name,
                                  struct frame_column *column)
{
  gamut_status status;
  bool found = false;
  unsigned component;
  column->name = name;
  column->components = 1;
  TRY(measure_column(run, name, column, &found));
  if (found)
    return GAMUT_OK;
  TRY(formula_declare(run, name));
  struct field *field = fields_find(run->fields, name);
  if (field && field->where == GAMUT_AT_POINT) {
    column->field = field;
    column->components = field->handle.components;
  } else {
    field = fields_component(run->fields, name, &component);
    for (size_t m = 0; field && m < run->scene->materials; m++)
      TRY(formula_plain(run, name, &column->formula[m]));
  }
  if (!field)
    return trace_fail_at(run->trace, GAMUT_SCENE, place_of_field(run, name), NULL, NULL,
                         "outputs.fields names '%s', but no plugin of this scene has such a field",
                         name);
  column->unit = field->unit;
  column->meaning = field->meaning;
  schedule_want(run->schedule, field, SIZE_MAX, why, place_of_field(run, name), false);
done:
  return status;
}

gamut_status frames_create(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  const struct scene *scene = run->scene;
  if (scene->output_every < 0.0 && !(run->end > 0.0))
    return trace_fail(run->trace, GAMUT_SCENE,
                      "outputs.frames counts frames up to an end that %s does not know; state "
                      "`every`",
                      scene->solver.descriptor->id);
  run->column = calloc(scene->output_fields + 1, sizeof *run->column);
  if (!run->column)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < scene->output_fields; i++) {
    run->columns = i + 1;
    TRY(create_column(run, scene->output_field[i], &run->column[i]));
  }
done:
  return status;
}

void frames_free(struct gamut_run *run)
{
  for (size_t i = 0; i < run->columns; i++) {
    for (size_t m = 0; run->column[i].formula && m < run->scene->materials; m++)
      formula_free(&run->column[i].formula[m]);
    free(run->column[i].formula);
  }
  free(run->column);
}

/* The real points of a set in the order of their ids, which is the same in every frame. */
struct order {
  int64_t *id;
  size_t *slot;
  size_t count;
};

static int by_id(const void *one, const void *other)
{
  const int64_t *a = one, *b = other;
  return (*a > *b) - (*a < *b);
}

static gamut_status order_points(const struct point_set *set, struct order *order)
{
  int64_t(*pair)[2] = calloc(set->open.slots + 1, sizeof *pair);
  order->id = calloc(set->open.slots + 1, sizeof *order->id);
  order->slot = calloc(set->open.slots + 1, sizeof *order->slot);
  order->count = 0;
  if (!pair || !order->id || !order->slot) {
    free(pair);
    return GAMUT_INTERNAL;
  }
  for (size_t s = 0; s < set->open.slots; s++)
    if (set->id[s] >= 0) {
      pair[order->count][0] = set->id[s];
      pair[order->count++][1] = (int64_t)s;
    }
  qsort(pair, order->count, sizeof *pair, by_id);
  for (size_t i = 0; i < order->count; i++) {
    order->id[i] = pair[i][0];
    order->slot[i] = (size_t)pair[i][1];
  }
  free(pair);
  return GAMUT_OK;
}

static double *pick_array(const double *array, const struct order *order)
{
  double *picked = calloc(order->count + 1, sizeof *picked);
  for (size_t i = 0; picked && array && i < order->count; i++)
    picked[i] = array[order->slot[i]];
  return picked;
}

static double *pick_column(struct gamut_run *run, const struct frame_column *column,
                           unsigned component, const struct point_set *set,
                           const struct order *order)
{
  if (column->field)
    return pick_array(set_stored(set, column->field->handle, component), order);
  double *picked = calloc(order->count + 1, sizeof *picked);
  struct formula *formula = &column->formula[set->material];
  for (size_t i = 0; picked && i < order->count; i++)
    picked[i] = formula->expression || formula->plain != SIZE_MAX
                    ? formula_value(formula, run, set, order->slot[i])
                    : 0.0;
  return picked;
}

/* Everything that a frame is made of, freed together. */
struct frame {
  struct order *order;
  struct frame_set *set;
  struct frame_field *field;
  double **memory;
  size_t pieces;
};

static int axes_of(const struct scene *scene)
{
  const struct geometry *geometry = values_geometry(scene->solver.values);
  return geometry ? (int)geometry->axes : 3;
}

static gamut_status fill_frame(struct gamut_run *run, struct frame *frame)
{
  size_t sets = run->scene->bodies;
  const struct field *position = fields_find(run->fields, "position");
  for (size_t s = 0; s < sets; s++) {
    struct frame_set *set = &frame->set[s];
    if (order_points(run->set[s], &frame->order[s]) != GAMUT_OK)
      return GAMUT_INTERNAL;
    *set = (struct frame_set){.body = run->set[s]->open.body,
                              .count = frame->order[s].count,
                              .id = frame->order[s].id,
                              .axes = axes_of(run->scene)};
    for (unsigned k = 0; position && k < 3; k++)
      set->position[k] = frame->memory[frame->pieces++] =
          pick_array(set_stored(run->set[s], position->handle, k), &frame->order[s]);
  }
  for (size_t c = 0; c < run->columns; c++) {
    const struct frame_column *column = &run->column[c];
    const double **data = (const double **)&frame->memory[frame->pieces];
    for (size_t s = 0; s < sets; s++)
      for (unsigned k = 0; k < column->components; k++)
        frame->memory[frame->pieces++] = pick_column(run, column, k, run->set[s], &frame->order[s]);
    frame->field[c] = (struct frame_field){.name = column->name,
                                           .unit = column->unit,
                                           .meaning = column->meaning,
                                           .components = column->components,
                                           .data = data};
  }
  for (size_t i = 0; i < frame->pieces; i++)
    if (!frame->memory[i])
      return GAMUT_INTERNAL;
  return GAMUT_OK;
}

gamut_status frames_write(struct gamut_run *run)
{
  gamut_status status;
  size_t sets = run->scene->bodies, pieces = 3 * sets;
  if (!run->store)
    return GAMUT_OK;
  for (size_t c = 0; c < run->columns; c++)
    pieces += sets * run->column[c].components;
  struct frame frame = {.order = calloc(sets + 1, sizeof *frame.order),
                        .set = calloc(sets + 1, sizeof *frame.set),
                        .field = calloc(run->columns + 1, sizeof *frame.field),
                        .memory = calloc(pieces + 1, sizeof *frame.memory)};
  if (!frame.order || !frame.set || !frame.field || !frame.memory ||
      fill_frame(run, &frame) != GAMUT_OK)
    status = trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  else
    status = store_frame(run->store, run->time, run->steps, frame.set, sets, frame.field,
                         run->columns, run->trace);
  for (size_t i = 0; i < frame.pieces; i++)
    free(frame.memory[i]);
  for (size_t s = 0; frame.order && s < sets; s++) {
    free(frame.order[s].id);
    free(frame.order[s].slot);
  }
  free(frame.order);
  free(frame.set);
  free(frame.field);
  free(frame.memory);
  return status;
}

static double frame_every(const struct gamut_run *run)
{
  double every = run->scene->output_every;
  return every < 0.0 ? run->end / -every : every;
}

/* Moves a count of what is due every so long up to the present time; false if nothing new is. Far
 * ahead it jumps: it never counts one by one what may be more than a run can live to see. */
bool due_by_now(const struct gamut_run *run, double every, uint64_t *count)
{
  const double now = run->time * (1.0 + 1e-12);
  if (!(every > 0.0) || now < (double)(*count + 1) * every)
    return false;
  const double whole = fmin(floor(now / every), 9e15);
  if (whole > (double)*count + 2.0)
    *count = (uint64_t)whole - 1;
  while (*count < (uint64_t)9e15 && now >= (double)(*count + 1) * every)
    ++*count;
  return true;
}

/* Frames are counted by time, so that others than before may be wanted after a restart. */
void frames_go_on(struct gamut_run *run)
{
  run->frame = 0;
  due_by_now(run, frame_every(run), &run->frame);
}

gamut_status frames_due(struct gamut_run *run)
{
  if (!run->store || !due_by_now(run, frame_every(run), &run->frame))
    return GAMUT_OK;
  return frames_write(run);
}
