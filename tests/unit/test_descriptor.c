/* Descriptors: what is read, what is refused and where, layout, digest, generated header. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "catalogue/catalogue.h"
#include "descriptor/descriptor.h"
#include "tests/tap.h"

static struct units *units;
static char folder[] = "test_descriptor_XXXXXX";

static const char *write_file(const char *name, const char *text)
{
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "w");
  if (file) {
    fputs(text, file);
    fclose(file);
  }
  return path;
}

/* Reads a text as sample.yaml; the words of its faults in `words`. */
static struct descriptor *read_sample(const char *text, char *words, size_t size)
{
  struct descriptor *descriptor = NULL;
  struct trace *trace = trace_new();
  const char *path = write_file("sample.yaml", text);
  gamut_status status = descriptor_read(path, units, trace, &descriptor);
  FILE *file = tmpfile();
  trace_print(trace, file);
  rewind(file);
  words[fread(words, 1, size - 1, file)] = 0;
  fclose(file);
  unlink(path);
  if (status != GAMUT_OK && trace_worst(trace) != GAMUT_PLUGIN)
    snprintf(words, size, "blamed as %d", (int)trace_worst(trace));
  trace_free(trace);
  return descriptor;
}

#define EOS                                                                                        \
  "plugin: eos/sample\nversion: \"1\"\nsummary: a sample\n"                                        \
  "inputs: [compression, energy?]\noutputs: [pressure, sound_speed]\n"

/* Parameters `body` under an eos are refused, with these words and at this line and column. */
static void refused(const char *rest, const char *place, const char *expected)
{
  char text[4096], words[8192];
  snprintf(text, sizeof text, "%s%s", EOS, rest);
  struct descriptor *descriptor = read_sample(text, words, sizeof words);
  bool good = !descriptor && strstr(words, expected) && strstr(words, place);
  if (!tap_ok(good, "refused at %s: %s", place, expected))
    printf("# %s\n", words);
  descriptor_free(descriptor);
}

static void test_range(void)
{
  struct range closed = {true, 0, 0.5, true, false};
  char text[128];
  tap_text("range in words", range_text(&closed, "Pa", text, sizeof text),
           "greater than 0 and at most 0.5 Pa");
  tap_ok(!range_holds(&closed, 0) && range_holds(&closed, 0.5) && !range_holds(&closed, 0.51) &&
             range_holds(&closed, 1e-300),
         "open and closed ends hold what they say");
}

static const char whole[] =
    "plugin: elasticity/sample\nversion: \"1.0\"\nsummary: a sample\nsource: [one, two]\n"
    "parameters:\n"
    "  A: {symbol: A_0, unit: Pa, default: 90 MPa, fit: \"[10, 1000] MPa\", physical: \"(0, inf)\","
    " random: true, doc: strength}\n"
    "  mode: {type: choice, choices: [fast, exact], default: exact, doc: mode}\n"
    "  steps: {type: integer, default: 3, physical: \"[1, 10]\", doc: steps}\n"
    "  shift: {type: vector, unit: m, size: 1..3, default: [1 mm, 2 mm], doc: shift}\n"
    "  path: {type: table, columns: {time: s, strain: 1}, optional: true, doc: path}\n"
    "  start: {type: expression, unit: m/s, variables: [x, y], optional: true, doc: start}\n"
    "  set: {type: group, members: {pic: {unit: 1, default: 0.01, doc: share}}, doc: group}\n"
    "  B: {unit: Pa, optional: true, doc: other}\n"
    "constraints: [\"A > B\"]\n"
    "given: [{set: [A], then: {B: \"2 * A\"}}, {set: [B], then: {A: \"B / 2\"}}]\n"
    "inputs: [velocity_gradient, viscous_pressure?, burn: {unit: 1, components: 2}]\n"
    "outputs: [sound_speed]\n"
    "state:\n  stress: {}\n  damage: {unit: 1, initial: 0.5, doc: damage}\n"
    "scratch: 24\nlaws: [eos, strength?]\nprepare: true\n"
    "messages: {worn: {severity: note, text: worn}, gone: {severity: stop, text: gone}}\n"
    "variants: [{when: \"A == 0\", kernel: fluid, drops: [burn]}]\n"
    "measures: {mises: {unit: Pa, at: point, formula: \"abs(stress_xx) + damage\", doc: m}}\n";

