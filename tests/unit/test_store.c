/* Results on disk: what is written is read back; what is there is not lost; faults are named.
 * With a folder as argument writes the sample result there and stops; with a second one, it loses
 * points on the way. */
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "store/result.h"
#include "tests/tap.h"
#include "tests/unit/sample_result.h"

static char home[] = P_tmpdir "/gamut-store-XXXXXX";

/* The call comes first, then its words. */
#define CHECK(condition, name)                                                                     \
  do {                                                                                             \
    bool passed = (condition);                                                                     \
    const char *said = words(trace);                                                               \
    tap_ok(passed, "%s%s%s", name, *said ? ": " : "", said);                                       \
  } while (0)

static char *words(struct trace *);

static char *at(const char *name)
{
  static char path[4][256];
  static int turn;
  turn = (turn + 1) % 4;
  snprintf(path[turn], sizeof path[turn], "%s/%s", home, name);
  return path[turn];
}

static void put(const char *path, const char *text)
{
  FILE *file = fopen(path, "w");
  if (file) {
    fputs(text, file);
    fclose(file);
  }
}

static bool there(const char *path)
{
  return access(path, F_OK) == 0;
}

/* The words of the trace. */
static char *words(struct trace *trace)
{
  static char text[4096];
  memset(text, 0, sizeof text);
  FILE *file = fmemopen(text, sizeof text - 1, "w");
  trace_print(trace, file);
  fclose(file);
  text[strcspn(text, "\n")] = 0;
  return text;
}

static void test_read_back(void)
{
  struct trace *trace = trace_new();
  struct store *store = NULL;
  struct result *result = NULL;
  struct result_frame *frame = NULL;
  struct result_history *history = NULL;
  size_t histories = 0;
  CHECK(sample_result(at("a/b/one"), false, false, trace, &store) == GAMUT_OK,
        "a result is written, its folders made");
  tap_text("its folder", store_folder(store), at("a/b/one"));
  store_close(store);

  tap_ok(result_open(at("a/b/one"), trace, &result) == GAMUT_OK, "it opens");
  tap_ok(result_frames(result) == SAMPLE_FRAMES, "frames: %zu", result_frames(result));
  CHECK(result_frame_read(result, 4, NULL, trace, &frame) == GAMUT_OK, "the last frame");
  tap_ok(frame->bodies == 2 && frame->body[1].count == SAMPLE_COLUMNS * SAMPLE_ROWS &&
             frame->body[1].axes == 2,
         "bodies and points");
  tap_relative("time", frame->time, 80e-6, 1e-15);
  tap_ok(frame->step == 400, "step: %d", (int)frame->step);
  tap_text("field by default", frame->field, "plastic_strain");
  result_frame_free(frame);

  result_frame_read(result, 4, "stress_yz", trace, &frame);
  double a = 0.5 / SAMPLE_COLUMNS, b = 0.5 / SAMPLE_ROWS;
  tap_relative("stress_yz keeps its place in a tensor written whole", frame->body[1].value[0],
               8e6 * (1 + a + 2 * b), 1e-14);
  tap_text("its unit", frame->unit, "Pa");
  result_frame_free(frame);
  result_frame_read(result, 4, "stress", trace, &frame);
  double mises = sqrt(0.5 * (1 + 1 + 4) + 3 * (49 + 64 + 81)) * 1e6 * (1 + a + 2 * b);
  tap_relative("stress is von Mises", frame->body[1].value[0], mises, 1e-14);
  result_frame_free(frame);
  CHECK(result_frame_read(result, 4, "stres", trace, &frame) == GAMUT_USAGE, "unknown field");
  result_frame_read(result, 4, "stres", trace, &frame);

  result_histories(result, trace, &history, &histories);
  tap_ok(histories == 2, "histories: %zu", histories);
  tap_text("name", history[1].name, "wall_force");
  tap_text("unit", history[1].unit, "N");
  tap_ok(history[0].count == 81, "samples: %zu", history[0].count);
  tap_relative("last value", history[0].value[80], 25.4e-3 * 0.75, 1e-14);
  result_histories_free(history, histories);
  result_close(result);
  trace_free(trace);
}

