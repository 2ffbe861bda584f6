/* Makes a run that has just started go on from a checkpoint. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "registry/guard.h"
#include "run/restart.h"
#include "store/file.h"

gamut_status resume_fill(const struct reading_back *r, const char *path, enum checkpoint_kind kind,
                         void *data, size_t count)
{
  return checkpoint_fill(r->file, path, kind, data, count, r->run->trace);
}

gamut_status resume_get(const struct reading_back *r, const char *path, enum checkpoint_kind kind,
                        void **data, size_t *count)
{
  return checkpoint_get(r->file, path, kind, data, count, r->run->trace);
}

static gamut_status check_scene(const struct reading_back *r)
{
  gamut_status status;
  void *text = NULL, *plugins = NULL, *files = NULL;
  struct tree *was = NULL;
  size_t size;
  TRY(resume_get(r, "scene", CHECKPOINT_BYTES, &text, &size));
  TRY(tree_parse(text, size, CHECKPOINT_FILE, GAMUT_OUTPUT, r->run->trace, &was));
  TRY(restart_same_scene(was, r->run->scene->tree, r->folder, r->run->trace));
  TRY(resume_get(r, "plugins", CHECKPOINT_BYTES, &plugins, &size));
  TRY(restart_same_plugins(r->run, plugins, r->folder));
  TRY(resume_get(r, "files", CHECKPOINT_BYTES, &files, &size));
  TRY(restart_same_files(r->run->scene, files, r->folder, r->run->trace));
done:
  free(files);
  tree_free(was);
  free(text);
  free(plugins);
  return status;
}

/* How far the results had come. The texts are to be freed. */
static gamut_status get_place(const struct reading_back *r, struct store_place *place)
{
  gamut_status status;
  double real[RESTART_REALS];
  int64_t whole[RESTART_WHOLES];
  void *xdmf = NULL, *id = NULL;
  size_t size;
  TRY(resume_fill(r, "clock", CHECKPOINT_REAL, real, RESTART_REALS));
  TRY(resume_fill(r, "counts", CHECKPOINT_WHOLE, whole, RESTART_WHOLES));
  TRY(resume_get(r, "run", CHECKPOINT_BYTES, &id, &size));
  place->run = id;
  TRY(resume_get(r, "frames", CHECKPOINT_BYTES, &xdmf, &size));
  *place = (struct store_place){.frames = (size_t)whole[1],
                                .last_time = real[2],
                                .last_step = (uint64_t)whole[2],
                                .checksum = (uint64_t)whole[4],
                                .run = id,
                                .xdmf = xdmf};
done:
  return status;
}

static gamut_status get_clock(const struct reading_back *r)
{
  gamut_status status;
  struct gamut_run *run = r->run;
  double real[RESTART_REALS];
  int64_t whole[RESTART_WHOLES];
  TRY(resume_fill(r, "clock", CHECKPOINT_REAL, real, RESTART_REALS));
  TRY(resume_fill(r, "counts", CHECKPOINT_WHOLE, whole, RESTART_WHOLES));
  if (!isfinite(real[0]) || !isfinite(real[1])) {
    status = trace_fail(run->trace, GAMUT_OUTPUT, "the time in the checkpoint is damaged");
    goto done;
  }
  if (run->end > 0.0 && run->end < real[0]) {
    status = trace_fail_at(run->trace, GAMUT_SCENE, NULL, "solver.end",
                           "a later end, or --force to run the scene anew",
                           "the run in '%s' has come to %g already, beyond the end at %g",
                           r->folder, real[0], run->end);
    goto done;
  }
  run->time = real[0];
  run->step = real[1];
  run->steps = (uint64_t)whole[0];
done:
  return status;
}

static gamut_status get_ledger(const struct reading_back *r)
{
  size_t lines = r->run->lines;
  double *value = calloc(3 * lines + 1, sizeof *value);
  if (!value)
    return trace_fail(r->run->trace, GAMUT_INTERNAL, "out of memory");
  gamut_status status = resume_fill(r, "ledger", CHECKPOINT_REAL, value, 3 * lines);
  for (size_t i = 0; i < lines && status == GAMUT_OK; i++) {
    r->run->ledger[i].start = value[3 * i];
    r->run->ledger[i].value = *r->run->line_value[i] = value[3 * i + 1];
    r->run->ledger[i].turnover = value[3 * i + 2];
  }
  free(value);
  return status;
}

