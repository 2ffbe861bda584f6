/* Scenes: values, what is refused and how it is said, includes, overrides, shapes, quantities.
 * The plugins are those of scene_plugins/: nothing is opened. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <jansson.h>

#include "tests/tap.h"
#include "scene/scene.h"

static struct units *units;
static struct registry *registry;
static char folder[] = "/tmp/gamut_scene_XXXXXX";

#define HEAD                                                                                       \
  "gamut: 1\n"                                                                                     \
  "solver: {model: grid, geometry: axisymmetric, cell: 0.5 mm, end: 10 us}\n"
#define METAL                                                                                      \
  "materials:\n"                                                                                   \
  "  copper:\n"                                                                                    \
  "    density: 8960 kg/m3\n"                                                                      \
  "    eos: {model: spring, bulk_modulus: 140 GPa}\n"                                              \
  "    strength: {model: metal, A: 90 MPa, T_melt: 1356 K}\n"                                      \
  "    elasticity: {model: hypoelastic, youngs_modulus: 124 GPa, poissons_ratio: 0.34}\n"
#define BAR                                                                                        \
  "bodies:\n"                                                                                      \
  "  bar: {material: copper, shape: {cylinder: {radius: 4 mm, length: 25 mm}},\n"                  \
  "        velocity: [0 m/s, -190 m/s]}\n"
#define GOOD HEAD METAL BAR

static void write_file(const char *name, const char *text)
{
  FILE *file = fopen(name, "w");
  fputs(text, file);
  fclose(file);
}

static char *told(struct trace *trace)
{
  static char words[65536];
  FILE *file = tmpfile();
  trace_print(trace, file);
  rewind(file);
  words[fread(words, 1, sizeof words - 1, file)] = 0;
  fclose(file);
  return words;
}

static struct scene *read_with(const char *text, const struct scene_override *set, size_t sets,
                               char **words, gamut_status *status)
{
  struct scene *scene;
  struct trace *trace = trace_new();
  write_file("scene.yaml", text);
  *status = scene_read("scene.yaml", set, sets, registry, units, trace, &scene);
  *words = told(trace);
  trace_free(trace);
  return scene;
}

/* A scene that must read without a word; null if not. */
static struct scene *good(const char *what, const char *text)
{
  char *words;
  gamut_status status;
  struct scene *scene = read_with(text, NULL, 0, &words, &status);
  if (!tap_ok(scene && words[0] == 0, "%s is read in silence", what))
    tap_print_text("said:", words);
  return scene;
}

/* A scene that must be refused with these words somewhere in the message. */
static void bad(const char *text, const char *place, const char *words, const char *help)
{
  char *said;
  gamut_status status;
  struct scene *scene = read_with(text, NULL, 0, &said, &status);
  bool found = status == GAMUT_SCENE && !scene && strstr(said, place) && strstr(said, words) &&
               strstr(said, help);
  if (!tap_ok(found, "refused: %s", words)) {
    tap_print_text("said:", said);
    tap_print_text("wanted:", place);
    tap_print_text("and:", words);
    tap_print_text("and:", help);
  }
  scene_free(scene);
}

static double real(const struct values *values, const char *path)
{
  const struct value *value = values_find(values, path);
  return value && value->present ? value->real : NAN;
}

static void test_good(void)
{
  struct scene *scene = good("a whole scene", GOOD);
  if (!scene)
    return;
  const struct material *copper = &scene->material[0];
  tap_relative("density", copper->density, 8960, 0);
  tap_relative("cell in metres", real(scene->solver.values, "cell"), 0.5e-3, 1e-15);
  tap_relative("default in a group", real(scene->solver.values, "transfer.pic"), 0.01, 0);
  tap_relative("derived shear modulus", real(copper->elasticity.values, "shear_modulus"),
               124e9 / 2.68, 1e-15);
  tap_ok(!values_find(copper->elasticity.values, "shear_modulus")->given, "derived is not given");
  tap_relative("default temperature", scene->body[0].temperature, 298, 0);
  tap_relative("velocity", scene->body[0].velocity[1], -190, 0);
  tap_relative("body parameter", real(scene->body[0].solver_values, "points_per_cell"), 4, 0);
  double lower[3], upper[3];
  shape_bounds(&scene->body[0].shape, lower, upper);
  tap_relative("length", upper[1] - lower[1], 25e-3, 1e-15);
  tap_ok(shape_contains(&scene->body[0].shape, (double[]){4e-3, 0, 0}), "a shape is closed");
  tap_ok(!shape_contains(&scene->body[0].shape, (double[]){4.1e-3, 0, 0}), "and ends somewhere");
  tap_ok(!scene->random, "nothing is random");
  scene_free(scene);
}

