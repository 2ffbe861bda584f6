/* The library as a program that embeds it sees it. */
#include <gamut/gamut.h>

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/tap.h"

static const char scene[] =
    "gamut: 1\n"
    "solver: {model: material_driver, end: 1 ms, steps: 4,\n"
    "         control: {xy: {velocity_gradient: 100 1/s}}}\n"
    "materials:\n"
    "  metal: {density: 8000 kg/m3,\n"
    "          eos: {model: linear, bulk_modulus: 140 GPa},\n"
    "          elasticity: {model: hypoelastic, shear_modulus: {mean: 48 GPa, cv: 0.05}}}\n"
    "bodies: {sample: {material: metal}}\n"
    "quantities: {shear: {measure: stress_xy, body: sample,\n"
    "                     reduce: at end}}\n"
    "uncertainty: {estimator: {model: monte_carlo, runs: 8}}\n";

/* Teams of threads of gcc's OpenMP are not built for the thread sanitizer, which would take what
 * stands after their barriers for races. */
#ifdef __SANITIZE_THREAD__
enum { TEAM = 1 };
#else
enum { TEAM = 2 };
#endif

/* A scene with an estimator is a study; the build's plugins lie beside the tests. */
static void test_study(void)
{
  const char *folder = getenv("builddir");
  char file[] = "embed-XXXXXX", *summary = NULL;
  if (!folder) {
    tap_skip("a study through the library", "the environment names no builddir");
    return;
  }
  int opened = mkstemp(file);
  tap_ok(opened >= 0 && write(opened, scene, sizeof scene - 1) == (ssize_t)sizeof scene - 1,
         "a scene is written");
  close(opened);
  struct gamut_session *session = gamut_session_new(folder);
  const char *set[] = {"uncertainty.estimator.runs=5"};
  const struct gamut_run_request request = {.set = set, .sets = 1, .threads = TEAM};
  const gamut_status ran = gamut_run_scene(session, file, &request, &summary);
  tap_ok(ran == GAMUT_OK, "a study runs%s", gamut_messages(session));
  tap_ok(summary && strstr(summary, "\"mean_error\"") && strstr(summary, "\"asked\": 5"),
         "its summary has moments of five runs");
  tap_ok(gamut_check_scene(session, file, &request) == GAMUT_OK, "it is checked");
  gamut_free(summary);
  gamut_session_free(session);
  unlink(file);
}

static void expect(struct gamut_session *session, gamut_status got, gamut_status wanted,
                   const char *name)
{
  tap_ok(got == wanted && *gamut_messages(session), "%s: status %d, %s", name, (int)got,
         gamut_messages(session));
}

static void test_nulls(void)
{
  const char *holes[] = {"solver.steps=4", NULL};
  const struct gamut_run_request no_list = {.sets = 2}, hole = {.set = holes, .sets = 2},
                                 backwards = {.threads = -1};
  char *summary = NULL;
  struct gamut_session *session = gamut_session_new(NULL);
  expect(NULL, gamut_run_scene(NULL, "x.yaml", &no_list, &summary), GAMUT_USAGE, "no session");
  expect(NULL, gamut_check_scene(NULL, "x.yaml", NULL), GAMUT_USAGE, "no session to check with");
  expect(session, gamut_run_scene(session, NULL, NULL, NULL), GAMUT_USAGE, "no scene");
  expect(session, gamut_check_scene(session, NULL, NULL), GAMUT_USAGE, "no scene to check");
  expect(session, gamut_run_scene(session, "x.yaml", &no_list, &summary), GAMUT_USAGE, "no list");
  expect(session, gamut_run_scene(session, "x.yaml", &hole, &summary), GAMUT_USAGE, "a hole in it");
  expect(session, gamut_check_scene(session, "x.yaml", &backwards), GAMUT_USAGE,
         "threads below none");
  expect(session, gamut_run_scene(session, "no/such.yaml", NULL, NULL), GAMUT_SCENE,
         "no request and no summary are fine");
  gamut_session_free(session);
}

/* What only a plan and a start can tell is known to the check. */
static void test_check(void)
{
  static const char *const wrong[] = {"axis_beyond_geometry", "body_behind_wall",
                                      "field_unknown_to_the_solver"};
  const char *folder = getenv("builddir"), *source = getenv("srcdir");
  if (!folder || !source) {
    tap_skip("what a check knows", "the environment names no srcdir and builddir");
    return;
  }
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    char file[4096];
    snprintf(file, sizeof file, "%s/tests/bad_inputs/%s.yaml", source, wrong[i]);
    struct gamut_session *session = gamut_session_new(folder);
    expect(session, gamut_check_scene(session, file, NULL), GAMUT_SCENE, wrong[i]);
    gamut_session_free(session);
  }
}

/* A folder of plugins that is skipped is told of, not only missed later. */
static void test_skipped(void)
{
  char folder[] = P_tmpdir "/gamut-embed-XXXXXX";
  tap_ok(mkdtemp(folder) && chmod(folder, 0777) == 0, "a folder that all may write to");
  struct gamut_session *session = gamut_session_new(folder);
  tap_ok(session && strstr(gamut_messages(session), folder) &&
             strstr(gamut_messages(session), "is skipped"),
         "it is skipped, with a word: %s", session ? gamut_messages(session) : "no session");
  gamut_session_free(session);
  rmdir(folder);
}

