#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "catalogue/catalogue.h"
#include "material/block_image.h"

struct effect_task {
  struct gamut_use *use;
  size_t uses;
  struct links *links; /* one a material; `begin` is settled by effect_resolve */
  kernel_function call;
};

struct effect_thread {
  struct image **image; /* one a material */
  double *zero, *sink;
  struct tally tally;
};

struct bound_effect {
  const struct kernel *const *kernel;
  size_t materials, threads, tasks;
  struct effect_task *task;
  struct effect_thread *per_thread;
  struct arena *arena;
};

static bool declared_state(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->states; i++)
    if (strcmp(d->state[i].name, name) == 0)
      return true;
  return false;
}

static bool optional_input(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->inputs; i++)
    if (strcmp(d->input[i].name, name) == 0)
      return d->input[i].optional;
  return false;
}

static bool at_point(const char *name)
{
  const struct field_info *info = catalogue_find(name);
  return !info || info->where == GAMUT_AT_POINT;
}

static bool is_among(const char *const *list, size_t count, const char *name)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(list[i], name) == 0)
      return true;
  return false;
}

static void add_use(struct effect_task *to, const struct kernel *kernel, const char *name,
                    enum gamut_access access)
{
  to->use[to->uses++] = (struct gamut_use){instance_field(kernel->instance, name), access};
}

/* A state that the task writes is read at its beginning; one of another task of this effect, at the
 * end. */
static gamut_status collect_uses(const struct kernel *kernel, const struct kernel_task *from,
                                 struct effect_task *to)
{
  const struct descriptor *d = kernel->descriptor;
  size_t most = from->reads + 2 * from->writes + from->adds + from->scales + from->lowers;
  to->use = calloc(most + 1, sizeof *to->use);
  if (!to->use)
    return GAMUT_INTERNAL;
  for (size_t i = 0; i < from->reads; i++)
    if (at_point(from->read[i]) && !is_among(from->write, from->writes, from->read[i]))
      add_use(to, kernel, from->read[i],
              optional_input(d, from->read[i]) ? GAMUT_READ_IF : GAMUT_READ);
  for (size_t i = 0; i < from->writes; i++) {
    if (declared_state(d, from->write[i]))
      add_use(to, kernel, from->write[i], GAMUT_READ_BEGIN);
    add_use(to, kernel, from->write[i], GAMUT_WRITE);
  }
  for (size_t i = 0; i < from->adds; i++)
    add_use(to, kernel, from->add[i], GAMUT_ADD);
  for (size_t i = 0; i < from->scales; i++)
    add_use(to, kernel, from->scale[i], GAMUT_SCALE);
  for (size_t i = 0; i < from->lowers; i++)
    add_use(to, kernel, from->lower[i], GAMUT_LEAST);
  return GAMUT_OK;
}

/* Parameters with a random field are read as fields, by whatever task. */
static gamut_status add_paths(const struct bound_effect *bound, struct effect_task *task)
{
  for (size_t m = 0; m < bound->materials; m++)
    for (size_t s = 0; s < bound->kernel[m]->slots; s++) {
      const char *path = bound->kernel[m]->path[s];
      bool known = path == NULL;
      for (size_t u = 0; !known && u < task->uses; u++)
        known = strcmp(task->use[u].field, path) == 0;
      if (known)
        continue;
      struct gamut_use *grown = realloc(task->use, (task->uses + 1) * sizeof *grown);
      if (!grown)
        return GAMUT_INTERNAL;
      task->use = grown;
      task->use[task->uses++] = (struct gamut_use){path, GAMUT_READ_BEGIN};
    }
  return GAMUT_OK;
}

static gamut_status make_tasks(struct bound_effect *bound, struct fields *fields,
                               struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *d = bound->kernel[0]->descriptor;
  bound->tasks = d->tasks;
  bound->task = calloc(d->tasks + 1, sizeof *bound->task);
  if (!bound->task)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  for (size_t t = 0; t < d->tasks; t++) {
    struct effect_task *task = &bound->task[t];
    task->links = calloc(bound->materials, sizeof *task->links);
    task->call = kernel_named(bound->kernel[0], d->task[t].kernel);
    if (!task->links || collect_uses(bound->kernel[0], &d->task[t], task) != GAMUT_OK ||
        add_paths(bound, task) != GAMUT_OK)
      return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    for (size_t m = 0; m < bound->materials; m++)
      TRY(links_new(bound->kernel[m], fields, trace, &task->links[m]));
  }
  for (size_t m = 0; m < bound->materials; m++)
    TRY(effect_try(bound->kernel[m], trace));
done:
  return status;
}

