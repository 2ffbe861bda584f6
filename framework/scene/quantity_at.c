/* Where quantities are taken: bodies, and points of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

enum { TRACERS_MAX = 1000 };

#define AT_FORM                                                                                    \
  "at: {body:, point: [..] | points: [[..], ..] | line: {..}, follow: material | space}"
#define LINE_FORM "line: {from: [..], to: [..], points: 11}"

static bool body_find(struct scene_reader *reader, const struct tree *node, int *body)
{
  char expected[WORDS_SIZE];
  const char *name = text_read(reader, node, "body");
  const size_t number = name ? tree_number(reader->bodies_node, name) : SIZE_MAX;
  if (number < reader->bodies) {
    *body = (int)number;
    return true;
  }
  if (name && reader->body)
    error_at_value(reader, node,
                   suggest_key(reader, name, reader->bodies_node, expected, sizeof expected),
                   "unknown body '%.60s'", name);
  return false;
}

/* The body of a measure that has one: the only one of the scene unless it is named. */
static void body_default(struct scene_reader *reader, const struct tree *node,
                         struct quantity *quantity)
{
  const struct tree *given = tree_get(node, "body");
  char expected[WORDS_SIZE], list[WORDS_SIZE - 32];
  if (given) {
    body_find(reader, given, &quantity->body);
  } else if (reader->bodies == 1) {
    quantity->body = 0;
  } else if (reader->bodies > 1) {
    snprintf(expected, sizeof expected, "body: one of %s",
             list_text(reader->body, reader->bodies, list, sizeof list));
    error_at_key(reader, node, expected, "'body' is missing in quantity '%s'", quantity->name);
  }
}