static void test_values(const struct descriptor *d)
{
  const struct parameter *a = &d->parameter[0];
  tap_ok(d->parameters == 8 && d->kind == GAMUT_KIND_ELASTICITY, "eight parameters, kind");
  tap_text("name", d->name, "sample");
  tap_text("symbol", a->symbol, "A_0");
  tap_relative("range in its own unit, lower", a->fit.lower, 1e7, 1e-15);
  tap_relative("range in its own unit, upper", a->fit.upper, 1e9, 1e-15);
  tap_ok(a->physical.lower_open && a->physical.lower == 0 && isinf(a->physical.upper) && a->random,
         "physical range and random");
  tap_ok(d->parameter[3].size_min == 1 && d->parameter[3].size_max == 3, "size 1..3");
  tap_text("column's unit", d->parameter[4].choice_unit[0], "s");
  tap_text("member of a group", d->parameter[6].member[0].name, "pic");
  tap_ok(d->givens == 2 && d->given[1].derivations == 1, "two sets");
  tap_text("formula of a set", d->given[1].formula[0], "B / 2");
  tap_ok(d->input[1].optional && strcmp(d->input[1].name, "viscous_pressure") == 0,
         "optional input loses its mark");
  tap_ok(d->input[2].components == 2 && d->input[0].components == 9, "components of inputs");
  tap_ok(d->state[0].components == 6, "stress has its six components from the catalogue");
  tap_relative("initial value", d->state[1].initial, 0.5, 0);
  tap_ok(d->laws == 2 && d->law[1].optional, "laws");
  tap_ok(d->message[1].severity == GAMUT_STOP, "severity");
  tap_ok(descriptor_parameter(d, "B") == 7 && descriptor_parameter(d, "C") == -1,
         "parameters by name");
}

static void test_layout(const struct descriptor *d)
{
  struct slot *slots;
  size_t count = descriptor_layout(d, &slots);
  /* 4 numbers, 9 + 1 + 2 inputs, 1 output, 12 + 2 of state, 2 laws, data, 24 scratch */
  tap_ok(count == 4 + 12 + 1 + 14 + 2 + 1 + 24, "the block has %zu pointers, 58 expected", count);
  tap_ok(slots[2].kind == SLOT_PARAMETER && slots[2].index == 2 && slots[3].index == 7,
         "only numbers are seen by kernels");
  tap_ok(slots[4].component == 0 && slots[12].component == 8 && slots[12].components == 9,
         "components follow each other");
  tap_text("state at the beginning", slots[17].name, "stress_begin");
  tap_text("state at the end", slots[23].name, "stress");
  free(slots);
}

static void header_text(const struct descriptor *d, char *text, size_t size)
{
  FILE *file = tmpfile();
  descriptor_header(d, file);
  rewind(file);
  text[fread(text, 1, size - 1, file)] = 0;
  fclose(file);
}

#define MODE "parameters:\n  mode: {type: choice, choices: [fast, exact], default: fast, doc: d}\n"

static void test_kernel_header(void)
{
  char words[8192], text[16384];
  struct descriptor *d = read_sample(EOS MODE, words, sizeof words);
  if (!tap_ok(d != NULL, "an eos is read")) {
    printf("# %s\n", words);
    return;
  }
  header_text(d, text, sizeof text);
  tap_ok(strstr(text, "#include <gamut/kernel.h>\n") && strstr(text, "enum sample_mode {") &&
             !strstr(text, "<gamut/plugin.h>") && !strstr(text, "gamut_choice("),
         "the header of a law asks nothing of the core");
  descriptor_free(d);
}

