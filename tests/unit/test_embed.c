/* The library as a program that embeds it sees it. */
#include <gamut/gamut.h>

#include <string.h>

#include "tests/tap.h"

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
  return tap_done();
}
