#include "boundary.gamut.h"

struct boundary_effect {
  struct gamut_run *run;
  struct gamut_plane plane;
  const struct gamut_reaction *reaction; /* null for a traction */
  double traction[3], depth;
  struct gamut_field position, volume, ratio, force;
};

static gamut_status pull(void *self, const struct gamut_chunk *chunk)
{
  const struct boundary_effect *b = self;
  const double *volume = gamut_begin(chunk, b->volume, 0), *ratio = gamut_end(chunk, b->ratio, 0);
  const double *x = gamut_end(chunk, b->position, 0), *y = gamut_end(chunk, b->position, 1),
               *z = gamut_end(chunk, b->position, 2);
  const double *n = b->plane.normal, nx = n[0], ny = n[1], nz = n[2];
  const double level = b->plane.point[0] * nx + b->plane.point[1] * ny + b->plane.point[2] * nz;
  for (int k = 0; k < 3; k++) {
    double *force = gamut_end(chunk, b->force, (unsigned)k);
    const double depth = b->depth, each = b->traction[k] / depth;
    GAMUT_EACH (i, chunk) {
      const double d = x[i] * nx + y[i] * ny + z[i] * nz - level;
      const double inside = (d >= 0.0 ? 1.0 : 0.0) * (d <= depth ? 1.0 : 0.0);
      force[i] += inside * each * volume[i] * ratio[i];
    }
  }
  return GAMUT_OK;
}

static gamut_status add_traction(struct gamut_run *run, const struct gamut_values *values,
                                 struct boundary_effect *b)
{
  static const struct gamut_use uses[] = {{"position", GAMUT_READ},
                                          {"reference_volume", GAMUT_READ_BEGIN},
                                          {"volume_ratio", GAMUT_READ},
                                          {"external_force", GAMUT_ADD}};
  static const char *const name[] = {"position", "reference_volume", "volume_ratio",
                                     "external_force"};
  struct gamut_field *const field[] = {&b->position, &b->volume, &b->ratio, &b->force};
  if (!gamut_given(values, "traction") || !gamut_given(values, "depth"))
    return gamut_fail_at(run, values, gamut_given(values, "traction") ? "depth" : "traction",
                         "traction: [..] and depth:", "a traction needs both");
  gamut_space_vector(values, "traction", b->traction);
  b->depth = gamut_real(values, "depth");
  for (int k = 0; k < 4; k++) {
    const gamut_status status = gamut_field_named(run, name[k], field[k]);
    if (status != GAMUT_OK)
      return status;
  }
  const struct gamut_task task = {.name = "traction",
                                  .phase = "forces",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = sizeof uses / sizeof *uses,
                                  .run = pull,
                                  .self = b};
  return gamut_add_task(run, &task);
}

static gamut_status add_plane(struct boundary_effect *b, enum gamut_plane_rule rule)
{
  b->plane.normal_rule = b->plane.tangential_rule = rule;
  return GAMUT_HOST(b->run)->plane(b->run, &b->plane, &b->reaction);
}

static gamut_status add_kind(struct gamut_run *run, const struct gamut_values *values,
                             struct boundary_effect *b)
{
  switch (boundary_kind_of(values)) {
  case BOUNDARY_KIND_FIXED:
    return add_plane(b, GAMUT_PLANE_PRESCRIBED);
  case BOUNDARY_KIND_SYMMETRY:
    return add_plane(b, GAMUT_PLANE_MIRROR);
  case BOUNDARY_KIND_VELOCITY:
    if (!gamut_given(values, "velocity"))
      return gamut_fail_at(run, values, "velocity", "velocity: [..]", "it is missing");
    gamut_space_vector(values, "velocity", b->plane.velocity);
    return add_plane(b, GAMUT_PLANE_PRESCRIBED);
  case BOUNDARY_KIND_TRACTION:
    return add_traction(run, values, b);
  }
  return gamut_fail(run, GAMUT_PLUGIN, "boundary does not know this kind");
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct boundary_effect *b = gamut_allocate(run, "boundary", sizeof *b);
  if (b == NULL)
    return GAMUT_INTERNAL;
  b->run = run;
  gamut_status status = gamut_read_plane(run, values, "a direction towards the material",
                                         b->plane.point, b->plane.normal);
  if (status == GAMUT_OK)
    status = add_kind(run, values, b);
  if (status != GAMUT_OK)
    gamut_release(run, b);
  else
    *self = b;
  return status;
}

GAMUT_CHOICE_IS_AXIS(BOUNDARY_FORCE_AXIS);
GAMUT_CHOICE_IS_AXIS(BOUNDARY_IMPULSE_AXIS);

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  (void)body;
  const struct boundary_effect *b = self;
  const struct gamut_reaction *r = b->reaction;
  if (r == NULL)
    return gamut_fail(b->run, GAMUT_SCENE, "a traction has no reaction: its force is stated");
  switch (boundary_measure_of(name)) {
  case BOUNDARY_MEASURE_NORMAL_FORCE:
    *value = 0.0;
    for (int k = 0; k < 3; k++)
      *value -= r->force[k] * b->plane.normal[k];
    return GAMUT_OK;
  case BOUNDARY_MEASURE_CONTACT_AREA:
    *value = r->area;
    return GAMUT_OK;
  case BOUNDARY_MEASURE_WORK:
    *value = r->work;
    return GAMUT_OK;
  case BOUNDARY_MEASURE_FORCE:
    *value = r->force[boundary_force_axis_of(arguments)];
    return GAMUT_OK;
  case BOUNDARY_MEASURE_IMPULSE:
    *value = r->impulse[boundary_impulse_axis_of(arguments)];
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}

GAMUT_EFFECT(boundary, .create = create, .measure = measure)