/* That of an effect does, but for its kernels. */
static void test_effect_header(void)
{
  char words[8192], text[16384];
  struct descriptor *d =
      read_sample("plugin: effect/sample\nversion: \"1\"\nsummary: a sample\n"
                  "outputs: [flow_stress_factor]\n" MODE
                  "tasks: [{kernel: k, phase: a, scales: [flow_stress_factor]}]\n",
                  words, sizeof words);
  if (!tap_ok(d != NULL, "an effect is read")) {
    printf("# %s\n", words);
    return;
  }
  header_text(d, text, sizeof text);
  tap_ok(strstr(text, "#ifdef GAMUT_KERNEL\n#include <gamut/kernel.h>\n#else\n"
                      "#include <gamut/plugin.h>\n#endif\n") != NULL,
         "its kernels see no more than kernels do");
  tap_ok(strstr(text,
                "#ifndef GAMUT_KERNEL\nstatic inline enum sample_mode\nsample_mode_of(const "
                "struct gamut_values *values)\n{\n"
                "  return (enum sample_mode)gamut_choice(values, \"mode\");\n}\n#endif\n") != NULL,
         "the rest may ask for its choice");
  descriptor_free(d);
}

static void test_header(const struct descriptor *d)
{
  static const char *const lines[] = {
      "#ifndef SAMPLE_GAMUT_H\n",
      "#define SAMPLE_SCRATCH 24\n",
      "enum sample_mode {\n  SAMPLE_MODE_FAST,\n  SAMPLE_MODE_EXACT\n};\n",
      "#include <gamut/kernel.h>\n",
      "#define SAMPLE_GONE GAMUT_MESSAGE(GAMUT_STOP, 1)\n",
      "  const double *A; ",
      "  const double *velocity_gradient[9]; ",
      "  const double *stress_begin[6]; ",
      "  double *stress[6]; ",
      "  const struct gamut_strength_law *strength; /* null if absent */\n",
      "/* Pa: strength */\n",
      "  double *scratch[24]; ",
      "struct sample_data; ",
      "  const struct sample_data *data; ",
      "  GAMUT_ELASTICITY_OPS(struct sample)\n  gamut_status (*prepare)(",
      "struct sample_data **);\n  void (*release)(struct sample_data *);\n",
      "  void (*fluid)(const struct sample *);",
  };
  char text[16384];
  header_text(d, text, sizeof text);
  for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++)
    tap_ok(strstr(text, lines[i]) != NULL, "header holds: %.60s", lines[i]);
  tap_ok(strstr(text, d->digest) != NULL, "header holds the digest");
}

static void test_whole(void)
{
  char words[8192], digest[24];
  struct descriptor *d = read_sample(whole, words, sizeof words);
  if (!tap_ok(d != NULL, "a whole descriptor is read")) {
    printf("# %s\n", words);
    return;
  }
  test_values(d);
  test_layout(d);
  test_kernel_header();
  test_effect_header();
  test_header(d);
  FILE *file = tmpfile();
  descriptor_show(d, file);
  descriptor_show_json(d, file);
  tap_ok(ftell(file) > 4000, "shown as text and JSON");
  fclose(file);
  memcpy(digest, d->digest, sizeof digest);
  descriptor_free(d);

  char other[sizeof whole + 64];
  memcpy(other, whole, sizeof whole);
  memcpy(strstr(other, "doc: strength"), "doc: weakness", 13);
  memcpy(strstr(other, "default: 90"), "default: 80", 11);
  d = read_sample(other, words, sizeof words);
  tap_text("prose and defaults leave the digest", d ? d->digest : NULL, digest);
  descriptor_free(d);
  memcpy(strstr(other, "unit: m, size"), "unit: s, size", 13);
  memcpy(strstr(other, "[1 mm, 2 mm]"), "[1 ms, 2 ms]", 12);
  d = read_sample(other, words, sizeof words);
  tap_text("what no kernel sees leaves the digest", d ? d->digest : NULL, digest);
  descriptor_free(d);
  memcpy(strstr(other, "[fast, exact]"), "[exact, fast]", 13);
  d = read_sample(other, words, sizeof words);
  tap_ok(d && strcmp(d->digest, digest) != 0, "the order of choices is in the digest");
  descriptor_free(d);
}

