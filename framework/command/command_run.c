#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "command/command_run.h"
#include "command/scene_arguments.h"
#include "registry/guard.h"
#include "report/report.h"
#include "run/run.h"
#include "store/file.h"
#include "store/store.h"
#include "tree/load.h"

/* Which signal asked for the end of the run; a handler may touch nothing else. */
static volatile sig_atomic_t interrupted;

static void on_signal(int number)
{
  interrupted = number;
}

static void catch_one(int number, int flags)
{
  struct sigaction action = {.sa_handler = on_signal, .sa_flags = flags}, now;
  sigemptyset(&action.sa_mask);
  /* What whoever started us had ignored stays so: HUP under nohup. */
  if (sigaction(number, NULL, &now) == 0 && now.sa_handler != SIG_IGN)
    sigaction(number, &action, NULL);
}

static void catch_signals(void)
{
  /* Batch systems announce the end of a job by one of these, some more than once. */
  static const int batch[] = {SIGUSR1, SIGUSR2, SIGXCPU};
  /* A shell without job control has INT ignored in what it starts in the background: these two
   * mean us, always. */
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  catch_one(SIGINT, (int)SA_RESETHAND); /* a second Ctrl-C ends at once */
  catch_one(SIGTERM, (int)SA_RESETHAND);
  catch_one(SIGHUP, (int)SA_RESETHAND); /* the terminal was closed */
  for (size_t i = 0; i < ARRAY_SIZE(batch); i++)
    catch_one(batch[i], 0);
  guard_obey(&interrupted);
  /* A run of hours does not end because somebody closed a pager. */
  signal(SIGPIPE, SIG_IGN);
}

/* "inputs/taylor_bar.yaml" gives "taylor_bar-results" in the current folder. */
static char *standard_folder(const char *scene)
{
  const char *slash = strrchr(scene, '/');
  const char *base = slash ? slash + 1 : scene;
  const char *dot = strrchr(base, '.');
  size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
  char *folder = malloc(length + sizeof "-results");
  if (folder)
    sprintf(folder, "%.*s-results", (int)length, base);
  return folder;
}

/* What the run goes along, for the estimate of the time left. */
static struct progress *make_progress(const struct scene *scene)
{
  const struct value *end = values_find(scene->solver.values, "end");
  const char *unit = scene->solver.descriptor->axis_unit;
  return progress_new(stderr, end && end->present ? end->real : 1.0, unit ? unit : "s");
}

static gamut_status write_results(struct gamut_run *run, struct store *store, gamut_status marched,
                                  const struct run_arguments *arguments, struct command *command)
{
  gamut_status status = GAMUT_OK;
  size_t count;
  struct history *const *history = run_histories(run, &count);
  char *summary = run_summary(run, marched, command->registry);
  if (!summary)
    return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  TRY(store_histories(store, history, count, command->trace));
  TRY(store_summary(store, summary, command->trace));
  TRY(store_finish(store, command->trace));
  if (arguments->json) {
    puts(summary);
  } else {
    report_summary(summary, stdout);
    printf("results in %s\n", store_folder(store));
  }
done:
  free(summary);
  return status;
}

/* A run of its own takes every random parameter at its mean. */
static void say_means(struct command *command, const struct scene *scene)
{
  size_t count = scene->random_parameters;
  if (count > 0)
    trace_note(command->trace,
               "%zu random parameter%s taken at %s mean: a study needs uncertainty.estimator, such "
               "as {model: monte_carlo, runs: 100}",
               count, count == 1 ? " is" : "s are", count == 1 ? "its" : "their");
}

static void say_how_to_go_on(struct command *command, const struct run_arguments *arguments,
                             const char *unit, double time)
{
  trace_note(command->trace,
             "stopped at %.6g %s: 'gamut run %s -o %s --resume'%s goes on from there", time,
             unit ? unit : "s", arguments->file, arguments->folder,
             arguments->set.count ? ", with the same --set," : "");
}

/* The summary that stands there goes out again, so that a script finds what it looks for. */
static gamut_status say_finished(struct command *command, const struct run_arguments *arguments)
{
  trace_note(command->trace, "the run in '%s' is at its end: there is nothing to do",
             arguments->folder);
  if (!arguments->json)
    return GAMUT_OK;
  char *path = file_path(arguments->folder, "summary.json"), piece[4096];
  FILE *file = path ? text_open(path) : NULL;
  for (size_t got; file && (got = fread(piece, 1, sizeof piece, file)) > 0;)
    fwrite(piece, 1, got, stdout);
  if (!file)
    trace_fail(command->trace, GAMUT_OUTPUT, "cannot read the summary in '%s'", arguments->folder);
  else
    fclose(file);
  putchar('\n');
  free(path);
  return file ? GAMUT_OK : GAMUT_OUTPUT;
}

