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

static gamut_status unknown(const struct model *m, const char *path)
{
  return gamut_fail(m->run, GAMUT_PLUGIN, "material_point_method does not know this %s", path);
}

static gamut_status read_shape(struct model *m, const struct gamut_values *values)
{
  switch (material_point_method_shape_of(values)) {
  case MATERIAL_POINT_METHOD_SHAPE_LINEAR:
    m->shape = SHAPE_LINEAR;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_SHAPE_GIMP:
    m->shape = SHAPE_GIMP;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_SHAPE_QUADRATIC:
    m->shape = SHAPE_QUADRATIC;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_SHAPE_CUBIC:
    m->shape = SHAPE_CUBIC;
    return GAMUT_OK;
  }
  return unknown(m, "shape");
}

static gamut_status read_domains(struct model *m, const struct gamut_values *values)
{
  if (m->shape != SHAPE_GIMP && gamut_given(values, "gimp"))
    return gamut_fail_at(m->run, values, "gimp", "shape: gimp, or no gimp",
                         "the shape is %s: only those of gimp have domains",
                         gamut_text(values, "shape"));
  switch (material_point_method_gimp_domain_of(values)) {
  case MATERIAL_POINT_METHOD_GIMP_DOMAIN_CONTIGUOUS:
    m->contiguous = m->shape == SHAPE_GIMP;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_GIMP_DOMAIN_FIXED:
    m->contiguous = false;
    return GAMUT_OK;
  }
  return unknown(m, "gimp.domain");
}

static gamut_status read_stress_update(struct model *m, const struct gamut_values *values)
{
  switch (material_point_method_stress_update_of(values)) {
  case MATERIAL_POINT_METHOD_STRESS_UPDATE_AUTO:
    m->stress_update = m->shape == SHAPE_LINEAR ? UPDATE_MUSL : UPDATE_USL;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_STRESS_UPDATE_MUSL:
    m->stress_update = UPDATE_MUSL;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_STRESS_UPDATE_USL:
    m->stress_update = UPDATE_USL;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_STRESS_UPDATE_USF:
    m->stress_update = UPDATE_USF;
    return GAMUT_OK;
  }
  return unknown(m, "stress_update");
}

static gamut_status read_scheme(struct model *m, const struct gamut_values *values)
{
  gamut_status status = read_shape(m, values);
  if (status == GAMUT_OK)
    status = read_stress_update(m, values);
  m->limited = m->shape == SHAPE_LINEAR && m->stress_update == UPDATE_USL;
  return status == GAMUT_OK ? read_domains(m, values) : status;
}

static gamut_status read_model(struct model *m, const struct gamut_values *values)
{
  switch (material_point_method_transfer_model_of(values)) {
  case MATERIAL_POINT_METHOD_TRANSFER_MODEL_FLIP:
    m->rule = RULE_FLIP;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_TRANSFER_MODEL_PIC:
    m->rule = RULE_PIC;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_TRANSFER_MODEL_APIC:
    m->rule = RULE_APIC;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_TRANSFER_MODEL_XPIC:
    m->rule = RULE_XPIC;
    return GAMUT_OK;
  }
  return unknown(m, "transfer.model");
}

static gamut_status read_rule(struct model *m, const struct gamut_values *values)
{
  const gamut_status status = read_model(m, values);
  const char *rule = gamut_text(values, "transfer.model");
  if (status != GAMUT_OK)
    return status;
  m->filter = (int)gamut_integer(values, "transfer.order");
  m->pic = m->rule == RULE_FLIP ? gamut_real(values, "transfer.pic") : 1.0;
  m->give_old = m->rule == RULE_XPIC ? 0.0 : m->pic;
  if (m->rule != RULE_FLIP && gamut_given(values, "transfer.pic"))
    return gamut_fail_at(m->run, values, "transfer.pic", "model: flip, or no pic",
                         "pic is a share in flip; %s takes none", rule);
  if (m->rule != RULE_XPIC && gamut_given(values, "transfer.order"))
    return gamut_fail_at(m->run, values, "transfer.order", "model: xpic, or no order",
                         "%s has no order", rule);
  if (m->rule == RULE_APIC && m->shape == SHAPE_LINEAR)
    return gamut_fail_at(m->run, values, "transfer.model", "a shape of gimp, quadratic or cubic",
                         "apic and linear shapes make energy at the nodes around a body, which see "
                         "its velocity's slope but next to nothing of its mass");
  return GAMUT_OK;
}

static gamut_status read_geometry(struct model *m, const struct gamut_values *values)
{
  switch (material_point_method_geometry_of(values)) {
  case MATERIAL_POINT_METHOD_GEOMETRY_1D:
    m->geometry = GEOMETRY_1D;
    m->dimension = 1;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_GEOMETRY_PLANE_STRAIN:
    m->geometry = GEOMETRY_PLANE_STRAIN;
    m->dimension = 2;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_GEOMETRY_AXISYMMETRIC:
    m->geometry = GEOMETRY_AXISYMMETRIC;
    m->dimension = 2;
    return GAMUT_OK;
  case MATERIAL_POINT_METHOD_GEOMETRY_3D:
    m->geometry = GEOMETRY_3D;
    m->dimension = 3;
    return GAMUT_OK;
  }
  return unknown(m, "geometry");
}

gamut_status model_read(struct model *m, const struct gamut_values *values)
{
  gamut_status status = read_geometry(m, values);
  if (status != GAMUT_OK)
    return status;
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
 * does not fall with the cell where material flows. */
void model_warn(const struct model *m)
{
  if (m->shape != SHAPE_LINEAR || m->stress_update != UPDATE_MUSL)
    return;
  for (size_t i = 0; i < m->bodies; i++) {
    const char *strength = m->host->body_strength(m->run, m->body[i].scene);
    if (strength == NULL)
      continue;
    gamut_warn(m->run,
               "shape linear with musl does not converge where material flows, as body '%s' "
               "(strength %s) may: with smaller cells the length of a Taylor bar falls through its "
               "limit, by 1 to 2 %% at 20 cells in the radius. It is fast for a first look; "
               "figures take shape quadratic or cubic (docs/shapes_and_transfers.md)",
               m->host->body_name(m->body[i].scene), strength);
    return;
  }
}
