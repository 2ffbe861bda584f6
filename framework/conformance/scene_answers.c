/* Known answers of whole runs, in NAME.test.yaml:
 *
 *   tests:
 *     - name: a block falls
 *       source: where the number comes from
 *       scene: gravity.scene.yaml               a file of the plugin's folder
 *       set: {solver.end: 10 us, effects: ...}  what of it is another: values by path, as --set;
 *                                               or a list of such, the later ones win
 *       expect: {fall: -1e6 m/s2}               its quantities: of a history the last value; bare
 *                                               numbers are SI. Or {value:, tolerance:, absolute:}
 *       tolerance: 1e-9                         relative; 1e-12 if not stated
 *       absolute: 0                             allowed besides that, in the quantity's unit
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/scene_run.h"

bool is_scene_test(const struct tree *test)
{
  return tree_get(test, "scene") != NULL;
}

/* A number of the quantity's own, else of the whole test, else the standard one. NaN, which nothing
 * is close to, where it cannot be read. */
static double stated(const struct proof *proof, const struct tree *test,
                     const struct tree *expected, const char *key, const char *unit,
                     double standard)
{
  const struct tree *own = tree_get(expected, key), *node = own ? own : tree_get(test, key);
  double value = standard;
  if (node && (node->kind != TREE_SCALAR ||
               unit_read_bare(proof->units, node->text, unit, &value) != UNIT_OK))
    return NAN;
  return value;
}

/* The quantity's value with its unit; false with the reason where it has none. */
static bool value_of(const struct gamut_run *run, const char *name, double *value, char *unit,
                     size_t unit_size, char *why, size_t size)
{
  size_t count;
  struct history *const *history = run_histories(run, &count);
  for (size_t i = 0; i < count; i++) {
    const struct history *h = history[i];
    if (strcmp(h->quantity->name, name) != 0)
      continue;
    if (h->quantity->reduction.kind != REDUCE_NONE)
      return reduction_value(&h->quantity->reduction, h, value, unit, unit_size, why, size);
    snprintf(unit, unit_size, "%s", h->unit);
    snprintf(why, size, "it has no samples");
    *value = h->count > 0 ? h->value[h->count - 1] : NAN;
    return h->count > 0;
  }
  snprintf(why, size, "the scene has no such quantity");
  return false;
}

static void compare(struct proof *proof, const struct scene_run *made, const struct tree *test,
                    const char *title, const struct tree *expected)
{
  double got = NAN, want = NAN;
  char unit[64] = "1", why[256] = "";
  if (!value_of(made->run, expected->key, &got, unit, sizeof unit, why, sizeof why)) {
    check_that(&proof->checks, false, "known answer: %s: %s (%s)", title, expected->key, why);
    return;
  }
  const struct tree *wanted = tree_get(expected, "value");
  wanted = expected->kind == TREE_MAPPING ? wanted : expected;
  if (!wanted || wanted->kind != TREE_SCALAR ||
      unit_read_bare(proof->units, wanted->text, unit, &want) != UNIT_OK) {
    check_that(&proof->checks, false, "known answer: %s: %s is expected in %s, not '%s'", title,
               expected->key, unit, wanted ? wanted->text : "");
    return;
  }
  double absolute = stated(proof, test, expected, "absolute", unit, 0);
  double tolerance = stated(proof, test, expected, "tolerance", "1", 1e-12);
  const double off = fabs(got - want), beyond = isnan(off) ? NAN : fmax(off - absolute, 0);
  check_figure(&proof->checks, want != 0 ? beyond / fabs(want) : off,
               want != 0 ? tolerance : absolute,
               "known answer: %s: %s is %.9g %s, expected %.9g, off by", title, expected->key, got,
               unit, want);
}

static struct scene_override *overrides_of(const struct tree *set, size_t *count)
{
  size_t parts = set && set->kind == TREE_SEQUENCE ? set->children : 1, room = 1;
  for (size_t p = 0; set && p < parts; p++)
    room += set->kind == TREE_SEQUENCE ? set->child[p]->children : set->children;
  struct scene_override *override = calloc(room, sizeof *override);
  *count = 0;
  for (size_t p = 0; override && set && p < parts; p++) {
    const struct tree *part = set->kind == TREE_SEQUENCE ? set->child[p] : set;
    for (size_t i = 0; i < part->children; i++)
      override[(*count)++] =
          (struct scene_override){.path = part->child[i]->key, .node = part->child[i]};
  }
  return override;
}

static void prove_one(struct proof *proof, const struct tree *test)
{
  const struct tree *name = tree_get(test, "name"), *set = tree_get(test, "set");
  const struct tree *expect = tree_get(test, "expect"), *scene = tree_get(test, "scene");
  const char *title = name ? name->text : "unnamed";
  size_t overrides;
  struct scene_override *override = overrides_of(set, &overrides);
  char *file = plugin_file(proof->descriptor, scene->text);
  struct scene_run made = {0};
  check_begin(&proof->checks, "known answer: %s", title);
  if (file && override)
    scene_run_make(&made, proof, file, override, overrides, 1);
  check_that(&proof->checks, made.run && made.status == GAMUT_OK && expect && expect->children > 0,
             "known answer: %s: %s runs%s", title, scene->text,
             expect && expect->children > 0 ? "" : " (nothing is expected of it)");
  for (size_t i = 0; made.run && made.status == GAMUT_OK && expect && i < expect->children; i++)
    compare(proof, &made, test, title, expect->child[i]);
  scene_run_free(&made);
  free(override);
  free(file);
}

void prove_scene_answers(struct proof *proof)
{
  const struct tree *tests = proof->known ? tree_get(proof->known, "tests") : NULL;
  for (size_t i = 0; tests && i < tests->children; i++)
    if (is_scene_test(tests->child[i]))
      prove_one(proof, tests->child[i]);
}
