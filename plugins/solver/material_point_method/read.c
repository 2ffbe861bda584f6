/* What the scene says of the model: geometry, scheme, domain. */
#include <math.h>
#include <string.h>

#include "model.h"

static gamut_status read_domain(struct model *m, const struct gamut_values *values)
{
  for (unsigned k = 0; k < 3; k++) {
    m->lower[k] = -INFINITY;
    m->upper[k] = INFINITY;
  }
  m->bounded = gamut_given(values, "domain");
  if (!m->bounded)
    return GAMUT_OK;
  static const char *const path[2] = {"domain.min", "domain.max"};
  for (int end = 0; end < 2; end++) {
    size_t count;
    if (!gamut_given(values, path[end]))
      continue;
    const double *place = gamut_vector(values, path[end], &count);
    memcpy(end == 0 ? m->lower : m->upper, place, count * sizeof *place);
  }
  for (unsigned k = 0; k < m->dimension; k++)
    if (!(m->lower[k] < m->upper[k]))
      return gamut_fail_at(m->run, values, "domain", "min below max along every axis",
                           "the domain is empty along %c", "xyz"[k]);
  return GAMUT_OK;
}

/* Which of `names`, which end with a null, the choice at `path` is. */
static gamut_status chosen(const struct model *m, const struct gamut_values *values,
                           const char *path, const char *const *names, int *number)
{
  const char *name = gamut_text(values, path);
  for (*number = 0; names[*number]; (*number)++)
    if (strcmp(name, names[*number]) == 0)
      return GAMUT_OK;
  return gamut_fail(m->run, GAMUT_PLUGIN, "material_point_method does not know the %s '%s'", path,
                    name);
}

static gamut_status read_scheme(struct model *m, const struct gamut_values *values)
{
  static const char *const shapes[] = {"linear", "gimp", "quadratic", "cubic", NULL};
  static const char *const orders[] = {"usl", "musl", "usf", "auto", NULL};
  int shape, order;
  gamut_status status = chosen(m, values, "shape", shapes, &shape);
  if (status == GAMUT_OK)
    status = chosen(m, values, "order", orders, &order);
  if (status != GAMUT_OK)
    return status;
  m->shape = (enum shape)shape;
  m->order = order < 3 ? (enum order)order : m->shape == SHAPE_LINEAR ? ORDER_MUSL : ORDER_USL;
  m->limited = m->shape == SHAPE_LINEAR && m->order == ORDER_USL;
  m->contiguous =
      m->shape == SHAPE_GIMP && strcmp(gamut_text(values, "gimp.domain"), "contiguous") == 0;
  if (m->shape != SHAPE_GIMP && gamut_given(values, "gimp"))
    return gamut_fail_at(m->run, values, "gimp", "shape: gimp, or no gimp",
                         "the shape is %s: only those of gimp have domains", shapes[m->shape]);
  return GAMUT_OK;
}

static gamut_status read_rule(struct model *m, const struct gamut_values *values)
{
  static const char *const rules[] = {"flip", "pic", "apic", "xpic", NULL};
  int rule;
  gamut_status status = chosen(m, values, "transfer.model", rules, &rule);
  if (status != GAMUT_OK)
    return status;
  m->rule = (enum rule)rule;
  m->filter = (int)gamut_integer(values, "transfer.order");
  m->pic = m->rule == RULE_FLIP ? gamut_real(values, "transfer.pic") : 1.0;
  m->give_old = m->rule == RULE_XPIC ? 0.0 : m->pic;
  if (m->rule != RULE_FLIP && gamut_given(values, "transfer.pic"))
    return gamut_fail_at(m->run, values, "transfer.pic", "model: flip, or no pic",
                         "pic is a share in flip; %s takes none", rules[m->rule]);
  if (m->rule != RULE_XPIC && gamut_given(values, "transfer.order"))
    return gamut_fail_at(m->run, values, "transfer.order", "model: xpic, or no order",
                         "%s has no order", rules[m->rule]);
  if (m->rule == RULE_APIC && m->shape == SHAPE_LINEAR)
    return gamut_fail_at(m->run, values, "transfer.model", "a shape of gimp, quadratic or cubic",
                         "apic and linear shapes make energy at the nodes around a body, which see "
                         "its velocity's slope but next to nothing of its mass");
  return GAMUT_OK;
}

gamut_status model_read(struct model *m, const struct gamut_values *values)
{
  static const char *const geometries[] = {"1d", "plane_strain", "axisymmetric", "3d", NULL};
  int geometry;
  gamut_status status = chosen(m, values, "geometry", geometries, &geometry);
  if (status != GAMUT_OK)
    return status;
  m->geometry = (enum geometry)geometry;
  m->dimension = m->geometry == GEOMETRY_1D ? 1 : m->geometry == GEOMETRY_3D ? 3 : 2;
  m->cell = gamut_real(values, "cell");
  m->courant = gamut_real(values, "courant");
  m->fixed_step = gamut_given(values, "step") ? gamut_real(values, "step") : 0.0;
  m->points_per_cell = 2;
  status = read_scheme(m, values);
  if (status == GAMUT_OK)
    status = read_rule(m, values);
  if (status != GAMUT_OK)
    return status;
  m->transfer = transfer_of(m->dimension, m->shape, m->rule == RULE_APIC);
  return read_domain(m, values);
}

/* Linear functions jump in their slope where points cross cells, and what that makes of the stress
 * does not fall with the cell where matter flows. */
void model_warn(const struct model *m)
{
  if (m->shape != SHAPE_LINEAR || m->order != ORDER_MUSL)
    return;
  for (size_t i = 0; i < m->bodies; i++) {
    const char *strength = m->host->body_strength(m->run, m->body[i].scene);
    if (strength == NULL || strcmp(strength, "none") == 0)
      continue;
    gamut_warn(m->run,
               "shape linear with order musl does not converge where matter flows, as body '%s' "
               "(strength %s) may: with smaller cells the length of a Taylor bar falls through its "
               "limit, by 1 to 2 %% at 20 cells in the radius. It is fast for a first look; "
               "figures take shape quadratic or cubic (docs/shapes_and_transfers.md)",
               m->host->body_name(m->body[i].scene), strength);
    return;
  }
}
