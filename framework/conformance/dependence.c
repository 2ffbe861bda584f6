/* What a law depends on: every parameter moves something, every input that moves its result has a
 * slope, and the result has no jump that no message reports. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "conformance/suite.h"

enum { POINTS = 64, LINES = 12, ON_LINE = 257, SUSPECTS = 6, HALVINGS = 1200 };

/* The result that other plugins call for, and the arguments by which they need its slope. */
static const struct callee {
  enum gamut_kind kind;
  const char *result, *argument[4];
} callees[] = {
    {GAMUT_KIND_STRENGTH, "flow_stress", {"plastic_strain", "plastic_strain_rate", "temperature"}},
    {GAMUT_KIND_EOS, "pressure", {"compression", "energy"}}};

static void load(struct block *block, size_t point)
{
  for (size_t s = 0; s < block->proof->slots; s++)
    if (block->kept[s] && block->array[s])
      block->array[s][0] = block->kept[s][point];
}

static void call(struct suite *suite)
{
  bench_call(suite->bench, kernel_operation(suite->specimen.kernel, 0), 1);
}

/* Whether any result of the point differs; `result` SIZE_MAX: of all outputs and the status. */
static bool moves(struct suite *suite, size_t slot, size_t result, double value)
{
  const struct proof *proof = suite->proof;
  struct block *block = &suite->block;
  double before[512];
  bool moved = false;
  call(suite);
  const int64_t status = bench_status(suite->bench)[0];
  for (size_t s = 0; s < proof->slots && s < 512; s++)
    before[s] = slot_is_output(&proof->slot[s]) ? block->array[s][0] : 0;
  double kept = block->array[slot][0];
  block->array[slot][0] = value;
  call(suite);
  block->array[slot][0] = kept;
  for (size_t s = 0; s < proof->slots && s < 512; s++)
    if (slot_is_output(&proof->slot[s]) && (result == SIZE_MAX || s == result))
      moved |= memcmp(&before[s], &block->array[s][0], sizeof(double)) != 0;
  return moved || (result == SIZE_MAX && status != bench_status(suite->bench)[0]);
}

static bool has_influence(struct suite *suite, size_t slot, size_t result)
{
  struct block *block = &suite->block;
  char label[96];
  const struct span span = span_of(slot_label(&suite->proof->slot[slot], label, sizeof label));
  const bool input = suite->proof->slot[slot].kind == SLOT_INPUT;
  for (size_t round = 0; round < 2; round++) {
    block_draw(block, round);
    for (size_t i = 0; i < POINTS; i++) {
      load(block, i);
      const double at = block->array[slot][0];
      const double step = fabs(at) > 0 ? 0.3 * at : 1;
      if (isnan(at) || moves(suite, slot, result, at + step) ||
          moves(suite, slot, result, at - step) ||
          (input && (moves(suite, slot, result, span.lower) ||
                     moves(suite, slot, result, span.upper))))
        return true;
    }
  }
  return false;
}

/* Parameters of which others are derived are for the reader of the scene. */
static bool is_derived(const struct descriptor *d, const char *name)
{
  for (size_t g = 0; g < d->givens; g++) {
    for (size_t k = 0; k < d->given[g].names; k++)
      if (strcmp(d->given[g].name[k], name) == 0)
        return true;
    for (size_t k = 0; k < d->given[g].derivations; k++)
      if (strcmp(d->given[g].derived[k], name) == 0)
        return true;
  }
  return false;
}

static void prove_use(struct suite *suite)
{
  struct proof *proof = suite->proof;
  const struct descriptor *d = proof->descriptor;
  for (size_t s = 0; s < proof->slots; s++) {
    const struct slot *slot = &proof->slot[s];
    if (slot->kind == SLOT_PARAMETER && d->parameter[slot->index].type == VALUE_REAL &&
        !d->parameter[slot->index].elsewhere && !is_derived(d, slot->name)) {
      check_begin(&proof->checks, "the parameter %s", slot->name);
      check_that(&proof->checks, has_influence(suite, s, SIZE_MAX),
                 "the parameter %s moves a result (`elsewhere: true` where only a solver reads it)",
                 slot->name);
    } else if (slot->kind == SLOT_INPUT && slot->components == 1 && suite->block.array[s] &&
               !has_influence(suite, s, SIZE_MAX)) {
      check_say(&proof->checks, "note: the input %s moves no result; leave it out", slot->name);
    }
  }
}