static void test_derivatives(void)
{
  char words[4096];
  struct slot *slots;
  struct descriptor *d = read_sample(
      EOS "parameters:\n  C0: {unit: m/s, random: true, doc: c}\n  S: {unit: 1, doc: s}\n"
          "derivatives: {of: pressure, by: [C0, S]}\n",
      words, sizeof words);
  if (!tap_ok(d != NULL, "an eos with derivatives is read")) {
    printf("# %s\n", words);
    return;
  }
  size_t count = descriptor_layout(d, &slots);
  tap_ok(count == 2 + 4 + 2 + 3, "first and second derivatives have slots");
  tap_text("first derivative", slots[6].name, "pressure_by_C0");
  tap_text("its unit", slots[6].unit, "Pa/(m/s)");
  tap_text("mixed derivative", slots[9].name, "pressure_by_C0_S");
  tap_text("unit of the second", slots[8].unit, "Pa/(m/s)/(m/s)");
  free(slots);
  descriptor_free(d);
}

static void test_refused(void)
{
  refused("parametrs: {}\n", ":6:1:", "did you mean 'parameters'?");
  refused("parameters: {A: {unti: Pa, unit: Pa, doc: a}}\n", ":6:18:", "did you mean 'unit'?");
  refused("parameters:\n  A: {doc: a}\n", ":7:3:", "'unit' is missing");
  refused("parameters: {A: {unit_of: B, doc: a}}\n", ":6:27:", "only an argument of a measure");
  refused("parameters:\n  A: {unit: Pa}\n", ":7:3:", "'doc' is missing");
  refused("parameters: {A: {unit: Paa, doc: a}}\n", ":6:24:", "'Paa' is no unit");
  refused("parameters: {A: {unit: Pa, default: 3 m, doc: a}}\n", ":6:37:", "is no quantity in Pa");
  refused("parameters: {A: {unit: Pa, default: -3 Pa, physical: \"(0, inf)\", doc: a}}\n",
          ":6:37:", "outside its physical range");
  refused("parameters: {A: {unit: Pa, default: 3 Pa, fit: \"[4, 5]\", doc: a}}\n",
          ":6:37:", "outside the range of its fit");
  refused("parameters: {A: {unit: Pa, fit: \"4 to 5\", doc: a}}\n",
          ":6:33:", "cannot read the range");
  refused("parameters: {A: {unit: Pa, fit: \"[5, 4]\", doc: a}}\n", ":6:33:", "range is empty");
  refused("parameters: {A: {unit: Pa, fit: \"[4, 5] m\", doc: a}}\n", ":6:33:", "dimension");
  refused("parameters: {A: {unit: Pa, fit: \"[-1, 5]\", physical: \"(0, inf)\", doc: a}}\n",
          ":6:33:", "beyond its physical range");
  refused("parameters: {A: {type: choise, doc: a, unit: 1}}\n", ":6:24:", "did you mean 'choice'?");
  refused("parameters: {A: {type: choice, choices: [a, b], default: c, doc: a}}\n",
          ":6:58:", "none of its choices");
  refused("parameters: {A: {type: boolean, unit: Pa, doc: a}}\n", ":6:33:", "no meaning");
  refused("parameters: {double: {unit: Pa, doc: a}}\n", ":6:14:", "has a meaning in C");
  refused("parameters: {pressure: {unit: Pa, doc: a}}\n", ":5:", "declared twice");
  refused("parameters: {a-b: {unit: Pa, doc: a}}\n", ":6:14:", "cannot be a name");
  refused("constraints: [\"A > \"]\nparameters: {A: {unit: Pa, doc: a}}\n",
          ":6:15:", "cannot read");
  refused("constraints: [\"A > B\"]\nparameters: {A: {unit: Pa, doc: a}}\n", ":6:15:", "B");
  refused("constraints: [\"A + 1\"]\nparameters: {A: {unit: Pa, doc: a}}\n",
          ":6:15:", "compares nothing");
  refused("variants: [{when: \"1 > 0\", kernel: pressure}]\n", ":6:36:", "is there already");
  refused("variants: [{when: \"1 > 0\", kernel: k}, {when: \"1 > 0\", kernel: k}]\n",
          ":6:64:", "is there already");
  refused("derivatives: {of: pressure, by: [A]}\n", ":6:34:", "neither a real parameter");
  refused("messages: {m: {severity: halt, text: t}}\n", ":6:26:", "unknown severity");
  refused("phases: [one]\n", ":6:1:", "no meaning for plugins of kind eos");
  refused("parameters: {A: {unit: 1, doc: a}, B: {unit: 1, doc: b}}\n"
          "given: [{set: [A], then: {B: A}}, {set: [B, D]}]\n",
          ":7:45:", "no parameter");
  refused("requires: [a, a]\n", ":6:15:", "stands twice");
}

