/* A plugin that needs no bodies, with its values: estimators and random fields. */
#ifndef GAMUT_STUB_HOST_H
#define GAMUT_STUB_HOST_H

#include <gamut/plugin.h>

#include "conformance/conformance_private.h"

struct bare_run {
  struct lone_run lone;
  struct specimen specimen; /* the plugin's values */
  const void *ops;
};

/* Makes it with the base values and opens the plugin. On failure a check fails with the reason. */
bool bare_run_new(struct bare_run *, struct proof *);
void bare_run_free(struct bare_run *);
struct gamut_run *bare_run_handle(struct bare_run *);
/* Prints what the plugin said, if anything. */
void bare_run_say(struct bare_run *, struct checks *);

#endif
