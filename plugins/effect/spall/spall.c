#include "spall.gamut.h"

struct spall_effect {
  struct gamut_run *run;
  double limit;
  double tears; /* 1; 0: tension is cut at the limit */
  struct gamut_field stress, energy, volume_ratio, gradient, viscous, damage;
};

static gamut_status cut(void *self, const struct gamut_chunk *chunk)
{
  static const unsigned mate[6][2] = {{0, 0}, {4, 4}, {8, 8}, {1, 3}, {5, 7}, {6, 2}};
  const struct spall_effect *e = self;
  const double half_step = 0.5 * gamut_time_step(e->run), limit = e->limit, tears = e->tears;
  const double *J0 = gamut_begin(chunk, e->volume_ratio, 0);
  const double *J1 = gamut_end(chunk, e->volume_ratio, 0);
  const double *torn = gamut_begin(chunk, e->damage, 0);
  const double *viscous = gamut_end(chunk, e->viscous, 0); /* null without viscosity */
  double *s[6], *energy = gamut_end(chunk, e->energy, 0), *now = gamut_end(chunk, e->damage, 0);
  for (unsigned k = 0; k < 6; k++)
    s[k] = gamut_end(chunk, e->stress, k);
  for (size_t i = 0; i < chunk->count; i++) {
    const double q = viscous ? viscous[i] : 0.0;
    const double p = -(s[0][i] + s[1][i] + s[2][i]) * (1.0 / 3.0) - q;
    const bool past = p < -limit;
    now[i] = torn[i] > 0.0 || past ? tears : 0.0;
    const bool loose = now[i] > 0.0;
    if (!loose && !past)
      continue;
    const double least = loose ? 0.0 : -limit, left = p > least ? p : least;
    double work = 0.0;
    for (unsigned k = 0; k < 6; k++) {
      const double normal = k < 3 ? 1.0 : 0.0, deviator = s[k][i] + normal * (p + q);
      const double rate = gamut_end(chunk, e->gradient, mate[k][0])[i] +
                          gamut_end(chunk, e->gradient, mate[k][1])[i];
      work += (k < 3 ? 0.5 : 1.0) * deviator * rate;
      s[k][i] = (loose ? 0.0 : deviator) - normal * (left + q);
    }
    energy[i] += 0.5 * (p - left) * (J1[i] - J0[i]);
    if (loose)
      energy[i] -= half_step * 0.5 * (J0[i] + J1[i]) * work;
  }
  return GAMUT_OK;
}

static gamut_status add_task(struct gamut_run *run, struct spall_effect *effect)
{
  static const struct gamut_use uses[] = {
      {"stress", GAMUT_READ},  {"stress", GAMUT_WRITE},           {"energy", GAMUT_READ},
      {"energy", GAMUT_WRITE}, {"volume_ratio", GAMUT_READ_BEGIN}, {"volume_ratio", GAMUT_READ},
      {"velocity_gradient", GAMUT_READ}, {"viscous_pressure", GAMUT_READ_IF},
      {"damage", GAMUT_READ_BEGIN}, {"damage", GAMUT_WRITE}};
  static const char *const name[] = {"stress", "energy", "volume_ratio", "velocity_gradient",
                                     "viscous_pressure", "damage"};
  struct gamut_field *const field[] = {&effect->stress, &effect->energy, &effect->volume_ratio,
                                       &effect->gradient, &effect->viscous, &effect->damage};
  for (int k = 0; k < 6; k++) {
    const gamut_status status = gamut_field_named(run, name[k], field[k]);
    if (status != GAMUT_OK)
      return status;
  }
  const struct gamut_task task = {.name = "spall",
                                  .phase = "after material",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = sizeof uses / sizeof *uses,
                                  .run = cut,
                                  .self = effect};
  return gamut_add_task(run, &task);
}

static gamut_status read_mode(struct gamut_run *run, const struct gamut_values *values,
                              double *tears)
{
  switch (spall_mode_of(values)) {
  case SPALL_MODE_TEAR:
    *tears = 1.0;
    return GAMUT_OK;
  case SPALL_MODE_CUTOFF:
    *tears = 0.0;
    return GAMUT_OK;
  }
  return gamut_fail(run, GAMUT_PLUGIN, "spall does not know this mode");
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct spall_effect *effect = gamut_allocate(run, "spall", sizeof *effect);
  if (!effect)
    return GAMUT_INTERNAL;
  effect->run = run;
  effect->limit = gamut_real(values, "limit");
  gamut_status status = read_mode(run, values, &effect->tears);
  if (status == GAMUT_OK)
    status = add_task(run, effect);
  if (status != GAMUT_OK)
    gamut_release(run, effect);
  else
    *self = effect;
  return status;
}

GAMUT_EFFECT(spall, .create = create)
