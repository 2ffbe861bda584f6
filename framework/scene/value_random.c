#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

static const char *const kind_names[] = DISTRIBUTION_NAMES;
static const char *const known_keys[] = {"mean",  "cv",    "sd",       "distribution",
                                         "lower", "upper", "truncate", "field"};

static bool bounded(enum distribution_kind kind)
{
  return kind == DISTRIBUTION_UNIFORM || kind == DISTRIBUTION_BETA ||
         kind == DISTRIBUTION_TRIANGULAR;
}

static bool kind_read(struct reading *reading, const struct tree *node,
                      enum distribution_kind *kind)
{
  char expected[WORDS_SIZE];
  *kind = DISTRIBUTION_NORMAL;
  if (!node)
    return true;
  const char *text = text_read(reading, node, "distribution");
  if (!text)
    return false;
  for (size_t i = 0; i < COUNT_OF(kind_names); i++)
    if (strcmp(kind_names[i], text) == 0) {
      *kind = (enum distribution_kind)i;
      return true;
    }
  blame_value(reading, node,
              suggest(reading, text, kind_names, COUNT_OF(kind_names), expected, sizeof expected),
              "unknown distribution '%s'", text);
  return false;
}

/* A number under a key; a fault where it is required and absent. */
static bool part(struct reading *reading, const struct tree *node, const char *key,
                 const char *unit, bool required, double *value)
{
  const struct tree *child = tree_get(node, key);
  if (child)
    return amount_read(reading, child, key, unit, value);
  if (required)
    blame_value(reading, node,
                "{mean:, cv:}, {mean:, sd:} or {distribution: uniform, lower:, upper:}",
                "'%s' of the random '%s' is missing", key, node->key ? node->key : "value");
  return !required;
}

/* Whether a number stands in a scale with a zero of its own (degC): its share says nothing. */
static bool has_own_zero(const struct reading *reading, const char *unit, const struct tree *node)
{
  double stated, difference;
  return node && node->kind == TREE_SCALAR && !unit_is_pure(unit) &&
         unit_read(reading->units, node->text, unit, &stated) == UNIT_OK &&
         unit_read_difference(reading->units, node->text, unit, &difference) == UNIT_OK &&
         stated != difference;
}

static bool spread_read(struct reading *reading, const char *unit, const struct tree *node,
                        struct distribution *d)
{
  const struct tree *cv_node = tree_get(node, "cv"), *sd_node = tree_get(node, "sd");
  double cv = 0;
  if (cv_node && sd_node) {
    blame_key(reading, sd_node, "one of them", "'cv' and 'sd' are both given");
    return false;
  }
  if (!cv_node && !sd_node) {
    blame_value(reading, node, "cv (a pure number) or sd (with the unit)",
                "the spread of the random '%s' is missing", node->key ? node->key : "value");
    return false;
  }
  if ((sd_node && !interval_read(reading, sd_node, "sd", unit, &d->deviation)) ||
      !part(reading, node, "cv", "1", false, &cv))
    return false;
  if (cv_node && d->mean == 0) {
    blame_value(reading, cv_node, "give 'sd' with the unit instead",
                "'cv' of a random value with mean 0 says nothing");
    return false;
  }
  if (cv_node && has_own_zero(reading, unit, tree_get(node, "mean"))) {
    blame_value(reading, cv_node, "give 'sd', which is a difference, or the mean in K",
                "'cv' of a mean in a scale with a zero of its own says nothing");
    return false;
  }
  if (cv_node)
    d->deviation = cv * fabs(d->mean);
  if (!(d->deviation > 0)) {
    blame_value(reading, cv_node ? cv_node : sd_node, "greater than 0",
                "the spread of a random value must be positive");
    return false;
  }
  return true;
}

