/* Kernels on blocks of points: what every law must keep, whatever it computes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/conformance_private.h"

/* A NaN with a payload that no arithmetic gives. */
static const uint64_t mark_bits = UINT64_C(0x7ff8dead0badf00d);

static uint64_t bits_of(double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

bool is_mark(double value)
{
  return bits_of(value) == mark_bits;
}

static bool same(double one, double other)
{
  return bits_of(one) == bits_of(other) ||
         (isnan(one) && isnan(other) && is_mark(one) == is_mark(other));
}

bool block_new(struct block *block, struct proof *proof, struct bench *bench)
{
  *block = (struct block){.proof = proof, .bench = bench};
  block->array = calloc(proof->slots + 1, sizeof *block->array);
  block->kept = calloc(proof->slots + 1, sizeof *block->kept);
  if (!block->array || !block->kept)
    return false;
  for (size_t s = 0; s < proof->slots; s++) {
    char label[96];
    const struct slot *slot = &proof->slot[s];
    if (slot->kind == SLOT_LAW || slot->kind == SLOT_SCRATCH)
      continue;
    block->array[s] = bench_array(bench, slot_label(slot, label, sizeof label));
    if (slot_is_input(slot))
      block->kept[s] = calloc(BLOCK_ROOM, sizeof(double));
  }
  return true;
}

void block_free(struct block *block)
{
  for (size_t s = 0; block->kept && s < block->proof->slots; s++)
    free(block->kept[s]);
  free(block->array);
  free(block->kept);
}

void block_mark(struct block *block)
{
  double mark;
  memcpy(&mark, &mark_bits, sizeof mark);
  for (size_t s = 0; s < block->proof->slots; s++)
    for (size_t i = 0; block->array[s] && !block->kept[s] && i < BLOCK_ROOM; i++)
      block->array[s][i] = mark;
  memset(bench_status(block->bench), 0, BLOCK_ROOM * sizeof(int64_t));
}

static double draw_input(struct proof *proof, const char *name, size_t corner)
{
  struct span span = span_of(name);
  if (corner > 0 && span.specials > 0 && draw(proof) < 0.7)
    return span.special[(size_t)(draw(proof) * (double)span.specials)];
  if (corner > 0 && draw(proof) < 0.5)
    return draw(proof) < 0.5 ? span.lower : span.upper;
  return draw_between(proof, span.lower, span.upper);
}

static double parameter_value(const struct specimen *specimen, const struct slot *slot)
{
  const struct values *values = slot->kind == SLOT_PARAMETER ? specimen->values : specimen->extra;
  const struct value *value = &values->value[slot->index];
  return value->present ? value->real : NAN;
}

static void draw_point(struct block *block, const struct specimen *specimen, size_t corner,
                       size_t i)
{
  struct proof *proof = block->proof;
  const struct descriptor *d = proof->descriptor;
  bool absent = false;
  for (size_t s = 0; s < proof->slots; s++) {
    const struct slot *slot = &proof->slot[s];
    char label[96];
    if (!block->kept[s] || !block->array[s])
      continue;
    /* An optional input is tried with values and, whole, as where it is absent. */
    if (slot->component == 0)
      absent = slot->kind == SLOT_INPUT && d->input[slot->index].optional && draw(proof) < 0.25;
    if (absent)
      block->array[s][i] = d->input[slot->index].absent;
    else if (slot->kind == SLOT_PARAMETER || slot->kind == SLOT_MATERIAL_PARAMETER)
      block->array[s][i] = parameter_value(specimen, slot);
    else
      block->array[s][i] = draw_input(proof, slot_label(slot, label, sizeof label), corner);
    /* A symmetric positive history such as a strain measure starts from what the plugin declares.
     */
    if (slot->kind == SLOT_STATE_BEGIN && d->state[slot->index].components > 1)
      block->array[s][i] = d->state[slot->index].initial;
  }
}

void block_draw(struct block *block, size_t round)
{
  struct proof *proof = block->proof;
  size_t corners = 3 + 2 * (proof->descriptor->parameters + proof->descriptor->material_parameters);
  struct specimen specimen = {0};
  for (size_t i = 0; i < BLOCK_ROOM; i++) {
    size_t corner = round == 0 ? i % corners : 0;
    bool taken = draw_settings(proof, corner, &specimen);
    if (taken)
      draw_point(block, &specimen, round == 0 ? i + 1 : 0, i);
    for (size_t s = 0; !taken && i > 0 && s < proof->slots; s++)
      if (block->kept[s] && block->array[s])
        block->array[s][i] = block->array[s][i - 1];
    specimen_close(&specimen);
  }
  for (size_t s = 0; s < proof->slots; s++)
    if (block->kept[s] && block->array[s])
      memcpy(block->kept[s], block->array[s], BLOCK_ROOM * sizeof(double));
}

static bool named(const char **list, size_t count, const char *name)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(list[i], name) == 0)
      return true;
  return false;
}

