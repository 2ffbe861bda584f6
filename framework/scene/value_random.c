#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "random/distribution_types.h"
#include "scene/scene_private.h"

static const char *const known_keys[] = {"mean",  "cv",    "sd",       "distribution",
                                         "lower", "upper", "truncate", "field"};

static bool type_read(struct scene_reader *reader, const struct tree *node,
                      const struct distribution_type **type)
{
  char expected[WORDS_SIZE];
  const char *name[DISTRIBUTIONS_MAX];
  const char *text = node ? text_read(reader, node, "distribution") : NULL;
  if (node && !text)
    return false;
  *type = distribution_named(text);
  if (*type)
    return true;
  const size_t count = distribution_names(name);
  error_at_value(reader, node, suggest(reader, text, name, count, expected, sizeof expected),
                 "unknown distribution '%s'", text);
  return false;
}

/* A number under a key; a fault where it is required and absent. */
static bool part(struct scene_reader *reader, const struct tree *node, const char *key,
                 const char *unit, bool required, double *value)
{
  const struct tree *child = tree_get(node, key);
  if (child)
    return amount_read(reader, child, key, unit, value);
  if (required)
    error_at_value(reader, node,
                   "{mean:, cv:}, {mean:, sd:} or {distribution: uniform, lower:, upper:}",
                   "'%s' of the random '%s' is missing", key, node->key ? node->key : "value");
  return !required;
}

/* Whether a number stands in a scale with a zero of its own (degC): its share says nothing. */
static bool has_own_zero(const struct scene_reader *reader, const char *unit,
                         const struct tree *node)
{
  double stated, difference;
  return node && node->kind == TREE_SCALAR && !unit_is_pure(unit) &&
         unit_read(reader->units, node->text, unit, &stated) == UNIT_OK &&
         unit_read_difference(reader->units, node->text, unit, &difference) == UNIT_OK &&
         stated != difference;
}

static bool spread_read(struct scene_reader *reader, const char *unit, const struct tree *node,
                        struct distribution *d)
{
  const struct tree *cv_node = tree_get(node, "cv"), *sd_node = tree_get(node, "sd");
  double cv = 0;
  if (cv_node && sd_node) {
    error_at_key(reader, sd_node, "one of them", "'cv' and 'sd' are both given");
    return false;
  }
  if (!cv_node && !sd_node) {
    error_at_value(reader, node, "cv (a pure number) or sd (with the unit)",
                   "the spread of the random '%s' is missing", node->key ? node->key : "value");
    return false;
  }
  if ((sd_node && !interval_read(reader, sd_node, "sd", unit, &d->deviation)) ||
      !part(reader, node, "cv", "1", false, &cv))
    return false;
  if (cv_node && d->mean == 0) {
    error_at_value(reader, cv_node, "give 'sd' with the unit instead",
                   "'cv' of a random value with mean 0 says nothing");
    return false;
  }
  if (cv_node && has_own_zero(reader, unit, tree_get(node, "mean"))) {
    error_at_value(reader, cv_node, "give 'sd', which is a difference, or the mean in K",
                   "'cv' of a mean in a scale with a zero of its own says nothing");
    return false;
  }
  if (cv_node)
    d->deviation = cv * fabs(d->mean);
  if (!(d->deviation > 0)) {
    error_at_value(reader, cv_node ? cv_node : sd_node, "greater than 0",
                   "the spread of a random value must be positive");
    return false;
  }
  return true;
}

static bool ends_read(struct scene_reader *reader, const char *unit, const struct tree *node,
                      struct distribution *d)
{
  bool due = d->type->bounded;
  for (int i = 0; i < 2 && !due; i++) {
    const struct tree *end = tree_get(node, i ? "upper" : "lower");
    if (end) {
      error_at_key(reader, end, "write truncate: [lower, upper]",
                   "a %s distribution has no ends of its own", d->type->name);
      return false;
    }
  }
  if (!due)
    return true;
  if (!part(reader, node, "lower", unit, true, &d->lower) ||
      !part(reader, node, "upper", unit, true, &d->upper))
    return false;
  if (d->lower < d->upper)
    return true;
  error_at_value(reader, tree_get(node, "upper"), NULL, "'upper' is not greater than 'lower'");
  return false;
}

/* Whether mean, spread and ends fit together; what is not stated follows. */
static bool agrees(struct scene_reader *reader, const struct tree *node, struct distribution *d)
{
  const struct tree *mean = tree_get(node, "mean");
  const char *expected = NULL, *why = NULL;
  if (d->type->positive && !(d->mean > 0)) {
    error_at_value(reader, mean, "greater than 0", "a %s distribution has a positive mean",
                   d->type->name);
    return false;
  }
  if (d->type->complete)
    why = d->type->complete(d, &expected);
  if (why)
    error_at_value(reader, mean, expected, "%s", why);
  return !why;
}