static double value_at(struct suite *suite, size_t result, size_t argument, double at, bool *fine)
{
  suite->block.array[argument][0] = at;
  call(suite);
  const double value = suite->block.array[result][0];
  *fine = bench_status(suite->bench)[0] == 0 && isfinite(value);
  return value;
}

/* The step that is left over an interval that is halved until nothing lies between its ends. */
static double step_within(struct suite *suite, size_t result, size_t argument, double a, double b,
                          double *where)
{
  bool fine_a, fine_b, fine;
  double at_a = value_at(suite, result, argument, a, &fine_a);
  double at_b = value_at(suite, result, argument, b, &fine_b);
  for (int k = 0; k < HALVINGS; k++) {
    const double middle = 0.5 * (a + b);
    if (!(middle > a && middle < b))
      break;
    const double at = value_at(suite, result, argument, middle, &fine);
    const bool left = !fine || fabs(at - at_a) > fabs(at_b - at);
    *(left ? &b : &a) = middle;
    *(left ? &at_b : &at_a) = at;
    *(left ? &fine_b : &fine_a) = fine;
  }
  *where = b;
  return fine_a && fine_b ? fabs(at_b - at_a) : 0;
}

/* The largest jump on one line, relative to the largest value on it. */
static double jump_on_line(struct suite *suite, size_t result, size_t argument, double *where)
{
  char label[96];
  struct span span = span_of(slot_label(&suite->proof->slot[argument], label, sizeof label));
  const double kept = suite->block.array[argument][0];
  double at[ON_LINE], value[ON_LINE], largest = 0, worst = 0;
  for (size_t k = 0; k < ON_LINE; k++) {
    bool fine;
    at[k] = span.lower + (span.upper - span.lower) * (double)k / (ON_LINE - 1);
    value[k] = value_at(suite, result, argument, at[k], &fine);
    value[k] = fine ? value[k] : NAN;
    largest = fmax(largest, fabs(value[k]));
  }
  for (int n = 0; n < SUSPECTS; n++) {
    size_t most = 0;
    double step = 0, place;
    for (size_t k = 0; k + 1 < ON_LINE; k++)
      if (fabs(value[k + 1] - value[k]) > step) {
        step = fabs(value[k + 1] - value[k]);
        most = k;
      }
    if (!(step > 1e-6 * largest))
      break;
    const double left = step_within(suite, result, argument, at[most], at[most + 1], &place);
    if (left > worst) {
      worst = left;
      *where = place;
    }
    value[most + 1] = value[most]; /* looked at */
  }
  suite->block.array[argument][0] = kept;
  return largest > 0 ? worst / largest : 0;
}

static void prove_jumps(struct suite *suite, size_t result, size_t argument, const char *name)
{
  double worst = 0, place = 0;
  char label[96];
  check_begin(&suite->proof->checks, "jumps along %s", name);
  block_draw(&suite->block, 1);
  for (size_t i = 0; i < LINES; i++) {
    double where = 0;
    load(&suite->block, i);
    const double jump = jump_on_line(suite, result, argument, &where);
    if (jump > worst) {
      worst = jump;
      place = where;
    }
  }
  label[0] = 0;
  if (worst > 1e-6)
    snprintf(label, sizeof label, " (at %s = %.9g)", name, place);
  check_figure(&suite->proof->checks, worst, 1e-6,
               "jumps of %s along %s that no message reports, relative%s",
               suite->proof->slot[result].name, name, label);
}

static void prove_argument(struct suite *suite, const char *result_name, const char *name)
{
  struct proof *proof = suite->proof;
  size_t result = slot_named(proof, SLOT_OUTPUT, result_name);
  size_t argument = slot_named(proof, SLOT_INPUT, name);
  char slope[128];
  snprintf(slope, sizeof slope, "%s_slope_%s", result_name, name);
  if (result == SIZE_MAX || argument == SIZE_MAX)
    return;
  check_begin(&proof->checks, "dependence on %s", name);
  if (slot_named(proof, SLOT_OUTPUT, slope) == SIZE_MAX)
    check_that(&proof->checks, !has_influence(suite, argument, result),
               "%s that changes with %s gives its slope: outputs: [.., %s]", result_name, name,
               slope);
  prove_jumps(suite, result, argument, name);
}

void prove_dependence(struct suite *suite)
{
  for (size_t c = 0; c < ARRAY_SIZE(callees); c++)
    for (size_t k = 0; callees[c].kind == suite->proof->descriptor->kind && callees[c].argument[k];
         k++)
      prove_argument(suite, callees[c].result, callees[c].argument[k]);
  prove_use(suite);
}