/* Changes what others have left: adds to it, scales or lowers it. */
static bool shares(const struct work *work, const struct slot *slot)
{
  const struct kernel_task *task = work->task;
  return task && slot_is_output(slot) &&
         (named(task->add, task->adds, slot->name) ||
          named(task->scale, task->scales, slot->name) ||
          named(task->lower, task->lowers, slot->name));
}

static bool writes(const struct work *work, const struct slot *slot)
{
  if (work->derivatives)
    return slot->kind == SLOT_DERIVATIVE || slot->kind == SLOT_SECOND_DERIVATIVE;
  if (!slot_is_output(slot))
    return false;
  return !work->task || named(work->task->write, work->task->writes, slot->name);
}

static void prepare(struct block *block, const struct work *work)
{
  block_mark(block);
  for (size_t s = 0; s < block->proof->slots; s++)
    for (size_t i = 0; shares(work, &block->proof->slot[s]) && i < BLOCK_ROOM; i++)
      block->array[s][i] = 0.25;
}

/* Results of one call, to compare another with. */
struct record {
  double **output;
  int64_t status[BLOCK_ROOM];
};

static void record_take(struct record *record, const struct block *block)
{
  size_t slots = block->proof->slots;
  if (!record->output)
    record->output = calloc(slots + 1, sizeof *record->output);
  for (size_t s = 0; s < slots; s++)
    if (block->array[s] && !block->kept[s]) {
      if (!record->output[s])
        record->output[s] = calloc(BLOCK_ROOM, sizeof(double));
      memcpy(record->output[s], block->array[s], BLOCK_ROOM * sizeof(double));
    }
  memcpy(record->status, bench_status(block->bench), sizeof record->status);
}

static void record_free(struct record *record, size_t slots)
{
  for (size_t s = 0; record->output && s < slots; s++)
    free(record->output[s]);
  free(record->output);
}

/* Points whose results differ in a bit: those of the record from `from` on against the block's
 * first. */
static size_t differing(const struct record *record, const struct block *block, size_t from,
                        size_t count)
{
  size_t different = 0;
  for (size_t i = 0; i < count; i++) {
    bool equal = bench_status(block->bench)[i] == record->status[from + i];
    for (size_t s = 0; s < block->proof->slots; s++)
      if (record->output[s] && block->array[s])
        equal = equal && same(record->output[s][from + i], block->array[s][i]);
    different += !equal;
  }
  return different;
}

static size_t touched_inputs(const struct block *block, char *which, size_t size)
{
  size_t touched = 0;
  for (size_t s = 0; s < block->proof->slots; s++)
    for (size_t i = 0; block->kept[s] && block->array[s] && i < BLOCK_ROOM; i++)
      if (bits_of(block->kept[s][i]) != bits_of(block->array[s][i])) {
        touched++;
        snprintf(which, size, " (%s at point %zu)", block->proof->slot[s].name, i);
        block->array[s][i] = block->kept[s][i];
      }
  return touched;
}

/* Outputs that were left as they were, and marks or sums that were written where none is due. */
static void count_writes(const struct block *block, const struct work *work, size_t count,
                         size_t *left, size_t *beyond, char *which, size_t size)
{
  for (size_t s = 0; s < block->proof->slots; s++) {
    const struct slot *slot = &block->proof->slot[s];
    if (!block->array[s] || block->kept[s])
      continue;
    for (size_t i = 0; i < BLOCK_ROOM; i++) {
      bool untouched =
          shares(work, slot) ? block->array[s][i] == 0.25 : is_mark(block->array[s][i]);
      bool due = i < count && writes(work, slot);
      bool allowed = due || (i < count && shares(work, slot)) ||
                     (i < count && slot->kind == SLOT_INVERSE_OUTPUT);
      *left += due && untouched;
      *beyond += !allowed && !untouched;
      if ((due && untouched) || (!allowed && !untouched))
        snprintf(which, size, " (%s at point %zu)", slot->name, i);
    }
  }
}

static size_t unflagged(const struct block *block, const struct work *work, const int64_t *excuse,
                        char *which, size_t size)
{
  size_t bad = 0;
  for (size_t s = 0; s < block->proof->slots; s++)
    for (size_t i = 0; i < BLOCK_POINTS; i++) {
      const struct slot *slot = &block->proof->slot[s];
      if (!block->array[s] || !(writes(work, slot) || shares(work, slot)))
        continue;
      if (isfinite(block->array[s][i]) || excuse[i] != 0 || bench_status(block->bench)[i] != 0)
        continue;
      bad++;
      snprintf(which, size, " (%s at point %zu is %g)", slot->name, i, block->array[s][i]);
    }
  return bad;
}

