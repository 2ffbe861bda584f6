#include <gamut/gamut.h>

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <hdf5.h>

#include "base/exclusive.h"
#include "registry/registry.h"
#include "run/run.h"
#include "scene/scene.h"
#include "store/store.h"
#include "study/study.h"

struct gamut_session {
  struct units *units;
  struct registry *registry;
  struct trace *trace;
  char *messages;
};

const char *gamut_version(void)
{
  return GAMUT_VERSION;
}

/* What has been said, as text for the program. */
static void keep_messages(struct gamut_session *session)
{
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  if (stream) {
    trace_print(session->trace, stream);
    fclose(stream);
  }
  free(session->messages);
  session->messages = text;
}

struct gamut_session *gamut_session_new(const char *plugin_path)
{
  EXCLUSIVE;
  char why[256];
  const struct registry_options options = {.plugin_path = plugin_path, .user_plugins = true};
  struct gamut_session *session = calloc(1, sizeof *session);
  if (!session)
    return NULL;
  gsl_set_error_handler_off();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  session->trace = trace_new();
  session->units = units_new(why, sizeof why);
  if (!session->trace || !session->units ||
      registry_new(&options, session->units, session->trace, &session->registry) != GAMUT_OK) {
    gamut_session_free(session);
    return NULL;
  }
  keep_messages(session);
  return session;
}

void gamut_session_free(struct gamut_session *session)
{
  if (!session)
    return;
  registry_free(session->registry);
  units_free(session->units);
  trace_free(session->trace);
  free(session->messages);
  free(session);
}

/* Messages belong to one call: what was said before is forgotten. */
static gamut_status begin(struct gamut_session *session)
{
  struct trace *fresh = trace_new();
  if (!fresh)
    return GAMUT_INTERNAL;
  trace_free(session->trace);
  session->trace = fresh;
  return GAMUT_OK;
}

static gamut_status end(struct gamut_session *session, gamut_status status)
{
  keep_messages(session);
  gamut_status worst = trace_worst(session->trace);
  return worst != GAMUT_OK ? worst : status;
}

static const char no_session[] = "error: the session is null\n";
static const struct gamut_run_request nothing_asked;

/* What a program got wrong. A null request asks for nothing; nulls in it are named. */
static gamut_status check_arguments(const struct gamut_session *session, const char *scene,
                                    const struct gamut_run_request *request)
{
  if (!scene)
    return trace_fail(session->trace, GAMUT_USAGE, "the name of the scene is null");
  if (request->sets > 0 && !request->set)
    return trace_fail(session->trace, GAMUT_USAGE, "the request has %zu sets, but `set` is null",
                      request->sets);
  for (size_t i = 0; i < request->sets; i++)
    if (!request->set[i])
      return trace_fail(session->trace, GAMUT_USAGE, "set %zu of the request is null", i);
  if (request->threads < 0)
    return trace_fail(session->trace, GAMUT_USAGE, "the request has %d threads", request->threads);
  return GAMUT_OK;
}

/* Reads a scene, and makes the study that it asks for, which is null for a run of its own. `study`
 * null: it is not made. */
static gamut_status read_scene(struct gamut_session *session, const char *file,
                               const struct gamut_run_request *request, struct scene **scene,
                               struct study **study)
{
  gamut_status status = GAMUT_OK;
  struct override_list list = {0};
  const struct study_options options = {.threads = request->threads, .force = request->force != 0};
  TRY(check_arguments(session, file, request));
  TRY(overrides_read(request->set, request->sets, session->trace, &list));
  TRY(scene_read(file, list.override, list.count, session->registry, session->units, session->trace,
                 scene));
  if (study && study_wanted(*scene))
    TRY(study_new(*scene, session->registry, session->units, &options, session->trace, study));
done:
  overrides_free(&list);
  return status;
}

gamut_status gamut_check_scene(struct gamut_session *session, const char *file,
                               const struct gamut_run_request *request)
{
  struct scene *scene = NULL;
  if (!session)
    return GAMUT_USAGE;
  request = request ? request : &nothing_asked;
  gamut_status status = begin(session);
  if (status == GAMUT_OK)
    status = read_scene(session, file, request, &scene, NULL);
  if (status == GAMUT_OK)
    status = study_check(scene, session->registry, session->units, session->trace);
  scene_free(scene);
  return end(session, status);
}

static gamut_status run_and_record(struct gamut_session *session, struct scene *scene,
                                   const struct gamut_run_request *request, char **summary)
{
  gamut_status status, marched;
  struct gamut_run *run = NULL;
  struct store *store = NULL;
  const struct run_options options = {.threads = request->threads, .seed = scene->seed};
  size_t count;
  TRY(run_new(scene, session->registry, &options, session->trace, &run));
  status = run_start(run, session->trace);
  if (status == GAMUT_SCENE)
    goto done;
  if (request->folder) {
    TRY(store_open(request->folder, request->force != 0, session->trace, &store));
    run_record(run, store);
    TRY(store_scene(store, scene->tree, session->trace));
  }
  marched = run_march(run, session->trace);
  run_warn(run, session->trace);
  *summary = run_summary(run, marched, session->registry);
  if (!*summary) {
    status = trace_fail(session->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  if (store) {
    struct history *const *history = run_histories(run, &count);
    TRY(store_histories(store, history, count, session->trace));
    TRY(store_summary(store, *summary, session->trace));
    TRY(store_finish(store, session->trace));
  }
  status = marched;
done:
  run_free(run);
  store_close(store);
  return status;
}

gamut_status gamut_run_scene(struct gamut_session *session, const char *file,
                             const struct gamut_run_request *request, char **summary)
{
  struct scene *scene = NULL;
  struct study *study = NULL;
  char *unwanted = NULL;
  summary = summary ? summary : &unwanted;
  *summary = NULL;
  if (!session)
    return GAMUT_USAGE;
  request = request ? request : &nothing_asked;
  gamut_status status = begin(session);
  if (status == GAMUT_OK)
    status = read_scene(session, file, request, &scene, &study);
  if (status == GAMUT_OK && study) {
    status = study_run(study, request->folder, session->trace);
    if (status == GAMUT_OK || status == GAMUT_NUMERICS)
      *summary = study_summary(study, status);
  } else if (status == GAMUT_OK) {
    status = run_and_record(session, scene, request, summary);
  }
  study_free(study);
  scene_free(scene);
  free(unwanted);
  return end(session, status);
}

const char *gamut_messages(const struct gamut_session *session)
{
  if (!session)
    return no_session;
  return session->messages ? session->messages : "";
}

void gamut_free(void *memory)
{
  free(memory);
}
