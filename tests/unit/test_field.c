/* Arrays on demand: what is stored, rearranged, grown, and what a chunk sees. */
#include "field/field.h"

#include <string.h>

#include "tests/tap.h"

enum { POINTS = 20, CHUNK = 8 };

struct bed {
  struct trace *trace;
  struct arena *arena;
  struct fields *fields;
  struct field *mass, *stress, *rate, *step;
  struct point_set *set;
};

static struct bed make(void)
{
  struct bed bed = {.trace = trace_new(), .arena = arena_new(), .fields = fields_new()};
  bed.mass = fields_add(bed.fields, "mass", GAMUT_AT_POINT, 1, "kg", "", bed.trace);
  bed.stress = fields_add(bed.fields, "stress", GAMUT_AT_POINT, 6, "Pa", "", bed.trace);
  bed.rate = fields_add(bed.fields, "plastic_strain_rate", GAMUT_AT_POINT, 1, "1/s", "", bed.trace);
  bed.step = fields_add(bed.fields, "time_step", GAMUT_AT_RUN, 1, "s", "", bed.trace);
  bed.mass->stored = bed.stress->stored = true;
  bed.stress->history = true;
  bed.stress->initial = 3.0;
  bed.set = set_new(bed.arena, "bar", 0, 0, POINTS);
  set_allocate(bed.set, bed.fields, bed.trace);
  for (int i = 0; i < POINTS; i++)
    set_stored(bed.set, bed.mass->handle, 0)[i] = 1.0 + i;
  return bed;
}

static void test_names(struct bed *bed)
{
  unsigned k = 9;
  tap_ok(fields_component(bed->fields, "stress_xy", &k) == bed->stress && k == 3,
         "stress_xy is component %u", k);
  tap_ok(fields_component(bed->fields, "plastic_strain_rate", &k) == bed->rate && k == 0,
         "a name with '_' is not taken for a component");
  tap_ok(!fields_component(bed->fields, "stress_ab", &k), "stress_ab is none");
  tap_ok(!fields_add(bed->fields, "stress", GAMUT_AT_POINT, 1, "Pa", "", bed->trace),
         "a field cannot have 6 and 1 components");
  tap_ok(fields_of_component(bed->fields, bed->stress->handle.first + 5) == bed->stress,
         "a component knows its field");
}

/* Reverses the points into two blocks of 16 and 8 slots with padding: more slots than there were.
 */
static void test_arrange(struct bed *bed)
{
  uint32_t source[24];
  const size_t first[] = {0, 16, 24};
  for (uint32_t i = 0; i < 16; i++)
    source[i] = (uint32_t)(POINTS - 1) - i;
  for (uint32_t i = 16; i < 24; i++)
    source[i] = i < 20 ? (uint32_t)(POINTS - 1) - i : (0u | 0x80000000u);
  gamut_status status = set_arrange(bed->set, source, 24, first, 2, bed->trace);
  const double *mass = set_stored(bed->set, bed->mass->handle, 0);
  tap_ok(status == GAMUT_OK && bed->set->open.slots == 24 && bed->set->open.blocks == 2,
         "20 points fill 24 slots of 2 blocks");
  tap_ok(bed->set->id[0] == 19 && mass[0] == 20.0, "the last point is first: id %lld, mass %g",
         (long long)bed->set->id[0], mass[0]);
  tap_ok(bed->set->id[20] == -1 && mass[20] == 0.0, "padding has no id and no mass");
  tap_ok(set_find(bed->set, 0) == 19 && set_find(bed->set, 77) == SIZE_MAX,
         "a point is found by id");
  const double *stress = set_stored(bed->set, bed->stress->handle, 5);
  tap_ok(stress[23] == 3.0, "padding copies the state: %g", stress[23]);
}