static gamut_status run_scene(struct command *command, const struct run_arguments *arguments,
                              struct scene *scene, bool *kept)
{
  gamut_status status = GAMUT_OK, marched;
  struct gamut_run *run = NULL;
  struct store *store = NULL;
  struct progress *progress = NULL;
  bool finished = false;
  struct run_options options = {
      .threads = arguments->threads, .stop = &interrupted, .seed = scene->seed};
  if (arguments->retry_failed || (arguments->resume && arguments->force)) {
    status = usage_fail(command, arguments->retry_failed
                                     ? "--retry-failed is for studies: this scene has no "
                                       "uncertainty.estimator"
                                     : "--resume goes on with a result, --force replaces it");
    goto done;
  }
  if (!scene->solver.descriptor) {
    status =
        trace_fail(command->trace, GAMUT_SCENE,
                   "%s has no solver: it is a card for other scenes, not a run", arguments->file);
    goto done;
  }
  if (arguments->resume) {
    TRY(run_finished(scene, arguments->folder, command->trace, &finished));
    if (finished) {
      status = say_finished(command, arguments);
      goto done;
    }
  }
  say_means(command, scene);
  progress = make_progress(scene);
  options.progress = progress_tell;
  options.progress_self = progress;
  catch_signals();
  TRY(run_new(scene, command->registry, &options, command->trace, &run));
  /* A batch job says --resume each time, also the first. */
  if (arguments->resume && store_there(arguments->folder)) {
    TRY(run_resume(run, arguments->folder, command->trace, &store));
  } else {
    if (arguments->resume)
      trace_note(command->trace, "there is no result in '%s' yet: the run begins",
                 arguments->folder);
    status = run_start(run, command->trace);
    if (status == GAMUT_SCENE)
      goto done;
    TRY(store_open(arguments->folder, arguments->force, command->trace, &store));
  }
  run_record(run, store);
  TRY(store_scene(store, scene->tree, command->trace));
  trace_print(command->trace, stderr);
  marched = run_march(run, command->trace);
  run_warn(run, command->trace);
  progress_free(progress);
  progress = NULL;
  status = write_results(run, store, marched, arguments, command);
  if (marched != GAMUT_OK)
    status = marched;
  *kept = marched == GAMUT_STOPPED && run_can_stop(run);
  if (*kept)
    say_how_to_go_on(command, arguments, scene->solver.descriptor->axis_unit, run_time(run));
done:
  progress_free(progress);
  run_free(run);
  store_close(store);
  return status;
}

/* Ends as a program does that the signal has killed, so that shells and make see what happened. */
static gamut_status end_by_signal(struct command *command)
{
  trace_note(command->trace, "interrupted; what was computed until then is in the results");
  trace_print(command->trace, stderr);
  fflush(stdout);
  signal(interrupted, SIG_DFL);
  raise(interrupted);
  return GAMUT_INTERNAL;
}

gamut_status command_run(struct command *command)
{
  struct run_arguments arguments = {0};
  const struct option option[] = {{"--output", 'o', OPTION_TEXT, &arguments.folder},
                                  {"--set", 0, OPTION_TEXTS, &arguments.set},
                                  {"--threads", 0, OPTION_WHOLE, &arguments.threads},
                                  {"--resume", 0, OPTION_FLAG, &arguments.resume},
                                  {"--retry-failed", 0, OPTION_FLAG, &arguments.retry_failed},
                                  {"--force", 0, OPTION_FLAG, &arguments.force},
                                  {"--json", 0, OPTION_FLAG, &arguments.json}};
  gamut_status status = GAMUT_OK;
  struct scene *scene = NULL;
  char *folder = NULL;
  TRY(options_read(command, option, ARRAY_SIZE(option), &arguments.file, 1, 1, NULL));
  TRY(scene_from_arguments(command, arguments.file, &arguments.set, &scene));
  folder = arguments.folder ? strdup(arguments.folder) : standard_folder(arguments.file);
  arguments.folder = folder;
  arguments.stop = &interrupted;
  if (study_wanted(scene)) {
    catch_signals();
    status = run_study(command, &arguments, scene);
  } else {
    bool kept = false;
    status = run_scene(command, &arguments, scene, &kept);
    if (status == GAMUT_STOPPED && interrupted && !kept)
      status = end_by_signal(command);
  }
done:
  scene_free(scene);
  free(folder);
  free(arguments.set.text);
  return status;
}
