/* Where quantities are taken: bodies, and points of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

enum { TRACERS_MAX = 1000 };

#define AT_FORM                                                                                    \
  "at: {body:, point: [..] | points: [[..], ..] | line: {..}, follow: material | space}"
#define LINE_FORM "line: {from: [..], to: [..], points: 11}"

static bool body_find(struct reading *reading, const struct tree *node, int *body)
{
  char expected[WORDS_SIZE];
  const char *name = text_read(reading, node, "body");
  const size_t number = name ? tree_number(reading->bodies_node, name) : SIZE_MAX;
  if (number < reading->bodies) {
    *body = (int)number;
    return true;
  }
  if (name && reading->body)
    blame_value(reading, node,
                suggest_key(reading, name, reading->bodies_node, expected, sizeof expected),
                "unknown body '%.60s'", name);
  return false;
}

/* The body of a measure that has one: the only one of the scene unless it is named. */
static void body_default(struct reading *reading, const struct tree *node,
                         struct quantity *quantity)
{
  const struct tree *given = tree_get(node, "body");
  char expected[WORDS_SIZE], list[WORDS_SIZE - 32];
  if (given) {
    body_find(reading, given, &quantity->body);
  } else if (reading->bodies == 1) {
    quantity->body = 0;
  } else if (reading->bodies > 1) {
    snprintf(expected, sizeof expected, "body: one of %s",
             list_text(reading->body, reading->bodies, list, sizeof list));
    blame_key(reading, node, expected, "'body' is missing in quantity '%s'", quantity->name);
  }
}

static bool place_read(struct reading *reading, const struct tree *node, const char *name,
                       double place[3])
{
  size_t count, axes = reading->axes ? reading->axes : 3;
  double *number = vector_read(reading, node, name, "m", axes, axes, &count);
  if (!number)
    return false;
  memset(place, 0, 3 * sizeof *place);
  memcpy(place, number, count * sizeof *number);
  free(number);
  return true;
}

static void places_take(struct places *places, size_t count)
{
  places->place = scene_take(3 * count, sizeof *places->place);
  places->count = count;
}

/* How many there shall be: a whole number within bounds. */
static bool count_fits(struct reading *reading, const struct tree *node, double count, size_t least)
{
  char expected[64];
  if (count == floor(count) && count >= (double)least && count <= TRACERS_MAX)
    return true;
  snprintf(expected, sizeof expected, "a whole number from %zu to %d", least, (int)TRACERS_MAX);
  blame_value(reading, node, expected, "the number of points is %g", count);
  return false;
}

static void points_read(struct reading *reading, const struct tree *list, struct places *places)
{
  if (list->kind != TREE_SEQUENCE) {
    blame_value(reading, list, "points: [[..], [..]]", "'points' is no list of places");
    return;
  }
  if (!count_fits(reading, list, (double)list->children, 1))
    return;
  places_take(places, list->children);
  for (size_t i = 0; i < list->children; i++)
    if (!place_read(reading, list->child[i], "points", &places->place[3 * i]))
      places->count = 0;
}

/* Points at equal distances, the ends among them. */
static void line_read(struct reading *reading, const struct tree *line, struct places *places)
{
  static const char *const known[] = {"from", "to", "points"};
  double end[2][3], count;
  bool fine = true;
  if (!expect_mapping(reading, line, "'line'"))
    return;
  expect_keys(reading, line, known, COUNT_OF(known), "'line'");
  for (size_t i = 0; i < COUNT_OF(known); i++)
    if (!tree_get(line, known[i])) {
      fine = false;
      if (!was_meant(reading, line, known[i]))
        blame_key(reading, line, LINE_FORM, "'%s' is missing in 'line'", known[i]);
    }
  for (int i = 0; i < 2; i++)
    fine = tree_get(line, known[i]) &&
           place_read(reading, tree_get(line, known[i]), known[i], end[i]) && fine;
  const struct tree *points = tree_get(line, "points");
  if (!points || !amount_read(reading, points, "points", "1", &count) ||
      !count_fits(reading, points, count, 2) || !fine)
    return;
  places_take(places, (size_t)count);
  for (size_t i = 0; i < places->count; i++)
    for (int k = 0; k < 3; k++) {
      const double part = (double)i / (double)(places->count - 1);
      places->place[3 * i + (size_t)k] = (1.0 - part) * end[0][k] + part * end[1][k];
    }
}

