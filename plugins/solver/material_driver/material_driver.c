#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "driver.h"

static void destroy(void *self)
{
  struct driver *driver = self;
  if (!driver)
    return;
  path_free(&driver->path);
  free(driver->point);
  free(driver->set);
  free(driver);
}

static gamut_status make_points(struct driver *driver)
{
  struct gamut_run *run = driver->run;
  driver->points = gamut_bodies(run);
  driver->point = calloc(driver->points + 1, sizeof *driver->point);
  driver->set = calloc(driver->points + 1, sizeof *driver->set);
  if (!driver->point || !driver->set)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < driver->points; i++) {
    const struct gamut_body *body = gamut_body_at(run, i);
    driver->point[i].body = GAMUT_HOST(run)->body_name(body);
    gamut_status status = gamut_points(run, body, 1, &driver->set[i]);
    if (status != GAMUT_OK)
      return status;
  }
  return GAMUT_OK;
}

static gamut_status name_fields(struct driver *driver)
{
  struct gamut_run *run = driver->run;
  gamut_status status = gamut_field_named(run, "velocity_gradient", &driver->velocity_gradient);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "stress", &driver->stress);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "energy", &driver->energy);
  if (status == GAMUT_OK)
    status = gamut_field_named(run, "cell_size", &driver->cell_size);
  return status;
}

static gamut_status add_task(struct driver *driver)
{
  const struct gamut_use uses[] = {
      {"velocity_gradient", GAMUT_WRITE}, {"stress", GAMUT_READ_BEGIN}, {"energy", GAMUT_READ_IF}};
  const struct gamut_task task = {.name = "drive",
                                  .phase = "drive",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = sizeof uses / sizeof uses[0],
                                  .essential = true,
                                  .material = true,
                                  .run = drive,
                                  .self = driver};
  return gamut_add_task(driver->run, &task);
}

/* The work is a trapezoid over the step, so it differs from what the material books as energy: the
 * remainder shows by how much. */
static gamut_status open_ledger(struct driver *driver)
{
  static const char account[] = "internal_energy", unit[] = "J/m3";
  struct gamut_run *run = driver->run;
  const struct gamut_host *host = GAMUT_HOST(run);
  gamut_status status =
      host->ledger(run, account, "internal", unit, GAMUT_STORED, &driver->internal);
  if (status == GAMUT_OK)
    status = host->ledger(run, account, "stress_work", unit, GAMUT_SUPPLIED, &driver->supplied);
  if (status == GAMUT_OK)
    status = host->ledger(run, account, "stress_remainder", unit, GAMUT_LOST, &driver->lost);
  return status;
}

static double step_of(const struct gamut_values *values)
{
  if (gamut_given(values, "steps"))
    return gamut_real(values, "end") / (double)gamut_integer(values, "steps");
  return gamut_real(values, "step");
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct driver *driver = calloc(1, sizeof *driver);
  *self = NULL;
  if (!driver)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  driver->run = run;
  driver->values = values;
  driver->step = step_of(values);
  GAMUT_HOST(run)->fixed_steps(run);
  gamut_status status = path_read(run, values, &driver->path);
  if (status == GAMUT_OK)
    status = make_points(driver);
  if (status == GAMUT_OK)
    status = name_fields(driver);
  if (status == GAMUT_OK)
    status = add_task(driver);
  if (status == GAMUT_OK)
    status = open_ledger(driver);
  if (status == GAMUT_OK)
    *self = driver;
  else
    destroy(driver);
  return status;
}

static double energy_at_start(const struct driver *driver, size_t i)
{
  const double *energy = GAMUT_HOST(driver->run)->stored(driver->set[i], driver->energy, 0);
  return energy ? energy[0] : 0.0;
}

static gamut_status start(void *self)
{
  struct driver *driver = self;
  struct gamut_run *run = driver->run;
  static const size_t first[] = {0, GAMUT_LANES};
  uint32_t source[GAMUT_LANES];
  for (uint32_t i = 0; i < GAMUT_LANES; i++)
    source[i] = i ? UINT32_C(0x80000000) : 0;
  *driver->internal = 0.0;
  if (gamut_given(driver->values, "cell"))
    GAMUT_HOST(run)->set_uniform(run, driver->cell_size, gamut_real(driver->values, "cell"));
  for (size_t i = 0; i < driver->points; i++) {
    gamut_status status =
        GAMUT_HOST(run)->arrange(run, driver->set[i], source, GAMUT_LANES, first, 1);
    if (status == GAMUT_OK)
      status = GAMUT_HOST(run)->start_material(run, driver->set[i]);
    if (status != GAMUT_OK)
      return status;
    driver->point[i].energy = energy_at_start(driver, i);
    *driver->internal += driver->point[i].energy;
  }
  return GAMUT_OK;
}

/* Steps end at multiples of the step, not at sums of it. */
static gamut_status next(void *self, double *step)
{
  struct driver *driver = self;
  double until = (double)(GAMUT_HOST(driver->run)->step(driver->run) + 1) * driver->step;
  double want = until - gamut_time(driver->run);
  *step = want > 0.0 && want < *step ? want : *step;
  return GAMUT_OK;
}