/* An effect with these parameters, and what may follow them. */
#define HOLDS(parameters)                                                                          \
  "plugin: effect/sample\nversion: 1\nsummary: s\nparameters:\n  " parameters "\n"

/* An eos with these parameters, and what may follow the rest. */
#define LAW_HOLDS(parameters, more)                                                                \
  "plugin: eos/sample\nversion: 1\nsummary: s\nparameters:\n  " parameters "\n"                    \
  "inputs: [compression]\noutputs: [pressure, sound_speed]\n" more

static void test_identity(void)
{
  static const struct {
    const char *text, *words;
  } wrong[] = {
      {"version: 1\n", "'plugin' is missing"},
      {"plugin: eos\n", "names no kind"},
      {"plugin: eso/sample\n", "did you mean 'eos'?"},
      {"plugin: eos/other\nversion: 1\nsummary: s\noutputs: [pressure, sound_speed]\n",
       "stands in a file called 'sample.yaml'"},
      {"plugin: eos/sample\nsummary: s\noutputs: [pressure, sound_speed]\n",
       "'version' is missing"},
      {"plugin: eos/sample\nversion: 1\nsummary: s\noutputs: [pressure]\n", "writes 'sound_speed'"},
      {"plugin: eos/sample\nversion: 1\nsummary: s\noutputs: [pressur, sound_speed]\n",
       "did you mean 'pressure'?"},
      {"plugin: eos/sample\nversion: 1\nsummary: s\ninputs: [energy]\n"
       "outputs: [pressure, sound_speed, energy]\n",
       "belongs under 'state'"},
      {"[1, 2]\n", "no plugin's YAML"},
      {LAW_HOLDS("a: {type: table, columns: {x: 1}, doc: d}", ""),
       "kernels see no value of type table, and nothing prepares 'a' for them"},
      {LAW_HOLDS("a: {unit: 1, prepared: true, doc: d}", ""), "no `prepare` reads 'a'"},
      {LAW_HOLDS("a: {type: file, prepared: true, doc: d}", "prepare: true\n"),
       "'prepared' has no meaning for a parameter of type file"},
      {LAW_HOLDS("a: {unit: 1, prepared: true, doc: d}",
                 "prepare: true\nderivatives: {of: pressure, by: [a]}\n"),
       "'a' is neither a real parameter that kernels see nor an input"},
      {LAW_HOLDS("data: {unit: 1, doc: d}", "prepare: true\n"), "'data' is declared twice"},
      {HOLDS("a: {unit: 1, doc: d}\nprepare: true"), "has no kernels that could carry"},
      {LAW_HOLDS("a: {type: table, columns: {x: 1}, size: 0, doc: d}", "prepare: true\n"),
       "'0' is no size of a table"},
      {HOLDS("a: {type: list, doc: d}"), "nothing says what an entry of 'a' is"},
      {HOLDS("a: {type: map, of: {unit: 1, default: 2}, doc: d}"),
       "'default' has no meaning for an entry"},
      {HOLDS("a: {type: list, size: 3..2, of: {unit: 1}, doc: d}"), "no size of a list"},
      {HOLDS("a: {type: entry, of: b, doc: d}"), "only an argument of a measure names an entry"},
      {HOLDS("a: {type: one of, doc: d, forms: {b: {unit: 1, doc: d}}}"), "'a' has no forms"},
      {HOLDS("a: {type: one of, doc: d, forms: {b: {unit: 1, doc: d}, c: {type: text, doc: d}}}"),
       "the form 'c' of 'a' cannot be told from another one"},
      {HOLDS("a: {type: group, doc: d, one_of: [b], members: {b: {unit: 1, doc: d}}}"),
       "no list of alternatives"},
      {HOLDS("a: {type: group, doc: d, one_of: [b, c], members: {b: {unit: 1, doc: d}}}"),
       "'one_of' names 'c', which is not declared here"},
      {HOLDS("b: {unit: 1, doc: d}\n  c: {unit: 1, default: 2, doc: d}\none_of: [b, c]"),
       "'c' has a default"},
      {HOLDS("b: {unit: 1, doc: d}\n  c: {unit: 1, doc: d}\none_of: [[b, c], b]"),
       "'b' stands in two alternatives"},
      {HOLDS("b: {unit: 1, doc: d}\n  c: {unit: 1, optional: true, doc: d}\none_of: [b, c]"),
       "some of the alternatives must be given and some need not"},
      {HOLDS("b: {unit: 1, doc: d}\nmeasures:\n  m: {unit: 1, at: run, doc: d,"
             " arguments: {e: {type: entry, of: b}}}"),
       "'b' is no map of this plugin"},
  };
  char words[8192];
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    struct descriptor *d = read_sample(wrong[i].text, words, sizeof words);
    if (!tap_ok(!d && strstr(words, wrong[i].words), "refused: %s", wrong[i].words))
      printf("# %s\n", words);
    descriptor_free(d);
  }
}