static gamut_status make_seats(struct bound_effect *bound)
{
  static const char label[] = "scratch of effects";
  size_t stride = GAMUT_CHUNK_MAX + ARRAY_PAD;
  bound->per_thread = arena_take(bound->arena, label, bound->threads * sizeof *bound->per_thread);
  if (!bound->per_thread)
    return GAMUT_INTERNAL;
  for (size_t t = 0; t < bound->threads; t++) {
    struct effect_thread *state = &bound->per_thread[t];
    const struct kernel *first = bound->kernel[0];
    size_t rows = 2;
    for (size_t s = 0; s < first->slots; s++)
      rows += first->slot[s].kind == SLOT_SCRATCH;
    state->zero = arena_take(bound->arena, label, rows * stride * sizeof(double));
    state->image = arena_take(bound->arena, label, bound->materials * sizeof(*state->image));
    if (!state->zero || !state->image)
      return GAMUT_INTERNAL;
    state->sink = state->zero + stride;
    for (size_t m = 0; m < bound->materials; m++) {
      state->image[m] = image_new(bound->kernel[m], bound->arena, GAMUT_CHUNK_MAX, label);
      if (!state->image[m])
        return GAMUT_INTERNAL;
      size_t row = 2;
      for (size_t s = 0; s < first->slots; s++)
        if (first->slot[s].kind == SLOT_SCRATCH)
          state->image[m]->pointer[s] = state->zero + stride * row++;
    }
  }
  return GAMUT_OK;
}

gamut_status effect_new(const struct kernel *const *by_material, size_t materials,
                        struct arena *arena, struct fields *fields, int threads,
                        struct trace *trace, struct bound_effect **out)
{
  gamut_status status;
  struct bound_effect *bound = calloc(1, sizeof *bound);
  if (!bound)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  *bound = (struct bound_effect){.kernel = by_material,
                                 .materials = materials,
                                 .threads = (size_t)threads,
                                 .arena = arena};
  TRY(make_tasks(bound, fields, trace));
  if (make_seats(bound) != GAMUT_OK)
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
done:
  if (status != GAMUT_OK) {
    effect_free(bound);
    bound = NULL;
  }
  *out = bound;
  return status;
}

void effect_free(struct bound_effect *bound)
{
  if (!bound)
    return;
  for (size_t t = 0; bound->task && t < bound->tasks; t++) {
    for (size_t m = 0; bound->task[t].links && m < bound->materials; m++)
      links_free(&bound->task[t].links[m]);
    free(bound->task[t].links);
    free(bound->task[t].use);
  }
  free(bound->task);
  for (size_t t = 0; bound->per_thread && t < bound->threads; t++) {
    struct effect_thread *state = &bound->per_thread[t];
    for (size_t m = 0; state->image && m < bound->materials; m++) {
      if (state->image[m])
        arena_give(bound->arena, state->image[m]->status);
      arena_give(bound->arena, state->image[m]);
    }
    arena_give(bound->arena, state->image);
    arena_give(bound->arena, state->zero);
  }
  arena_give(bound->arena, bound->per_thread);
  free(bound);
}

const struct gamut_use *effect_uses(struct bound_effect *bound, size_t task, size_t *count)
{
  *count = bound->task[task].uses;
  return bound->task[task].use;
}

void effect_resolve(struct bound_effect *bound, size_t task, const struct task *planned)
{
  for (size_t m = 0; m < bound->materials; m++)
    links_resolve(bound->kernel[m], &bound->task[task].links[m], planned);
}

void effect_call(struct bound_effect *bound, size_t task, size_t material,
                 const struct gamut_chunk *chunk)
{
  struct effect_thread *state = &bound->per_thread[chunk->thread];
  struct image *image = state->image[material];
  const struct links *links = &bound->task[task].links[material];
  image_follow(image, links->link, links->count, chunk, state->zero, state->sink);
  memset(image->status, 0, chunk->count * sizeof *image->status);
  bound->task[task].call(image);
  tally_block(&state->tally, image->status, chunk);
}

void effect_counts(const struct bound_effect *bound, int64_t count[FLAG_COUNTS])
{
  tally_counts(&bound->per_thread[0].tally, bound->threads, sizeof(struct effect_thread), count);
}

void effect_go_on(struct bound_effect *bound, const int64_t count[FLAG_COUNTS])
{
  tally_go_on(&bound->per_thread[0].tally, bound->threads, sizeof(struct effect_thread), count);
}

void effect_spare(struct bound_effect *bound, const struct spare *spare)
{
  for (size_t t = 0; t < bound->threads; t++)
    bound->per_thread[t].tally.spare = spare;
}

bool effect_flag(const struct bound_effect *bound, size_t index, struct flag_report *report)
{
  return tally_report(&bound->per_thread[0].tally, bound->threads, sizeof(struct effect_thread),
                      bound->kernel[0]->descriptor, &index, report);
}

bool effect_stopped(struct bound_effect *bound, struct flag_stop *stop)
{
  return tally_stopped(&bound->per_thread[0].tally, bound->threads, sizeof(struct effect_thread),
                       bound->kernel[0]->descriptor, stop);
}
