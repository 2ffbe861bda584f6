#include "conformance/stub_host.h"

#include <stdlib.h>

bool bare_run_new(struct bare_run *run, struct proof *proof)
{
  gamut_status status = GAMUT_OK;
  const struct gamut_plugin *plugin;
  *run = (struct bare_run){0};
  lone_run_open(&run->lone, trace_new(), arena_new());
  TRY(specimen_values(&run->specimen, proof->descriptor, &proof->base, "base", proof->units,
                      run->lone.trace));
  TRY(registry_open(proof->registry, proof->descriptor, run->lone.trace, &plugin));
  lone_run_values(run->specimen.values);
  run->ops = plugin->ops;
done:
  if (status != GAMUT_OK) {
    check_that(&proof->checks, false, "the plugin can be given its parameters");
    bare_run_say(run, &proof->checks);
  }
  return status == GAMUT_OK;
}

void bare_run_free(struct bare_run *run)
{
  specimen_close(&run->specimen);
  arena_free(run->lone.arena);
  trace_free(run->lone.trace);
}

struct gamut_run *bare_run_handle(struct bare_run *run)
{
  return lone_run_handle(&run->lone);
}

void bare_run_say(struct bare_run *run, struct checks *checks)
{
  char *text = trace_text(run->lone.trace);
  check_say(checks, "%s", text ? text : "");
  free(text);
}
