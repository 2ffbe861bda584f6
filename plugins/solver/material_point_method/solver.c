/* The operations of the solver: makes the model, starts it, chooses steps. */
#include <math.h>
#include <string.h>

#include "model.h"
#include "restart.h"

/* No sound is faster; it bounds the first step, before the material was asked for its own. */
static const double fastest_sound = 1e5;
/* Points may move so far, in cells, before they are sorted. */
static const double sort_after = 0.3, sort_before = 0.9;
static const double growth = 1.1;

/* The value of a stored field, zero where the scene does not store it. */
static double stored_value(const struct model *m, const struct gamut_set *set, size_t slot,
                           struct gamut_field field, unsigned component)
{
  const double *value = m->host->stored(set, field, component);
  return value != NULL ? value[slot] : 0.0;
}

gamut_status point_failed(struct model *m, const struct gamut_set *set, size_t slot,
                          const double x[3], const double v[3], const char *what)
{
  double stress[6];
  for (unsigned k = 0; k < 6; k++)
    stress[k] = stored_value(m, set, slot, m->field.stress, k);
  return gamut_fail(
      m->run, GAMUT_NUMERICS,
      "point %lld of body '%s' was lost at t = %.6g s, step %llu of %.3g s: %s. "
      "Position %.6g %.6g %.6g m; velocity %.6g %.6g %.6g m/s; volume_ratio %.6g; "
      "stress %.6g %.6g %.6g %.6g %.6g %.6g Pa; energy %.6g J/m3",
      (long long)set->id[slot], set->body, gamut_time(m->run),
      (unsigned long long)m->host->step(m->run), gamut_time_step(m->run), what, x[0], x[1], x[2],
      v[0], v[1], v[2], stored_value(m, set, slot, m->field.volume_ratio, 0), stress[0], stress[1],
      stress[2], stress[3], stress[4], stress[5], stored_value(m, set, slot, m->field.energy, 0));
}

static void destroy(void *self)
{
  struct model *m = self;
  if (m == NULL)
    return;
  struct gamut_run *run = m->run;
  planes_destroy(m);
  removal_destroy(m);
  grid_destroy(&m->grid);
  for (int t = 0; m->work != NULL && t < m->threads; t++) {
    if (m->work[t] == NULL)
      continue;
    gamut_release(run, m->work[t]->tile);
    gamut_release(run, m->work[t]->sums);
    gamut_release(run, m->work[t]->point_sum);
    gamut_release(run, m->work[t]);
  }
  gamut_release(run, m->work);
  gamut_release(run, m->filter_line);
  gamut_release(run, m->body);
  totals_destroy(m);
  gamut_release(run, m);
}

static gamut_status find_fields(struct model *m)
{
  struct fields *f = &m->field;
  const struct {
    const char *name;
    struct gamut_field *field;
  } wanted[] = {{"position", &f->position},
                {"velocity", &f->velocity},
                {"mass", &f->mass},
                {"reference_volume", &f->reference_volume},
                {"volume_ratio", &f->volume_ratio},
                {"stress", &f->stress},
                {"energy", &f->energy},
                {"velocity_gradient", &f->velocity_gradient},
                {"external_force", &f->external_force},
                {"sound_speed", &f->sound_speed},
                {"omega_squared", &f->omega_squared},
                {"cell_size", &f->cell_size},
                {"domain_length", &f->domain_length},
                {"affine_velocity", &f->affine_velocity},
                {"viscous_pressure", &f->viscous_pressure},
                {"removal", &f->removal},
                {"transfer_heat", &f->transfer_heat}};
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted && status == GAMUT_OK; i++)
    status = gamut_field_named(m->run, wanted[i].name, wanted[i].field);
  return status;
}

static gamut_status make_work(struct model *m)
{
  static const char label[] = "work space of threads";
  const size_t tile = m->grid.tile_nodes * NODE_SIZE * sizeof(double);
  m->threads = gamut_threads(m->run);
  m->work = gamut_allocate(m->run, label, (size_t)m->threads * sizeof(*m->work));
  if (m->work == NULL)
    return GAMUT_INTERNAL;
  for (int t = 0; t < m->threads; t++) {
    struct work *w = gamut_allocate(m->run, label, sizeof *w);
    m->work[t] = w;
    if (w == NULL)
      return GAMUT_INTERNAL;
    w->pending_node = -1;
    w->tile = gamut_allocate(m->run, label, tile);
    w->sums = gamut_allocate(m->run, label, tile);
    w->point_sum = gamut_allocate(m->run, label, POINT_SUMS * GAMUT_LANES * sizeof(double));
    if (w->tile == NULL || w->sums == NULL || w->point_sum == NULL)
      return GAMUT_INTERNAL;
    for (unsigned k = 0; k < 3; k++) {
      w->lower[k] = k < m->dimension ? m->grid.tile : 0;
      w->upper[k] = k < m->dimension ? 0 : 1;
    }
  }
  return GAMUT_OK;
}

