#include "conformance/scene_run.h"

#include <stdlib.h>
#include <string.h>

char *plugin_file(const struct descriptor *d, const char *name)
{
  size_t length = strlen(d->folder) + strlen(name) + 2;
  char *file = malloc(length);
  if (file)
    snprintf(file, length, "%s/%s", d->folder, name);
  return file;
}

void scene_run_make(struct scene_run *made, struct proof *proof, const char *file,
                    const struct scene_override *override, size_t overrides, int threads)
{
  gamut_status status = GAMUT_OK;
  const struct run_options options = {.threads = threads};
  *made = (struct scene_run){.trace = trace_new()};
  TRY(scene_read(file, override, overrides, proof->registry, proof->units, made->trace,
                 &made->scene));
  TRY(run_new(made->scene, proof->registry, &options, made->trace, &made->run));
  TRY(run_march(made->run, made->trace));
done:
  made->status = status;
  if (status != GAMUT_OK) {
    char *text = trace_text(made->trace);
    check_say(&proof->checks, "%s", text ? text : "");
    free(text);
  }
}

void scene_run_free(struct scene_run *made)
{
  run_free(made->run);
  scene_free(made->scene);
  trace_free(made->trace);
}