static void test_refusals(void)
{
  struct trace *trace = trace_new();
  struct store *store = NULL;
  const char *folder = at("a/b/one");
  CHECK(store_open(folder, false, trace, &store) == GAMUT_OUTPUT && !store,
        "an existing result is refused");
  mkdir(at("a/b/one/pictures"), 0777);
  put(at("a/b/one/notes.txt"), "mine");
  put(at("a/b/one/pictures/history_length.png"), "old");
  put(at("a/b/one/pictures/mine.png"), "mine");
  tap_ok(store_open(at("a/b/one"), true, trace, &store) == GAMUT_OK, "force replaces it");
  store_close(store);
  tap_ok(!there(at("a/b/one/summary.json")) && !there(at("a/b/one/scene.yaml")) &&
             !there(at("a/b/one/pictures/history_length.png")),
         "what the former result had is gone");
  tap_ok(there(at("a/b/one/notes.txt")) && there(at("a/b/one/pictures/mine.png")),
         "other files stay");

  mkdir(at("two"), 0777);
  put(at("two/scene.yaml"), "gamut: 1\n");
  tap_ok(store_open(at("two"), true, trace, &store) == GAMUT_OUTPUT,
         "force leaves a folder alone that holds no result of ours");
  words(trace);
  tap_ok(there(at("two/scene.yaml")), "a scene of the user's stays");

  put(at("file"), "");
  CHECK(store_open(at("file/x"), false, trace, &store) == GAMUT_OUTPUT, "below a file");
  CHECK(store_open("/proc/gamut", false, trace, &store) == GAMUT_OUTPUT, "no such place");
  if (geteuid() == 0) {
    tap_skip("a folder without permission", "root may write anywhere");
  } else {
    mkdir(at("locked"), 0555);
    CHECK(store_open(at("locked"), false, trace, &store) == GAMUT_OUTPUT, "no permission");
  }
  struct result *result = NULL;
  CHECK(result_open(at("two"), trace, &result) == GAMUT_OUTPUT, "no result to read");
  trace_free(trace);
}

/* In a child, since a limit on the size of files holds for good; stands for a full disk. */
static void test_full_disk(void)
{
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    struct trace *trace = trace_new();
    struct store *store = NULL;
    struct rlimit limit = {300000, 300000};
    gamut_status status = GAMUT_OK;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    status = store_open(at("full"), false, trace, &store);
    for (int frame = 0; frame < 100 && status == GAMUT_OK; ++frame)
      status = sample_frame(store, frame, trace);
    store_close(store);
    bool named = strstr(words(trace), "File too large") != NULL;
    trace_free(trace);
    exit(status == GAMUT_OUTPUT && named ? 0 : 10 + (int)status);
  }
  int status = -1;
  waitpid(child, &status, 0);
  tap_ok(WIFEXITED(status) && WEXITSTATUS(status) == 0, "a full disk is named: status %d", status);
}

/* Whoever is killed leaves every frame that was written. */
static void test_kill(void)
{
  int ready[2];
  char byte;
  if (pipe(ready) != 0)
    return;
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    struct trace *trace = trace_new();
    struct store *store = NULL;
    store_open(at("killed"), false, trace, &store);
    for (int frame = 0; frame < 3; ++frame)
      sample_frame(store, frame, trace);
    if (write(ready[1], "x", 1) == 1)
      pause();
    _exit(1);
  }
  struct trace *trace = trace_new();
  struct result *result = NULL;
  bool started = read(ready[0], &byte, 1) == 1;
  gamut_status status = result_open(at("killed"), trace, &result);
  tap_ok(started && status == GAMUT_OK && result_frames(result) == 3,
         "a reader may look while the run writes");
  result_close(result);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  status = result_open(at("killed"), trace, &result);
  CHECK(status == GAMUT_OK && result_frames(result) == 3, "frames after a kill");
  result_close(result);
  trace_free(trace);
}

int main(int argc, char **argv)
{
  if (argc > 1) {
    struct trace *trace = trace_new();
    struct store *store = NULL;
    gamut_status status = sample_result(argv[1], false, argc > 2, trace, &store);
    store_close(store);
    trace_print(trace, stderr);
    trace_free(trace);
    return (int)status;
  }
  char command[64];
  if (!mkdtemp(home))
    return 1;
  test_read_back();
  test_refusals();
  test_full_disk();
  test_kill();
  snprintf(command, sizeof command, "rm -rf %s", home);
  tap_ok(system(command) == 0, "the test's folder is removed");
  return tap_done();
}
