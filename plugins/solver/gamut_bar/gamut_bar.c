#include <stdio.h>
#include <string.h>

#include "bar.h"
#include "restart.h"

double *bar_array(struct bar *bar, const char *label)
{
  return gamut_allocate(bar->run, label, bar->bonds * sizeof(double));
}

/* The core frees what was allocated for the run. */
static void destroy(void *self)
{
  (void)self;
}

static gamut_status take_arrays(struct bar *bar)
{
  static const char label[] = "bonds";
  double **array[] = {&bar->length,     &bar->place,        &bar->section,  &bar->volume,
                      &bar->stiffness,  &bar->mass_density, &bar->softness, &bar->yield_factor,
                      &bar->limit,      &bar->spread,       &bar->scale,    &bar->root,
                      &bar->softening,  &bar->internal,     &bar->flow,     &bar->stress,
                      &bar->old_stress, &bar->strain};
  for (size_t k = 0; k < sizeof array / sizeof array[0]; k++)
    if (!(*array[k] = bar_array(bar, label)))
      return GAMUT_INTERNAL;
  for (size_t k = 0; k < sizeof bar->work / sizeof bar->work[0]; k++)
    if (!(bar->work[k] = bar_array(bar, "work space")))
      return GAMUT_INTERNAL;
  return GAMUT_OK;
}

/* A figure of the law that may be absent, for this law or in this scene. */
static double law_figure(const struct bar *bar, const char *name)
{
  const double *array = GAMUT_HOST(bar->run)->law_array(bar->families.law[0].law, name);
  return array ? array[0] : NAN;
}

static gamut_status read_material(struct bar *bar)
{
  const struct gamut_values *own = GAMUT_HOST(bar->run)->body_values(bar->body);
  bar->density = GAMUT_HOST(bar->run)->body_density(bar->run, bar->body);
  bar->modulus = law_figure(bar, "youngs_modulus");
  if (gamut_given(own, "youngs_modulus"))
    bar->modulus = gamut_real(own, "youngs_modulus");
  bar->yield = law_figure(bar, "yield_stress");
  bar->failure_stress = law_figure(bar, "failure_stress");
  bar->failure_strain = law_figure(bar, "failure_strain");
  /* The two figures that make the curve one of Ramberg and Osgood. */
  bool curve = !isnan(bar->modulus) && !isnan(law_figure(bar, "K"));
  bar->n = curve ? law_figure(bar, "n") : NAN;
  bar->K = curve ? law_figure(bar, "K") : NAN;
  if (!(bar->modulus > 0.0))
    return gamut_fail_at(bar->run, own, "youngs_modulus", "such as '70 GPa'",
                         "'youngs_modulus' is missing: the strength of body '%s' has none",
                         GAMUT_HOST(bar->run)->body_name(bar->body));
  return GAMUT_OK;
}

/* Turns that a family must remember at once: those of the load within itself, and a few more. */
static size_t memory_depth(const struct bar *bar)
{
  enum { SPARE = 4, MOST = 64 };
  size_t rows, depth = SPARE;
  gamut_table(bar->values, "load_table", &rows);
  if (gamut_bar_load_of(bar->values) == GAMUT_BAR_LOAD_TABLE)
    depth += rows;
  switch (gamut_bar_dynamics_of(bar->values)) {
  case GAMUT_BAR_DYNAMICS_OFF:
    break;
  case GAMUT_BAR_DYNAMICS_BACKWARD_EULER:
    depth = MOST; /* a bar that comes to rest turns within itself */
    break;
  }
  return depth < MOST ? depth : MOST;
}

static gamut_status step(void *self, const struct gamut_chunk *chunk)
{
  struct bar *bar = self;
  double before = bar->force, strain = bar->mean_strain;
  (void)chunk;
  memcpy(bar->old_stress, bar->stress, bar->bonds * sizeof *bar->stress);
  gamut_status status = equilibrium(bar, bar->next_stress * bar->area);
  if (status != GAMUT_OK)
    return status;
  ledger_step(bar, before, strain);
  bar->loop.area += 0.5 * (before / bar->area + bar->nominal_stress) * (bar->mean_strain - strain);
  if (bar->dynamic)
    inertia_commit(bar);
  status = families_commit(bar, bar->internal);
  load_stepped(bar);
  bonds_look(bar);
  show_positions(bar);
  return status;
}

