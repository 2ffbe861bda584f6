/* What is live, in which order, in which sweep, stored or not. */
#include "schedule/schedule.h"

#include <string.h>

#include "tests/tap.h"

static const char *const phases[] = {"grid", "gather", "material", "after", "scatter"};

struct plan {
  struct trace *trace;
  struct fields *fields;
  struct schedule *schedule;
};

static gamut_status nothing(void *self, const struct gamut_chunk *chunk)
{
  (void)self;
  (void)chunk;
  return GAMUT_OK;
}

static struct plan make(void)
{
  struct plan plan = {trace_new(), fields_new(), schedule_new(phases, 5)};
  const char *const name[] = {"velocity", "stress", "heat", "q", "temperature", "loop_a", "loop_b"};
  for (size_t i = 0; i < sizeof name / sizeof name[0]; i++)
    fields_add(plan.fields, name[i], GAMUT_AT_POINT, 1, "1", "", plan.trace);
  return plan;
}

static void unmake(struct plan *plan)
{
  schedule_free(plan->schedule);
  fields_free(plan->fields);
  trace_free(plan->trace);
}

static void add(struct plan *plan, const char *name, const char *phase, enum gamut_extent extent,
                bool essential, const struct gamut_use *uses, size_t count)
{
  const struct gamut_task task = {.name = name,
                                  .phase = phase,
                                  .extent = extent,
                                  .uses = uses,
                                  .use_count = count,
                                  .essential = essential,
                                  .run = nothing};
  schedule_add(plan->schedule, "test", NULL, &task, plan->fields, SIZE_MAX, NULL, plan->trace);
}
#define USES(...)                                                                                  \
  (const struct gamut_use[]){__VA_ARGS__},                                                         \
      sizeof((const struct gamut_use[]){__VA_ARGS__}) / sizeof(struct gamut_use)

static const struct task *task_called(const struct plan *plan, const char *name, size_t *index)
{
  for (*index = 0; *index < schedule_tasks(plan->schedule); ++*index)
    if (strcmp(schedule_task(plan->schedule, *index)->name, name) == 0)
      return schedule_task(plan->schedule, *index);
  return NULL;
}

/* The step of a solver: registered in the wrong order on purpose. */
static void add_step(struct plan *plan)
{
  add(plan, "scatter", "scatter", GAMUT_PER_CHUNK, true,
      USES({"stress", GAMUT_READ}, {"velocity", GAMUT_READ}));
  add(plan, "leave", "scatter", GAMUT_CLOSE_BLOCK, true, NULL, 0);
  add(plan, "material", "material", GAMUT_PER_CHUNK, false,
      USES({"q", GAMUT_READ_IF}, {"stress", GAMUT_READ_BEGIN}, {"stress", GAMUT_WRITE},
           {"heat", GAMUT_WRITE}));
  add(plan, "gather", "gather", GAMUT_PER_CHUNK, true, USES({"velocity", GAMUT_WRITE}));
  add(plan, "load", "gather", GAMUT_OPEN_BLOCK, true, NULL, 0);
  add(plan, "grid", "grid", GAMUT_ONCE, true, USES({"velocity", GAMUT_READ_LAST}));
  fields_find(plan->fields, "stress")->history = true;
}

