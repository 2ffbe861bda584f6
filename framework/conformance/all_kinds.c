/* What plugins of every kind must keep: a whole descriptor, refusals by name, known answers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/conformance_private.h"

static size_t undocumented(const struct parameter *parameter, size_t count, char *which,
                           size_t size)
{
  size_t missing = 0;
  for (size_t i = 0; i < count; i++) {
    if (!parameter[i].doc || !parameter[i].doc[0]) {
      missing++;
      snprintf(which, size, " (%s)", parameter[i].name);
    }
    missing += undocumented(parameter[i].member, parameter[i].members, which, size);
  }
  return missing;
}

static void prove_descriptor(struct proof *proof)
{
  const struct descriptor *d = proof->descriptor;
  struct checks *checks = &proof->checks;
  char which[128] = "";
  size_t missing =
      undocumented(d->parameter, d->parameters, which, sizeof which) +
      undocumented(d->material_parameter, d->material_parameters, which, sizeof which) +
      undocumented(d->body_parameter, d->body_parameters, which, sizeof which);
  check_that(checks, d->summary && d->summary[0] && d->version && d->version[0],
             "the descriptor has a summary and a version");
  check_that(checks, d->sources > 0, "the descriptor names its source");
  check_figure(checks, (double)missing, 0, "parameters without doc%s", which);
}

/* Whether a value outside is refused with the parameter's name in the message. */
static bool refused(struct proof *proof, const struct parameter *parameter, double value,
                    bool *taken)
{
  struct settings settings = {0};
  struct specimen specimen;
  struct trace *trace = trace_new();
  settings_copy(&settings, &proof->base);
  settings_number(&settings, parameter, value);
  *taken = specimen_values(&specimen, proof->descriptor, &settings, "outside", proof->units,
                           trace) == GAMUT_OK;
  char *text = trace_text(trace);
  bool named = text && strstr(text, parameter->name);
  free(text);
  specimen_close(&specimen);
  trace_free(trace);
  settings_free(&settings);
  return !*taken && named;
}

static double beyond(double end, bool open, double direction)
{
  return open ? end : end + direction * (fabs(end) > 0 ? 0.01 * fabs(end) : 1e-3);
}

static void prove_refusals(struct proof *proof, const struct parameter *parameter, size_t count)
{
  for (size_t i = 0; i < count; i++) {
    const struct parameter *p = &parameter[i];
    if (p->type != VALUE_REAL || !p->physical.stated)
      continue;
    const struct range *range = &p->physical;
    bool fine = true, taken = false;
    double bad = 0;
    if (isfinite(range->lower)) {
      bad = beyond(range->lower, range->lower_open, -1);
      fine = refused(proof, p, bad, &taken);
    }
    if (fine && isfinite(range->upper)) {
      bad = beyond(range->upper, range->upper_open, 1);
      fine = refused(proof, p, bad, &taken);
    }
    check_that(&proof->checks, fine, "%s outside its physical range is refused by name%s", p->name,
               fine    ? ""
               : taken ? " (it was taken)"
                       : " (the message does not name it)");
    if (!fine)
      check_say(&proof->checks, "tried %g", bad);
  }
}

void prove_common(struct proof *proof, bool based)
{
  const struct descriptor *d = proof->descriptor;
  check_begin(&proof->checks, "the descriptor");
  prove_descriptor(proof);
  prove_object(proof);
  if (!based)
    return;
  check_begin(&proof->checks, "refusals");
  prove_refusals(proof, d->parameter, d->parameters);
  prove_refusals(proof, d->material_parameter, d->material_parameters);
}
