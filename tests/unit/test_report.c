/* What people read: units, progress, summary, pictures. */
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report/readable.h"
#include "report/report.h"
#include "tests/tap.h"
#include "tests/unit/sample_result.h"

static void test_readable(void)
{
  static const struct {
    double value;
    const char *unit, *text;
  } known[] = {
      {0.0162, "m", "16.2 mm"},  {80e-6, "s", "80 us"},
      {2.5e9, "Pa", "2.5 GPa"},  {190, "m/s", "190 m/s"},
      {3940, "m/s", "3940 m/s"}, {0.3, "1", "0.3"},
      {1e-3, "m", "1 mm"},       {999.9e-6, "m", "999.9 um"},
      {0.0105, "kg", "10.5 g"},  {-4.2e4, "N", "-42 kN"},
      {0, "m", "0 m"},           {298, "K", "298 K"},
      {1e20, "Pa", "1e+08 TPa"}, {1e5, "1/s", "1e+05 1/s"},
      {3e6, "J/m3", "3 MJ/m3"},
  };
  char text[48], rate[64];
  for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i)
    tap_text(known[i].text, readable(known[i].value, known[i].unit, text, sizeof text),
             known[i].text);
  tap_text("in the unit of another", readable_like(1e-6, 80e-3, "m", text, sizeof text),
           "0.001 mm");
  tap_text("not a number", readable(NAN, "m", text, sizeof text), "nan m");
  tap_text("rate", readable_rate(12.34e6, rate, sizeof rate), "12.3 million point-steps/s");
}

static void test_progress(void)
{
  char *text = NULL;
  size_t size = 0, lines = 0;
  FILE *file = tmpfile();
  struct progress *progress = progress_new(file, 80e-6, "s");
  for (int i = 0; i <= 1000; ++i)
    progress_tell(progress, i / 1000.0, 80e-9 * i, (uint64_t)i, 2e6);
  progress_free(progress);
  rewind(file);
  FILE *memory = open_memstream(&text, &size);
  for (int c; (c = getc(file)) != EOF; putc(c, memory))
    lines += c == '\n';
  fclose(memory);
  fclose(file);
  tap_ok(lines == 10, "one line a tenth where no terminal is: %zu", lines);
  tap_ok(strncmp(text, " 10 %  8 us of 80 us, step 100, 2 million point-steps/s, 0:00 left\n",
                 67) == 0,
         "the first: %.66s", text);
  tap_ok(!strchr(text, '\r') && !strchr(text, '\033'), "no control characters in a file");
  free(text);
}

static void test_summary(void)
{
  static const char json[] =
      "{\"quantities\": {\"final_length\": {\"unit\": \"m\", \"value\": 0.0162},"
      " \"pressure\": {\"unit\": \"Pa\", \"times\": [0, 1, 2], \"values\": [0, 2e9, 1e9]},"
      " \"never\": {\"unit\": \"s\", \"value\": null, \"reason\": \"it never reaches 5 Pa\"},"
      " \"study\": {\"unit\": \"m\", \"mean\": 0.016, \"variance\": 1e-6, \"mean_error\": 1e-5}},"
      " \"ledger\": {\"mass\": {\"residual\": 1e-16, \"scale\": 0.01}},"
      " \"cost\": {\"points\": 1000, \"steps\": 200, \"wall_s\": 0.5, \"point_steps_per_s\": 4e5}}";
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  report_summary(json, memory);
  report_summary("{", memory);
  fclose(memory);
  tap_ok(strstr(text, "final_length  16.2 mm\n") != NULL, "a scalar");
  tap_ok(strstr(text, "1 GPa at the end; from 0 GPa to 2 GPa in 3 samples\n") != NULL, "a history");
  tap_ok(strstr(text, "no value: it never reaches 5 Pa\n") != NULL, "none");
  tap_ok(strstr(text, "16 mm +- 0.01 mm, standard deviation 1 mm\n") != NULL, "a study's");
  tap_ok(strstr(text, "ledger closes: mass to 1.0e-14") != NULL, "the ledger");
  tap_ok(strstr(text, "1000 points, 200 steps, 0.5 s (400000 point-steps/s)") != NULL, "the cost");
  tap_ok(strstr(text, "cannot be read") != NULL, "a broken summary is said to be");
  free(text);
}