static void test_live_and_order(void)
{
  struct plan plan = make();
  size_t material, scatter, gather, heating;
  add_step(&plan);
  add(&plan, "heating", "after", GAMUT_PER_CHUNK, false,
      USES({"heat", GAMUT_READ}, {"temperature", GAMUT_WRITE}));
  gamut_status status = schedule_plan(plan.schedule, plan.fields, 1, plan.trace);
  tap_ok(status == GAMUT_OK, "a plan is made");
  const struct task *task = task_called(&plan, "material", &material);
  tap_ok(task->live, "material is live: %s", task->why);
  task = task_called(&plan, "heating", &heating);
  tap_ok(!task->live && strcmp(task->why, "nobody reads temperature") == 0, "heating is off: %s",
         task->why);
  task_called(&plan, "gather", &gather);
  task_called(&plan, "scatter", &scatter);
  tap_ok(gather < material && material < scatter && scatter < heating,
         "order by phase, the dead last: %zu %zu %zu %zu", gather, material, scatter, heating);
  tap_ok(schedule_sweeps(plan.schedule) == 2 && schedule_sweep(plan.schedule, 0)->once,
         "two sweeps: the grid, then all that works on a block (%zu)",
         schedule_sweeps(plan.schedule));
  const struct sweep *sweep = schedule_sweep(plan.schedule, 1);
  tap_ok(sweep->opens == 1 && sweep->chunks == 3 && sweep->closes == 1, "joined: %zu %zu %zu",
         sweep->opens, sweep->chunks, sweep->closes);
  tap_ok(fields_find(plan.fields, "stress")->stored, "a history is stored");
  tap_ok(fields_find(plan.fields, "velocity")->stored, "what the next step reads is stored");
  tap_ok(!fields_find(plan.fields, "heat")->stored, "what nobody reads later is not stored");
  tap_ok(!fields_find(plan.fields, "temperature")->used, "a dead task's field is not used");
  unmake(&plan);
}

static void test_wanted(void)
{
  struct plan plan = make();
  size_t index;
  add_step(&plan);
  add(&plan, "heating", "after", GAMUT_PER_CHUNK, false,
      USES({"heat", GAMUT_READ}, {"temperature", GAMUT_WRITE}));
  schedule_want(plan.schedule, fields_find(plan.fields, "temperature"), SIZE_MAX, "outputs",
                NULL, false);
  schedule_plan(plan.schedule, plan.fields, 1, plan.trace);
  const struct task *task = task_called(&plan, "heating", &index);
  tap_ok(task->live && strstr(task->why, "outputs"), "an output brings it to life: %s", task->why);
  tap_ok(fields_find(plan.fields, "temperature")->stored, "and its field is stored");
  unmake(&plan);
}

static void test_read_of_what_comes_later(void)
{
  struct plan plan = make();
  size_t index;
  add_step(&plan);
  add(&plan, "viscosity", "gather", GAMUT_PER_CHUNK, false,
      USES({"heat", GAMUT_READ}, {"q", GAMUT_WRITE}));
  schedule_plan(plan.schedule, plan.fields, 1, plan.trace);
  const struct task *task = task_called(&plan, "viscosity", &index);
  tap_ok(task->live, "material reads q, so viscosity is live");
  tap_ok(task->use[0].access == GAMUT_READ_LAST, "it reads what the last step left");
  tap_ok(fields_find(plan.fields, "heat")->stored, "which is therefore stored");
  unmake(&plan);
}

/* Two effects scale one field after the material, which reads what the step before left. */
static void test_shared(void)
{
  struct plan plan = make();
  size_t index;
  add(&plan, "material", "material", GAMUT_PER_CHUNK, true,
      USES({"heat", GAMUT_READ_IF}, {"stress", GAMUT_WRITE}));
  add(&plan, "one", "after", GAMUT_PER_CHUNK, false, USES({"heat", GAMUT_SCALE}));
  add(&plan, "two", "after", GAMUT_PER_CHUNK, false, USES({"heat", GAMUT_SCALE}));
  tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) == GAMUT_OK,
         "two tasks scale one field");
  const struct task *task = task_called(&plan, "one", &index);
  tap_ok(task->live && task->clears == 1 && task->clear[0].start == 1.0 &&
             task->clear[0].on_set[0],
         "the first one starts it at 1");
  tap_ok(task_called(&plan, "two", &index)->clears == 0, "the second one does not");
  const struct field *heat = fields_find(plan.fields, "heat");
  tap_ok(heat->stored && heat->initial == 1.0, "it is stored, and 1 before the first step");
  unmake(&plan);
  plan = make();
  add(&plan, "add", "after", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_ADD}));
  add(&plan, "scale", "after", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_SCALE}));
  tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) == GAMUT_SCENE,
         "one that adds and one that scales do not go together");
  unmake(&plan);
  plan = make();
  add(&plan, "early", "gather", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_LEAST}));
  add(&plan, "late", "after", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_LEAST}));
  add(&plan, "material", "material", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_READ_IF}));
  tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) == GAMUT_SCENE,
         "nor do such that work before and after it is read");
  const struct gamut_use least = {"heat", GAMUT_LEAST};
  const struct gamut_task once = {.name = "once", .phase = "after", .extent = GAMUT_ONCE,
                                  .uses = &least, .use_count = 1, .run = nothing};
  tap_ok(schedule_add(plan.schedule, "test", NULL, &once, plan.fields, SIZE_MAX, NULL,
                      plan.trace) == GAMUT_PLUGIN,
         "a task that sees no points cannot lower what they have");
  unmake(&plan);
}

