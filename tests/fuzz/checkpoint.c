/* A checkpoint under --resume. Bytes that begin like HDF5 are the file as it is, and the checksum
 * must refuse them before HDF5 sees them, or it is the whole file; anything else is a list of
 * changes (hdf5_edit.h) to a sound checkpoint, which is sealed again. */
#include <sys/stat.h>
#include <unistd.h>

#include "tests/fuzz/base_run.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/hdf5_edit.h"

/* For the seal, which nobody but a writer of checkpoints may set. */
#include "store/checkpoint.c"

static void make_changed(const uint8_t *data, size_t size)
{
  const struct base_file *whole = base_checkpoint();
  bench_write("run/" CHECKPOINT_FILE, whole->data, whole->size - TRAILER);
  hid_t file = H5Fopen(bench_path("run/" CHECKPOINT_FILE), H5F_ACC_RDWR, H5P_DEFAULT);
  demand(file >= 0, "the checkpoint to be changed cannot be opened");
  hdf5_edit(file, data, size);
  demand(H5Fclose(file) >= 0 && seal(bench_path("run/" CHECKPOINT_FILE)) == 0,
         "the changed checkpoint cannot be sealed");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const char magic[] = "\x89HDF";
  const struct base_file *results = base_results();
  struct trace *trace = trace_new();
  struct gamut_run *run = NULL;
  struct store *store = NULL;
  static const volatile sig_atomic_t stop = 1;
  const struct run_options options = {.threads = 1, .stop = &stop};
  mkdir(bench_path("run"), 0777);
  unlink(bench_path("run/" CHECKPOINT_PREVIOUS));
  bench_write("run/results.h5", results->data, results->size);
  if (size >= sizeof magic - 1 && memcmp(data, magic, sizeof magic - 1) == 0)
    bench_write("run/" CHECKPOINT_FILE, data, size);
  else
    make_changed(data, size);
  demand(run_new(base_scene(), bench_get()->registry, &options, trace, &run) == GAMUT_OK,
         "the run cannot be made");
  gamut_status status = run_resume(run, bench_path("run"), trace, &store);
  demand(status == GAMUT_OK || trace_errors(trace) > 0, "a checkpoint is refused without a word");
  demand((status == GAMUT_OK) == (store != NULL), "a checkpoint and its status disagree");
  if (status == GAMUT_OK) {
    run_record(run, store);
    run_march(run, trace);
  }
  trace_discard(trace);
  run_free(run);
  store_close(store);
  trace_free(trace);
  return 0;
}
