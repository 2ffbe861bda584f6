/* The checks that any plugin must pass; prints TAP. */
#ifndef GAMUT_CONFORMANCE_H
#define GAMUT_CONFORMANCE_H

#include <stdio.h>

#include "descriptor/descriptor.h"
#include "registry/registry.h"
#include "unit/unit.h"

/* Runs the suite of the plugin's kind and its *.test.yaml. Returns GAMUT_OK or GAMUT_PLUGIN. */
gamut_status conformance_run(struct registry *, const struct descriptor *, const struct units *,
                             struct trace *, FILE *);

#endif
