#include "base/error.h"

#include <pthread.h>
#include <stdlib.h>

#include "tests/tap.h"

static char *printed(struct trace *trace)
{
  char *text = NULL;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  trace_print(trace, stream);
  fclose(stream);
  return text;
}

static void check_print(const char *name, struct trace *trace, const char *expected)
{
  char *text = printed(trace);
  tap_text(name, text, expected);
  free(text);
}

static void test_form(void)
{
  struct trace *trace = trace_new();
  struct place place = {"inputs/flyer.yaml", 12, 5, 7, "    strengt: johnson_cook"};
  gamut_status status =
      trace_fail_at(trace, GAMUT_SCENE, &place, "materials.copper.strengt",
                    "did you mean 'strength'?", "unknown key '%s' in material 'copper'", "strengt");
  tap_ok(status == GAMUT_SCENE, "trace_fail_at hands the status back");
  check_print("the printed form with the caret line", trace,
              "inputs/flyer.yaml:12:5: error: unknown key 'strengt' in material 'copper'\n"
              "   12 |     strengt: johnson_cook\n"
              "      |     ^~~~~~~  did you mean 'strength'?\n"
              "(materials.copper.strengt)\n");
  check_print("what was printed is not printed again", trace, "");
  trace_fail(trace, GAMUT_OUTPUT, "cannot write '%s'", "out");
  trace_note(trace, "a note");
  place.source = NULL;
  trace_warn_at(trace, &place, NULL, "take less", "much");
  check_print("without a place, and a warning without its line", trace,
              "error: cannot write 'out'\nnote: a note\n"
              "inputs/flyer.yaml:12:5: warning: much\n  take less\n");
  tap_ok(trace_errors(trace) == 2 && trace_warnings(trace) == 1, "counts: %zu errors, %zu warnings",
         trace_errors(trace), trace_warnings(trace));
  tap_ok(trace_worst(trace) == GAMUT_SCENE, "the worst is the first error's status");
  trace_free(trace);
  trace_free(NULL);
}

static void test_repeats(void)
{
  struct trace *trace = trace_new();
  for (int k = 0; k < 10; k++)
    trace_fail(trace, GAMUT_SCENE, "the same");
  tap_ok(trace_errors(trace) == 1, "ten repeats count %zu (expected 1)", trace_errors(trace));
  for (int k = 0; k < 99; k++)
    trace_fail(trace, GAMUT_SCENE, "number %d", k);
  tap_ok(trace_errors(trace) == 100, "100 errors count %zu", trace_errors(trace));
  char *text = printed(trace);
  tap_ok(strstr(text, "number 48\n50 more errors not shown\n") != NULL, "50 are shown, 50 counted");
  free(text);
  check_print("the rest is told once", trace, "");
  trace_free(trace);
}

static void test_hostile_lines(void)
{
  struct trace *trace = trace_new();
  size_t length = 3000000;
  char *line = malloc(length + 1);
  memset(line, 'x', length);
  line[length] = '\0';
  struct place place = {"long.yaml", 1, 2000001, 900000, line};
  trace_fail_at(trace, GAMUT_SCENE, &place, NULL, NULL, "far right");
  memcpy(line + 2, "AB", 2);
  place = (struct place){"long.yaml", 1, 3, 2, line};
  trace_fail_at(trace, GAMUT_SCENE, &place, NULL, NULL, "far left");
  char *text = printed(trace);
  tap_ok(strlen(text) < 700, "a line of 3 MB prints %zu bytes (below 700)", strlen(text));
  tap_ok(strstr(text, "    1 | ...xxx") != NULL, "cut on the left");
  tap_ok(strstr(text, "    1 | xxABxxx") != NULL && strstr(text, "x...\n      |   ^~\n") != NULL,
         "cut on the right, caret below the letters");
  free(text);
  free(line);

  place = (struct place){"c\033[2J.yaml", 3, 8, 2, "\t\xC2\xB5: \x01\033[31mab\xFF\xE2\x80\xAE"};
  trace_fail_at(trace, GAMUT_SCENE, &place, "a\nb", "x\033", "text\033[0m\nerror: \xC2\x9Bother");
  check_print("control characters and bad bytes are shown harmless", trace,
              "c?[2J.yaml:3:8: error: text?[0m error: ?other\n"
              "    3 |  \xC2\xB5: ??[31mab??\n"
              "      |        ^~  x?\n"
              "(a b)\n");
  place = (struct place){"e.yaml", 1, 40, -3, "ab"};
  trace_fail_at(trace, GAMUT_SCENE, &place, NULL, NULL, "%s", "%s%n");
  check_print("a column behind the line; percent signs in the text", trace,
              "e.yaml:1:40: error: %s%n\n    1 | ab\n      |   ^\n");
  trace_free(trace);
  tap_ok(trace_fail(NULL, GAMUT_SCENE, "x") == GAMUT_SCENE, "a null trace throws the words away");
}

static void *fail_often(void *trace)
{
  for (int k = 0; k < 1000; k++)
    trace_fail(trace, GAMUT_NUMERICS, "step %d", k);
  return NULL;
}

static void test_threads(void)
{
  struct trace *trace = trace_new();
  pthread_t thread[4];
  for (int k = 0; k < 4; k++)
    pthread_create(&thread[k], NULL, fail_often, trace);
  for (int k = 0; k < 4; k++)
    pthread_join(thread[k], NULL);
  size_t errors = trace_errors(trace);
  tap_ok(errors >= 1000 && errors <= 4000, "four threads: %zu errors (1000 to 4000)", errors);
  trace_free(trace);
}

static void check_nearest(const char *word, const char *expected)
{
  static const char *const known[] = {"strength",  "eos",      "elasticity",
                                      "cell_size", "velocity", "x"};
  char name[200];
  snprintf(name, sizeof name, "nearest to '%.20s' is '%s'", word, expected ? expected : "none");
  tap_text(name, nearest(word, known, sizeof known / sizeof *known), expected);
}

static void test_nearest(void)
{
  check_nearest("strengt", "strength");
  check_nearest("strenhgt", "strength");
  check_nearest("Cell-Size", "cell_size");
  check_nearest("cellsize", "cell_size");
  check_nearest("oes", "eos");
  check_nearest("velocty", "velocity");
  check_nearest("pressure", NULL);
  check_nearest("y", NULL);
  check_nearest("", NULL);
  char *word = malloc(100001);
  memset(word, 'e', 100000);
  word[100000] = '\0';
  check_nearest(word, NULL);
  free(word);
  tap_text("no candidates", nearest("a", NULL, 0), NULL);
}

int main(void)
{
  test_form();
  test_repeats();
  test_hostile_lines();
  test_threads();
  test_nearest();
  tap_text("status text", status_text(GAMUT_USAGE), "wrong command line");
  tap_text("a status that is none", status_text((gamut_status)99), "unknown status");
  return tap_done();
}