static void test_keys(void)
{
  bad("gamut: 1\nsolvr: {}\n", "scene.yaml:2:1: error", "unknown key 'solvr'",
      "did you mean 'solver'?");
  bad("gamut: 1\nsolver: {model: grid, geometry: 3d, cel: 1 mm, end: 1 s}\n", "(solver.cel)",
      "unknown key 'cel' in solver 'grid'", "did you mean 'cell'?");
  bad(HEAD METAL "    A: 90 MPa\n" BAR, "(materials.copper.A)",
      "unknown key 'A' in material 'copper'", "'A' belongs under 'strength:'");
  bad(HEAD "materials: {m: {density: 1 kg/m3, eos: {model: spring, bulk_modulus: 1 GPa, "
           "density: 2 kg/m3}}}\n" BAR,
      "(materials.m.eos.density)", "unknown key 'density' in eos 'spring'",
      "'density' belongs one level up, to the material");
  bad(HEAD METAL BAR
      "  bar2: {material: coper, shape: {sphere: {radius: 1 mm, center: [0 m, 1 m]}}}"
      "\n",
      "(bodies.bar2.shape.sphere.center)", "unknown key 'center' in a sphere",
      "did you mean 'centre'?");
  bad(GOOD "effects: {w: {model: floor, plan: {}}}\n", "(effects.w.plan)", "unknown key 'plan'",
      "did you mean 'plane'?");
  bad(GOOD "effects: {w: {model: floor, point: [0 m, 0 m]}}\n", "(effects.w.point)",
      "unknown key 'point'", "'point' belongs under 'plane:'");
  bad(GOOD "quantities: {q: {mesure: extent}}\n", "(quantities.q.mesure)", "unknown key 'mesure'",
      "did you mean 'measure'?");
  bad(GOOD "outputs: {evry: 1 us}\n", "(outputs.evry)", "unknown key 'evry'",
      "did you mean 'every'?");
  bad(GOOD "effects: {w: {model: floor}}\n", "(effects.w.plane)",
      "'plane' is missing in effect 'floor'", "keys point, normal");
  bad("gamut: 1\n", "error", "'solver' is missing", "solver: {model: NAME, ...}");
  scene_free(good("a card", "gamut: 1\n" METAL));
  bad(HEAD METAL "bodies: {b: {material: copper}}\n", "(bodies.b.shape)", "'shape' is missing",
      "cylinder");
}

static void test_values(void)
{
#define MATERIAL(text) HEAD "materials: {copper: {" text "}}\n" BAR
#define EOS "eos: {model: spring, bulk_modulus: 140 GPa}"
  bad(MATERIAL("density: 8960, " EOS), "scene.yaml:3:31", "density: '8960' has no unit",
      "'8960 kg/m3'");
  bad(MATERIAL("density: 5 m, " EOS), "(materials.copper.density)",
      "'5 m' has a unit of another dimension", "kg/m3");
  bad(MATERIAL("density: -5 kg/m3, " EOS), "density", "density = -5 kg/m3 is not possible",
      "greater than 0 kg/m3");
  bad(MATERIAL("density: 39ab, " EOS), "density", "'39ab' is no number", "such as");
  bad(MATERIAL("density: .nan, " EOS), "density", "'.nan' is no", "kg/m3");
  bad(MATERIAL("density: nan kg/m3, " EOS), "density", "'nan kg/m3' is no finite number", "kg/m3");
  bad(MATERIAL("density: [1 kg/m3], " EOS), "density",
      "'density' is a vector where a number is due", "8960 kg/m3");
  bad(MATERIAL(EOS), "(materials.copper.density)", "'density' is missing in material 'copper'",
      "kg/m3");
  bad(MATERIAL("density: 1 kg/m3, eos: {model: spring}"), "(materials.copper.eos.bulk_modulus)",
      "'bulk_modulus' is missing in eos 'spring'", "stiffness");
  bad(MATERIAL("density: 1 kg/m3, eos: {model: sprong, bulk_modulus: 1 Pa}"),
      "(materials.copper.eos.model)", "sprong", "spring");
  bad(MATERIAL("density: 1 kg/m3, eos: {model: metal, A: 1 Pa}"), "(materials.copper.eos.model)",
      "metal", "strength");
  bad(MATERIAL("density: 1 kg/m3, " EOS ", strength: {model: metal, A: 1 MPa, T_melt: 200 K}"),
      "materials.copper.strength.T_", "T_room = 298 K, T_melt = 200 K is not possible",
      "T_melt > T_room");
  bad(MATERIAL("density: 1 kg/m3, " EOS ", elasticity: {model: hypoelastic, poissons_ratio: 0.3}"),
      "elasticity", "poissons_ratio alone is no set that it knows",
      "[shear_modulus] or [youngs_modulus, poissons_ratio]");
  bad(MATERIAL("density: 1 kg/m3, " EOS ", elasticity: {model: hypoelastic, poissons_ratio: 0.55, "
               "youngs_modulus: 1 GPa}"),
      "(materials.copper.elasticity.poissons_ratio)", "poissons_ratio = 0.55 is not possible",
      "less than 0.5");
  bad(MATERIAL("density: 1 kg/m3"), "(materials.copper.eos)",
      "'eos' is missing in material 'copper'", "");
  bad(HEAD METAL
      "bodies: {b: {material: copper, shape: {sphere: {radius: 4 mm}}, velocity: 1 m/s}}",
      "(bodies.b.velocity)", "'velocity' is a number where a vector is due", "[0 m/s, -100 m/s]");
  bad(HEAD METAL "bodies: {b: {material: coper, shape: {sphere: {radius: 4 mm}}}}",
      "(bodies.b.material)", "unknown material 'coper'", "did you mean 'copper'?");
}

