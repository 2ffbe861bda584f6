/* results.h5 as `gamut plot` and --resume read it: changes (hdf5_edit.h) to a sound one. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/checksum.h"
#include "store/hdf5.h"
#include "store/result.h"
#include "store/store_private.h"
#include "tests/fuzz/base_run.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/hdf5_edit.h"

enum { FRAMES_MAX = 4 };

/* Every number is looked at, so that a wrong count is seen. */
static void look_at(const struct result_frame *frame)
{
  volatile double sum = 0;
  for (size_t b = 0; b < frame->bodies; b++) {
    const struct result_body *body = &frame->body[b];
    demand(body->name && body->position, "a body of a frame has no positions");
    for (size_t i = 0; i < body->count; i++)
      sum += body->position[3 * i] + body->position[3 * i + 1] + body->position[3 * i + 2] +
             (body->value ? body->value[i] : 0.0);
  }
}

static void read_frames(const struct result *result, struct trace *trace)
{
  static const char *const fields[] = {NULL, "velocity", "velocity_y", "stress", "stress_xy"};
  for (size_t f = 0; f < result_frames(result) && f < FRAMES_MAX; f++)
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
      struct result_frame *frame = NULL;
      gamut_status status = result_frame_read(result, f, fields[i], trace, &frame);
      demand((status == GAMUT_OK) == (frame != NULL), "a frame and its status disagree");
      if (frame)
        look_at(frame);
      result_frame_free(frame);
    }
}

static void read_histories(const struct result *result, struct trace *trace)
{
  volatile double sum = 0;
  struct result_history *history = NULL;
  size_t count = 0;
  if (result_histories(result, trace, &history, &count) != GAMUT_OK)
    return;
  for (size_t h = 0; h < count; h++)
    for (size_t i = 0; i < history[h].count; i++)
      sum += history[h].time[i] + history[h].value[i] +
             (history[h].deviation ? history[h].deviation[i] : 0.0);
  result_histories_free(history, count);
}

static gamut_status go_on(struct trace *trace)
{
  gamut_status status;
  struct store *store = NULL;
  bool damaged;
  TRY(store_hold(bench_path("run"), trace, &store));
  TRY(store_reopen(store, base_place(), trace, &damaged));
  TRY(store_join(store, trace));
  status = store_scene(store, base_scene()->tree, trace);
done:
  store_close(store);
  return status;
}

/* A group and what it says about itself agree again, so that not everything ends at the checksum;
 * a change of the checksum itself stays as it is. */
static void sign(hid_t file, const char *path, const char *name)
{
  uint64_t sum;
  hid_t group = H5Oopen(file, path, H5P_DEFAULT);
  if (group >= 0 && !checksum_holds(group, name, &sum) && checksum_stated(group, &sum) &&
      H5Adelete(group, "checksum") >= 0)
    checksum_write(group, name, &sum);
  if (group >= 0)
    H5Oclose(group);
}

static void sign_all(hid_t file)
{
  for (int f = 0; f < FRAMES_MAX; f++) {
    char name[32], path[64];
    snprintf(name, sizeof name, "%08d", f);
    snprintf(path, sizeof path, "/frames/%s", name);
    sign(file, path, name);
  }
  sign(file, "/quantities", CURVES_NAME);
  sign(file, "/study/curves", CURVES_NAME);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const struct base_file *whole = base_results();
  struct trace *trace = trace_new();
  struct result *result = NULL;
  mkdir(bench_path("run"), 0777);
  bench_write("run/results.h5", whole->data, whole->size);
  hid_t file = H5Fopen(bench_path("run/results.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
  demand(file >= 0, "the result to be changed cannot be opened");
  hdf5_edit(file, data, size);
  if (size % 4 != 0)
    sign_all(file);
  demand(H5Fclose(file) >= 0, "the changed result cannot be closed");
  if (result_open(bench_path("run"), trace, &result) == GAMUT_OK) {
    read_frames(result, trace);
    read_histories(result, trace);
  }
  result_close(result);
  go_on(trace);
  trace_discard(trace);
  trace_free(trace);
  return 0;
}