/* Points leave the middle and the end of the first block, and all of the second. */
static void test_drop(struct bed *bed)
{
  const uint32_t some[] = {2, 14}, rest[] = {16, 17, 18, 19};
  const double *mass = set_stored(bed->set, bed->mass->handle, 0);
  set_drop(bed->set, some, 2);
  tap_ok(bed->set->open.points == 18 && bed->set->id[2] == 4 && mass[2] == 5.0,
         "the last point of a block takes the free slot: id %lld, mass %g",
         (long long)bed->set->id[2], mass[2]);
  tap_ok(bed->set->id[13] == 6 && bed->set->id[14] == -1 && bed->set->id[15] == -1 &&
             mass[14] == 0.0 && mass[15] == 0.0,
         "padding stays at the end of the block");
  tap_ok(set_find(bed->set, 17) == SIZE_MAX && set_find(bed->set, 5) == SIZE_MAX,
         "who left is not found");
  set_drop(bed->set, rest, 4);
  tap_ok(bed->set->open.points == 14 && bed->set->id[16] == -1 && mass[16] == 0.0,
         "a block can lose all of its points");
}

static void test_chunk(struct bed *bed)
{
  unsigned char source[9];
  double *uniform[9] = {NULL};
  double step[CHUNK] = {0.5};
  struct gamut_chunk chunk = {.set = &bed->set->open};
  struct lane_scratch *scratch = scratch_new(bed->arena, bed->fields, CHUNK);
  source[bed->mass->handle.first] = SOURCE_ARRAY;
  for (unsigned k = 0; k < 6; k++)
    source[bed->stress->handle.first + k] = SOURCE_FRESH;
  source[bed->rate->handle.first] = SOURCE_SCRATCH;
  source[bed->step->handle.first] = SOURCE_UNIFORM;
  uniform[bed->step->handle.first] = step;
  scratch_bind(scratch, bed->set, source, uniform, 8, CHUNK, &chunk);
  double *begin = gamut_begin(&chunk, bed->stress->handle, 2);
  double *end = gamut_end(&chunk, bed->stress->handle, 2);
  tap_ok(begin != end && begin == set_stored(bed->set, bed->stress->handle, 2) + 8,
         "history begins in the array and ends in scratch");
  tap_ok(gamut_end(&chunk, bed->step->handle, 0) == step, "a uniform field is one array for all");
  for (unsigned k = 0; k < 6; k++)
    for (int i = 0; i < CHUNK; i++)
      gamut_end(&chunk, bed->stress->handle, k)[i] = 10.0 * k + i;
  tap_ok(begin[7] == 3.0, "the beginning stays while the end is written");
  scratch_commit(scratch, source, &chunk);
  tap_ok(begin[7] == 27.0, "then the end becomes the beginning: %g", begin[7]);
  tap_ok(scratch_bytes(bed->fields, CHUNK) > 0, "a thread's scratch takes %zu B",
         scratch_bytes(bed->fields, CHUNK));
}

static void test_arena(void)
{
  struct arena *arena = arena_new();
  char *one = arena_take(arena, "grid", 1000), *two = arena_take(arena, "points", 24);
  const char *label;
  size_t bytes;
  tap_ok(((size_t)one & 63) == 0 && ((size_t)two & 63) == 0, "memory is 64-byte aligned");
  arena_give(arena, one);
  tap_ok(arena_bytes(arena) == 24 && arena_peak(arena) == 1024, "24 B now, 1024 B at most");
  tap_ok(arena_label(arena, 0, &label, &bytes) && strcmp(label, "grid") == 0 && bytes == 0,
         "the label 'grid' holds nothing any more");
  tap_ok(!arena_label(arena, 2, &label, &bytes), "there are two labels");
  arena_give(arena, NULL);
  arena_free(arena);
}

int main(void)
{
  struct bed bed = make();
  test_names(&bed);
  test_arrange(&bed);
  test_chunk(&bed);
  test_drop(&bed);
  test_arena();
  set_free(bed.set);
  bed.set = set_new(bed.arena, "bar", 0, 0, POINTS);
  set_allocate(bed.set, bed.fields, bed.trace);
  tap_ok(set_stored(bed.set, bed.rate->handle, 0) == NULL, "what is not stored has no array");
  set_free(bed.set);
  fields_free(bed.fields);
  arena_free(bed.arena);
  trace_free(bed.trace);
  return tap_done();
}