static bool ends_read(struct reading *reading, const char *unit, const struct tree *node,
                      struct distribution *d)
{
  bool due = bounded(d->kind);
  for (int i = 0; i < 2 && !due; i++) {
    const struct tree *end = tree_get(node, i ? "upper" : "lower");
    if (end) {
      blame_key(reading, end, "write truncate: [lower, upper]",
                "a %s distribution has no ends of its own", kind_names[d->kind]);
      return false;
    }
  }
  if (!due)
    return true;
  if (!part(reading, node, "lower", unit, true, &d->lower) ||
      !part(reading, node, "upper", unit, true, &d->upper))
    return false;
  if (d->lower < d->upper)
    return true;
  blame_value(reading, tree_get(node, "upper"), NULL, "'upper' is not greater than 'lower'");
  return false;
}

/* Whether mean, spread and ends fit together; uniform and triangular have no spread of their own.
 */
static bool agrees(struct reading *reading, const struct tree *node, struct distribution *d)
{
  const struct tree *mean = tree_get(node, "mean");
  double width = d->upper - d->lower;
  switch (d->kind) {
  case DISTRIBUTION_NORMAL:
  case DISTRIBUTION_UNIFORM:
    return true;
  case DISTRIBUTION_LOGNORMAL:
  case DISTRIBUTION_WEIBULL:
  case DISTRIBUTION_GAMMA:
    if (d->mean > 0)
      return true;
    blame_value(reading, mean, "greater than 0", "a %s distribution has a positive mean",
                kind_names[d->kind]);
    return false;
  case DISTRIBUTION_TRIANGULAR: {
    double mode = 3 * d->mean - d->lower - d->upper;
    if (mode >= d->lower && mode <= d->upper) {
      d->deviation = sqrt((d->lower * d->lower + d->upper * d->upper + mode * mode -
                           d->lower * d->upper - d->lower * mode - d->upper * mode) /
                          18);
      return true;
    }
    blame_value(reading, mean, "in the middle third between the ends",
                "no triangular distribution has this mean");
    return false;
  }
  case DISTRIBUTION_BETA:
    if (d->mean > d->lower && d->mean < d->upper &&
        d->deviation * d->deviation < (d->mean - d->lower) * (d->upper - d->mean) && width > 0)
      return true;
    blame_value(reading, mean, "the mean between the ends, the spread smaller than their distance",
                "no beta distribution has this mean, spread and ends");
    return false;
  }
  return false;
}

/* [lower, upper]; an open end is -inf or inf. */
static bool truncation_ends(struct reading *reading, const char *unit, const struct tree *given,
                            double ends[2])
{
  static const char *const open[2] = {"-inf", "inf"};
  if (given->kind != TREE_SEQUENCE || given->children != 2) {
    blame_value(reading, given, "[lower, upper], such as [300 K, inf]",
                "'truncate' has not two ends");
    return false;
  }
  for (int i = 0; i < 2; i++) {
    const struct tree *end = given->child[i];
    ends[i] = i ? INFINITY : -INFINITY;
    if (!(end->kind == TREE_SCALAR && strcmp(end->text, open[i]) == 0) &&
        !amount_read(reading, end, "truncate", unit, &ends[i]))
      return false;
  }
  return true;
}

static bool truncate_read(struct reading *reading, const struct parameter *parameter,
                          const struct tree *node, struct distribution *d)
{
  const struct range *physical = &parameter->physical;
  const struct tree *given = tree_get(node, "truncate");
  if (bounded(d->kind)) {
    if (given)
      blame_key(reading, given, "'lower' and 'upper' are its ends",
                "a %s distribution cannot be truncated", kind_names[d->kind]);
    return !given;
  }
  if (!given || (given->kind == TREE_SCALAR && strcmp(given->text, "false") == 0))
    return true;
  if (given->kind == TREE_SCALAR && strcmp(given->text, "true") == 0) {
    d->truncated = d->conforms = true;
    if (physical->stated) {
      d->lower = physical->lower;
      d->upper = physical->upper;
    }
    return true;
  }
  if (given->kind == TREE_SCALAR) {
    blame_value(reading, given, "true (to the physical range), false, or [lower, upper]",
                "'truncate' cannot be '%.40s'", given->text);
    return false;
  }
  double ends[2];
  if (!truncation_ends(reading, parameter->unit, given, ends))
    return false;
  if (!(ends[0] < ends[1] && ends[0] < d->mean && d->mean < ends[1])) {
    blame_value(reading, given, "[lower, upper] around the mean", "nothing is left by 'truncate'");
    return false;
  }
  d->truncated = true;
  d->lower = ends[0];
  d->upper = ends[1];
  return true;
}