static gamut_status report(const struct driver *driver, const struct point *point)
{
  double end = gamut_time(driver->run);
  if (!point->finite)
    return gamut_fail(driver->run, GAMUT_NUMERICS,
                      "the stress of body '%s' is not a number at t = %g s, where %s is to be "
                      "%g Pa",
                      point->body, end, point->failed, point->wanted);
  return gamut_fail(driver->run, GAMUT_NUMERICS,
                    "stress %s of body '%s' cannot be brought to %g Pa at t = %g s: %g Pa are "
                    "lacking. The material may be unable to carry it, or the step be too long",
                    point->failed, point->body, point->wanted, end, point->left);
}

static gamut_status after(void *self)
{
  struct driver *driver = self;
  double before = *driver->internal, internal = 0.0, work = 0.0;
  for (size_t i = 0; i < driver->points; i++) {
    struct point *point = &driver->point[i];
    if (point->failed)
      return report(driver, point);
    memcpy(point->H, point->H_end, sizeof point->H);
    point->work += point->work_step;
    work += point->work_step;
    internal += point->energy;
  }
  *driver->internal = internal;
  *driver->supplied += work;
  *driver->lost += work - (internal - before);
  return GAMUT_OK;
}

_Static_assert(MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_CHOICES == SYMMETRIC &&
                   MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_XX == 0 &&
                   MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_YY == 1 &&
                   MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_ZZ == 2 &&
                   MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_XY == 3 &&
                   MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_YZ == 4 &&
                   MATERIAL_DRIVER_LOG_STRAIN_COMPONENT_ZX == 5,
               "components as tensors have them");

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  static const size_t place[] = {0, 4, 8, 1, 5, 6}, mirror[] = {0, 4, 8, 3, 7, 2};
  struct driver *driver = self;
  const char *body_name = GAMUT_HOST(driver->run)->body_name(body);
  const struct point *point = driver->point;
  double strain[SYMMETRIC];
  while (strcmp(point->body, body_name) != 0)
    point++;
  switch (material_driver_measure_of(name)) {
  case MATERIAL_DRIVER_MEASURE_WORK:
    *value = point->work;
    return GAMUT_OK;
  case MATERIAL_DRIVER_MEASURE_LOG_STRAIN:
    log_strain(point->H, strain);
    *value = strain[material_driver_log_strain_component_of(arguments)];
    return GAMUT_OK;
  case MATERIAL_DRIVER_MEASURE_ENGINEERING_STRAIN: {
    const size_t c = (size_t)material_driver_engineering_strain_component_of(arguments);
    *value = point->H[place[c]] + (c < NORMALS ? 0.0 : point->H[mirror[c]]);
    return GAMUT_OK;
  }
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}

static gamut_status describe(void *self, double *step, char *text, size_t size)
{
  const struct driver *driver = self;
  *step = driver->step;
  snprintf(text, size, "the scene's step");
  return GAMUT_OK;
}

struct saved_point {
  double H[9], rate[SYMMETRIC], energy, work;
  uint64_t moved;
};

static size_t save(const void *self, void *bytes)
{
  const struct driver *driver = self;
  unsigned char *to = bytes;
  for (size_t i = 0; to && i < driver->points; i++) {
    const struct point *p = &driver->point[i];
    struct saved_point saved = {.energy = p->energy, .work = p->work, .moved = p->moved};
    memcpy(saved.H, p->H, sizeof saved.H);
    memcpy(saved.rate, p->rate, sizeof saved.rate);
    memcpy(to + sizeof driver->step + i * sizeof saved, &saved, sizeof saved);
  }
  if (to)
    memcpy(to, &driver->step, sizeof driver->step);
  return sizeof driver->step + driver->points * sizeof(struct saved_point);
}

static gamut_status restore(void *self, const void *bytes, size_t size)
{
  struct driver *driver = self;
  const unsigned char *from = bytes;
  double step;
  if (size != save(driver, NULL))
    return gamut_fail(driver->run, GAMUT_OUTPUT,
                      "the state of the driver in the checkpoint does not fit this solver");
  memcpy(&step, from, sizeof step);
  if (step != driver->step)
    return gamut_fail_at(driver->run, driver->values, "steps",
                         "the end that the checkpoint was written with",
                         "the step was %g s and is %g s: with `steps` another end is another step",
                         step, driver->step);
  for (size_t i = 0; i < driver->points; i++) {
    struct point *p = &driver->point[i];
    struct saved_point saved;
    memcpy(&saved, from + sizeof step + i * sizeof saved, sizeof saved);
    memcpy(p->H, saved.H, sizeof saved.H);
    memcpy(p->rate, saved.rate, sizeof saved.rate);
    p->energy = saved.energy;
    p->work = saved.work;
    p->moved = saved.moved != 0;
  }
  return GAMUT_OK;
}

GAMUT_SOLVER(material_driver, .create = create, .destroy = destroy, .start = start, .next = next,
             .after = after, .measure = measure, .describe = describe, .save = save,
             .restore = restore)
