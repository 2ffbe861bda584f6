/* One time step as tasks. The step is turned round so that it needs one sweep over the points: the
 * grid is updated from the boxes that the last sweep left, then each block of points is gathered,
 * strained and scattered while it is in cache. */
#include "step/step.h"

/* Heat that effects give is taken up where somebody gives any. */
static const struct gamut_use heat[] = {
    {"transfer_heat", GAMUT_READ_IF}, {"energy", GAMUT_READ}, {"energy", GAMUT_WRITE}};

static gamut_status add(struct model *m, const char *name, const char *phase,
                        enum gamut_extent extent,
                        gamut_status (*run)(void *, const struct gamut_chunk *),
                        const struct gamut_use *uses, size_t count)
{
  const bool takes_heat = run == scatter_points;
  const struct gamut_task task = {.name = name,
                                  .phase = phase,
                                  .extent = extent,
                                  .uses = uses,
                                  .use_count = count,
                                  .essential = true,
                                  .run = run,
                                  .self = m,
                                  .offers = heat,
                                  .offer_count = takes_heat ? sizeof heat / sizeof *heat : 0};
  return gamut_add_task(m->run, &task);
}

/* Fields of a task, to which schemes add theirs. */
struct uses {
  struct gamut_use use[12];
  size_t count;
};

static void use(struct uses *u, const char *field, enum gamut_access access)
{
  u->use[u->count++] = (struct gamut_use){field, access};
}

/* Gathers, and where the points move in this sweep or get their velocity, what that takes. */
static void use_new_velocity(const struct model *m, struct uses *u)
{
  use(u, "velocity", GAMUT_READ_BEGIN);
  use(u, "velocity", GAMUT_WRITE);
  if (m->rule == RULE_APIC)
    use(u, "affine_velocity", GAMUT_WRITE);
}

static gamut_status register_first_pass(struct model *m)
{
  struct uses u = {0};
  use(&u, "position", GAMUT_READ_BEGIN);
  use(&u, "mass", GAMUT_READ_BEGIN);
  use_new_velocity(m, &u);
  if (m->shape == SHAPE_GIMP)
    use(&u, "domain_length", GAMUT_READ_BEGIN);
  if (m->stress_update == UPDATE_USF)
    use(&u, "position", GAMUT_WRITE);
  gamut_status status =
      add(m, "load velocity change", "momentum", GAMUT_OPEN_BLOCK, load_block, NULL, 0);
  if (status == GAMUT_OK)
    status = add(m, "renew momentum", "momentum", GAMUT_PER_CHUNK, renew_momentum, u.use, u.count);
  if (status == GAMUT_OK)
    status = add(m, "flush momentum", "momentum", GAMUT_CLOSE_BLOCK, flush_momentum, NULL, 0);
  if (status == GAMUT_OK)
    status = add(m, "update grid again", "second grid", GAMUT_ONCE, step_update_again, NULL, 0);
  return status;
}

static gamut_status register_gather(struct model *m)
{
  struct uses u = {0};
  if (m->stress_update == UPDATE_USF) {
    use(&u, "position", GAMUT_READ);
  } else {
    use(&u, "position", GAMUT_READ_BEGIN);
    use(&u, "position", GAMUT_WRITE);
  }
  if (m->stress_update == UPDATE_USL)
    use_new_velocity(m, &u);
  else
    use(&u, "velocity", GAMUT_READ);
  use(&u, "velocity_gradient", GAMUT_WRITE);
  if (m->shape == SHAPE_GIMP)
    use(&u, "domain_length", GAMUT_READ_BEGIN);
  if (m->contiguous)
    use(&u, "domain_length", GAMUT_WRITE);
  const gamut_status status =
      add(m, "load velocity", "gather", GAMUT_OPEN_BLOCK, load_block, NULL, 0);
  return status != GAMUT_OK
             ? status
             : add(m, "gather", "gather", GAMUT_PER_CHUNK, gather_points, u.use, u.count);
}

static gamut_status register_scatter(struct model *m)
{
  struct uses u = {0};
  use(&u, "position", GAMUT_READ);
  use(&u, "velocity", GAMUT_READ);
  use(&u, "mass", GAMUT_READ_BEGIN);
  use(&u, "volume_ratio", GAMUT_READ);
  use(&u, "stress", GAMUT_READ);
  use(&u, "energy", GAMUT_READ_IF);
  use(&u, "external_force", GAMUT_READ_IF);
  use(&u, "omega_squared", GAMUT_READ);
  use(&u, "removal", GAMUT_READ_IF);
  if (m->shape == SHAPE_GIMP)
    use(&u, "domain_length", m->contiguous ? GAMUT_READ : GAMUT_READ_BEGIN);
  if (m->rule == RULE_APIC)
    use(&u, "affine_velocity", GAMUT_READ);
  const gamut_status status =
      add(m, "scatter", "scatter", GAMUT_PER_CHUNK, scatter_points, u.use, u.count);
  return status != GAMUT_OK
             ? status
             : add(m, "flush block", "scatter", GAMUT_CLOSE_BLOCK, flush_block, NULL, 0);
}

gamut_status step_register(struct model *m)
{
  static const struct gamut_use bound[] = {
      {"sound_speed", GAMUT_READ}, {"velocity", GAMUT_READ}, {"omega_squared", GAMUT_ADD}};
  gamut_status status = add(m, "update grid", "grid", GAMUT_ONCE, step_update_grid, NULL, 0);
  if (status == GAMUT_OK && m->stress_update != UPDATE_USL)
    status = register_first_pass(m);
  if (status == GAMUT_OK)
    status = register_gather(m);
  if (status == GAMUT_OK)
    status = add(m, "bound step", "bound", GAMUT_PER_CHUNK, bound_step, bound,
                 sizeof bound / sizeof *bound);
  if (status == GAMUT_OK)
    status = register_scatter(m);
  return status;
}
