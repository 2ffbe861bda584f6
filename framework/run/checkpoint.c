/* What a run is between two steps, as a checkpoint. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "registry/guard.h"
#include "run/restart.h"

struct writing {
  struct gamut_run *run;
  struct checkpoint *file;
};

static gamut_status put(const struct writing *w, const char *path, enum checkpoint_kind kind,
                        const void *data, size_t count)
{
  return checkpoint_put(w->file, path, kind, data, count, w->run->trace);
}

static gamut_status put_text(const struct writing *w, const char *path, const char *text)
{
  return put(w, path, CHECKPOINT_BYTES, text, strlen(text));
}

static gamut_status put_scene(const struct writing *w)
{
  gamut_status status;
  char *scene = restart_scene_text(w->run->scene->tree), *plugins = restart_plugins_text(w->run);
  char *files = restart_files_text(w->run->scene);
  if (!scene || !plugins || !files) {
    status = trace_fail(w->run->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  TRY(put_text(w, "scene", scene));
  TRY(put_text(w, "plugins", plugins));
  TRY(put_text(w, "files", files));
done:
  free(files);
  free(scene);
  free(plugins);
  return status;
}

static gamut_status put_clock(const struct writing *w)
{
  gamut_status status;
  const struct gamut_run *run = w->run;
  const struct store_place place = store_place_of(run->store);
  const double real[RESTART_REALS] = {run->time, run->step, place.last_time};
  const int64_t whole[RESTART_WHOLES] = {(int64_t)run->steps, (int64_t)place.frames,
                                         (int64_t)place.last_step, (int64_t)run->scene->bodies,
                                         (int64_t)place.checksum};
  TRY(put(w, "clock", CHECKPOINT_REAL, real, RESTART_REALS));
  TRY(put(w, "counts", CHECKPOINT_WHOLE, whole, RESTART_WHOLES));
  TRY(put_text(w, "run", place.run));
  TRY(put_text(w, "frames", place.xdmf));
done:
  return status;
}

static gamut_status put_ledger(const struct writing *w)
{
  gamut_status status;
  size_t lines = w->run->lines;
  double *value = calloc(3 * lines + 1, sizeof *value);
  if (!value)
    return trace_fail(w->run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < lines; i++) {
    value[3 * i] = w->run->ledger[i].start;
    value[3 * i + 1] = *w->run->line_value[i];
    value[3 * i + 2] = w->run->ledger[i].turnover;
  }
  status = put(w, "ledger", CHECKPOINT_REAL, value, 3 * lines);
  free(value);
  return status;
}

static gamut_status put_histories(const struct writing *w)
{
  gamut_status status = GAMUT_OK;
  char path[RESTART_PATH];
  for (size_t i = 0; i < w->run->probes; i++) {
    const struct history *h = w->run->history[i];
    const double last[] = {h->every, h->last_time, h->last_value, h->has_last};
    TRY(put(w, restart_path(path, "quantities", h->quantity->name, "axis"), CHECKPOINT_REAL,
            h->time, h->count));
    TRY(put(w, restart_path(path, "quantities", h->quantity->name, "value"), CHECKPOINT_REAL,
            h->value, h->count));
    TRY(put(w, restart_path(path, "quantities", h->quantity->name, "last"), CHECKPOINT_REAL, last,
            ARRAY_SIZE(last)));
  }
done:
  return status;
}

/* The arrays of a set, each by way of `row`, which has room for all of its rows. */
static gamut_status put_arrays(const struct writing *w, const struct point_set *set,
                               const struct packed *packed, double *row)
{
  gamut_status status;
  char path[RESTART_PATH], name[RESTART_PATH];
  const char *body = set->open.body;
  pack(packed, set->open.id, row);
  TRY(put(w, restart_path(path, "bodies", body, "id"), CHECKPOINT_WHOLE, row, packed->rows));
  for (size_t f = 0; f < fields_count(w->run->fields); f++) {
    const struct field *field = fields_at(w->run->fields, f);
    for (unsigned k = 0; k < field->handle.components; k++) {
      const double *array = set_stored(set, field->handle, k);
      if (!array)
        continue;
      pack(packed, array, row);
      restart_path(path, "bodies", body, restart_component(name, field, k));
      TRY(put(w, path, CHECKPOINT_REAL, row, packed->rows));
    }
  }
done:
  return status;
}