/* [lower, upper]; an open end is -inf or inf. */
static bool truncation_ends(struct scene_reader *reader, const char *unit, const struct tree *given,
                            double ends[2])
{
  static const char *const open[2] = {"-inf", "inf"};
  if (given->kind != TREE_SEQUENCE || given->children != 2) {
    error_at_value(reader, given, "[lower, upper], such as [300 K, inf]",
                   "'truncate' has not two ends");
    return false;
  }
  for (int i = 0; i < 2; i++) {
    const struct tree *end = given->child[i];
    ends[i] = i ? INFINITY : -INFINITY;
    if (!(end->kind == TREE_SCALAR && strcmp(end->text, open[i]) == 0) &&
        !amount_read(reader, end, "truncate", unit, &ends[i]))
      return false;
  }
  return true;
}

static bool truncate_read(struct scene_reader *reader, const struct parameter *parameter,
                          const struct tree *node, struct distribution *d)
{
  const struct range *physical = &parameter->physical;
  const struct tree *given = tree_get(node, "truncate");
  if (d->type->bounded) {
    if (given)
      error_at_key(reader, given, "'lower' and 'upper' are its ends",
                   "a %s distribution cannot be truncated", d->type->name);
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
    error_at_value(reader, given, "true (to the physical range), false, or [lower, upper]",
                   "'truncate' cannot be '%.40s'", given->text);
    return false;
  }
  double ends[2];
  if (!truncation_ends(reader, parameter->unit, given, ends))
    return false;
  if (!(ends[0] < ends[1] && ends[0] < d->mean && d->mean < ends[1])) {
    error_at_value(reader, given, "[lower, upper] around the mean",
                   "nothing is left by 'truncate'");
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

static bool distribution_read(struct scene_reader *reader, const struct parameter *parameter,
                              const struct tree *node, struct distribution *d)
{
  const char *unit = parameter->unit;
  if (!type_read(reader, tree_get(node, "distribution"), &d->type))
    return false;
  const bool centred = d->type->states != DISTRIBUTION_ENDS;
  const bool spread = d->type->states == DISTRIBUTION_MEAN_AND_SPREAD;
  for (size_t i = 0; i < 3; i++) {
    const struct tree *extra = tree_get(node, known_keys[i]);
    if (extra && (!centred || (i > 0 && !spread))) {
      error_at_key(reader, extra, "its ends say all of it", "a %s distribution takes no '%s'",
                   d->type->name, extra->key);
      return false;
    }
  }
  if (!ends_read(reader, unit, node, d) ||
      (centred && !part(reader, node, "mean", unit, true, &d->mean)) ||
      (spread && !spread_read(reader, unit, node, d)))
    return false;
  return agrees(reader, node, d) && truncate_read(reader, parameter, node, d);
}

static bool field_read(struct scene_reader *reader, const struct parameter *parameter,
                       const struct tree *node, struct value *value)
{
  if (!node)
    return true;
  if (reader->pointwise)
    return plugin_read(reader, GAMUT_KIND_RANDOM_FIELD, node, value);
  error_at_key(reader, node, "leave 'field' out: then it is one random number",
               "'%s' cannot vary in space: it is not given to kernels point by point",
               parameter->name);
  return false;
}

bool random_read(struct scene_reader *reader, const struct parameter *parameter,
                 const struct tree *node, struct value *value)
{
  struct distribution d = {.lower = -INFINITY, .upper = INFINITY};
  char what[128];
  if (!parameter->random) {
    const bool meant = tree_get(node, "mean") || tree_get(node, "distribution");
    error_at_value(reader, node,
                   meant ? "one number; a sweep may vary it"
                         : "one number with its unit, no mapping",
                   meant ? "'%s' may not be random" : "'%s' is a mapping where a number is due",
                   parameter->name);
    return false;
  }
  size_t faults = reader->faults;
  snprintf(what, sizeof what, "the random '%s'", parameter->name);
  expect_keys(reader, node, known_keys, ARRAY_SIZE(known_keys), what);
  if (reader->faults > faults || !distribution_read(reader, parameter, node, &d) ||
      !field_read(reader, parameter, tree_get(node, "field"), value))
    return false;
  const struct tree *mean = tree_get(node, "mean");
  if (!range_check(reader, parameter, mean ? mean : node, d.mean))
    return false;
  double mass = d.truncated ? 0 : mass_outside(&d, &parameter->physical);
  if (mass > 1e-6)
    warn_value(
        reader, node, d.type->bounded ? "move its ends inside" : "'truncate: true' keeps it inside",
        "%.3g of the distribution of '%s' lies outside its physical range", mass, parameter->name);
  value->random = scene_take(1, sizeof *value->random);
  *value->random = d;
  value->real = d.mean;
  reader->random = reader->random || !value->model;
  return true;
}
