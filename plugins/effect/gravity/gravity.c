#include <stdio.h>

#include "gravity.gamut.h"

struct gravity_effect {
  double acceleration[3];
  struct gamut_field mass, force;
};

static gamut_status pull(void *self, const struct gamut_chunk *chunk)
{
  const struct gravity_effect *effect = self;
  const double *mass = gamut_begin(chunk, effect->mass, 0);
  for (unsigned k = 0; k < 3; k++) {
    double g = effect->acceleration[k];
    double *force = gamut_end(chunk, effect->force, k);
    GAMUT_EACH (i, chunk)
      force[i] += mass[i] * g;
  }
  return GAMUT_OK;
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  static const struct gamut_use uses[] = {{"mass", GAMUT_READ_BEGIN},
                                          {"external_force", GAMUT_ADD}};
  struct gravity_effect *effect = gamut_allocate(run, "gravity", sizeof *effect);
  if (!effect)
    return GAMUT_INTERNAL;
  gamut_space_vector(values, "acceleration", effect->acceleration);
  gamut_status status = gamut_field_named(run, "mass", &effect->mass);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "external_force", &effect->force);
  const struct gamut_task task = {.name = "gravity",
                                  .phase = "forces",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = sizeof uses / sizeof uses[0],
                                  .run = pull,
                                  .self = effect};
  if (status == GAMUT_OK)
    status = gamut_add_task(run, &task);
  if (status != GAMUT_OK)
    gamut_release(run, effect);
  else
    *self = effect;
  return status;
}

static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)
{
  (void)self;
  size_t count;
  const double *acceleration = gamut_vector(values, "acceleration", &count);
  for (size_t k = 0; k < count; k++)
    if (acceleration[k] != 0.0)
      return false;
  snprintf(why, size, "acceleration = 0");
  return true;
}

GAMUT_EFFECT(gravity, .create = create, .decline = decline)
