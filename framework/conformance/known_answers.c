/* NAME.test.yaml: known answers as data; those with a `scene` are read in scene_answers.c.
 *
 *   tests:
 *     - name: on the Hugoniot
 *       source: where the number comes from
 *       parameters: {C0: 3940 m/s, ...}         bare numbers are SI
 *       at: {compression: 0.1, ...}             inputs; states at the beginning by their name; a
 *                                               list gives all components
 *       laws: {eos: {model: NAME, ...}, strength: {model: NAME, ...}}   elasticity: its callees
 *       kernel: heat                            effect of several tasks: which kernel
 *       expect: {pressure: 1.0e9, ...}          outputs; states at the end; null: not a number;
 *                                               what a task adds to counts from 0
 *       derivatives: {pressure: {C0: ...}}
 *       second_derivatives: {pressure: {C0: {S1: ...}}}
 *       status: message name                    where the law must flag the point
 *       tolerance: 1e-12                        relative; 1e-12 if not stated
 *       absolute: 0                             allowed besides that
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"
#include "conformance/laws.h"
#include "conformance/scene_run.h"

struct answer {
  struct proof *proof;
  const struct tree *test;
  struct specimen specimen;
  struct laws laws;
  struct bench *bench;
  double worst, tolerance, absolute;
  char which[128]; /* where the worst error is, or what is wrong with the test */
  bool broken;
};

static void broken(struct answer *a, const char *what, const char *name)
{
  a->broken = true;
  snprintf(a->which, sizeof a->which, "%s '%s'", what, name);
}

static double number_of(struct answer *a, const struct tree *node, const char *unit)
{
  double value = NAN;
  if (!node || node->kind != TREE_SCALAR ||
      unit_read_bare(a->proof->units, node->text, unit ? unit : "1", &value) != UNIT_OK)
    broken(a, "cannot read the number", node ? node->text : "");
  return value;
}

static double own_number(struct answer *a, const char *key, double standard)
{
  const struct tree *node = tree_get(a->test, key);
  return node ? number_of(a, node, "1") : standard;
}

/* The slot that a name in `at` or `expect` stands for, whole or one component. */
static const struct slot *slot_called(const struct proof *proof, const char *name, bool input)
{
  for (size_t s = 0; s < proof->slots; s++) {
    const struct slot *slot = &proof->slot[s];
    char label[96], begin[112];
    if (input ? !slot_is_input(slot) : !slot_is_output(slot) && slot->kind != SLOT_INVERSE_OUTPUT)
      continue;
    slot_label(slot, label, sizeof label);
    snprintf(begin, sizeof begin, "%s_begin", name);
    if (strcmp(label, name) == 0 || strcmp(slot->name, name) == 0 ||
        (slot->kind == SLOT_STATE_BEGIN &&
         (strcmp(slot->name, begin) == 0 ||
          strcmp(proof->descriptor->state[slot->index].name, name) == 0)))
      return slot;
    if (slot->kind != SLOT_STATE_BEGIN || slot->components == 1)
      continue;
    snprintf(begin, sizeof begin, "%s_%s", proof->descriptor->state[slot->index].name,
             component_name(slot->components, slot->component));
    if (strcmp(begin, name) == 0)
      return slot;
  }
  return NULL;
}

static double *array_of(struct answer *a, const struct slot *slot)
{
  char label[96];
  return bench_array(a->bench, slot_label(slot, label, sizeof label));
}

static bool is_elsewhere(const char *name)
{
  return strcmp(name, "compression") == 0 || strcmp(name, "energy") == 0 ||
         strcmp(name, "reference_density") == 0 || strcmp(name, "plastic_strain") == 0 ||
         strcmp(name, "plastic_strain_rate") == 0 || strcmp(name, "temperature") == 0;
}

static void set_inputs(struct answer *a)
{
  const struct tree *at = tree_get(a->test, "at");
  for (size_t i = 0; at && i < at->children; i++) {
    const struct tree *node = at->child[i];
    const struct slot *slot = slot_called(a->proof, node->key, true);
    if (!slot && is_elsewhere(node->key))
      continue; /* a law need not read what its kind may be asked at */
    if (!slot) {
      broken(a, "no input", node->key);
      return;
    }
    if (node->kind == TREE_SCALAR)
      array_of(a, slot)[0] = number_of(a, node, slot->unit);
    for (size_t k = 0; k < node->children && k < slot->components; k++)
      array_of(a, slot + k)[0] = number_of(a, node->child[k], slot->unit);
  }
}

