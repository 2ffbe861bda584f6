/* One time step as tasks. The step is turned round so that it needs one sweep over the points: the
 * grid is updated from the boxes that the last sweep left, then each block of points is gathered,
 * strained and scattered while it is in cache. */
#include "step/step.h"

static gamut_status add(struct model *m, const char *name, const char *phase,
                        enum gamut_extent extent,
                        gamut_status (*run)(void *, const struct gamut_chunk *),
                        const struct gamut_use *uses, size_t count)
{
  const struct gamut_task task = {.name = name,
                                  .phase = phase,
                                  .extent = extent,
                                  .uses = uses,
                                  .use_count = count,
                                  .essential = true,
                                  .run = run,
                                  .self = m};
  return gamut_add_task(m->run, &task);
}

#define USES(array) (array), sizeof(array) / sizeof *(array)

gamut_status step_register(struct model *m)
{
  static const struct gamut_use renew[] = {{"position", GAMUT_READ_BEGIN},
                                           {"mass", GAMUT_READ_BEGIN},
                                           {"velocity", GAMUT_READ_BEGIN},
                                           {"velocity", GAMUT_WRITE}};
  static const struct gamut_use gather_once[] = {{"position", GAMUT_READ_BEGIN},
                                                 {"velocity", GAMUT_READ_BEGIN},
                                                 {"position", GAMUT_WRITE},
                                                 {"velocity", GAMUT_WRITE},
                                                 {"velocity_gradient", GAMUT_WRITE}};
  static const struct gamut_use gather_again[] = {{"position", GAMUT_READ_BEGIN},
                                                  {"velocity", GAMUT_READ},
                                                  {"position", GAMUT_WRITE},
                                                  {"velocity_gradient", GAMUT_WRITE}};
  static const struct gamut_use bound[] = {
      {"sound_speed", GAMUT_READ}, {"velocity", GAMUT_READ}, {"omega_squared", GAMUT_ADD}};
  static const struct gamut_use scatter[] = {
      {"position", GAMUT_READ},          {"velocity", GAMUT_READ},     {"mass", GAMUT_READ_BEGIN},
      {"volume_ratio", GAMUT_READ},      {"stress", GAMUT_READ},       {"energy", GAMUT_READ_IF},
      {"external_force", GAMUT_READ_IF}, {"omega_squared", GAMUT_READ}};
  gamut_status status = add(m, "update grid", "grid", GAMUT_ONCE, step_update_grid, NULL, 0);
  if (status == GAMUT_OK && m->second_pass) {
    status = add(m, "load velocity change", "momentum", GAMUT_OPEN_BLOCK, load_block, NULL, 0);
    if (status == GAMUT_OK)
      status = add(m, "renew momentum", "momentum", GAMUT_PER_CHUNK, renew_momentum, USES(renew));
    if (status == GAMUT_OK)
      status = add(m, "leave momentum", "momentum", GAMUT_CLOSE_BLOCK, leave_momentum, NULL, 0);
    if (status == GAMUT_OK)
      status = add(m, "update grid again", "second grid", GAMUT_ONCE, step_update_again, NULL, 0);
  }
  if (status == GAMUT_OK)
    status = add(m, "load velocity", "gather", GAMUT_OPEN_BLOCK, load_block, NULL, 0);
  if (status == GAMUT_OK)
    status = m->second_pass
                 ? add(m, "gather", "gather", GAMUT_PER_CHUNK, gather_points, USES(gather_again))
                 : add(m, "gather", "gather", GAMUT_PER_CHUNK, gather_points, USES(gather_once));
  if (status == GAMUT_OK)
    status = add(m, "bound step", "bound", GAMUT_PER_CHUNK, bound_step, USES(bound));
  if (status == GAMUT_OK)
    status = add(m, "scatter", "scatter", GAMUT_PER_CHUNK, scatter_points, USES(scatter));
  if (status == GAMUT_OK)
    status = add(m, "leave block", "scatter", GAMUT_CLOSE_BLOCK, leave_block, NULL, 0);
  return status;
}