/* What history_tell relies on. `last`: every, time, value, whether there is one. */
static bool history_is_sound(const double last[4], const double *time, size_t count)
{
  if (!isfinite(last[0]) || last[0] < 0.0 || !isfinite(last[1]) || (last[3] != 0.0 && count == 0))
    return false;
  for (size_t i = 0; i < count; i++)
    if (!isfinite(time[i]))
      return false;
  return true;
}

static gamut_status get_history(const struct reading_back *r, struct history *h)
{
  gamut_status status;
  char path[RESTART_PATH];
  const char *name = h->quantity->name;
  void *time = NULL, *value = NULL;
  size_t times, values;
  double last[4];
  TRY(resume_fill(r, restart_path(path, "quantities", name, "last"), CHECKPOINT_REAL, last, 4));
  TRY(resume_get(r, restart_path(path, "quantities", name, "axis"), CHECKPOINT_REAL, &time,
                 &times));
  TRY(resume_get(r, restart_path(path, "quantities", name, "value"), CHECKPOINT_REAL, &value,
                 &values));
  if (times != values || !history_is_sound(last, time, times))
    status = trace_fail(r->run->trace, GAMUT_OUTPUT, "the curve '%s' in the checkpoint is damaged",
                        name);
  else if (!history_go_on(h, r->run->end, last[0], time, value, times))
    status = trace_fail(r->run->trace, GAMUT_INTERNAL, "out of memory for the curve '%s'", name);
  h->last_time = last[1];
  h->last_value = last[2];
  h->has_last = last[3] != 0.0;
done:
  free(time);
  free(value);
  return status;
}

static gamut_status get_materials(const struct reading_back *r)
{
  gamut_status status = GAMUT_OK;
  char path[RESTART_PATH];
  struct gamut_run *run = r->run;
  for (size_t m = 0; m < run->scene->materials; m++) {
    int64_t count[MATERIAL_COUNTS];
    double factor;
    const char *name = run->scene->material[m].name;
    if (!run->material[m])
      continue;
    TRY(resume_fill(r, restart_path(path, "materials", name, "step_factor"), CHECKPOINT_REAL,
                    &factor, 1));
    TRY(resume_fill(r, restart_path(path, "materials", name, "flags"), CHECKPOINT_WHOLE, count,
                    MATERIAL_COUNTS));
    material_step_factor(run->material[m]);
    material_step_factor_keep(run->material[m], factor);
    material_go_on(run->material[m], count);
  }
done:
  return status;
}

static gamut_status get_state(const struct reading_back *r, const char *plugin, const char *path,
                              void *self,
                              gamut_status (*restore)(void *, const void *, size_t))
{
  void *bytes;
  size_t size;
  gamut_status status = resume_get(r, path, CHECKPOINT_BYTES, &bytes, &size);
  if (status != GAMUT_OK)
    return status;
  status = GUARDED(plugin, restore(self, bytes, size));
  if (status != GAMUT_OK && trace_errors(r->run->trace) == 0)
    trace_fail(r->run->trace, status, "'%s' of the checkpoint in '%s' does not fit", path,
               r->folder);
  free(bytes);
  return status;
}

static gamut_status get_effects(const struct reading_back *r)
{
  gamut_status status = GAMUT_OK;
  char path[RESTART_PATH];
  for (size_t e = 0; e < r->run->effects; e++) {
    const struct running_effect *effect = &r->run->effect[e];
    const char *name = effect->effect->instance.name;
    int64_t count[FLAG_COUNTS];
    if (effect->bound) {
      TRY(resume_fill(r, restart_path(path, "effects", name, "flags"), CHECKPOINT_WHOLE, count,
                      FLAG_COUNTS));
      effect_go_on(effect->bound, count);
    }
    if (effect->ops->save && effect->ops->restore)
      TRY(get_state(r, effect->effect->instance.descriptor->id,
                    restart_path(path, "effects", name, "state"), effect->self,
                    effect->ops->restore));
  }
done:
  return status;
}

static gamut_status get_all(const struct reading_back *r)
{
  gamut_status status;
  struct gamut_run *run = r->run;
  TRY(run_start(run, run->trace));
  TRY(get_clock(r));
  TRY(get_ledger(r));
  for (size_t i = 0; i < run->probes; i++)
    TRY(get_history(r, run->history[i]));
  for (size_t s = 0; s < run->scene->bodies; s++)
    TRY(resume_set(r, run->set[s]));
  TRY(get_materials(r));
  TRY(get_effects(r));
  TRY(get_state(r, run->scene->solver.descriptor->id, "solver", run->solver_self,
                run->solver->restore));
  run->resumed = true;
  frames_go_on(run);
done:
  return status;
}