/* Bodies in 1 and 3 dimensions: a line, and a bar with a long z axis. */
static gamut_status write_body(const char *folder, int axes, struct trace *trace)
{
  enum { SIDE = 8, LONG = 40, ALL = SIDE * SIDE * LONG };
  static double x[3][ALL], value[ALL];
  static int64_t id[ALL];
  struct store *store = NULL;
  size_t count = 0;
  for (int i = 0; i < (axes == 1 ? LONG : ALL); ++i, ++count) {
    id[i] = i;
    x[0][i] = axes == 1 ? 1e-3 * (i + 0.5) : 1e-3 * (i % SIDE + 0.5 - SIDE / 2);
    x[1][i] = 1e-3 * (i / SIDE % SIDE + 0.5 - SIDE / 2);
    x[2][i] = 1e-3 * (i / SIDE / SIDE + 0.5);
    value[i] = 300 + 1e4 * (axes == 1 ? x[0][i] : x[2][i] + x[0][i]);
  }
  const double *data[1] = {value};
  const struct frame_set set = {
      "bar", count, id, {x[0], axes > 1 ? x[1] : NULL, axes > 2 ? x[2] : NULL}, axes};
  const struct frame_field field = {"temperature", "K", "temperature", 1, data};
  gamut_status status = store_open(folder, false, trace, &store);
  if (status == GAMUT_OK)
    status = store_frame(store, 1e-6, 1, &set, 1, &field, 1, trace);
  store_close(store);
  return status;
}

static bool is_picture(const char *folder, const char *name)
{
  char path[300], head[8] = "";
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "rb");
  size_t read = file ? fread(head, 1, 8, file) : 0;
  if (file)
    fclose(file);
  return read == 8 && memcmp(head, "\211PNG\r\n\032\n", 8) == 0;
}

static bool is_there(const char *folder, const char *name)
{
  char path[300];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return access(path, R_OK) == 0;
}

/* The names that report_plot prints are not for the test's own output. */
static gamut_status draw(const char *result, const struct plot_options *options,
                         struct trace *trace)
{
  fflush(stdout);
  int kept = dup(STDOUT_FILENO);
  FILE *away = tmpfile();
  dup2(fileno(away), STDOUT_FILENO);
  gamut_status status = report_plot(result, options, trace);
  fflush(stdout);
  dup2(kept, STDOUT_FILENO);
  close(kept);
  fclose(away);
  return status;
}

static void test_pictures(const char *home)
{
  char bar[200], line[200], block[200], pictures[250];
  struct trace *trace = trace_new();
  struct store *store = NULL;
  struct plot_options options = {.frame = -1};
  snprintf(bar, sizeof bar, "%s/bar", home);
  snprintf(line, sizeof line, "%s/line", home);
  snprintf(block, sizeof block, "%s/block", home);
  snprintf(pictures, sizeof pictures, "%s/pictures", bar);
  sample_result(bar, false, false, trace, &store);
  store_close(store);
  tap_ok(write_body(line, 1, trace) == GAMUT_OK && write_body(block, 3, trace) == GAMUT_OK,
         "results are written");

  bool gnuplot = system("command -v gnuplot > /dev/null") == 0;
  char *path = strdup(getenv("PATH") ? getenv("PATH") : "");
  setenv("PATH", "/nowhere", 1);
  tap_ok(draw(bar, &options, trace) == GAMUT_OUTPUT, "without gnuplot there are no pictures");
  tap_ok(is_there(pictures, "history.gp") && is_there(pictures, "history_length.dat") &&
             is_there(pictures, "body_plastic_strain_00000004.gp"),
         "but data and scripts");
  setenv("PATH", path, 1);
  free(path);
  if (!gnuplot) {
    tap_skip("pictures", "gnuplot is not installed");
    trace_free(trace);
    return;
  }
  tap_ok(draw(bar, &options, trace) == GAMUT_OK, "pictures of a result");
  tap_ok(is_picture(pictures, "history.png") && is_picture(pictures, "history_length.png") &&
             is_picture(pictures, "history_wall_force.png") &&
             is_picture(pictures, "body_plastic_strain_00000004.png"),
         "each history, all histories, the body");
  tap_ok(!is_there(pictures, "gnuplot.log"), "no log is left");
  options = (struct plot_options){.field = "stress_xy", .frame = 0, .folder = home};
  tap_ok(draw(bar, &options, trace) == GAMUT_OK && is_picture(home, "body_stress_xy_00000000.png"),
         "another field, frame and folder");
  options.frame = 5;
  tap_ok(draw(bar, &options, trace) == GAMUT_USAGE, "a frame that is not there");
  options = (struct plot_options){.frame = -1, .folder = home};
  tap_ok(draw(line, &options, trace) == GAMUT_OK &&
             is_picture(home, "body_temperature_00000000.png"),
         "a line");
  options.folder = NULL;
  snprintf(pictures, sizeof pictures, "%s/pictures", block);
  tap_ok(draw(block, &options, trace) == GAMUT_OK &&
             is_picture(pictures, "body_temperature_00000000.png"),
         "a slice of a block");
  trace_free(trace);
}

int main(void)
{
  char home[] = P_tmpdir "/gamut-report-XXXXXX", command[64];
  test_readable();
  test_progress();
  test_summary();
  if (!mkdtemp(home))
    return 1;
  test_pictures(home);
  if (!getenv("GAMUT_KEEP_PICTURES")) {
    snprintf(command, sizeof command, "rm -rf %s", home);
    tap_ok(system(command) == 0, "the test's folder is removed");
  } else {
    printf("# pictures are in %s\n", home);
  }
  return tap_done();
}
