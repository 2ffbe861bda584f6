#include <string.h>

#include "rigid_wall.gamut.h"

struct wall {
  double normal[3];
  const struct gamut_reaction *reaction;
};

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct gamut_plane plane = {.normal_rule = GAMUT_PLANE_MIRROR,
                              .tangential_rule = GAMUT_PLANE_MIRROR,
                              .unilateral = gamut_boolean(values, "unilateral"),
                              .friction = gamut_real(values, "friction")};
  struct wall *wall = gamut_allocate(run, "rigid wall", sizeof *wall);
  if (wall == NULL)
    return GAMUT_INTERNAL;
  gamut_status status = gamut_read_plane(run, values, "a direction towards the material",
                                         plane.point, plane.normal);
  if (gamut_given(values, "velocity"))
    gamut_space_vector(values, "velocity", plane.velocity);
  memcpy(wall->normal, plane.normal, sizeof wall->normal);
  if (status == GAMUT_OK)
    status = GAMUT_HOST(run)->plane(run, &plane, &wall->reaction);
  if (status != GAMUT_OK)
    gamut_release(run, wall);
  else
    *self = wall;
  return status;
}

GAMUT_CHOICE_IS_AXIS(RIGID_WALL_FORCE_AXIS);
GAMUT_CHOICE_IS_AXIS(RIGID_WALL_IMPULSE_AXIS);

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  (void)body;
  const struct wall *wall = self;
  const struct gamut_reaction *r = wall->reaction;
  switch (rigid_wall_measure_of(name)) {
  case RIGID_WALL_MEASURE_NORMAL_FORCE:
    *value = 0.0;
    for (int k = 0; k < 3; k++)
      *value -= r->force[k] * wall->normal[k];
    return GAMUT_OK;
  case RIGID_WALL_MEASURE_CONTACT_AREA:
    *value = r->area;
    return GAMUT_OK;
  case RIGID_WALL_MEASURE_WORK:
    *value = r->work;
    return GAMUT_OK;
  case RIGID_WALL_MEASURE_FORCE:
    *value = r->force[rigid_wall_force_axis_of(arguments)];
    return GAMUT_OK;
  case RIGID_WALL_MEASURE_IMPULSE:
    *value = r->impulse[rigid_wall_impulse_axis_of(arguments)];
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}

GAMUT_EFFECT(rigid_wall, .create = create, .measure = measure)