static void test_together(void)
{
  char *words;
  gamut_status status;
  const char *text =
      "gamut: 1\nsolver: {model: grid, cel: 1 mm, end: 5}\nmaterials: {m: {densty: 1}}"
      "\nbodies: {b: {material: n}}\nquantities: {q: {}}\n";
  struct scene *scene = read_with(text, NULL, 0, &words, &status);
  size_t errors = 0;
  for (const char *at = words; (at = strstr(at, "error:")); at++)
    errors++;
  tap_ok(!scene && errors >= 7, "all errors are collected: %zu, at least 7", errors);
}

static void test_bodies(void)
{
#define TWO(one, two)                                                                              \
  HEAD METAL "bodies:\n  one: {material: copper, shape: " one                                      \
             "}\n  two: {material: copper, shape: " two "}\n"
  bad(TWO("{cylinder: {radius: 4 mm, length: 10 mm}}",
          "{cylinder: {radius: 4 mm, length: 10 mm, base: [0 mm, 9 mm]}}"),
      "(bodies.two.shape)", "bodies 'one' and 'two' overlap", "may touch");
  scene_free(good("touching cylinders",
                  TWO("{cylinder: {radius: 4 mm, length: 10 mm}}",
                      "{cylinder: {radius: 4 mm, length: 10 mm, base: [0 mm, 10 mm]}}")));
  scene_free(
      good("a sphere on a cylinder", TWO("{cylinder: {radius: 4 mm, length: 10 mm}}",
                                         "{sphere: {radius: 3 mm, centre: [0 mm, 13 mm]}}")));
  bad(TWO("{box: {min: [0 mm, 0 mm], max: [1 mm, 1 mm]}}",
          "{box: {size: [1 mm, 1 mm], centre: [1 mm, 1.4 mm]}}"),
      "(bodies.two.shape)", "overlap", "");
  bad("gamut: 1\nsolver: {model: grid, geometry: axisymmetric, cell: 5 mm, end: 1 us}\n" METAL BAR,
      "(solver.cell)", "cell = 0.005 m is larger than body 'bar', which has 0.004 m along x",
      "at most 0.004 m");
  bad("gamut: 1\nsolver: {model: grid, geometry: axisymmetric, cell: 1 mm, end: 1 us, domain: "
      "{min: "
      "[0 mm, 0 mm], max: [9 mm, 20 mm]}}\n" METAL BAR,
      "(bodies.bar.shape)", "body 'bar' is outside the domain", "y = 0 m to 0.02 m");
  bad(HEAD METAL "bodies: {b: {material: copper, shape: {cylinder: {radius: 4 mm, length: 1 mm, "
                 "axis: x}}}}",
      "(bodies.b.shape.cylinder.axis)", "turns about y", "axis: y");
  struct scene *scene = good("a velocity by arithmetic",
                             HEAD METAL "bodies: {b: {material: copper, shape: {sphere: {radius: "
                                        "4 mm}}, velocity: [\"100 * x\", 3 m/s]}}");
  if (scene) {
    double x[3] = {2, 0, 0};
    tap_relative("velocity at x", expression_value(scene->body[0].velocity_expression[0], x), 200,
                 0);
    tap_ok(!scene->body[0].velocity_expression[1], "the other component is uniform");
  }
  scene_free(scene);
}

