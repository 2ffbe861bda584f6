#include <stdatomic.h>
#include <stdlib.h>

#include "expansion.h"
#include "karhunen_loeve.gamut.h"

struct field {
  struct gamut_run *run;
  enum karhunen_loeve_from origin;
  struct expansion expansion;
  double lower[AXES], upper[AXES];
  struct noise noise; /* distribution of the values */
  struct ensemble ensemble;
  struct table table;
  atomic_flag reported; /* what a user must know is said once */
};

static gamut_status read_domain(struct field *field, const struct gamut_values *values)
{
  static const char *const path[] = {"domain.lower", "domain.upper"};
  const struct gamut_host *host = GAMUT_HOST(field->run);
  double *end[] = {field->lower, field->upper};
  size_t count[2] = {0, 0};
  for (int i = 0; i < 2; i++) {
    const double *given = gamut_vector(values, path[i], &count[i]);
    for (size_t k = 0; k < count[i]; k++)
      end[i][k] = given[k];
  }
  if (count[0] != count[1])
    return gamut_fail_at(field->run, values, "domain", "lower: [0 mm, 0 mm], upper: [4 mm, 26 mm]",
                         "'lower' and 'upper' of the domain have not as many components");
  for (size_t k = 0; k < count[0]; k++)
    if (!(field->lower[k] < field->upper[k]))
      return gamut_fail_at(field->run, values, "domain.upper", "greater than 'lower'",
                           "the domain has no extent along %c", "xyz"[k]);
  bool known =
      count[0] > 0 || (host->domain && host->domain(field->run, field->lower, field->upper));
  bool extent = false;
  for (int k = 0; k < AXES; k++)
    extent = extent || field->upper[k] > field->lower[k];
  if (known && extent)
    return GAMUT_OK;
  return gamut_fail_at(field->run, values, "domain", "lower: [0 mm], upper: [100 mm]",
                       "no body has a shape that says where the field lives");
}

static gamut_status read_lengths(const struct field *field, const struct gamut_values *values,
                                 double length[AXES])
{
  size_t count;
  const double *lengths = gamut_vector(values, "correlation_lengths", &count);
  bool one = gamut_given(values, "correlation_length");
  if (one == (count > 0))
    return gamut_fail_at(field->run, values, "correlation_length",
                         "correlation_length: 2 mm, or correlation_lengths: [2 mm, 8 mm]",
                         one ? "both a correlation length and one for each axis are given"
                             : "a field from a kernel needs a correlation length");
  for (size_t k = 0; k < AXES; k++) {
    length[k] = one ? gamut_real(values, "correlation_length") : k < count ? lengths[k] : 0.0;
    if (field->upper[k] > field->lower[k] && !(length[k] > 0.0))
      return gamut_fail_at(field->run, values, "correlation_lengths", "one for each axis",
                           "there is no correlation length along %c", "xyz"[k]);
  }
  return GAMUT_OK;
}

/* Nystrom's nodes do not resolve more. */
static gamut_status check_lengths(const struct field *field, const struct gamut_values *values,
                                  enum covariance covariance, const double length[AXES])
{
  const double most = 200.0;
  for (int k = 0; k < AXES; k++) {
    double extent = field->upper[k] - field->lower[k];
    if (extent > most * length[k] && covariance != EXPONENTIAL && covariance != MATERN_1_2)
      return gamut_fail_at(field->run, values, "correlation_length",
                           "a longer one, a smaller 'domain', or random_field/white",
                           "%g m is far below the extent of %g m along %c: at most %g of them "
                           "are resolved",
                           length[k], extent, "xyz"[k], most);
  }
  return GAMUT_OK;
}

static gamut_status report_modes(const struct field *field, const struct gamut_values *values,
                                 double energy)
{
  const struct expansion *e = &field->expansion;
  const char *name = "random_field/karhunen_loeve";
  if (e->held < energy - 1e-10)
    return gamut_fail_at(field->run, values, "energy",
                         "less energy, a longer correlation length, a larger 'modes_max', or "
                         "random_field/white",
                         "%zu modes hold only %.4g of the variance, %g is wanted: the correlation "
                         "length is short for this domain",
                         e->modes, e->held, energy);
  GAMUT_HOST(field->run)
      ->note(field->run,
             "%s: %zu mode%s hold%s %.6g of the variance, %.3g is "
             "dropped%s",
             name, e->modes, e->modes == 1 ? "" : "s", e->modes == 1 ? "s" : "", e->held,
             fmax(1.0 - e->held, 0.0),
             e->unit_variance ? "; every point is scaled back to variance 1" : "");
  if (e->modes == 1 && e->held > 0.999)
    GAMUT_HOST(field->run)
        ->note(field->run,
               "%s: the correlation length is far above the domain: "
               "the field is nearly one random number",
               name);
  return GAMUT_OK;
}