static gamut_status open_counts(struct model *m)
{
  struct work_counts *c = &m->counts;
  c->slots = m->host->count(m->run, "slots");
  c->node_lines = m->host->count(m->run, "node_lines");
  c->box_lines = m->host->count(m->run, "box_lines");
  c->sorts = m->host->count(m->run, "sorts");
  return c->slots != NULL && c->node_lines != NULL && c->box_lines != NULL && c->sorts != NULL
             ? GAMUT_OK
             : GAMUT_INTERNAL;
}

static gamut_status read_outside(struct model *m, const struct gamut_values *values)
{
  switch (material_point_method_domain_outside_of(values)) {
  case MATERIAL_POINT_METHOD_DOMAIN_OUTSIDE_STOP:
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_DOMAIN_OUTSIDE_REMOVE:
    return removal_open_domain(m);
  }
  return gamut_fail(m->run, GAMUT_PLUGIN, "material_point_method does not know this outside");
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct model *m = gamut_allocate(run, "solver", sizeof *m);
  if (m == NULL)
    return GAMUT_INTERNAL;
  m->run = run;
  m->host = GAMUT_HOST(run);
  gamut_status status = model_read(m, values);
  if (m->fixed_step > 0.0)
    m->host->fixed_steps(run);
  if (status == GAMUT_OK)
    status = grid_create(&m->grid, run, m->dimension, shape_nodes(m->shape), shape_shift(m->shape),
                         m->cell);
  if (status == GAMUT_OK)
    status = make_work(m);
  if (status == GAMUT_OK)
    status = find_fields(m);
  if (status == GAMUT_OK)
    status = layout_bodies(m, values);
  if (status == GAMUT_OK)
    status = pairs_warn(m);
  if (status == GAMUT_OK)
    model_warn(m);
  if (status == GAMUT_OK)
    status = step_register(m);
  if (status == GAMUT_OK)
    status = ledger_open(m);
  if (status == GAMUT_OK)
    status = open_counts(m);
  if (status == GAMUT_OK && m->bounded)
    status = read_outside(m, values);
  if (status == GAMUT_OK && m->geometry == GEOMETRY_AXISYMMETRIC) {
    const struct gamut_plane axis = {.normal = {1.0, 0.0, 0.0},
                                     .normal_rule = GAMUT_PLANE_MIRROR,
                                     .tangential_rule = GAMUT_PLANE_MIRROR};
    status = planes_add(m, &axis, NULL);
  }
  if (status != GAMUT_OK) {
    destroy(m);
    return status;
  }
  *self = m;
  return GAMUT_OK;
}

static gamut_status start(void *self)
{
  struct model *m = self;
  m->host->set_uniform(m->run, m->field.cell_size, m->cell);
  gamut_status status = planes_fix_origin(m);
  if (status != GAMUT_OK)
    return status;
  layout_origin(m);
  status = layout_fill(m);
  if (status == GAMUT_OK)
    status = sort_points(m);
  for (size_t i = 0; i < m->bodies && status == GAMUT_OK; i++)
    status = m->host->start_material(m->run, m->body[i].set);
  if (status == GAMUT_OK)
    status = step_first_scatter(m);
  if (status == GAMUT_OK)
    status = removal_start(m);
  if (status == GAMUT_OK)
    ledger_start(m);
  return status;
}

/* The step by what the points and the planes allow; the first one knows no sound speed yet and is
 * short. Infinite where nothing bounds it. */
static double allowed_step(const struct model *m)
{
  if (m->fixed_step > 0.0)
    return m->fixed_step;
  if (m->taken == 0)
    return m->courant * m->cell / (fastest_sound + m->nodes.speed + m->planes.fastest);
  double step = m->omega_squared > 0.0 ? 2.0 * m->courant / sqrt(m->omega_squared) : INFINITY;
  if (m->planes.fastest > 0.0)
    step = fmin(step, m->courant * m->cell / m->planes.fastest);
  return m->taken == 1 || m->host->given_steps(m->run) ? step : fmin(step, growth * m->last_step);
}

