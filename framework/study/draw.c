#include <math.h>
#include <stdlib.h>

#include "random/correlation.h"
#include "study/inside.h"

gamut_status draw_prepare(struct study *study)
{
  const struct scene *scene = study->scene;
  size_t n = study->parameters = scene->random_parameters;
  if (!scene->correlation)
    return GAMUT_OK;
  study->lower = calloc(n * n + 1, sizeof *study->lower);
  if (!study->lower || !correlation_factor(scene->correlation, n, study->lower))
    return trace_fail(study->trace, GAMUT_INTERNAL, "the correlation cannot be factored");
  return GAMUT_OK;
}

static double correlated(const struct study *study, const double *normal, size_t i)
{
  double sum = 0;
  if (!study->lower)
    return normal[i];
  for (size_t k = 0; k <= i; k++)
    sum += study->lower[i * study->parameters + k] * (isnan(normal[k]) ? 0 : normal[k]);
  return sum;
}

void draw_row(const struct study *study, const double *normal, double *parameter)
{
  for (size_t i = 0; i < study->parameters; i++) {
    const struct distribution *d = study->scene->random_parameter[i].distribution;
    parameter[i] =
        isnan(normal[i]) ? d->mean : distribution_of_normal(d, correlated(study, normal, i));
  }
}
