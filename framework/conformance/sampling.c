#include "base/array.h"
#include "conformance/conformance_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

char *trace_text(struct trace *trace)
{
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return NULL;
  trace_print(trace, file);
  return memory_close(file, &text);
}

/* SplitMix64. */
double draw(struct proof *proof)
{
  uint64_t z = (proof->seed += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double draw_between(struct proof *proof, double lower, double upper)
{
  double u = draw(proof);
  if (lower > 0 && upper > 100 * lower)
    return lower * exp(u * log(upper / lower));
  return lower + u * (upper - lower);
}

/* What is usual for a solid, by the unit. */
static double usual(const struct parameter *p)
{
  static const struct {
    const char *unit;
    double value;
  } known[] = {{"Pa", 1e9}, {"K", 1000}, {"kg/m3", 8000}, {"m/s", 4000}, {"J/(kg K)", 400}};
  for (size_t i = 0; p->unit && i < ARRAY_SIZE(known); i++)
    if (strcmp(known[i].unit, p->unit) == 0)
      return known[i].value;
  return 1.0;
}

/* A value inside a range, away from open ends. */
static double middle(const struct parameter *p)
{
  const struct range *range = p->fit.stated ? &p->fit : &p->physical;
  if (!range->stated || (isinf(range->lower) && isinf(range->upper)) ||
      (isinf(range->upper) && range_holds(range, usual(p))))
    return usual(p);
  if (isinf(range->upper))
    return range->lower > 0 ? 2 * range->lower : range->lower + 1;
  if (isinf(range->lower))
    return range->upper < 0 ? 2 * range->upper : range->upper - 1;
  return 0.5 * (range->lower + range->upper);
}

static bool accepted(const struct descriptor *descriptor, const struct settings *settings,
                     const struct units *units, char *why, size_t size)
{
  struct trace *trace = trace_new();
  struct specimen specimen;
  bool fine =
      specimen_values(&specimen, descriptor, settings, "parameters", units, trace) == GAMUT_OK;
  if (!fine && why) {
    char *text = trace_text(trace);
    snprintf(why, size, "%s", text ? text : "");
    free(text);
  }
  specimen_close(&specimen);
  trace_free(trace);
  return fine;
}

static bool in_other_set(const struct descriptor *d, const char *name)
{
  bool first = false, other = false;
  for (size_t g = 0; g < d->givens; g++)
    for (size_t k = 0; k < d->given[g].names; k++)
      if (strcmp(d->given[g].name[k], name) == 0)
        *(g == 0 ? &first : &other) = true;
  for (size_t g = 0; g < d->givens; g++)
    for (size_t k = 0; k < d->given[g].derivations; k++)
      if (strcmp(d->given[g].derived[k], name) == 0)
        other = true;
  return other && !first;
}

static void base_vector(struct settings *settings, const struct parameter *p)
{
  char text[512] = "[";
  bool pure = !p->unit || strcmp(p->unit, "1") == 0;
  for (size_t i = 0; i < p->size_min; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text), "%s1%s%s", i ? ", " : "",
             pure ? "" : " ", pure ? "" : p->unit);
  snprintf(text + strlen(text), sizeof text - strlen(text), "]");
  settings_put(settings, p->name, text);
}

void base_of_table(const struct descriptor *d, const struct parameter *parameter, size_t count,
                   struct settings *settings)
{
  for (size_t i = 0; i < count; i++) {
    const struct parameter *p = &parameter[i];
    if (p->standard || p->optional || in_other_set(d, p->name))
      continue;
    if (p->type == VALUE_REAL)
      settings_number(settings, p, middle(p));
    else if (p->type == VALUE_INTEGER)
      settings_put(settings, p->name, p->physical.stated && p->physical.lower > 1 ? "10" : "1");
    else if (p->type == VALUE_BOOLEAN)
      settings_put(settings, p->name, "false");
    else if (p->type == VALUE_CHOICE)
      settings_put(settings, p->name, p->choice[0]);
    else if (p->type == VALUE_VECTOR)
      base_vector(settings, p);
    else if (p->type == VALUE_LEVELS)
      settings_put(settings, p->name, "{solver.cell: [4 mm, 2 mm, 1 mm]}");
  }
  /* Without a shear modulus a solid would be tried as a fluid. */
  const struct parameter *shear = parameter_named(parameter, count, "shear_modulus");
  if (d->kind == GAMUT_KIND_ELASTICITY && shear)
    settings_number(settings, shear, 48e9);
}

bool find_base(const struct descriptor *descriptor, const struct tree *known,
               const struct units *units, struct settings *settings, char *why, size_t size)
{
  const struct tree *tests = known ? tree_get(known, "tests") : NULL;
  for (size_t i = 0; tests && i < tests->children; i++) {
    const struct tree *parameters = tree_get(tests->child[i], "parameters");
    struct trace *trace = trace_new();
    bool fine = parameters != NULL;
    settings->folder = descriptor->folder;
    for (size_t k = 0; fine && k < parameters->children; k++)
      fine = settings_node(settings, descriptor, parameters->child[k], "known answers", units,
                           trace) == GAMUT_OK;
    trace_free(trace);
    if (fine && accepted(descriptor, settings, units, why, size))
      return true;
    settings_free(settings);
  }
  base_of_table(descriptor, descriptor->parameter, descriptor->parameters, settings);
  base_of_table(descriptor, descriptor->material_parameter, descriptor->material_parameters,
                settings);
  return accepted(descriptor, settings, units, why, size);
}

/* The end of a range, a little inside where it is open. */
static double end_of(const struct range *range, double lower, double upper, bool high)
{
  double end = high ? upper : lower, inside = high ? -1e-3 : 1e-3;
  bool open = high ? range->upper_open : range->lower_open;
  return open ? end + inside * (upper - lower) : end;
}

void draw_range(const struct parameter *p, double base, double *lower, double *upper)
{
  double size = fabs(base) > 0 && fabs(base) < 1e200 ? fabs(base) : 0;
  *lower = base - 0.5 * size;
  *upper = base + 0.5 * size;
  if (p->fit.stated && isfinite(p->fit.lower) && isfinite(p->fit.upper)) {
    *lower = p->fit.lower;
    *upper = p->fit.upper;
  } else if (size > 0 && p->physical.stated && isfinite(p->physical.lower) &&
             isfinite(p->physical.upper)) {
    *lower = p->physical.lower;
    *upper = p->physical.upper;
  }
  if (p->physical.stated && *lower < p->physical.lower)
    *lower = p->physical.lower;
  if (p->physical.stated && *upper > p->physical.upper)
    *upper = p->physical.upper;
}

static void draw_one(struct proof *proof, const struct parameter *p, size_t number, double base,
                     size_t corner, struct settings *settings)
{
  double lower, upper;
  const struct range *range = p->fit.stated ? &p->fit : &p->physical;
  draw_range(p, base, &lower, &upper);
  double low = end_of(range, lower, upper, false), high = end_of(range, lower, upper, true);
  double value = draw_between(proof, low, high);
  if (corner == 1 || corner == 2)
    value = corner == 1 ? low : high;
  else if (corner >= 3)
    value = (corner - 3) / 2 != number ? base : corner % 2 ? low : high;
  settings_number(settings, p, value);
}

/* Draws the numbers that the base states or that have a default. */
static void draw_table(struct proof *proof, const struct specimen *base, size_t corner,
                       struct settings *settings)
{
  const struct descriptor *d = proof->descriptor;
  const struct values *table[2] = {base->values, base->extra};
  for (int t = 0; t < 2; t++)
    for (size_t i = 0; table[t] && i < table[t]->count; i++) {
      const struct value *value = &table[t]->value[i];
      bool stated = value->present && (value->given || value->parameter->standard);
      if (stated && value->parameter->type == VALUE_REAL)
        draw_one(proof, value->parameter, i + (t ? d->parameters : 0), value->real, corner,
                 settings);
    }
}

bool draw_settings(struct proof *proof, size_t corner, struct specimen *specimen)
{
  struct specimen base;
  struct trace *trace = trace_new();
  bool fine = specimen_values(&base, proof->descriptor, &proof->base, "base", proof->units,
                              trace) == GAMUT_OK;
  trace_free(trace);
  for (int attempt = 0; fine && attempt < 20; attempt++) {
    struct settings settings = {0};
    settings_copy(&settings, &proof->base);
    draw_table(proof, &base, attempt < 2 ? corner : 0, &settings);
    trace = trace_new();
    bool taken = specimen_values(specimen, proof->descriptor, &settings, "draw", proof->units,
                                 trace) == GAMUT_OK;
    trace_free(trace);
    settings_free(&settings);
    if (taken) {
      specimen_close(&base);
      return true;
    }
    specimen_close(specimen);
  }
  specimen_close(&base);
  return false;
}

struct span span_of(const char *name)
{
  static const double compression[] = {0, 1e-16, -1e-16, 1e-8, -1e-8, 1e-3, -1e-3, -0.999999, 10};
  static const double energy[] = {0, -1e9, 1e3, 1e12};
  static const double strain[] = {0, 1e-300, 1e-16, 1e-8, 10};
  static const double rate[] = {0, 1e-300, 1, 1 + 1e-15, 1 - 1e-15, 1e12};
  static const double temperature[] = {0, 1, 298, 298 + 1e-9, 298 - 1e-9, 1e4};
  static const struct {
    const char *prefix;
    struct span span;
  } known[] = {
      {"compression", {-0.4, 0.4, 1e-2, compression, 9}},
      {"energy", {-1e8, 1e10, 1e8, energy, 4}},
      {"reference_density", {500, 2e4, 100, NULL, 0}},
      {"plastic_strain_rate", {1e-3, 1e6, 1, rate, 6}},
      {"plastic_strain", {0, 2, 1e-2, strain, 5}},
      {"plastic_dissipation", {0, 1e7, 1e5, NULL, 0}},
      {"temperature", {200, 1500, 10, temperature, 6}},
      {"velocity_gradient", {-1e3, 1e3, 1, NULL, 0}},
      {"deformation_gradient", {-0.2, 0.2, 1e-3, NULL, 0}},
      {"deformation_gradient_xx", {0.8, 1.25, 1e-3, NULL, 0}},
      {"deformation_gradient_yy", {0.8, 1.25, 1e-3, NULL, 0}},
      {"deformation_gradient_zz", {0.8, 1.25, 1e-3, NULL, 0}},
      {"time_step", {1e-8, 1e-7, 1e-9, NULL, 0}},
      {"cell_size", {1e-4, 1e-2, 1e-5, NULL, 0}},
      {"time", {0, 1e-3, 1e-6, NULL, 0}},
      {"volume_ratio", {0.7, 1.3, 1e-2, NULL, 0}},
      {"stress", {-1e8, 1e8, 1e6, NULL, 0}},
      {"pressure", {-1e8, 1e9, 1e6, NULL, 0}},
      {"viscous_pressure", {0, 1e8, 1e6, NULL, 0}},
      {"sound_speed", {1e3, 1e4, 10, NULL, 0}},
      {"flow_stress", {1e7, 1e9, 1e6, NULL, 0}},
      {"mass", {1e-6, 1e-3, 1e-6, NULL, 0}},
      {"reference_volume", {1e-9, 1e-6, 1e-9, NULL, 0}},
      {"position", {-1, 1, 1e-2, NULL, 0}},
      {"velocity", {-500, 500, 1, NULL, 0}},
  };
  size_t best = SIZE_MAX, length = 0;
  for (size_t i = 0; i < ARRAY_SIZE(known); i++) {
    size_t size = strlen(known[i].prefix);
    if (size > length && strncmp(name, known[i].prefix, size) == 0) {
      best = i;
      length = size;
    }
  }
  return best != SIZE_MAX ? known[best].span : (struct span){0, 1, 1e-2, NULL, 0};
}

size_t slot_named(const struct proof *proof, enum slot_kind kind, const char *name)
{
  for (size_t s = 0; s < proof->slots; s++)
    if (proof->slot[s].kind == kind && strcmp(proof->slot[s].name, name) == 0)
      return s;
  return SIZE_MAX;
}