/* One of several sessions at work at the same time: a run with results on the disk, a study, a
 * scene that is wrong, plugins and units each time. */
enum { SESSIONS = 4, TURNS = 3 };

struct at_work {
  const char *plugins, *file;
  char folder[64];
  char *value; /* of the study: the same in all sessions */
  int faults;
};

static const char bar[] = "gamut: 1\n"
                          "solver: {model: material_driver, end: 1 ms, steps: 4,\n"
                          "         control: {xy: {velocity_gradient: 100 1/s}}}\n"
                          "materials:\n"
                          "  metal: {density: 8000 kg/m3,\n"
                          "          eos: {model: linear, bulk_modulus: 140 GPa},\n"
                          "          elasticity: {model: hypoelastic, shear_modulus: 48 GPa}}\n"
                          "bodies: {sample: {material: metal}}\n"
                          "quantities: {shear: {measure: stress_xy, body: sample,\n"
                          "                     reduce: at end}}\n"
                          "outputs: {frames: 4, fields: [stress]}\n";

static void *work(void *self)
{
  struct at_work *own = self;
  for (int turn = 0; turn < TURNS; turn++) {
    char *summary = NULL, *run = NULL, other[80];
    struct gamut_session *session = gamut_session_new(own->plugins);
    const struct gamut_run_request request = {.threads = 1, .folder = own->folder, .force = 1};
    snprintf(other, sizeof other, "%s.yaml", own->folder);
    own->faults += gamut_run_scene(session, other, &request, &run) != GAMUT_OK;
    own->faults += gamut_check_scene(session, "no/such.yaml", NULL) != GAMUT_SCENE;
    own->faults += gamut_run_scene(session, own->file, &(struct gamut_run_request){.threads = 1},
                                   &summary) != GAMUT_OK;
    const char *mean = summary ? strstr(summary, "\"mean\"") : NULL;
    free(own->value);
    own->value = mean ? strndup(mean, strcspn(mean, ",")) : NULL;
    gamut_free(summary);
    gamut_free(run);
    gamut_session_free(session);
  }
  return NULL;
}

static void put(const char *name, const char *text)
{
  FILE *file = fopen(name, "w");
  if (file) {
    fputs(text, file);
    fclose(file);
  }
}

static void test_threads(void)
{
  const char *folder = getenv("builddir");
  char home[] = P_tmpdir "/gamut-embed-XXXXXX", study[80], command[120];
  struct at_work own[SESSIONS] = {0};
  pthread_t thread[SESSIONS];
  int faults = 0;
  if (!folder || !mkdtemp(home)) {
    tap_skip("sessions in threads", "the environment names no builddir");
    return;
  }
  snprintf(study, sizeof study, "%s/study.yaml", home);
  put(study, scene);
  for (int i = 0; i < SESSIONS; i++) {
    own[i].plugins = folder;
    own[i].file = study;
    snprintf(own[i].folder, sizeof own[i].folder, "%s/%d", home, i);
    snprintf(command, sizeof command, "%s.yaml", own[i].folder);
    put(command, bar);
  }
  for (int i = 0; i < SESSIONS; i++)
    pthread_create(&thread[i], NULL, work, &own[i]);
  for (int i = 0; i < SESSIONS; i++)
    pthread_join(thread[i], NULL);
  for (int i = 0; i < SESSIONS; i++) {
    faults += own[i].faults;
    faults += !own[i].value || !own[0].value || strcmp(own[i].value, own[0].value) != 0;
  }
  tap_ok(faults == 0,
         "%d sessions in threads, %d times a run and a study: %d faults (allowed 0), %s", SESSIONS,
         TURNS, faults, own[0].value ? own[0].value : "no mean");
  for (int i = 0; i < SESSIONS; i++)
    free(own[i].value);
  snprintf(command, sizeof command, "rm -rf %s", home);
  tap_ok(system(command) == 0, "the test's folder is removed");
}

int main(void)
{
  struct gamut_run_request request = {0};
  char *summary = NULL;
  tap_ok(strcmp(gamut_version(), GAMUT_VERSION) == 0, "the version is the build's");
  struct gamut_session *session = gamut_session_new(NULL);
  tap_ok(session != NULL, "a session is made");
  tap_ok(gamut_run_scene(session, "no/such/scene.yaml", &request, &summary) == GAMUT_SCENE,
         "a missing scene is GAMUT_SCENE");
  tap_ok(summary == NULL, "and gives no summary");
  tap_ok(strstr(gamut_messages(session), "no/such/scene.yaml") != NULL, "the message names it: %s",
         gamut_messages(session));
  const char *bad[] = {"no equals sign"};
  request.set = bad;
  request.sets = 1;
  tap_ok(gamut_check_scene(session, "no/such/scene.yaml", &request) == GAMUT_USAGE,
         "an override without '=' is GAMUT_USAGE");
  gamut_session_free(session);
  gamut_session_free(NULL);
  gamut_free(NULL);
  test_study();
  test_nulls();
  test_check();
  test_skipped();
  test_threads();
  return tap_done();
}