static void warn_outside(struct reading *reading, const struct tree *node,
                         const struct quantity *quantity, const struct places *places)
{
  const struct gamut_body *body =
      quantity->body >= 0 ? &reading->scene->body[quantity->body] : NULL;
  size_t outside = 0;
  if (!body || body->shape.kind == SHAPE_NONE)
    return;
  for (size_t i = 0; i < places->count; i++)
    outside += !shape_inside(&body->shape, &places->place[3 * i], -1e-9 * (1 + body->shape.radius));
  if (outside == 0)
    return;
  const bool space = quantity->follow_space;
  const char *then = space                ? "there is no value until material comes there"
                     : places->count == 1 ? "the nearest point of the body is taken"
                                          : "the nearest points of the body are taken";
  if (places->count == 1)
    warn_value(reading, node, then, "the point lies outside body '%s', %.3g mm from it", body->name,
               1e3 * fabs(shape_depth(&body->shape, places->place)));
  else
    warn_value(reading, node, then, "%zu of %zu points lie outside body '%s'", outside,
               places->count, body->name);
}

/* Which of the three ways to say where is taken; null with a fault. */
static const struct tree *way_of(struct reading *reading, const struct tree *at)
{
  static const char *const way[] = {"point", "points", "line"};
  const struct tree *found = NULL;
  bool meant = false;
  for (size_t i = 0; i < COUNT_OF(way); i++) {
    const struct tree *node = tree_get(at, way[i]);
    meant = meant || (!node && was_meant(reading, at, way[i]));
    if (node && found) {
      blame_key(reading, node, "one of point, points and line", "'%s' and '%s' in one 'at'",
                found->key, node->key);
      return NULL;
    }
    found = node ? node : found;
  }
  if (!found && !meant && reading->axes)
    blame_key(reading, at, AT_FORM, "'point' is missing in 'at'");
  return found;
}

static void point_read(struct reading *reading, const struct tree *at, struct quantity *quantity,
                       struct places *places)
{
  const struct tree *follow = tree_get(at, "follow");
  if (reading->lost)
    return;
  const char *text = follow ? text_read(reading, follow, "follow") : NULL;
  if (text && strcmp(text, "space") != 0 && strcmp(text, "material") != 0)
    blame_value(reading, follow, "material or space", "'follow' cannot be '%.40s'", text);
  quantity->follow_space = text && strcmp(text, "space") == 0;
  const struct tree *way = way_of(reading, at);
  if (!way)
    return;
  if (strcmp(way->key, "line") == 0) {
    line_read(reading, way, places);
  } else if (strcmp(way->key, "points") == 0) {
    points_read(reading, way, places);
  } else {
    places_take(places, 1);
    if (!place_read(reading, way, "point", places->place))
      places->count = 0;
  }
  if (places->count == 0)
    return;
  memcpy(quantity->point, places->place, sizeof quantity->point);
  quantity->has_point = true;
  warn_outside(reading, way, quantity, places);
  if (strcmp(way->key, "point") == 0)
    places->count = 0;
}

void at_read(struct reading *reading, const struct tree *node, struct quantity *quantity,
             struct places *places)
{
  static const char *const known[] = {"body", "point", "points", "line", "follow"};
  const struct measure *measure = quantity->measure;
  bool argument = parameter_named(measure->argument, measure->arguments, "at") != NULL;
  const struct tree *at = argument ? NULL : tree_get(node, "at");
  if (measure->at != MEASURE_POINT) {
    if (at)
      blame_key(reading, at, measure->at == MEASURE_BODY ? "body: NAME" : NULL,
                "measure '%s' is not one of a point", measure->name);
    if (measure->at == MEASURE_BODY)
      body_default(reading, node, quantity);
    else if (tree_get(node, "body"))
      body_find(reading, tree_get(node, "body"), &quantity->body);
    return;
  }
  if (at) {
    if (!expect_mapping(reading, at, "'at'"))
      return;
    expect_keys(reading, at, known, COUNT_OF(known), "'at'");
    body_default(reading, tree_get(at, "body") ? at : node, quantity);
    point_read(reading, at, quantity, places);
  } else if (reading->axes && !was_meant(reading, node, "at")) {
    blame_key(reading, node, AT_FORM,
              "'at' is missing in quantity '%s': '%s' is a measure of points", quantity->name,
              measure->name);
  } else {
    body_default(reading, node, quantity);
  }
}
