/* The file of a checkpoint: read back as written; a broken one is found out and gives way to the
 * one before it; one that is not finished leaves nothing. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/checkpoint.h"
#include "store/file.h"
#include "tests/tap.h"

static char home[] = P_tmpdir "/gamut-checkpoint-XXXXXX";

static gamut_status write_one(int64_t number, struct trace *trace)
{
  static const double real[] = {0.1, -0.0, INFINITY, 1e-320};
  struct checkpoint *file = NULL;
  gamut_status status;
  TRY(checkpoint_begin(home, 100000, trace, &file));
  TRY(checkpoint_put(file, "bodies/bar/id", CHECKPOINT_WHOLE, &number, 1, trace));
  TRY(checkpoint_put(file, "bodies/bar/x", CHECKPOINT_REAL, real, 4, trace));
  TRY(checkpoint_put(file, "scene", CHECKPOINT_BYTES, "a: 1\n", 5, trace));
  TRY(checkpoint_put(file, "none", CHECKPOINT_REAL, NULL, 0, trace));
  status = checkpoint_end(file, trace);
  file = NULL;
done:
  checkpoint_close(file);
  return status;
}

static int64_t number_of(struct trace *trace, gamut_status *status)
{
  struct checkpoint *file = NULL;
  int64_t number = -1;
  *status = checkpoint_open(home, trace, &file);
  if (file)
    *status = checkpoint_fill(file, "bodies/bar/id", CHECKPOINT_WHOLE, &number, 1, trace);
  checkpoint_close(file);
  return number;
}

static bool there(const char *name)
{
  char *path = file_path(home, name);
  bool found = path && file_exists(path);
  free(path);
  return found;
}

static void turn_bit(const char *name, double share)
{
  char *path = file_path(home, name);
  FILE *file = path ? fopen(path, "r+b") : NULL;
  if (file) {
    fseek(file, 0, SEEK_END);
    long at = (long)(share * (double)ftell(file));
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 1, file);
    fclose(file);
  }
  free(path);
}

static void read_back(struct trace *trace)
{
  static const double wanted[] = {0.1, -0.0, INFINITY, 1e-320};
  struct checkpoint *file = NULL;
  void *data;
  double real[4];
  size_t count;
  tap_ok(checkpoint_open(home, trace, &file) == GAMUT_OK && !file, "none: no fault, no checkpoint");
  tap_ok(write_one(7, trace) == GAMUT_OK && there(CHECKPOINT_FILE) && !there(CHECKPOINT_PARTIAL),
         "written");
  if (!tap_ok(checkpoint_open(home, trace, &file) == GAMUT_OK && file, "opened"))
    return;
  tap_ok(checkpoint_fill(file, "bodies/bar/x", CHECKPOINT_REAL, real, 4, trace) == GAMUT_OK &&
             memcmp(real, wanted, sizeof real) == 0,
         "reals to the bit");
  tap_ok(checkpoint_get(file, "scene", CHECKPOINT_BYTES, &data, &count, trace) == GAMUT_OK &&
             count == 5 && strcmp(data, "a: 1\n") == 0,
         "a text");
  free(data);
  tap_ok(checkpoint_get(file, "none", CHECKPOINT_REAL, &data, &count, trace) == GAMUT_OK &&
             count == 0,
         "an array of nothing");
  free(data);
  tap_ok(checkpoint_has(file, "scene") && !checkpoint_has(file, "bodies/rod/x"), "what is there");
  tap_ok(checkpoint_fill(file, "bodies/bar/x", CHECKPOINT_REAL, real, 3, trace) == GAMUT_OUTPUT &&
             checkpoint_get(file, "scene", CHECKPOINT_REAL, &data, &count, trace) == GAMUT_OUTPUT &&
             checkpoint_get(file, "lost", CHECKPOINT_REAL, &data, &count, trace) == GAMUT_OUTPUT,
         "another size, another kind, nothing there: faults");
  checkpoint_close(file);
}

static void rotate(struct trace *trace)
{
  gamut_status status;
  struct checkpoint *file = NULL;
  write_one(8, trace);
  tap_ok(there(CHECKPOINT_PREVIOUS) && number_of(trace, &status) == 8, "the last one counts");
  checkpoint_begin(home, 1000, trace, &file);
  checkpoint_close(file);
  tap_ok(!there(CHECKPOINT_PARTIAL) && number_of(trace, &status) == 8,
         "one that is thrown away leaves nothing");
  for (int k = 0; k < 10; k++) {
    write_one(9, trace);
    write_one(10, trace);
    turn_bit(CHECKPOINT_FILE, (k + 0.5) / 10.0);
    if (number_of(trace, &status) != 9 || status != GAMUT_OK)
      tap_ok(false, "a bit turned at %d %%", 10 * k + 5);
  }
  tap_ok(number_of(trace, &status) == 9 && trace_warnings(trace) > 0 && !there(CHECKPOINT_PREVIOUS),
         "a bit turned anywhere: the one before it, with a warning, takes its place");
  turn_bit(CHECKPOINT_FILE, 0.99);
  number_of(trace, &status);
  tap_ok(status == GAMUT_OUTPUT, "no whole one left: a fault");
}

int main(void)
{
  if (!mkdtemp(home))
    return 1;
  struct trace *trace = trace_new();
  read_back(trace);
  rotate(trace);
  trace_free(trace);
  static const char *const file[] = {CHECKPOINT_FILE, CHECKPOINT_PREVIOUS, CHECKPOINT_PARTIAL};
  for (size_t i = 0; i < sizeof file / sizeof file[0]; i++) {
    char *path = file_path(home, file[i]);
    if (path)
      file_remove(path, NULL);
    free(path);
  }
  rmdir(home);
  return tap_done();
}
