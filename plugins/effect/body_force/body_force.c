#include <stdio.h>

#include "body_force.gamut.h"

enum { PLACE, FIRST_PLACE = 3, TIME = 6, VARIABLES };

static const char *const component[] = {"acceleration.x", "acceleration.y", "acceleration.z"};

struct body_force_effect {
  struct gamut_run *run;
  struct gamut_formula *formula[3]; /* null: zero */
  bool from_first;                  /* some formula uses the first position */
  struct gamut_field mass, force, position, first;
};

static gamut_status push(void *self, const struct gamut_chunk *chunk)
{
  const struct body_force_effect *effect = self;
  const struct gamut_host *host = GAMUT_HOST(effect->run);
  const double *mass = gamut_begin(chunk, effect->mass, 0);
  double at[VARIABLES] = {0};
  at[TIME] = gamut_time(effect->run) + gamut_time_step(effect->run);
  for (size_t i = 0; i < chunk->count; i++) {
    for (unsigned k = 0; k < 3; k++) {
      at[PLACE + k] = gamut_end(chunk, effect->position, k)[i];
      if (effect->from_first)
        at[FIRST_PLACE + k] = gamut_begin(chunk, effect->first, k)[i];
    }
    for (unsigned k = 0; k < 3; k++)
      if (effect->formula[k])
        gamut_end(chunk, effect->force, k)[i] +=
            mass[i] * host->formula_value(effect->formula[k], chunk->thread, at);
  }
  return GAMUT_OK;
}

static gamut_status add_task(struct gamut_run *run, struct body_force_effect *effect)
{
  static const struct gamut_use uses[] = {{"mass", GAMUT_READ_BEGIN},
                                          {"external_force", GAMUT_ADD},
                                          {"position", GAMUT_READ},
                                          {"first_position", GAMUT_READ_BEGIN}};
  const struct gamut_task task = {.name = "body force",
                                  .phase = "forces",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = effect->from_first ? 4 : 3,
                                  .run = push,
                                  .self = effect};
  gamut_status status = gamut_field_named(run, "mass", &effect->mass);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "external_force", &effect->force);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "position", &effect->position);
  if (status == GAMUT_OK && effect->from_first)
    status = gamut_field_named(run, "first_position", &effect->first);
  return status == GAMUT_OK ? gamut_add_task(run, &task) : status;
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  const struct gamut_host *host = GAMUT_HOST(run);
  gamut_status status = GAMUT_OK;
  struct body_force_effect *effect = gamut_allocate(run, "body force", sizeof *effect);
  if (!effect)
    return GAMUT_INTERNAL;
  effect->run = run;
  for (int k = 0; k < 3 && status == GAMUT_OK; k++) {
    status = host->formula(run, values, component[k], &effect->formula[k]);
    for (size_t v = FIRST_PLACE; v < TIME && effect->formula[k]; v++)
      effect->from_first |= host->formula_uses(effect->formula[k], v);
  }
  if (status == GAMUT_OK)
    status = add_task(run, effect);
  if (status != GAMUT_OK)
    gamut_release(run, effect);
  else
    *self = effect;
  return status;
}

static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)
{
  (void)self;
  for (int k = 0; k < 3; k++)
    if (gamut_given(values, component[k]))
      return false;
  snprintf(why, size, "no component of the acceleration is given");
  return true;
}

GAMUT_EFFECT(body_force, .create = create, .decline = decline)