static void table(const char *text, size_t numbers, double last)
{
  char whole[4096], name[128];
  snprintf(whole, sizeof whole,
           "gamut: 1\nsolver: {model: grid, geometry: axisymmetric, cell: 1 mm, end: 1 s, load: "
           "%s}\n%s%s",
           text, METAL, BAR);
  snprintf(name, sizeof name, "a table %s", text);
  struct scene *scene = good(name, whole);
  const struct value *load = scene ? values_find(scene->solver.values, "load") : NULL;
  if (load && tap_ok(load->numbers == numbers, "%zu numbers", load->numbers))
    tap_relative("the last", load->number[numbers - 1], last, 1e-15);
  scene_free(scene);
}

static void test_tables(void)
{
  write_file("load.csv", "# measured\npressure [MPa], other, time [us]\n1, x, 0\n\n2, y, 3\n");
  write_file("odd.csv", "time, pressure\n0, 1\n1, two\n");
  table("[[0 s, 1 MPa], [1 us, 3 MPa]]", 4, 3e6);
  table("{file: load.csv}", 4, 2e6);
  table("5 MPa", 2, 5e6);
#define LOAD(text)                                                                                 \
  "gamut: 1\nsolver: {model: grid, geometry: 3d, cell: 1 mm, end: 1 s, load: " text "}\n"
  bad(LOAD("{file: odd.csv}"), "(solver.load.file)", "odd.csv:3:4: error: 'two' is no value",
      "SI");
  bad(LOAD("{file: none.csv}"), "(solver.load.file)", "table file 'none.csv': cannot open", "");
  bad(LOAD("[[0 s]]"), "(solver.load.0)", "row 1 of the table 'load' has not 2 columns",
      "[time, pressure]");
  bad(LOAD("[]"), "(solver.load)", "'load' is an empty list where a table is due", "rows");
}

static void test_effects(void)
{
  bad(GOOD "effects: {b: {model: beam}}\n", "(effects.b)",
      "effect 'b' needs 'laser', which neither solver 'grid' nor another effect provides", "");
  scene_free(good("an effect that is off", GOOD "effects: {b: {model: beam, enabled: off}}\n"));
  scene_free(good("an effect by its name", GOOD "effects: {b: {model: beam, enabled: no}}\n"));
  bad(GOOD "effects: {h: heat}\n", "(materials.copper.specific_heat)",
      "'specific_heat' is missing in material 'copper': effect 'h' needs it", "heat capacity");
  bad(GOOD "effects: {h: {model: heat, bodies: [bra]}}\n", "(effects.h.bodies.0)",
      "unknown body 'bra'", "did you mean 'bar'?");
  struct scene *scene =
      good("an effect on no body", HEAD METAL "  other: {density: 1 kg/m3, eos: {model: spring, "
                                              "bulk_modulus: 1 GPa}}\n" BAR
                                              "effects: {h: {model: heat, materials: other}}\n");
  if (scene)
    tap_ok(!scene->effect[0].on_body[0], "materials: selects the bodies");
  scene_free(scene);
}