/* On two sets; an effect writes on the first only. */
static void test_absent(void)
{
  struct plan plan = make();
  static const bool on_set[] = {true, false};
  const struct gamut_use write = {"heat", GAMUT_WRITE};
  const struct gamut_task effect = {.name = "effect", .phase = "gather", .uses = &write,
                                    .use_count = 1, .essential = true, .run = nothing};
  schedule_add(plan.schedule, "test", NULL, &effect, plan.fields, SIZE_MAX, on_set, plan.trace);
  add(&plan, "material", "material", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_READ_IF}));
  schedule_plan(plan.schedule, plan.fields, 2, plan.trace);
  const struct sweep *sweep = schedule_sweep(plan.schedule, 0);
  const size_t heat = fields_find(plan.fields, "heat")->handle.first;
  tap_ok(sweep->source[heat] == SOURCE_SCRATCH, "what an effect writes is there");
  tap_ok(sweep->source[fields_components(plan.fields) + heat] == SOURCE_NONE,
         "and absent on the set on which it does not");
  unmake(&plan);
}

/* A task between sends the reader of a state's beginning into another sweep than its writer. */
static void test_beginnings(void)
{
  for (int cut = 0; cut < 2; cut++) {
    struct plan plan = make();
    add_step(&plan);
    if (cut)
      add(&plan, "between", "after", GAMUT_ONCE, true, NULL, 0);
    add(&plan, "late", "scatter", GAMUT_PER_CHUNK, true, USES({"stress", GAMUT_READ_BEGIN}));
    tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) ==
               (cut ? GAMUT_SCENE : GAMUT_OK),
           cut ? "the beginning of a state cannot be read when it is overwritten"
               : "in the sweep of its writer it can");
    unmake(&plan);
  }
  struct plan plan = make();
  add(&plan, "gather", "gather", GAMUT_PER_CHUNK, true, USES({"velocity", GAMUT_WRITE}));
  add(&plan, "late", "after", GAMUT_PER_CHUNK, true, USES({"velocity", GAMUT_READ_BEGIN}));
  tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) == GAMUT_SCENE,
         "nor that of a field without history once it is written");
  unmake(&plan);
  plan = make();
  add_step(&plan);
  add(&plan, "between", "after", GAMUT_ONCE, true, NULL, 0);
  add(&plan, "change", "scatter", GAMUT_PER_CHUNK, true,
      USES({"stress", GAMUT_READ}, {"stress", GAMUT_WRITE}));
  schedule_plan(plan.schedule, plan.fields, 1, plan.trace);
  const size_t stress = fields_find(plan.fields, "stress")->handle.first;
  tap_ok(schedule_sweep(plan.schedule, schedule_sweeps(plan.schedule) - 1)->source[stress] ==
             SOURCE_ARRAY,
         "who changes a state in a later sweep finds what the first one left");
  unmake(&plan);
}