/* What the task shares with others it finds as the core starts it. */
static void start_shared(struct answer *a, const char *const *name, size_t count, double start)
{
  for (size_t i = 0; i < count; i++) {
    const struct slot *slot = slot_called(a->proof, name[i], false);
    for (size_t k = 0; slot && k < slot->components; k++)
      array_of(a, slot + k)[0] = start;
  }
}

static void set_shared(struct answer *a, kernel_function function)
{
  const struct descriptor *d = a->proof->descriptor;
  for (size_t t = 0; t < d->tasks; t++) {
    const struct kernel_task *task = &d->task[t];
    if (kernel_named(a->specimen.kernel, task->kernel) != function)
      continue;
    start_shared(a, task->scale, task->scales, access_neutral(GAMUT_SCALE));
    start_shared(a, task->lower, task->lowers, access_neutral(GAMUT_LEAST));
  }
}

static void compare(struct answer *a, double got, const struct tree *node, const char *unit,
                    const char *name)
{
  double error;
  if (strcmp(node->text, "null") == 0 || strcmp(node->text, ".nan") == 0) {
    error = isfinite(got) ? INFINITY : 0;
  } else {
    double want = number_of(a, node, unit);
    error = fmax(fabs(got - want) - a->absolute, 0);
    if (want != 0)
      error /= fabs(want);
    if (isnan(error))
      error = INFINITY;
  }
  if (error >= a->worst && !a->broken) {
    a->worst = error;
    snprintf(a->which, sizeof a->which, "%s: %.17g for %s", name, got, node->text);
  }
}

static void compare_outputs(struct answer *a)
{
  const struct tree *expect = tree_get(a->test, "expect");
  for (size_t i = 0; expect && i < expect->children; i++) {
    const struct tree *node = expect->child[i];
    const struct slot *slot = slot_called(a->proof, node->key, false);
    if (!slot) {
      broken(a, "no output", node->key);
      return;
    }
    if (node->kind == TREE_SCALAR)
      compare(a, array_of(a, slot)[0], node, slot->unit, node->key);
    for (size_t k = 0; k < node->children && k < slot->components; k++)
      compare(a, array_of(a, slot + k)[0], node->child[k], slot->unit, node->key);
  }
}

static size_t by_number(struct answer *a, const char *name)
{
  const struct descriptor *d = a->proof->descriptor;
  for (size_t k = 0; k < d->derivatives; k++)
    if (strcmp(d->derivative_by[k], name) == 0)
      return k;
  broken(a, "no derivative by", name);
  return 0;
}

/* The mapping of derivatives of the output that the descriptor declares them of. */
static const struct tree *derivatives_of(struct answer *a, const char *key)
{
  const struct tree *all = tree_get(a->test, key);
  const char *of = a->proof->descriptor->derivative_of;
  if (!all)
    return NULL;
  if (!of || !tree_get(all, of)) {
    broken(a, "the descriptor declares no", key);
    return NULL;
  }
  return tree_get(all, of);
}

static void compare_derivatives(struct answer *a)
{
  size_t n = a->proof->descriptor->derivatives;
  const struct tree *first = derivatives_of(a, "derivatives");
  const struct tree *second = derivatives_of(a, "second_derivatives");
  if (!first && !second)
    return;
  double *value = calloc(n + n * n, sizeof *value);
  if (!value || bench_derivatives(a->bench, 0, false, value, value + n) != GAMUT_OK)
    broken(a, "derivatives", "cannot be had");
  for (size_t i = 0; first && !a->broken && i < first->children; i++)
    compare(a, value[by_number(a, first->child[i]->key)], first->child[i], NULL,
            first->child[i]->key);
  for (size_t i = 0; second && !a->broken && i < second->children; i++)
    for (size_t k = 0; k < second->child[i]->children; k++) {
      const struct tree *node = second->child[i]->child[k];
      compare(a, value[n + by_number(a, second->child[i]->key) * n + by_number(a, node->key)], node,
              NULL, node->key);
    }
  free(value);
}