/* What the summary in a folder says of how the run ended. */
static bool ended(const char *folder, const char *how)
{
  char *path = file_path(folder, "summary.json");
  json_t *summary = path ? json_load_file(path, 0, NULL) : NULL;
  const char *ending = json_string_value(json_object_get(summary, "status"));
  bool so = ending && strcmp(ending, how) == 0;
  json_decref(summary);
  free(path);
  return so;
}

/* A run that was killed, or failed, and left nothing to go on from begins anew: all that stands
 * there comes out again. */
static gamut_status begin_anew(const struct reading_back *r, const char *why, struct store *store)
{
  gamut_status status = GAMUT_OK;
  struct tree *was = NULL;
  char *path = file_path(r->folder, "scene.yaml");
  if (path && file_exists(path)) {
    TRY(tree_read(path, GAMUT_OUTPUT, r->run->trace, &was));
    TRY(restart_same_scene(was, r->run->scene->tree, r->folder, r->run->trace));
  }
  trace_note(r->run->trace, "%s in '%s': the run begins anew", why, r->folder);
  status = store_begin(store, true, r->run->trace);
done:
  tree_free(was);
  free(path);
  return status;
}

/* Results first, as far as the checkpoint counts on them; then the state; then they are joined. */
static gamut_status go_on(const struct reading_back *r, bool in_order, struct store *store)
{
  gamut_status status;
  struct store_place place = {0};
  struct trace *trace = r->run->trace, *unheard = NULL;
  bool damaged = false;
  TRY(check_scene(r));
  TRY(get_place(r, &place));
  /* what killed the run may have caught it while it wrote */
  unheard = in_order ? NULL : trace_new();
  status = store_reopen(store, &place, unheard ? unheard : trace, &damaged);
  if (unheard && damaged) {
    status = begin_anew(r, "the run was cut off while it wrote its results", store);
    goto done;
  }
  if (unheard && status != GAMUT_OK)
    trace_fail(trace, status, "%s", trace_first(unheard, MESSAGE_ERROR));
  TRY(status);
  TRY(get_all(r));
  TRY(store_join(store, trace));
done:
  trace_free(unheard);
  free((char *)(size_t)place.xdmf);
  free((char *)(size_t)place.run);
  return status;
}

gamut_status run_resume(struct gamut_run *run, const char *folder, struct trace *trace,
                        struct store **store)
{
  gamut_status status;
  struct reading_back r = {run, NULL, folder};
  struct checkpoint *file = NULL;
  bool in_order = ended(folder, "done") || ended(folder, "interrupted");
  run->trace = trace;
  *store = NULL;
  if (!run_can_stop(run))
    return trace_fail(trace, GAMUT_PLUGIN, "%s cannot go on with a run: it has no `restore`",
                      run->scene->solver.descriptor->id);
  TRY(store_hold(folder, trace, store));
  TRY(checkpoint_open(folder, trace, &file));
  r.file = file;
  if (file)
    status = go_on(&r, in_order, *store);
  else if (!in_order)
    status = begin_anew(&r, "there is nothing to go on from", *store);
  else
    status = trace_fail_at(trace, GAMUT_OUTPUT, NULL, NULL,
                           "--force runs the scene anew; outputs.checkpoint leaves checkpoints on "
                           "the way",
                           "'%s' holds a result, but no checkpoint to go on from", folder);
done:
  checkpoint_close(file);
  if (status != GAMUT_OK) {
    store_close(*store);
    *store = NULL;
  }
  return status;
}

gamut_status run_finished(const struct scene *scene, const char *folder, struct trace *trace,
                          bool *finished)
{
  gamut_status status = GAMUT_OK;
  struct tree *was = NULL;
  char *path = NULL;
  *finished = false;
  if (!ended(folder, "done"))
    return GAMUT_OK;
  path = file_path(folder, "scene.yaml");
  if (!path || !file_exists(path))
    goto done;
  TRY(tree_read(path, GAMUT_OUTPUT, trace, &was));
  TRY(restart_same_scene(was, scene->tree, folder, trace));
  TRY(restart_same_summary(scene, folder, trace));
  const struct tree *before = tree_at(was, "solver.end"), *now = tree_at(scene->tree, "solver.end");
  *finished = !before || !now ? before == now : strcmp(before->text, now->text) == 0;
done:
  tree_free(was);
  free(path);
  return status;
}