/* What a body gives is there for who takes it only where it is, and where others write it. */
static void test_given(void)
{
  static const bool on_set[] = {true, false};
  for (int heated = 0; heated < 2; heated++) {
    struct plan plan = make();
    const struct gamut_use write = {"temperature", GAMUT_WRITE};
    const struct gamut_task heating = {.name = "heat",
                                       .phase = "gather",
                                       .uses = &write,
                                       .use_count = 1,
                                       .essential = true,
                                       .run = nothing};
    struct field *temperature = fields_find(plan.fields, "temperature");
    temperature->given = GIVEN_BY_BODY;
    if (heated)
      schedule_add(plan.schedule, "test", NULL, &heating, plan.fields, SIZE_MAX, on_set,
                   plan.trace);
    add(&plan, "look", "material", GAMUT_PER_CHUNK, true, USES({"temperature", GAMUT_READ_IF}));
    schedule_plan(plan.schedule, plan.fields, 2, plan.trace);
    const unsigned char *source = schedule_sweep(plan.schedule, 0)->source;
    tap_ok(temperature->stored &&
               source[fields_components(plan.fields) + temperature->handle.first] == SOURCE_ARRAY,
           heated ? "temperature that is written on one body is the other's own there"
                  : "temperature is there for who reads it only if it is");
    unmake(&plan);
  }
}

static bool task_writes_field(const struct task *task, const char *field)
{
  for (size_t u = 0; u < task->uses; u++)
    if (task->use[u].access == GAMUT_WRITE && strcmp(task->use[u].field->name, field) == 0)
      return true;
  return false;
}

static void test_offers(void)
{
  struct plan plan = make();
  static const struct gamut_use heat[] = {{"heat", GAMUT_WRITE}, {"velocity", GAMUT_READ}};
  static const struct gamut_use unheard = {"unheard_of", GAMUT_READ_IF};
  static const struct gamut_use q = {"q", GAMUT_WRITE};
  size_t index;
  add(&plan, "material", "material", GAMUT_PER_CHUNK, true, USES({"stress", GAMUT_WRITE}));
  schedule_offer(plan.schedule, heat, 2);
  schedule_offer(plan.schedule, &unheard, 1);
  schedule_offer(plan.schedule, &q, 1);
  add(&plan, "gather", "gather", GAMUT_PER_CHUNK, true, USES({"velocity", GAMUT_WRITE}));
  schedule_want(plan.schedule, fields_find(plan.fields, "heat"), SIZE_MAX, "outputs", NULL, false);
  gamut_status status = schedule_plan(plan.schedule, plan.fields, 1, plan.trace);
  const struct task *task = task_called(&plan, "material", &index);
  tap_ok(status == GAMUT_OK && task_writes_field(task, "heat"),
         "an offer is taken where its field is sought");
  tap_ok(task->uses == 3 && !task_writes_field(task, "q"), "and not where nobody reads it");
  unmake(&plan);
}

static void test_faults(void)
{
  struct plan plan = make();
  add(&plan, "lonely", "gather", GAMUT_PER_CHUNK, true, USES({"heat", GAMUT_READ}));
  tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) == GAMUT_SCENE,
         "a field that nobody provides is an error");
  unmake(&plan);
  plan = make();
  add(&plan, "one", "gather", GAMUT_PER_CHUNK, true,
      USES({"loop_a", GAMUT_READ}, {"loop_b", GAMUT_WRITE}));
  add(&plan, "two", "gather", GAMUT_PER_CHUNK, true,
      USES({"loop_b", GAMUT_READ}, {"loop_a", GAMUT_WRITE}));
  tap_ok(schedule_plan(plan.schedule, plan.fields, 1, plan.trace) == GAMUT_PLUGIN,
         "tasks that wait for each other are an error");
  const struct gamut_task stray = {.name = "stray", .phase = "nowhere", .run = nothing};
  tap_ok(schedule_add(plan.schedule, "test", NULL, &stray, plan.fields, SIZE_MAX, NULL,
                      plan.trace) == GAMUT_PLUGIN,
         "an unknown phase is an error");
  unmake(&plan);
}

int main(void)
{
  test_live_and_order();
  test_wanted();
  test_read_of_what_comes_later();
  test_shared();
  test_absent();
  test_beginnings();
  test_given();
  test_offers();
  test_faults();
  return tap_done();
}