static void refused_whole(const char *head, const char *rest, const char *expected)
{
  char text[4096], words[8192];
  snprintf(text, sizeof text, "%sversion: \"1\"\nsummary: a sample\n%s", head, rest);
  struct descriptor *descriptor = read_sample(text, words, sizeof words);
  if (!tap_ok(!descriptor && strstr(words, expected), "refused: %s", expected))
    printf("# %s\n", words);
  descriptor_free(descriptor);
}

static void refused_eos(const char *rest, const char *expected)
{
  refused_whole("plugin: eos/sample\noutputs: [pressure, sound_speed]\n", rest, expected);
}

static void refused_effect(const char *rest, const char *expected)
{
  refused_whole("plugin: effect/sample\n", rest, expected);
}

/* What optional inputs read where nobody gives them, and who may change what several may. */
static void test_absent(void)
{
  char words[8192];
  struct descriptor *d = read_sample(
      "plugin: eos/sample\nversion: \"1\"\nsummary: a sample\noutputs: [pressure, sound_speed]\n"
      "inputs: [compression, energy?, burn?: {unit: 1, absent: 1},"
      " wear?: {unit: Pa, absent: 2 MPa},"
      " limit?: {unit: Pa, absent: inf}, flow_stress_factor?, opening_tension?]\n",
      words, sizeof words);
  const double due[] = {0.0, 0.0, 1.0, 2e6, HUGE_VAL, 1.0, HUGE_VAL};
  tap_ok(d && d->inputs == 7, "seven inputs%s%s", d ? "" : ": ", d ? "" : words);
  for (size_t i = 0; d && i < d->inputs; i++)
    tap_ok(d->input[i].absent == due[i], "%s is %g where absent", d->input[i].name,
           d->input[i].absent);
  descriptor_free(d);
  refused_eos("inputs: [burn: {unit: 1, absent: 1}]\n", "is never absent");
  refused_eos("inputs: [burn?: {unit: Pa, absent: 1 m}]\n", "'1 m' is no quantity in Pa");
  refused_eos("inputs: [time_step?: {absent: 1}]\n", "has a value in every scene");
  refused_effect("outputs: [flow_stress_factor]\n"
                 "tasks: [{kernel: k, phase: a, writes: [flow_stress_factor]}]\n",
                 "scales: [flow_stress_factor]");
  refused_effect("outputs: [opening_tension]\n"
                 "tasks: [{kernel: k, phase: a, scales: [opening_tension]}]\n",
                 "lowers: [opening_tension]");
  refused_effect("state: {wear: {unit: 1, doc: a}}\n"
                 "tasks: [{kernel: k, phase: a, scales: [wear]}]\n",
                 "is a state of this plugin");
  refused_effect("tasks: [{kernel: k, phase: a, reads: []}]\n", "this task changes nothing");
}

int main(void)
{
  char why[256];
  units = units_new(why, sizeof why);
  if (!units || !mkdtemp(folder))
    return 99;
  tap_text("component of a symmetric tensor", component_name(6, 5), "zx");
  tap_text("component of a full tensor", component_name(9, 3), "yx");
  tap_ok(catalogue_find("stress") && !catalogue_find("stres"), "catalogue by name");
  test_range();
  test_whole();
  test_derivatives();
  test_refused();
  test_identity();
  test_absent();
  rmdir(folder);
  units_free(units);
  return tap_done();
}