static gamut_status put_set(const struct writing *w, const struct point_set *set)
{
  gamut_status status = GAMUT_OK;
  char path[RESTART_PATH];
  const char *body = set->open.body;
  const int64_t points = (int64_t)set->open.points;
  struct packed packed;
  double *row = NULL;
  TRY(packed_of(&set->open, &packed, w->run->trace));
  row = malloc((packed.rows + 1) * sizeof *row);
  if (!row) {
    status = trace_fail(w->run->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  TRY(put(w, restart_path(path, "bodies", body, "points"), CHECKPOINT_WHOLE, &points, 1));
  TRY(put(w, restart_path(path, "bodies", body, "block_points"), CHECKPOINT_WHOLE, packed.count,
          packed.blocks));
  TRY(put_arrays(w, set, &packed, row));
done:
  free(row);
  packed_free(&packed);
  return status;
}

/* Counts of flags, and the factor that the next step is bounded by. */
static gamut_status put_materials(const struct writing *w)
{
  gamut_status status = GAMUT_OK;
  char path[RESTART_PATH];
  struct gamut_run *run = w->run;
  for (size_t m = 0; m < run->scene->materials; m++) {
    int64_t count[MATERIAL_COUNTS];
    if (!run->material[m])
      continue;
    double factor = material_step_factor(run->material[m]);
    material_step_factor_keep(run->material[m], factor);
    material_counts(run->material[m], count);
    const char *name = run->scene->material[m].name;
    TRY(put(w, restart_path(path, "materials", name, "step_factor"), CHECKPOINT_REAL, &factor, 1));
    TRY(put(w, restart_path(path, "materials", name, "flags"), CHECKPOINT_WHOLE, count,
            MATERIAL_COUNTS));
  }
done:
  return status;
}

static gamut_status put_state(const struct writing *w, const char *plugin, const char *path,
                              const void *self, size_t (*save)(const void *, void *))
{
  const char *before = guard_enter_long(plugin);
  size_t size = save(self, NULL);
  guard_leave(before);
  void *bytes = malloc(size + 1);
  if (!bytes)
    return trace_fail(w->run->trace, GAMUT_INTERNAL, "out of memory");
  memset(bytes, 0, size);
  guard_enter_long(plugin);
  save(self, bytes);
  guard_leave(before);
  gamut_status status = put(w, path, CHECKPOINT_BYTES, bytes, size);
  free(bytes);
  return status;
}

static gamut_status put_effects(const struct writing *w)
{
  gamut_status status = GAMUT_OK;
  char path[RESTART_PATH];
  for (size_t e = 0; e < w->run->effects; e++) {
    const struct running_effect *effect = &w->run->effect[e];
    const char *name = effect->effect->instance.name;
    int64_t count[FLAG_COUNTS];
    if (effect->bound) {
      effect_counts(effect->bound, count);
      TRY(put(w, restart_path(path, "effects", name, "flags"), CHECKPOINT_WHOLE, count,
              FLAG_COUNTS));
    }
    if (effect->ops->save && effect->ops->restore)
      TRY(put_state(w, effect->effect->instance.descriptor->id,
                    restart_path(path, "effects", name, "state"), effect->self, effect->ops->save));
  }
done:
  return status;
}

/* What the file will take, with HDF5's own on top: generous. */
static size_t checkpoint_bytes(const struct gamut_run *run)
{
  size_t arrays = 64, bytes = run->solver->save(run->solver_self, NULL);
  for (size_t s = 0; s < run->scene->bodies; s++) {
    bytes += run->set[s]->open.slots * (fields_components(run->fields) + 1) * sizeof(double);
    bytes += (run->set[s]->open.blocks + 1) * sizeof(int64_t);
    arrays += fields_components(run->fields) + 8;
  }
  for (size_t i = 0; i < run->probes; i++)
    bytes += 2 * run->history[i]->count * sizeof(double);
  arrays += 4 * (run->probes + run->effects + run->scene->materials);
  return bytes + strlen(store_place_of(run->store).xdmf) + 4096 * arrays +
         (run->effects + 3 * run->scene->materials) * FLAG_COUNTS * sizeof(int64_t);
}

bool run_can_stop(const struct gamut_run *run)
{
  return run->solver->save && run->solver->restore;
}

gamut_status checkpoint_write(struct gamut_run *run)
{
  gamut_status status;
  struct writing w = {.run = run};
  struct trace *trace = run->trace;
  TRY(store_sync(run->store, trace));
  TRY(checkpoint_begin(store_folder(run->store), checkpoint_bytes(run), trace, &w.file));
  TRY(put_scene(&w));
  TRY(put_clock(&w));
  TRY(put_ledger(&w));
  TRY(put_histories(&w));
  for (size_t s = 0; s < run->scene->bodies; s++)
    TRY(put_set(&w, run->set[s]));
  TRY(put_materials(&w));
  TRY(put_effects(&w));
  TRY(put_state(&w, run->scene->solver.descriptor->id, "solver", run->solver_self,
                run->solver->save));
  status = checkpoint_end(w.file, trace);
  w.file = NULL;
  run->checkpoint_wall = clock_seconds(CLOCK_MONOTONIC);
done:
  checkpoint_close(w.file);
  return status;
}

void checkpoint_start(struct gamut_run *run)
{
  run->checkpoint_wall = clock_seconds(CLOCK_MONOTONIC);
  run->checkpoint = 0;
  due_by_now(run, run->scene->checkpoint_every, &run->checkpoint);
}

gamut_status checkpoint_due(struct gamut_run *run)
{
  double every = run->scene->checkpoint_every, wall = run->scene->checkpoint_wall;
  bool due = wall > 0.0 && clock_seconds(CLOCK_MONOTONIC) - run->checkpoint_wall >= wall;
  if (!run->store || !run_can_stop(run))
    return GAMUT_OK;
  due |= due_by_now(run, every, &run->checkpoint);
  return due ? checkpoint_write(run) : GAMUT_OK;
}