static void test_quantities(void)
{
#define WALL "effects: {w: {model: floor, plane: {point: [0 m, 0 m], normal: [0, 1]}}}\n"
#define QUANTITY(text) GOOD WALL "quantities: {q: {" text "}}\n"
  struct scene *scene = good("quantities", QUANTITY("measure: extent, axis: y, reduce: at end"));
  if (scene) {
    const struct quantity *q = &scene->quantity[0];
    tap_ok(q->body == 0 && q->reduction.kind == REDUCE_AT && q->reduction.at_end,
           "the only body, at the end");
    tap_text("argument", values_find(q->arguments, "axis")->text, "y");
  }
  scene_free(scene);
  scene = good("a measure of an effect", QUANTITY("measure: force, reduce: {mean: [1 us, 2 us]}"));
  if (scene) {
    tap_text("its effect", scene->quantity[0].effect, "w");
    tap_relative("window", scene->quantity[0].reduction.to, 2e-6, 1e-15);
  }
  scene_free(scene);
  scene = good("a plain field", QUANTITY("measure: velocity_y, at: {point: [0 mm, 1 mm], follow: "
                                         "space}, every: 1 us, reduce: {time_of: -3 m/s}"));
  if (scene) {
    tap_text("its field", scene->quantity[0].field, "velocity_y");
    tap_text("its unit", scene->quantity[0].measure->unit, "m/s");
    tap_relative("its level", scene->quantity[0].reduction.level, -3, 0);
  }
  scene_free(scene);
  bad(QUANTITY("measure: extend, axis: y"), "(quantities.q.measure)", "unknown measure 'extend'",
      "did you mean 'extent'?");
  bad(QUANTITY("measure: pressure"), "(quantities.q)", "'at' is missing", "point: [..]");
  bad(QUANTITY("measure: extent, axis: w"), "(quantities.q.axis)", "unknown choice 'w'", "x, y, z");
  bad(QUANTITY("measure: force, reduce: at last"), "(quantities.q.reduce)",
      "unknown reduction 'at last'", "at end");
  bad(GOOD "outputs: {every: 1 us, fields: [velocity, presure]}\n", "(outputs.fields.1)",
      "unknown field 'presure'", "did you mean 'pressure'?");
}

static void test_random(void)
{
#define RANDOM(text)                                                                               \
  HEAD "materials: {copper: {density: 1 kg/m3, eos: {model: spring, bulk_modulus: " text "}}}"     \
       "\n" BAR
  struct scene *scene = good("a random parameter", RANDOM("{mean: 100 GPa, cv: 0.1}"));
  if (scene) {
    const struct value *k = values_find(scene->material[0].eos.values, "bulk_modulus");
    tap_ok(scene->random && k->random, "is random");
    tap_relative("its mean", k->real, 100e9, 1e-15);
    tap_relative("its deviation", k->random->deviation, 10e9, 1e-15);
  }
  scene_free(scene);
  bad(RANDOM("{mean: 100 GPa}"), "bulk_modulus",
      "the spread of the random 'bulk_modulus' is missing", "cv");
  bad(RANDOM("{mean: 100 GPa, cv: 0.1, distribution: normel}"), "distribution",
      "unknown distribution 'normel'", "did you mean 'normal'?");
  char *words;
  gamut_status status;
  scene = read_with(RANDOM("{mean: 100 GPa, cv: 0.4}"), NULL, 0, &words, &status);
  tap_ok(scene && strstr(words, "0.00621 of the distribution") && strstr(words, "warning"),
         "mass outside the physical range is told");
  scene_free(scene);
  bad(HEAD METAL "    source: x\n" BAR
                 "effects: {h: {model: heat, taylor_quinney: {mean: 1, sd: 1}}}",
      "taylor_quinney", "'taylor_quinney' may not be random", "one number");
}

static void test_files(void)
{
  mkdir("inputs", 0755);
  mkdir("inputs/materials", 0755);
  mkdir("elsewhere", 0755);
  write_file("inputs/materials/copper.yaml", "gamut: 1\n" METAL);
  write_file("elsewhere/a.yaml", "gamut: 1\ninclude: [b.yaml]\n");
  write_file("elsewhere/b.yaml", "gamut: 1\ninclude: [a.yaml]\n");
  struct scene *scene =
      good("an included card", "gamut: 1\ninclude: [materials/copper.yaml]\n"
                               "solver: {model: grid, geometry: axisymmetric, cell: 1 mm, end: 1 s}"
                               "\nmaterials: {copper: {strength: {A: 91 MPa}}}\n" BAR);
  if (scene) {
    tap_relative("the scene wins", real(scene->material[0].strength.values, "A"), 91e6, 1e-15);
    tap_relative("the card stays", real(scene->material[0].strength.values, "T_melt"), 1356, 0);
  }
  scene_free(scene);
  scene_free(good("another law than the card's",
                  "gamut: 1\ninclude: materials/copper.yaml\n"
                  "solver: {model: grid, geometry: axisymmetric, cell: 1 mm, end: 1 s}\n"
                  "materials: {copper: {eos: {model: spring, bulk_modulus: 3 GPa}}}\n" BAR));
  bad("gamut: 1\ninclude: [elsewhere/a.yaml]\n", "elsewhere/b.yaml:2:11",
      "circular include: scene.yaml includes elsewhere/a.yaml includes elsewhere/b.yaml includes "
      "elsewhere/a.yaml",
      "");
  bad("gamut: 1\ninclude: [coper.yaml]\n", "scene.yaml:2:11",
      "included file 'coper.yaml' is not found (scene.yaml includes coper.yaml)", "inputs");
  bad("", "scene.yaml", "error", "");
}

