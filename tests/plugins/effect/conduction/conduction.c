#include "conduction.gamut.h"

struct conduction_effect {
  struct gamut_run *run;
  double conductivity, specific_heat;
  struct gamut_formula *initial; /* null: not given */
  struct gamut_field mass, volume_ratio, position, temperature, capacity, flux, rate, heat;
  struct gamut_grid_pass *pass; /* one a body */
};

static double density(const struct conduction_effect *e, size_t set)
{
  return GAMUT_HOST(e->run)->body_density(e->run, gamut_body_at(e->run, set));
}

static void begin(const struct conduction_effect *e, const struct gamut_set *set)
{
  const struct gamut_host *host = GAMUT_HOST(e->run);
  double *temperature = host->stored(set, e->temperature, 0);
  for (size_t i = 0; i < set->slots; i++) {
    double x[3];
    for (unsigned k = 0; k < 3; k++)
      x[k] = host->stored(set, e->position, k)[i];
    temperature[i] = host->formula_value(e->initial, 0, x);
  }
}

/* Stored arrays of a set, for the first pass. */
static void show_temperature(const struct conduction_effect *e, const struct gamut_set *set,
                             struct gamut_grid_pass *pass)
{
  const struct gamut_host *host = GAMUT_HOST(e->run);
  const double *mass = host->stored(set, e->mass, 0);
  double *capacity = host->stored(set, e->capacity, 0);
  for (size_t i = 0; i < set->slots; i++)
    capacity[i] = mass[i] * e->specific_heat;
  *pass =
      (struct gamut_grid_pass){.weight = capacity, .value = host->stored(set, e->temperature, 0)};
  for (unsigned k = 0; k < 3; k++)
    pass->gradient[k] = host->stored(set, e->flux, k);
}

/* The gradient becomes the flux, which the second pass takes. */
static void show_flux(const struct conduction_effect *e, const struct gamut_set *set,
                      struct gamut_grid_pass *pass)
{
  const struct gamut_host *host = GAMUT_HOST(e->run);
  const double *ratio = host->stored(set, e->volume_ratio, 0);
  const double diffusivity = e->conductivity / (density(e, set->index) * e->specific_heat);
  *pass = (struct gamut_grid_pass){.weight = host->stored(set, e->capacity, 0),
                                   .result = host->stored(set, e->rate, 0)};
  for (unsigned k = 0; k < 3; k++) {
    double *flux = host->stored(set, e->flux, k);
    for (size_t i = 0; i < set->slots; i++)
      flux[i] *= -diffusivity * ratio[i];
    pass->flux[k] = flux;
  }
}

static gamut_status conduct(void *self, const struct gamut_chunk *chunk)
{
  (void)chunk;
  struct conduction_effect *e = self;
  const struct gamut_host *host = GAMUT_HOST(e->run);
  const size_t bodies = gamut_bodies(e->run);
  for (size_t i = 0; i < bodies && e->initial && host->step(e->run) == 0; i++)
    begin(e, host->set(e->run, i));
  for (size_t i = 0; i < bodies; i++)
    show_temperature(e, host->set(e->run, i), &e->pass[i]);
  gamut_status status = host->grid_pass(e->run, e->pass);
  for (size_t i = 0; i < bodies; i++)
    show_flux(e, host->set(e->run, i), &e->pass[i]);
  return status == GAMUT_OK ? host->grid_pass(e->run, e->pass) : status;
}

static gamut_status warm(void *self, const struct gamut_chunk *chunk)
{
  const struct conduction_effect *e = self;
  const double step = gamut_time_step(e->run);
  const double capacity = density(e, chunk->set->index) * e->specific_heat;
  const double *rate = gamut_end(chunk, e->rate, 0), *from = gamut_begin(chunk, e->temperature, 0);
  double *to = gamut_end(chunk, e->temperature, 0), *heat = gamut_end(chunk, e->heat, 0);
  for (size_t i = 0; i < chunk->count; i++) {
    to[i] = from[i] + step * rate[i];
    heat[i] += capacity * step * rate[i];
  }
  return GAMUT_OK;
}

static gamut_status find_fields(struct conduction_effect *e)
{
  const struct {
    const char *name;
    struct gamut_field *field;
  } wanted[] = {{"mass", &e->mass},
                {"volume_ratio", &e->volume_ratio},
                {"position", &e->position},
                {"temperature", &e->temperature},
                {"heat_capacity", &e->capacity},
                {"heat_flux", &e->flux},
                {"heating_rate", &e->rate},
                {"transfer_heat", &e->heat}};
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted && status == GAMUT_OK; i++)
    status = gamut_field_named(e->run, wanted[i].name, wanted[i].field);
  return status;
}

static gamut_status add_tasks(struct conduction_effect *e)
{
  /* who sets the temperature first leaves no beginning of it */
  const enum gamut_access found = e->initial ? GAMUT_READ : GAMUT_READ_BEGIN;
  const struct gamut_use flows[] = {
      {"temperature", GAMUT_READ_BEGIN},  {"mass", GAMUT_READ_BEGIN},
      {"volume_ratio", GAMUT_READ_BEGIN}, {"position", GAMUT_READ_BEGIN},
      {"heat_capacity", GAMUT_WRITE},     {"heat_flux", GAMUT_WRITE},
      {"heating_rate", GAMUT_WRITE},      {"temperature", GAMUT_WRITE}};
  const struct gamut_use warms[] = {{"heating_rate", GAMUT_READ},
                                    {"temperature", found},
                                    {"temperature", GAMUT_WRITE},
                                    {"transfer_heat", GAMUT_ADD}};
  const struct gamut_task flow = {.name = "conduct",
                                  .phase = "grid",
                                  .extent = GAMUT_ONCE,
                                  .uses = flows,
                                  .use_count = sizeof flows / sizeof *flows - (e->initial ? 0 : 1),
                                  .run = conduct,
                                  .self = e};
  const struct gamut_task heating = {.name = "warm",
                                     .phase = "after material",
                                     .extent = GAMUT_PER_CHUNK,
                                     .uses = warms,
                                     .use_count = sizeof warms / sizeof *warms,
                                     .run = warm,
                                     .self = e};
  const gamut_status status = gamut_add_task(e->run, &flow);
  return status == GAMUT_OK ? gamut_add_task(e->run, &heating) : status;
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct conduction_effect *e = gamut_allocate(run, "conduction", sizeof *e);
  if (!e)
    return GAMUT_INTERNAL;
  e->run = run;
  e->conductivity = gamut_real(values, "conductivity");
  e->specific_heat = gamut_real(values, "specific_heat");
  e->pass = gamut_allocate(run, "conduction", gamut_bodies(run) * sizeof *e->pass);
  gamut_status status = e->pass ? find_fields(e) : GAMUT_INTERNAL;
  if (status == GAMUT_OK)
    status = GAMUT_HOST(run)->formula(run, values, "initial", &e->initial);
  if (status == GAMUT_OK)
    status = add_tasks(e);
  if (status != GAMUT_OK) {
    gamut_release(run, e->pass);
    gamut_release(run, e);
  } else {
    *self = e;
  }
  return status;
}

static void destroy(void *self)
{
  struct conduction_effect *e = self;
  if (!e)
    return;
  gamut_release(e->run, e->pass);
  gamut_release(e->run, e);
}

GAMUT_EFFECT(conduction, .create = create, .destroy = destroy)