/* Probability outside the physical range. */
static double mass_outside(const struct distribution *d, const struct range *physical)
{
  if (!physical->stated)
    return 0;
  double mass = isfinite(physical->lower) ? distribution_below(d, physical->lower) : 0;
  if (isfinite(physical->upper))
    mass += 1 - distribution_below(d, physical->upper);
  return mass;
}

static bool distribution_read(struct reading *reading, const struct parameter *parameter,
                              const struct tree *node, struct distribution *d)
{
  const char *unit = parameter->unit;
  if (!kind_read(reading, tree_get(node, "distribution"), &d->kind))
    return false;
  bool uniform = d->kind == DISTRIBUTION_UNIFORM;
  bool spread = !uniform && d->kind != DISTRIBUTION_TRIANGULAR;
  for (size_t i = 0; i < 3; i++) {
    const struct tree *extra = tree_get(node, known_keys[i]);
    if (extra && (uniform || (i > 0 && !spread))) {
      blame_key(reading, extra, "its ends say all of it", "a %s distribution takes no '%s'",
                kind_names[d->kind], extra->key);
      return false;
    }
  }
  if (!ends_read(reading, unit, node, d) ||
      (!uniform && !part(reading, node, "mean", unit, true, &d->mean)) ||
      (spread && !spread_read(reading, unit, node, d)))
    return false;
  if (uniform) {
    d->mean = 0.5 * (d->lower + d->upper);
    d->deviation = (d->upper - d->lower) / sqrt(12.);
  }
  return agrees(reading, node, d) && truncate_read(reading, parameter, node, d);
}

static bool field_read(struct reading *reading, const struct parameter *parameter,
                       const struct tree *node, struct value *value)
{
  if (!node)
    return true;
  if (reading->pointwise)
    return plugin_read(reading, GAMUT_KIND_RANDOM_FIELD, node, value);
  blame_key(reading, node, "leave 'field' out: then it is one random number",
            "'%s' cannot vary in space: it is not given to kernels point by point",
            parameter->name);
  return false;
}

bool random_read(struct reading *reading, const struct parameter *parameter,
                 const struct tree *node, struct value *value)
{
  struct distribution d = {.lower = -INFINITY, .upper = INFINITY};
  char what[128];
  if (!parameter->random) {
    const bool meant = tree_get(node, "mean") || tree_get(node, "distribution");
    blame_value(reading, node,
                meant ? "one number; a sweep may vary it" : "one number with its unit, no mapping",
                meant ? "'%s' may not be random" : "'%s' is a mapping where a number is due",
                parameter->name);
    return false;
  }
  size_t faults = reading->faults;
  snprintf(what, sizeof what, "the random '%s'", parameter->name);
  expect_keys(reading, node, known_keys, COUNT_OF(known_keys), what);
  if (reading->faults > faults || !distribution_read(reading, parameter, node, &d) ||
      !field_read(reading, parameter, tree_get(node, "field"), value))
    return false;
  const struct tree *mean = tree_get(node, "mean");
  if (!range_check(reading, parameter, mean ? mean : node, d.mean))
    return false;
  double mass = d.truncated ? 0 : mass_outside(&d, &parameter->physical);
  if (mass > 1e-6)
    warn_value(reading, node,
               bounded(d.kind) ? "move its ends inside" : "'truncate: true' keeps it inside",
               "%.3g of the distribution of '%s' lies outside its physical range", mass,
               parameter->name);
  value->random = scene_take(1, sizeof *value->random);
  *value->random = d;
  value->real = d.mean;
  reading->random = reading->random || !value->model;
  return true;
}
