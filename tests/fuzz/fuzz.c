#include "tests/fuzz/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <gsl/gsl_errno.h>
#include <hdf5.h>

void demand(int holds, const char *what)
{
  if (holds)
    return;
  fprintf(stderr, "fuzz: %s\n", what);
  abort();
}

struct bench *bench_get(void)
{
  static struct bench bench;
  char why[256] = "";
  const char *temporary = getenv("TMPDIR");
  const struct registry_options options = {.plugin_path = getenv("GAMUT_FUZZ_PLUGINS")};
  if (bench.registry)
    return &bench;
  demand(options.plugin_path != NULL, "GAMUT_FUZZ_PLUGINS names no folder of plugins");
  gsl_set_error_handler_off();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  snprintf(bench.folder, sizeof bench.folder, "%s/gamut-fuzz-XXXXXX",
           temporary ? temporary : P_tmpdir);
  demand(mkdtemp(bench.folder) != NULL, "no temporary folder");
  char inputs[sizeof bench.folder + 8];
  snprintf(inputs, sizeof inputs, "%s/inputs", bench.folder);
  demand(symlink(GAMUT_DATA_DIR "/inputs", inputs) == 0, "no link to the cards of the tree");
  struct trace *trace = trace_new();
  bench.units = units_new(why, sizeof why);
  demand(bench.units != NULL, why);
  demand(registry_new(&options, bench.units, trace, &bench.registry) == GAMUT_OK &&
             registry_count(bench.registry) > 0,
         "no plugins are found");
  trace_free(trace);
  return &bench;
}

const char *bench_path(const char *name)
{
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", bench_get()->folder, name);
  return path;
}

void bench_write(const char *name, const void *data, size_t size)
{
  FILE *file = fopen(bench_path(name), "wb");
  demand(file && fwrite(data, 1, size, file) == size && fclose(file) == 0,
         "the input cannot be written to a file");
}

void trace_discard(struct trace *trace)
{
  FILE *nowhere = fopen("/dev/null", "w");
  if (nowhere) {
    trace_print(trace, nowhere);
    fclose(nowhere);
  }
}
