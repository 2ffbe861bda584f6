/* Runs of scenes that lie in a plugin's folder. */
#ifndef GAMUT_SCENE_RUN_H
#define GAMUT_SCENE_RUN_H

#include "conformance/conformance_private.h"
#include "run/run.h"

struct scene_run {
  struct scene *scene;
  struct gamut_run *run;
  struct trace *trace;
  gamut_status status;
};
/* Path of a file in the plugin's folder, to be freed; null without memory. */
char *plugin_file(const struct descriptor *, const char *name);
/* Runs a scene to its end, with some of it overridden. Says why where it fails. */
void scene_run_make(struct scene_run *, struct proof *, const char *file,
                    const struct scene_override *, size_t overrides, int threads);
void scene_run_free(struct scene_run *);
/* Writes the scene in which an effect without a scene of its own is tried, with the base
 * parameters, and gives its path; null if it cannot be written. */
char *usual_scene_new(const struct proof *);
/* Removes the file as well. */
void usual_scene_free(char *file);
/* Asks for every measure that the plugin of a run declares, and for one that it does not. */
void prove_measures(struct proof *, struct gamut_run *);

/* The tests of NAME.test.yaml that run a scene. */
void prove_scene_answers(struct proof *);
/* Whether a test of NAME.test.yaml is such a one. */
bool is_scene_test(const struct tree *test);

#endif
