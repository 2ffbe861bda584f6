#include "conformance/suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expression/expression.h"

bool suite_new(struct suite *suite, struct proof *proof)
{
  gamut_status status = GAMUT_OK;
  struct trace *trace = trace_new();
  *suite = (struct suite){.proof = proof};
  check_begin(&proof->checks, "making the kernel");
  TRY(specimen_values(&suite->specimen, proof->descriptor, &proof->base, "base", proof->units,
                      trace));
  TRY(specimen_open(&suite->specimen, proof->registry, BLOCK_ROOM, 8000, trace));
  TRY(laws_new(&suite->laws, proof, NULL, BLOCK_ROOM, 8000, trace));
  TRY(bench_new(suite->specimen.kernel, suite->laws.eos.kernel, suite->laws.strength.kernel,
                BLOCK_ROOM, trace, &suite->bench));
  if (!block_new(&suite->block, proof, suite->bench))
    status = GAMUT_INTERNAL;
done:
  if (status != GAMUT_OK) {
    char *text = trace_text(trace);
    check_that(&proof->checks, false, "the kernel can be made");
    check_say(&proof->checks, "%s", text ? text : "");
    free(text);
  }
  trace_free(trace);
  return status == GAMUT_OK;
}

void suite_free(struct suite *suite)
{
  if (suite->block.proof)
    block_free(&suite->block);
  bench_free(suite->bench);
  laws_free(&suite->laws);
  specimen_close(&suite->specimen);
}

void suite_work(struct suite *suite, size_t operation, const char *label)
{
  kernel_function function = kernel_operation(suite->specimen.kernel, operation);
  const struct work work = {.function = function, .label = label};
  if (function)
    prove_work(&suite->block, &work);
  else
    check_that(&suite->proof->checks, false, "the operation %s is there", label);
}

void suite_derivatives(struct suite *suite, size_t operation)
{
  struct proof *proof = suite->proof;
  kernel_function own = kernel_operation(suite->specimen.kernel, operation);
  if (proof->descriptor->derivatives == 0)
    return;
  if (!own) {
    check_skip(&proof->checks, "the plugin leaves them to differences", "derivatives of %s",
               proof->descriptor->derivative_of);
    return;
  }
  const struct work work = {.function = own,
                            .label = "derivatives",
                            .derivatives = true,
                            .flags = kernel_operation(suite->specimen.kernel, 0)};
  bench_offer_derivatives(suite->bench, true);
  prove_work(&suite->block, &work);
  bench_offer_derivatives(suite->bench, false);
  prove_derivatives(proof, &suite->block, kernel_operation(suite->specimen.kernel, 0));
}

/* The parameters of a point as the condition's variables; NaN for what kernels do not see. */
static double *point_parameters(const struct suite *suite, size_t point, double *value)
{
  const struct descriptor *d = suite->proof->descriptor;
  for (size_t i = 0; i < d->parameters; i++) {
    size_t slot = slot_named(suite->proof, SLOT_PARAMETER, d->parameter[i].name);
    value[i] = slot == SIZE_MAX ? NAN : suite->block.array[slot][point];
  }
  return value;
}

/* Makes a condition such as "C == 0 && S2 == 0" true: the parameters it uses are set to zero. */
static void meet_condition(struct suite *suite, struct expression *when, size_t point)
{
  const struct descriptor *d = suite->proof->descriptor;
  for (size_t i = 0; i < d->parameters; i++) {
    size_t slot = slot_named(suite->proof, SLOT_PARAMETER, d->parameter[i].name);
    if (slot != SIZE_MAX && expression_uses(when, i))
      suite->block.array[slot][point] = 0;
  }
}

static double variant_error(struct suite *suite, const struct variant *variant, size_t *tried)
{
  struct proof *proof = suite->proof;
  const struct descriptor *d = proof->descriptor;
  struct block *block = &suite->block;
  double worst = 0, *value = calloc(d->parameters + 1, sizeof *value);
  double *kept = calloc(proof->slots * BLOCK_POINTS + 1, sizeof *kept);
  const char **name = calloc(d->parameters + 1, sizeof *name);
  char why[200];
  if (!value || !kept || !name)
    abort(); /* the checks are a process of their own */
  for (size_t i = 0; i < d->parameters; i++)
    name[i] = d->parameter[i].name;
  struct expression *when = expression_new(variant->when, name, d->parameters, why, sizeof why);
  block_draw(block, 1);
  for (size_t i = 0; when && i < BLOCK_POINTS; i++)
    if (expression_value(when, point_parameters(suite, i, value)) == 0)
      meet_condition(suite, when, i);
  block_mark(block);
  bench_call(block->bench, kernel_operation(suite->specimen.kernel, 0), BLOCK_POINTS);
  for (size_t s = 0; s < proof->slots; s++)
    if (slot_is_output(&proof->slot[s]))
      memcpy(kept + s * BLOCK_POINTS, block->array[s], BLOCK_POINTS * sizeof(double));
  block_mark(block);
  bench_call(block->bench, kernel_named(suite->specimen.kernel, variant->kernel), BLOCK_POINTS);
  for (size_t i = 0; when && i < BLOCK_POINTS; i++) {
    if (expression_value(when, point_parameters(suite, i, value)) == 0)
      continue;
    (*tried)++;
    for (size_t s = 0; s < proof->slots; s++) {
      double whole = kept[s * BLOCK_POINTS + i];
      if (slot_is_output(&proof->slot[s]) && isfinite(whole))
        worst = fmax(worst, fabs(block->array[s][i] - whole) / fmax(fabs(whole), 1e-300));
    }
  }
  expression_free(when);
  free(name);
  free(kept);
  free(value);
  return worst;
}

void suite_variants(struct suite *suite)
{
  const struct descriptor *d = suite->proof->descriptor;
  for (size_t v = 0; v < d->variants; v++) {
    size_t tried = 0;
    const struct work work = {.function =
                                  kernel_named(suite->specimen.kernel, d->variant[v].kernel),
                              .label = d->variant[v].kernel};
    check_begin(&suite->proof->checks, "variant %s", d->variant[v].kernel);
    if (!work.function) {
      check_that(&suite->proof->checks, false, "the variant %s is there", d->variant[v].kernel);
      continue;
    }
    double worst = variant_error(suite, &d->variant[v], &tried);
    check_figure(&suite->proof->checks, tried ? worst : NAN, 1e-12,
                 "variant %s against the whole formula at %zu points, relative",
                 d->variant[v].kernel, tried);
  }
}
