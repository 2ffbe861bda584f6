#include "outflow.gamut.h"

struct outflow_effect {
  double normal[3], level; /* of the plane: level = point . normal */
  double mark;
  const struct gamut_removed *left;
  struct gamut_field position, removal;
};

static gamut_status take(void *self, const struct gamut_chunk *chunk)
{
  const struct outflow_effect *e = self;
  const double *x = gamut_end(chunk, e->position, 0), *y = gamut_end(chunk, e->position, 1),
               *z = gamut_end(chunk, e->position, 2);
  const double nx = e->normal[0], ny = e->normal[1], nz = e->normal[2], level = e->level;
  const double mark = e->mark;
  double *removal = gamut_end(chunk, e->removal, 0);
  GAMUT_EACH (i, chunk) {
    const bool goes = x[i] * nx + y[i] * ny + z[i] * nz < level;
    removal[i] = goes && removal[i] == 0.0 ? mark : removal[i];
  }
  return GAMUT_OK;
}

static gamut_status read_plane(struct gamut_run *run, const struct gamut_values *values,
                               struct outflow_effect *e)
{
  double point[3];
  const gamut_status status = gamut_read_plane(
      run, values, "a direction towards the material that stays", point, e->normal);
  for (size_t k = 0; k < 3; k++)
    e->level += point[k] * e->normal[k];
  return status;
}

static gamut_status open_task(struct gamut_run *run, struct outflow_effect *e)
{
  static const struct gamut_use uses[] = {{"position", GAMUT_READ}, {"removal", GAMUT_ADD}};
  static const struct gamut_removal rule = {.expected = true};
  const struct gamut_task task = {.name = "outflow",
                                  .phase = "removal",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = sizeof uses / sizeof *uses,
                                  .run = take,
                                  .self = e};
  gamut_status status = GAMUT_HOST(run)->removal(run, &rule, &e->left, &e->mark);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "position", &e->position);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "removal", &e->removal);
  return status == GAMUT_OK ? gamut_add_task(run, &task) : status;
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct outflow_effect *e = gamut_allocate(run, "outflow", sizeof *e);
  if (e == NULL)
    return GAMUT_INTERNAL;
  gamut_status status = read_plane(run, values, e);
  if (status == GAMUT_OK)
    status = open_task(run, e);
  if (status != GAMUT_OK)
    gamut_release(run, e);
  else
    *self = e;
  return status;
}

GAMUT_CHOICE_IS_AXIS(OUTFLOW_LEFT_MOMENTUM_AXIS);

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  (void)body;
  const struct outflow_effect *e = self;
  const struct gamut_removed *left = e->left;
  switch (outflow_measure_of(name)) {
  case OUTFLOW_MEASURE_LEFT_MASS:
    *value = left->mass;
    return GAMUT_OK;
  case OUTFLOW_MEASURE_LEFT_MOMENTUM:
    *value = left->momentum[outflow_left_momentum_axis_of(arguments)];
    return GAMUT_OK;
  case OUTFLOW_MEASURE_LEFT_ENERGY:
    *value = left->kinetic + left->internal;
    return GAMUT_OK;
  case OUTFLOW_MEASURE_LEFT_POINTS:
    *value = left->points;
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}

GAMUT_EFFECT(outflow, .create = create, .measure = measure)