static gamut_status add_step(struct bar *bar)
{
  static const struct gamut_use use = {"position", GAMUT_WRITE};
  const struct gamut_task task = {.name = "equilibrium",
                                  .phase = "equilibrium",
                                  .extent = GAMUT_ONCE,
                                  .uses = &use,
                                  .use_count = 1,
                                  .essential = true,
                                  .run = step,
                                  .self = bar};
  gamut_status status = gamut_field_named(bar->run, "position", &bar->position);
  if (status == GAMUT_OK)
    status = gamut_add_task(bar->run, &task);
  return status == GAMUT_OK ? show_new(bar) : status;
}

static gamut_status read_body(struct bar *bar)
{
  struct gamut_run *run = bar->run;
  const struct gamut_host *host = GAMUT_HOST(run);
  if (gamut_bodies(run) == 0)
    return gamut_fail(run, GAMUT_SCENE, "solver/gamut_bar takes one body, the bar; there is none");
  if (gamut_bodies(run) > 1)
    return gamut_fail_at(run, host->body_values(gamut_body_at(run, 1)), "", "one body",
                         "solver/gamut_bar takes one body, the bar; there are %zu",
                         gamut_bodies(run));
  bar->body = gamut_body_at(run, 0);
  const struct gamut_values *own = host->body_values(bar->body);
  bar->span = gamut_real(own, "length");
  bar->area = gamut_real(own, "area");
  return gamut_points(run, bar->body, bar->bonds, &bar->set);
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct bar *bar = gamut_allocate(run, "bonds", sizeof *bar);
  if (!bar)
    return GAMUT_INTERNAL;
  *bar = (struct bar){.run = run,
                      .values = values,
                      .threads = gamut_threads(run),
                      .bonds = (size_t)gamut_integer(values, "bonds")};
  GAMUT_HOST(run)->fixed_steps(run);
  gamut_status status = read_body(bar);
  if (status == GAMUT_OK)
    status = take_arrays(bar);
  if (status == GAMUT_OK)
    status = families_new(bar, memory_depth(bar));
  if (status == GAMUT_OK)
    status = read_material(bar);
  if (status == GAMUT_OK)
    status = load_new(bar);
  if (status == GAMUT_OK)
    status = add_step(bar);
  *self = bar;
  return status;
}

/* One block holds the bonds in their order. */
static gamut_status arrange(struct bar *bar)
{
  static const uint32_t padding = UINT32_C(0x80000000);
  size_t slots = (bar->bonds + GAMUT_LANES - 1) / GAMUT_LANES * GAMUT_LANES;
  const size_t first[] = {0, slots};
  uint32_t *source = gamut_allocate(bar->run, "order", slots * sizeof *source);
  if (!source)
    return GAMUT_INTERNAL;
  for (size_t i = 0; i < slots; i++)
    source[i] = i < bar->bonds ? (uint32_t)i : padding | (uint32_t)(bar->bonds - 1);
  gamut_status status = GAMUT_HOST(bar->run)->arrange(bar->run, bar->set, source, slots, first, 1);
  gamut_release(bar->run, source);
  return status;
}

static gamut_status start(void *self)
{
  struct bar *bar = self;
  gamut_status status = arrange(bar);
  if (status == GAMUT_OK)
    status = families_start(bar);
  if (status == GAMUT_OK)
    status = grid_new(bar);
  if (status == GAMUT_OK)
    status = softness_new(bar);
  if (status == GAMUT_OK)
    status = weights_new(bar);
  if (status == GAMUT_OK)
    status = inertia_new(bar);
  if (status == GAMUT_OK)
    status = ledger_new(bar);
  if (status == GAMUT_OK)
    show_start(bar);
  return status;
}

static gamut_status next(void *self, double *step)
{
  struct bar *bar = self;
  *step = load_next(bar, &bar->next_stress) ? 1.0 : 0.0;
  return GAMUT_OK;
}

static gamut_status describe(void *self, double *step, char *text, size_t size)
{
  const struct bar *bar = self;
  *step = 1.0;
  snprintf(text, size, "the path of the load; %s operator", bar->operator_name);
  return GAMUT_OK;
}

GAMUT_SOLVER(gamut_bar, .create = create, .destroy = destroy, .start = start, .next = next,
             .measure = measure_bar, .describe = describe, .save = bar_save, .restore = bar_restore)