/* The first point with mass says why nothing bounds the step; none, and there is nothing to bound.
 */
static gamut_status check_bound(struct model *m)
{
  for (size_t b = 0; b < m->bodies; b++) {
    const struct gamut_set *set = m->body[b].set;
    const double *mass = m->host->stored(set, m->field.mass, 0);
    for (size_t i = 0; i < set->slots; i++) {
      if (set->id[i] < 0 || !(mass[i] > 0.0))
        continue;
      double x[3], v[3];
      for (unsigned k = 0; k < 3; k++) {
        x[k] = m->host->stored(set, m->field.position, k)[i];
        v[k] = m->host->stored(set, m->field.velocity, k)[i];
      }
      return point_failed(m, set, i, x, v,
                          "nothing bounds the time step: it has a sound speed of 0, like all "
                          "others, and nothing moves. Give its body an initial energy, temperature "
                          "or pressure with which its material has a sound speed, or state "
                          "solver.step");
    }
  }
  return GAMUT_OK;
}

static gamut_status next(void *self, double *step)
{
  struct model *m = self;
  const double left = *step;
  const double allowed = allowed_step(m);
  if (!(allowed > 0.0) || isnan(m->omega_squared))
    return gamut_fail(m->run, GAMUT_NUMERICS,
                      "no time step is short enough: fastest node %g m/s, (sound speed / cell)^2 = "
                      "%g 1/s2",
                      m->nodes.speed, m->omega_squared);
  if (allowed == INFINITY && check_bound(m) != GAMUT_OK)
    return GAMUT_NUMERICS;
  *step = fmin(allowed, left);
  /* the last two steps share what is left, so that none is tiny */
  if (m->fixed_step == 0.0 && !m->host->given_steps(m->run) && *step < left && left < 2.0 * *step)
    *step = 0.5 * left;
  const double ahead = m->speed * *step / m->cell;
  if (!m->removal.sort_due) {
    if (m->moved <= sort_after && m->moved + ahead <= sort_before)
      return GAMUT_OK;
    if (m->taken == 0 || m->moved == 0.0)
      return GAMUT_OK;
  }
  if (step_collect(m) != GAMUT_OK)
    return GAMUT_INTERNAL;
  m->collected = true;
  return sort_points(m);
}

static void tell_domains(struct model *m)
{
  bool beyond = false;
  for (int t = 0; t < m->threads; t++)
    beyond |= m->work[t]->beyond != 0;
  if (!beyond || m->beyond)
    return;
  m->beyond = true;
  GAMUT_HOST(m->run)->warn(m->run,
                           "from t = %.6g s on some points have domains longer than a cell; they "
                           "act as one cell long, and gaps between them are not filled (measure "
                           "long_domains counts them; more points a cell or a larger cell help)",
                           gamut_time(m->run));
}

static gamut_status after(void *self)
{
  struct model *m = self;
  const double step = gamut_time_step(m->run);
  m->omega_squared = m->speed = 0.0;
  for (size_t s = 0; s < m->grid.sources; s++) {
    m->omega_squared = fmax(m->omega_squared, m->block_most[s].omega_squared);
    m->speed = fmax(m->speed, m->block_most[s].speed);
  }
  m->moved += m->speed * step / m->cell;
  m->last_step = step;
  m->taken++;
  for (size_t i = 0; i < m->bodies; i++)
    *m->counts.slots += m->body[i].set->slots;
  *m->counts.box_lines = m->grid.box_lines;
  tell_domains(m);
  gamut_status status = removal_keep(m);
  if (status == GAMUT_OK) {
    ledger_keep(m, step);
    status = removal_check(m);
  }
  return status;
}

static gamut_status plane(void *self, const struct gamut_plane *given,
                          const struct gamut_reaction **reaction)
{
  return planes_add(self, given, reaction);
}

static gamut_status grid_pass(void *self, const struct gamut_grid_pass *pass)
{
  return step_pass(self, pass);
}

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  return measure_value(self, name, body, arguments, value);
}

static gamut_status describe(void *self, double *step, char *text, size_t size)
{
  struct model *m = self;
  (void)step;
  if (size > 0)
    strncpy(text, m->fixed_step > 0.0 ? "the scene (step)" : "sound crossing a cell", size - 1);
  return GAMUT_OK;
}

GAMUT_SOLVER(material_point_method, .create = create, .destroy = destroy, .start = start,
             .next = next, .after = after, .plane = plane, .measure = measure, .describe = describe,
             .save = model_save, .restore = model_restore, .removal = removal_add,
             .grid_pass = grid_pass)