static void test_sets(void)
{
  char *words;
  gamut_status status;
  const struct scene_override set[] = {{"bodies.bar.velocity", "[0 m/s, -200 m/s]", NULL},
                                       {"bodies.bar.shape.cylinder.length", "30 mm", NULL},
                                       {"solver.shape", "linear", NULL},
                                       {"solver.transfer.pic", "0.5", NULL}};
  struct scene *scene = read_with(GOOD, set, 4, &words, &status);
  if (tap_ok(scene && !words[0], "overrides are read")) {
    tap_relative("vector", scene->body[0].velocity[1], -200, 0);
    tap_relative("length", scene->body[0].shape.length, 30e-3, 1e-15);
    tap_text("choice", values_find(scene->solver.values, "shape")->text, "linear");
    tap_relative("a new mapping", real(scene->solver.values, "transfer.pic"), 0.5, 0);
  } else {
    tap_print_text("said:", words);
  }
  scene_free(scene);
  const struct scene_override wrong[] = {{"solver.cel", "1 mm", NULL}};
  scene = read_with(GOOD, wrong, 1, &words, &status);
  tap_ok(!scene && status == GAMUT_SCENE && strstr(words, "--set solver.cel") &&
             strstr(words, "did you mean 'cell'?"),
         "an unknown path is told by its --set");
  scene_free(scene);
}

static void test_set_value(void)
{
  struct scene *scene = good("a scene to change", GOOD);
  struct trace *trace = trace_new();
  if (scene) {
    struct instance *e = &scene->material[0].elasticity;
    int k = descriptor_parameter(e->descriptor, "youngs_modulus");
    tap_ok(values_set(e->values, e->descriptor, (size_t)k, 200e9, trace) == GAMUT_OK, "set");
    tap_relative("derived again", real(e->values, "shear_modulus"), 200e9 / 2.68, 1e-15);
    struct instance *s = &scene->material[0].strength;
    k = descriptor_parameter(s->descriptor, "T_melt");
    tap_ok(values_set(s->values, s->descriptor, (size_t)k, 100, trace) == GAMUT_SCENE,
           "a constraint holds when a value is set");
    tap_ok(strstr(told(trace), "is not possible") != NULL, "and says so");
  }
  trace_free(trace);
  scene_free(scene);
}

static void test_schema(void)
{
  FILE *file = tmpfile();
  json_error_t error;
  schema_write(registry, file);
  rewind(file);
  json_t *schema = json_loadf(file, 0, &error);
  fclose(file);
  tap_ok(schema && json_object_get(json_object_get(schema, "properties"), "solver"),
         "the schema is JSON");
  json_decref(schema);
}

static void add_plugins(const char *from, struct trace *trace)
{
  static const char *const name[] = {"grid",  "spring", "metal", "hypoelastic",
                                     "floor", "heat",   "beam"};
  for (size_t i = 0; i < sizeof name / sizeof name[0]; i++) {
    char path[PATH_MAX + 64];
    snprintf(path, sizeof path, "%s/tests/unit/scene_plugins/%s.yaml", from, name[i]);
    const struct descriptor *descriptor;
    if (!tap_ok(registry_add(registry, path, trace, &descriptor) == GAMUT_OK, "plugin %s", name[i]))
      tap_print_text("said:", told(trace));
  }
}

int main(void)
{
  char why[256] = "", source[PATH_MAX];
  const struct registry_options options = {.plugin_path = NULL, .user_plugins = false};
  struct trace *trace = trace_new();
  if (!realpath(getenv("srcdir") ? getenv("srcdir") : ".", source) || !mkdtemp(folder) ||
      chdir(folder) != 0)
    return 1;
  units = units_new(why, sizeof why);
  tap_ok(units && registry_new(&options, units, trace, &registry) == GAMUT_OK, "registry %s", why);
  add_plugins(source, trace);
  test_good();
  test_keys();
  test_values();
  test_together();
  test_bodies();
  test_tables();
  test_effects();
  test_quantities();
  test_random();
  test_files();
  test_sets();
  test_set_value();
  test_schema();
  registry_free(registry);
  units_free(units);
  trace_free(trace);
  if (chdir("/") != 0 || !strstr(folder, "gamut_scene_"))
    return 1;
  char remove[64];
  snprintf(remove, sizeof remove, "rm -r %s", folder);
  return system(remove) != 0 || tap_done();
}