bool bench_call_kept(struct bench *bench, kernel_function function, size_t count)
{
  fenv_t before, after;
  fegetenv(&before);
  bench_call(bench, function, count);
  fegetenv(&after);
  fesetenv(&before);
  return same_arithmetic(&before, &after);
}

static bool call(struct block *block, const struct work *work, size_t count)
{
  prepare(block, work);
  return bench_call_kept(block->bench, work->function, count);
}

static void move_to_front(struct block *block, size_t from, size_t count)
{
  for (size_t s = 0; s < block->proof->slots; s++)
    if (block->kept[s] && block->array[s])
      memmove(block->array[s], block->kept[s] + from, count * sizeof(double));
}

static void restore(struct block *block)
{
  for (size_t s = 0; s < block->proof->slots; s++)
    if (block->kept[s] && block->array[s])
      memcpy(block->array[s], block->kept[s], BLOCK_ROOM * sizeof(double));
}

/* The same point in other company and place must give the same bits. */
static size_t differing_in_blocks(struct block *block, const struct work *work,
                                  const struct record *record)
{
  static const size_t size[] = {1, 7, 64};
  size_t different = 0;
  for (size_t k = 0; k < 3; k++)
    for (size_t from = 0; from + size[k] <= BLOCK_POINTS; from += k == 0 ? 13 : 3 * size[k] + 1) {
      move_to_front(block, from, size[k]);
      call(block, work, size[k]);
      different += differing(record, block, from, size[k]);
    }
  restore(block);
  return different;
}

struct findings {
  size_t arithmetic;
  size_t unflagged, unrepeatable, blocks, touched, left, beyond, flagged, points;
  char which[4][120];
};

static void work_round(struct block *block, const struct work *work, struct findings *f)
{
  struct record record = {0};
  int64_t excuse[BLOCK_ROOM] = {0};
  if (work->flags) {
    block_mark(block);
    bench_call(block->bench, work->flags, BLOCK_POINTS);
    memcpy(excuse, bench_status(block->bench), sizeof excuse);
  }
  call(block, work, 0);
  count_writes(block, work, 0, &f->left, &f->beyond, f->which[2], sizeof f->which[2]);
  call(block, work, 7);
  count_writes(block, work, 7, &f->left, &f->beyond, f->which[2], sizeof f->which[2]);
  f->arithmetic += !call(block, work, BLOCK_POINTS);
  record_take(&record, block);
  f->touched += touched_inputs(block, f->which[1], sizeof f->which[1]);
  count_writes(block, work, BLOCK_POINTS, &f->left, &f->beyond, f->which[2], sizeof f->which[2]);
  f->unflagged += unflagged(block, work, excuse, f->which[0], sizeof f->which[0]);
  for (size_t i = 0; i < BLOCK_POINTS; i++, f->points++)
    f->flagged += record.status[i] != 0;
  call(block, work, BLOCK_POINTS);
  f->unrepeatable += differing(&record, block, 0, BLOCK_POINTS);
  f->blocks += differing_in_blocks(block, work, &record);
  record_free(&record, block->proof->slots);
}

void prove_work(struct block *block, const struct work *work)
{
  struct checks *checks = &block->proof->checks;
  struct findings f = {0};
  check_begin(checks, "%s on blocks of points", work->label);
  for (size_t round = 0; round < 3; round++) {
    block_draw(block, round);
    work_round(block, work, &f);
  }
  check_figure(checks, (double)f.unflagged, 0,
               "%s: values neither finite nor flagged, of %zu points (%zu flagged)%s", work->label,
               f.points, f.flagged, f.which[0]);
  check_figure(checks, (double)f.unrepeatable, 0, "%s: points with other bits when called again",
               work->label);
  check_figure(checks, (double)f.blocks, 0, "%s: points with other bits in blocks of 1, 7 and 64",
               work->label);
  check_figure(checks, (double)f.touched, 0, "%s: inputs written%s", work->label, f.which[1]);
  check_figure(checks, (double)f.arithmetic, 0,
               "%s: calls that change rounding, flushing or traps", work->label);
  check_figure(checks, (double)(f.left), 0, "%s: outputs left unwritten%s", work->label,
               f.left ? f.which[2] : "");
  check_figure(checks, (double)(f.beyond), 0, "%s: values written beyond the block or undeclared%s",
               work->label, f.beyond ? f.which[2] : "");
}