static gamut_status make(struct answer *a, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct settings settings = {.folder = a->proof->descriptor->folder};
  const struct tree *parameters = tree_get(a->test, "parameters");
  const struct tree *density = tree_at(a->test, "at.reference_density");
  double rho = density ? number_of(a, density, "kg/m3") : 1000;
  for (size_t i = 0; parameters && i < parameters->children; i++)
    TRY(settings_node(&settings, a->proof->descriptor, parameters->child[i], "parameters",
                      a->proof->units, trace));
  TRY(specimen_values(&a->specimen, a->proof->descriptor, &settings, "parameters", a->proof->units,
                      trace));
  TRY(specimen_open(&a->specimen, a->proof->registry, 1, rho, trace));
  TRY(laws_new(&a->laws, a->proof, tree_get(a->test, "laws"), 1, rho, trace));
  TRY(bench_new(a->specimen.kernel, a->laws.eos.kernel, a->laws.strength.kernel, 1, trace,
                &a->bench));
done:
  settings_free(&settings);
  return status;
}

/* What the test calls: the law's own operation, its inverse, or the kernel of an effect's task. */
static kernel_function function_called(struct answer *a)
{
  const struct descriptor *d = a->proof->descriptor;
  const struct tree *named = tree_get(a->test, "kernel"), *expect = tree_get(a->test, "expect");
  bool inverse = expect && tree_get(expect, "plastic_strain_inverse");
  if (d->kind != GAMUT_KIND_EFFECT)
    return kernel_operation(a->specimen.kernel, inverse ? 1 : 0);
  return kernel_named(a->specimen.kernel, named ? named->text : d->task[0].kernel);
}

static bool status_fits(struct answer *a, const char **got, const char **want)
{
  const struct tree *node = tree_get(a->test, "status");
  const struct message *message = status_message(a->proof->descriptor, bench_status(a->bench)[0]);
  *want = node ? node->text : "ok";
  *got = message ? message->name : "ok";
  return strcmp(*got, *want) == 0;
}

static void prove_one(struct proof *proof, const struct tree *test, size_t number)
{
  struct answer a = {.proof = proof, .test = test};
  const struct tree *name = tree_get(test, "name");
  const char *title = name ? name->text : "unnamed", *got = "ok", *want = "ok";
  struct trace *trace = trace_new();
  check_begin(&proof->checks, "known answer %zu: %s", number, title);
  a.tolerance = own_number(&a, "tolerance", 1e-12);
  a.absolute = own_number(&a, "absolute", 0);
  bool made = make(&a, trace) == GAMUT_OK, fits = false;
  if (made) {
    set_inputs(&a);
    kernel_function function = function_called(&a);
    set_shared(&a, function);
    if (function)
      bench_call_kept(a.bench, function, 1);
    else
      broken(&a, "no such operation for", title);
    fits = status_fits(&a, &got, &want);
    compare_outputs(&a);
    if (!a.broken)
      compare_derivatives(&a);
  }
  if (!made || a.broken)
    check_that(&proof->checks, false, "known answer: %s (the test cannot be made: %s)", title,
               a.which);
  else if (!fits)
    check_that(&proof->checks, false, "known answer: %s: status %s where %s is due", title, got,
               want);
  else
    check_figure(&proof->checks, a.worst, a.tolerance, "known answer: %s", title);
  if (made && (a.worst > a.tolerance || a.broken))
    check_say(&proof->checks, "%s", a.which);
  if (!made) {
    char *text = trace_text(trace);
    check_say(&proof->checks, "%s", text ? text : "");
    free(text);
  }
  bench_free(a.bench);
  laws_free(&a.laws);
  specimen_close(&a.specimen);
  trace_free(trace);
}

void prove_known_answers(struct proof *proof)
{
  const struct tree *tests = proof->known ? tree_get(proof->known, "tests") : NULL;
  bool kernel = proof->descriptor->kind == GAMUT_KIND_EOS ||
                proof->descriptor->kind == GAMUT_KIND_STRENGTH ||
                proof->descriptor->kind == GAMUT_KIND_ELASTICITY ||
                (proof->descriptor->kind == GAMUT_KIND_EFFECT && proof->descriptor->tasks > 0);
  bool effect = proof->descriptor->kind == GAMUT_KIND_EFFECT;
  if (effect && (!tests || !tests->children))
    check_skip(&proof->checks, "no known answer: what it computes is unproven",
               "known answers of %s.test.yaml", proof->descriptor->name);
  else if (kernel || effect)
    check_that(&proof->checks, tests && tests->children > 0,
               "%s.test.yaml has a known answer%s", proof->descriptor->name,
               tests && tests->children > 0 ? "" : ": no known answer: formula unproven");
  for (size_t i = 0; kernel && tests && i < tests->children; i++)
    if (!is_scene_test(tests->child[i]))
      prove_one(proof, tests->child[i], i + 1);
}