static gamut_status read_covariance(const struct field *field, const struct gamut_values *values,
                                    enum covariance *covariance)
{
  switch (karhunen_loeve_kernel_of(values)) {
  case KARHUNEN_LOEVE_KERNEL_EXPONENTIAL:
    *covariance = EXPONENTIAL;
    return GAMUT_OK;
  case KARHUNEN_LOEVE_KERNEL_GAUSSIAN:
    *covariance = GAUSSIAN;
    return GAMUT_OK;
  case KARHUNEN_LOEVE_KERNEL_MATERN_1_2:
    *covariance = MATERN_1_2;
    return GAMUT_OK;
  case KARHUNEN_LOEVE_KERNEL_MATERN_3_2:
    *covariance = MATERN_3_2;
    return GAMUT_OK;
  case KARHUNEN_LOEVE_KERNEL_MATERN_5_2:
    *covariance = MATERN_5_2;
    return GAMUT_OK;
  }
  return gamut_fail(field->run, GAMUT_PLUGIN, "karhunen_loeve does not know this kernel");
}

static gamut_status create_expansion(struct field *field, const struct gamut_values *values)
{
  enum covariance covariance = EXPONENTIAL;
  double length[AXES], energy = gamut_real(values, "energy");
  size_t most = (size_t)gamut_integer(values, "modes_max");
  gamut_status status = read_covariance(field, values, &covariance);
  if (status == GAMUT_OK)
    status = read_domain(field, values);
  if (status == GAMUT_OK)
    status = read_lengths(field, values, length);
  if (status == GAMUT_OK)
    status = check_lengths(field, values, covariance, length);
  if (status != GAMUT_OK)
    return status;
  field->expansion.unit_variance = gamut_boolean(values, "unit_variance");
  if (!expansion_new(&field->expansion, covariance, field->lower, field->upper, length, energy,
                     most))
    return gamut_fail(field->run, GAMUT_INTERNAL, "no memory for the modes of a random field");
  return report_modes(field, values, energy);
}

static gamut_status check_places(const struct field *field, size_t count,
                                 const double *const position[3], const int64_t *id)
{
  for (int k = 0; k < AXES; k++) {
    double slack = 1e-6 * (field->upper[k] - field->lower[k]);
    for (size_t i = 0; slack > 0.0 && i < count; i++)
      if (!(position[k][i] >= field->lower[k] - slack && position[k][i] <= field->upper[k] + slack))
        return gamut_fail(field->run, GAMUT_SCENE,
                          "random_field/karhunen_loeve: point %lld with %c = %g m is outside the "
                          "field's domain, %g m to %g m; give a larger 'domain'",
                          (long long)id[i], "xyz"[k], position[k][i], field -> lower[k],
                          field -> upper[k]);
  }
  return GAMUT_OK;
}

static gamut_status sample_expansion(struct field *field, const struct gamut_stream *stream,
                                     size_t count, const double *const position[3],
                                     const int64_t *id, double *value)
{
  size_t modes = field->expansion.modes;
  gamut_status status = check_places(field, count, position, id);
  if (status != GAMUT_OK)
    return status;
  if (2 * modes > count && count > 1 && !atomic_flag_test_and_set(&field->reported))
    gamut_warn(field->run,
               "random_field/karhunen_loeve: %zu points for a field of %zu modes: the correlation "
               "length is near or below their spacing, which does not resolve the field",
               count, modes);
  if (!expansion_sample(&field->expansion, stream, count, position, value))
    return gamut_fail(field->run, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; !noise_is_standard(&field->noise) && i < count; i++)
    value[i] = noise_of_normal(&field->noise, value[i]);
  return GAMUT_OK;
}

static gamut_status create_ensemble(struct field *field, const struct gamut_values *values)
{
  if (!gamut_given(values, "samples"))
    return gamut_fail_at(field->run, values, "samples", "a whole number, such as 30",
                         "a field from samples needs their number");
  field->ensemble = (struct ensemble){.noise = field->noise,
                                      .samples = (size_t)gamut_integer(values, "samples"),
                                      .energy = gamut_real(values, "energy")};
  if (gamut_given(values, "points"))
    field->ensemble.points = (size_t)gamut_integer(values, "points");
  return GAMUT_OK;
}

