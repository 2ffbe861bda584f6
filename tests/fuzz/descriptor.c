/* A plugin's YAML; of a sound one also what is generated and shown. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "descriptor/descriptor.h"
#include "tests/fuzz/fuzz.h"

enum { NAME = 64 };

/* A plugin stands in a file of its own name: takes it from "plugin: kind/name". */
static void name_of(const uint8_t *data, size_t size, char name[NAME + 8])
{
  static const char mark[] = "plugin: ";
  size_t length = 0, at = 0;
  while (at + sizeof mark - 1 < size && memcmp(data + at, mark, sizeof mark - 1) != 0)
    at++;
  while (at < size && data[at] != '/' && data[at] != '\n')
    at++;
  for (at++; at < size && length < NAME && (isalnum(data[at]) || data[at] == '_'); at++)
    name[length++] = (char)data[at];
  strcpy(name + length, length ? ".yaml" : "x.yaml");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char name[NAME + 8];
  struct bench *bench = bench_get();
  struct trace *trace = trace_new();
  struct descriptor *descriptor = NULL;
  name_of(data, size, name);
  bench_write(name, data, size);
  gamut_status status = descriptor_read(bench_path(name), bench->units, trace, &descriptor);
  unlink(bench_path(name));
  demand((status == GAMUT_OK) == (descriptor != NULL), "a descriptor and its status disagree");
  demand(status == GAMUT_OK || trace_errors(trace) > 0, "a descriptor is refused without a word");
  trace_discard(trace);
  FILE *nowhere = fopen("/dev/null", "w");
  if (descriptor && nowhere) {
    struct slot *slots = NULL;
    descriptor_layout(descriptor, &slots);
    free(slots);
    descriptor_header(descriptor, nowhere);
    descriptor_show(descriptor, nowhere);
    descriptor_show_json(descriptor, nowhere);
  }
  if (nowhere)
    fclose(nowhere);
  descriptor_free(descriptor);
  trace_free(trace);
  return 0;
}
