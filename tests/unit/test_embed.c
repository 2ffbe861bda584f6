/* The library as a program that embeds it sees it. */
#include <gamut/gamut.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/tap.h"

static const char scene[] =
    "gamut: 1\n"
    "solver: {model: material_driver, end: 1 ms, steps: 4,\n"
    "         control: {xy: {velocity_gradient: 100 1/s}}}\n"
    "materials:\n"
    "  metal: {density: 8000 kg/m3, eos: {model: linear, bulk_modulus: 140 GPa},\n"
    "          elasticity: {model: hypoelastic, shear_modulus: {mean: 48 GPa, cv: 0.05}}}\n"
    "bodies: {sample: {material: metal}}\n"
    "quantities: {shear: {measure: stress_xy, body: sample, reduce: at end}}\n"
    "uncertainty: {estimator: {model: monte_carlo, runs: 8}}\n";

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
  const struct gamut_run_request request = {.set = set, .sets = 1, .threads = 2};
  tap_ok(gamut_run_scene(session, file, &request, &summary) == GAMUT_OK, "a study runs%s",
         gamut_messages(session));
  tap_ok(summary && strstr(summary, "\"mean_error\"") && strstr(summary, "\"asked\": 5"),
         "its summary has moments of five runs");
  tap_ok(gamut_check_scene(session, file, &request) == GAMUT_OK, "it is checked");
  gamut_free(summary);
  gamut_session_free(session);
  unlink(file);
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
  return tap_done();
}