static bool place_read(struct scene_reader *reader, const struct tree *node, const char *name,
                       double place[3])
{
  size_t count, axes = reader->axes ? reader->axes : 3;
  double *number = vector_read(reader, node, name, "m", axes, axes, &count);
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
static bool count_fits(struct scene_reader *reader, const struct tree *node, double count,
                       size_t least)
{
  char expected[64];
  if (count == floor(count) && count >= (double)least && count <= TRACERS_MAX)
    return true;
  snprintf(expected, sizeof expected, "a whole number from %zu to %d", least, (int)TRACERS_MAX);
  error_at_value(reader, node, expected, "the number of points is %g", count);
  return false;
}

static void points_read(struct scene_reader *reader, const struct tree *list, struct places *places)
{
  if (list->kind != TREE_SEQUENCE) {
    error_at_value(reader, list, "points: [[..], [..]]", "'points' is no list of places");
    return;
  }
  if (!count_fits(reader, list, (double)list->children, 1))
    return;
  places_take(places, list->children);
  for (size_t i = 0; i < list->children; i++)
    if (!place_read(reader, list->child[i], "points", &places->place[3 * i]))
      places->count = 0;
}

/* Points at equal distances, the ends among them. */
static void line_read(struct scene_reader *reader, const struct tree *line, struct places *places)
{
  static const char *const known[] = {"from", "to", "points"};
  double end[2][3], count;
  bool fine = true;
  if (!expect_mapping(reader, line, "'line'"))
    return;
  expect_keys(reader, line, known, ARRAY_SIZE(known), "'line'");
  for (size_t i = 0; i < ARRAY_SIZE(known); i++)
    if (!tree_get(line, known[i])) {
      fine = false;
      if (!is_typo_of(reader, line, known[i]))
        error_at_key(reader, line, LINE_FORM, "'%s' is missing in 'line'", known[i]);
    }
  for (int i = 0; i < 2; i++)
    fine = tree_get(line, known[i]) &&
           place_read(reader, tree_get(line, known[i]), known[i], end[i]) && fine;
  const struct tree *points = tree_get(line, "points");
  if (!points || !amount_read(reader, points, "points", "1", &count) ||
      !count_fits(reader, points, count, 2) || !fine)
    return;
  places_take(places, (size_t)count);
  for (size_t i = 0; i < places->count; i++)
    for (int k = 0; k < 3; k++) {
      const double part = (double)i / (double)(places->count - 1);
      places->place[3 * i + (size_t)k] = (1.0 - part) * end[0][k] + part * end[1][k];
    }
}

static void warn_outside(struct scene_reader *reader, const struct tree *node,
                         const struct quantity *quantity, const struct places *places)
{
  const struct gamut_body *body = quantity->body >= 0 ? &reader->scene->body[quantity->body] : NULL;
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
    warn_value(reader, node, then, "the point lies outside body '%s', %.3g mm from it", body->name,
               1e3 * fabs(shape_depth(&body->shape, places->place)));
  else
    warn_value(reader, node, then, "%zu of %zu points lie outside body '%s'", outside,
               places->count, body->name);
}

/* Which of the three ways to say where is taken; null with a fault. */
static const struct tree *way_of(struct scene_reader *reader, const struct tree *at)
{
  static const char *const way[] = {"point", "points", "line"};
  const struct tree *found = NULL;
  bool meant = false;
  for (size_t i = 0; i < ARRAY_SIZE(way); i++) {
    const struct tree *node = tree_get(at, way[i]);
    meant = meant || (!node && is_typo_of(reader, at, way[i]));
    if (node && found) {
      error_at_key(reader, node, "one of point, points and line", "'%s' and '%s' in one 'at'",
                   found->key, node->key);
      return NULL;
    }
    found = node ? node : found;
  }
  if (!found && !meant && reader->axes)
    error_at_key(reader, at, AT_FORM, "'point' is missing in 'at'");
  return found;
}

static void point_read(struct scene_reader *reader, const struct tree *at,
                       struct quantity *quantity, struct places *places)
{
  const struct tree *follow = tree_get(at, "follow");
  if (reader->geometry_unknown)
    return;
  const char *text = follow ? text_read(reader, follow, "follow") : NULL;
  if (text && strcmp(text, "space") != 0 && strcmp(text, "material") != 0)
    error_at_value(reader, follow, "material or space", "'follow' cannot be '%.40s'", text);
  quantity->follow_space = text && strcmp(text, "space") == 0;
  const struct tree *way = way_of(reader, at);
  if (!way)
    return;
  if (strcmp(way->key, "line") == 0) {
    line_read(reader, way, places);
  } else if (strcmp(way->key, "points") == 0) {
    points_read(reader, way, places);
  } else {
    places_take(places, 1);
    if (!place_read(reader, way, "point", places->place))
      places->count = 0;
  }
  if (places->count == 0)
    return;
  memcpy(quantity->point, places->place, sizeof quantity->point);
  quantity->has_point = true;
  warn_outside(reader, way, quantity, places);
  if (strcmp(way->key, "point") == 0)
    places->count = 0;
}

void at_read(struct scene_reader *reader, const struct tree *node, struct quantity *quantity,
             struct places *places)
{
  static const char *const known[] = {"body", "point", "points", "line", "follow"};
  const struct measure *measure = quantity->measure;
  bool argument = parameter_named(measure->argument, measure->arguments, "at") != NULL;
  const struct tree *at = argument ? NULL : tree_get(node, "at");
  if (measure->at != MEASURE_POINT) {
    if (at)
      error_at_key(reader, at, measure->at == MEASURE_BODY ? "body: NAME" : NULL,
                   "measure '%s' is not one of a point", measure->name);
    if (measure->at == MEASURE_BODY)
      body_default(reader, node, quantity);
    else if (tree_get(node, "body"))
      body_find(reader, tree_get(node, "body"), &quantity->body);
    return;
  }
  if (at) {
    if (!expect_mapping(reader, at, "'at'"))
      return;
    expect_keys(reader, at, known, ARRAY_SIZE(known), "'at'");
    body_default(reader, tree_get(at, "body") ? at : node, quantity);
    point_read(reader, at, quantity, places);
  } else if (reader->axes && !is_typo_of(reader, node, "at")) {
    error_at_key(reader, node, AT_FORM,
                 "'at' is missing in quantity '%s': '%s' is a measure of points", quantity->name,
                 measure->name);
  } else {
    body_default(reader, node, quantity);
  }
}
