/* As much of a run as a plugin needs that works without bodies: what `create` of estimators and
 * random fields and `prepare` of laws are handed where there is no run. */
#ifndef GAMUT_LONE_RUN_H
#define GAMUT_LONE_RUN_H

#include <gamut/plugin.h>

#include "base/error.h"
#include "field/field.h"

struct lone_run {
  struct gamut_run_head head; /* first */
  struct trace *trace;
  struct arena *arena;
};

void lone_run_open(struct lone_run *, struct trace *, struct arena *);
struct gamut_run *lone_run_handle(struct lone_run *);
/* Gives values and the groups below them its host; accepts null. */
void lone_run_values(struct gamut_values *);

#endif