static gamut_status sample_ensemble(struct field *field, const struct gamut_stream *stream,
                                    size_t count, const int64_t *id, double *value)
{
  const struct ensemble *ensemble = &field->ensemble;
  struct ensemble_report report;
  if (stream->realisation >= ensemble->samples)
    return gamut_fail(field->run, GAMUT_SCENE,
                      "random_field/karhunen_loeve: realisation %llu is asked for, but the "
                      "ensemble has 'samples' = %zu, realisations 0 to %zu; give more samples or "
                      "make fewer runs",
                      (unsigned long long)stream->realisation, ensemble->samples,
                      ensemble->samples - 1);
  if (!ensemble_sample(ensemble, stream, count, id, value, &report)) {
    if (report.twice >= 0)
      return gamut_fail(field->run, GAMUT_SCENE,
                        "random_field/karhunen_loeve: point %lld is in the ensemble twice",
                        (long long)report.twice);
    return gamut_fail(field->run, GAMUT_INTERNAL, "no memory for the ensemble of a random field");
  }
  if (!atomic_flag_test_and_set(&field->reported))
    GAMUT_HOST(field->run)
        ->note(field->run,
               "random_field/karhunen_loeve: %zu of %zu modes hold "
               "%.6g of the variance, %.3g is dropped",
               report.modes, ensemble->samples, report.held, fmax(1.0 - report.held, 0.0));
  return GAMUT_OK;
}

static gamut_status create_table(struct field *field, const struct gamut_values *values)
{
  size_t rows;
  const double *row = gamut_table(values, "values", &rows);
  if (rows == 0)
    return gamut_fail_at(field->run, values, "values", "rows of [x, y, z, value]",
                         "a field from a table needs 'values'");
  const char *wrong = table_new(&field->table, row, rows);
  return wrong ? gamut_fail_at(field->run, values, "values", "each place of a grid once",
                               "the table cannot be interpolated: %s", wrong)
               : GAMUT_OK;
}

static void destroy(void *self)
{
  struct field *field = self;
  if (!field)
    return;
  expansion_free(&field->expansion);
  table_free(&field->table);
  free(field);
}

static gamut_status create_origin(struct field *field, const struct gamut_values *values)
{
  switch (field->origin) {
  case KARHUNEN_LOEVE_FROM_KERNEL:
    return create_expansion(field, values);
  case KARHUNEN_LOEVE_FROM_SAMPLES:
    return create_ensemble(field, values);
  case KARHUNEN_LOEVE_FROM_TABLE:
    return create_table(field, values);
  }
  return gamut_fail(field->run, GAMUT_PLUGIN, "karhunen_loeve does not know this origin");
}

static gamut_status read_noise(struct field *field, const struct gamut_values *values)
{
  switch (karhunen_loeve_distribution_of(values)) {
  case KARHUNEN_LOEVE_DISTRIBUTION_NORMAL:
    field->noise = noise_read(values, false);
    return GAMUT_OK;
  case KARHUNEN_LOEVE_DISTRIBUTION_WEIBULL:
    field->noise = noise_read(values, true);
    return GAMUT_OK;
  }
  return gamut_fail(field->run, GAMUT_PLUGIN, "karhunen_loeve does not know this distribution");
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct field *field = calloc(1, sizeof *field);
  *self = NULL;
  if (!field)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  field->run = run;
  field->origin = karhunen_loeve_from_of(values);
  gamut_status status = read_noise(field, values);
  if (status == GAMUT_OK)
    status = create_origin(field, values);
  if (status != GAMUT_OK)
    destroy(field);
  else
    *self = field;
  return status;
}

static gamut_status sample(const void *self, const struct gamut_stream *stream, size_t count,
                           const double *const position[3], const int64_t *id, double *value)
{
  struct field *field = (struct field *)(size_t)self;
  switch (field->origin) {
  case KARHUNEN_LOEVE_FROM_KERNEL:
    return sample_expansion(field, stream, count, position, id, value);
  case KARHUNEN_LOEVE_FROM_SAMPLES:
    return sample_ensemble(field, stream, count, id, value);
  case KARHUNEN_LOEVE_FROM_TABLE:
    for (size_t i = 0; i < count; i++)
      value[i] =
          table_at(&field->table, (const double[]){position[0][i], position[1][i], position[2][i]});
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN;
}

static double below(const void *self, double value)
{
  const struct field *field = self;
  bool standard = field->origin == KARHUNEN_LOEVE_FROM_TABLE || noise_is_standard(&field->noise);
  return standard ? NAN : noise_below(&field->noise, value);
}

GAMUT_RANDOM_FIELD(karhunen_loeve, .create = create, .destroy = destroy, .sample = sample,
                   .below = below)
