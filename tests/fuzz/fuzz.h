/* What the harnesses share. Each reads one input as `gamut` would read the file; libFuzzer makes
 * the inputs, or replay.c takes them from files. A reader may refuse anything, but in order. */
#ifndef GAMUT_TESTS_FUZZ_H
#define GAMUT_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "registry/registry.h"
#include "unit/unit.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Units and the tree's plugins ($GAMUT_FUZZ_PLUGINS), found once. */
struct bench {
  struct units *units;
  struct registry *registry;
  char folder[256]; /* of this process, with the tree's inputs; whoever sets TMPDIR removes it */
};
struct bench *bench_get(void);

/* "FOLDER/NAME", valid until the next call. */
const char *bench_path(const char *name);
void bench_write(const char *name, const void *data, size_t size);

/* Writes what the trace says to nowhere: messages are part of what a reader does. */
void trace_discard(struct trace *);

/* For what cannot be but by a fault of gamut. */
void demand(int holds, const char *what);

#endif
