#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

bool unit_is_pure(const char *unit)
{
  return !unit || unit[0] == 0 || strcmp(unit, "1") == 0;
}

/* Shortened for messages: a hostile scalar may be long. */
static const char *shortened(const char *text, char *buffer, size_t size)
{
  if (strlen(text) < size)
    return strcpy(buffer, text);
  snprintf(buffer, size, "%.*s...", (int)size - 4, text);
  return buffer;
}

static bool not_a_scalar(struct scene_reader *reader, const struct tree *node, const char *name,
                         const char *unit)
{
  char expected[160];
  if (unit_is_pure(unit))
    snprintf(expected, sizeof expected, "one number, such as 0.3");
  else
    snprintf(expected, sizeof expected, "one number with its unit, such as '%s'",
             unit_example(unit));
  error_at_value(reader, node, expected, "'%s' is %s where a number is due", name,
                 node->kind == TREE_SEQUENCE ? "a vector" : "a mapping");
  return false;
}

typedef enum unit_result unit_reader(const struct units *, const char *text, const char *unit,
                                     double *value);

/* What hides in text that is no number: a unit without a blank before it, a decimal comma. Writes
 * what should stand there. */
static void explain_text(const struct scene_reader *reader, const char *text, const char *unit,
                         char *words, size_t size)
{
  char spaced[96], *end;
  const size_t digits = strspn(text, "0123456789+-.,eE");
  strtod(text, &end);
  const size_t number = (size_t)(end - text);
  if (number > 0 && number < 32 && *end == ',' && end[1] >= '0' && end[1] <= '9') {
    snprintf(words, size, "write a decimal point: '%.*s.%.40s'", (int)number, text, end + 1);
    return;
  }
  if (number == 0 || number > 31 || digits == strlen(text) || strlen(end) > 31)
    return;
  snprintf(spaced, sizeof spaced, "%.*s %s", (int)number, text, end);
  if (unit_alike(reader->units, end, unit_is_pure(unit) ? "1" : unit))
    snprintf(words, size, "a blank before the unit: '%s'", spaced);
}

static bool number_read_by(unit_reader *read, struct scene_reader *reader, const struct tree *node,
                           const char *name, const char *unit, double *value)
{
  char text[64], expected[320] = "a number, such as 0.3", due[96];
  if (node->kind != TREE_SCALAR)
    return not_a_scalar(reader, node, name, unit);
  bool pure = unit_is_pure(unit);
  const char *words = NULL;
  shortened(node->text, text, sizeof text);
  snprintf(due, sizeof due, "%s", pure ? "" : unit_example(unit));
  if (!pure)
    snprintf(expected, sizeof expected, "a number with a unit like %s, such as '%s'", unit, due);
  enum unit_result result = read(reader->units, node->text, pure ? "1" : unit, value);
  char *after;
  if (result == UNIT_OK && node->quoted) {
    strtod(node->text, &after); /* quotes around a number with a unit do no harm */
    if (*after == 0)
      result = UNIT_NOT_A_NUMBER;
  }
  switch (result) {
  case UNIT_OK:
    unit_words_check(reader, node);
    return true;
  case UNIT_NOT_A_NUMBER:
    if (node->text[0] == 0) {
      error_at_value(reader, node, expected, "'%s' has no value", name);
      return false;
    }
    words = node->quoted ? "is text in quotes, no number" : "is no number";
    if (!node->quoted)
      explain_text(reader, node->text, unit, expected, sizeof expected);
    break;
  case UNIT_NAN:
    words = "is no finite number";
    break;
  case UNIT_MISSING:
    snprintf(expected, sizeof expected, "a unit like %s is due, such as '%s'", unit, due);
    words = "has no unit";
    break;
  case UNIT_UNKNOWN:
    words = "has a unit that is not known";
    break;
  case UNIT_DIMENSION:
    words = "has a unit of another dimension";
    break;
  case UNIT_UNWANTED:
    snprintf(expected, sizeof expected, "a pure number, such as 0.3");
    words = "has a unit where a pure number is due";
    break;
  }
  error_at_value(reader, node, expected, "%s: '%s' %s", name, text, words);
  return false;
}

bool amount_read(struct scene_reader *reader, const struct tree *node, const char *name,
                 const char *unit, double *value)
{
  return number_read_by(unit_read, reader, node, name, unit, value);
}

bool interval_read(struct scene_reader *reader, const struct tree *node, const char *name,
                   const char *unit, double *value)
{
  return number_read_by(unit_read_difference, reader, node, name, unit, value);
}

bool range_check(struct scene_reader *reader, const struct parameter *parameter,
                 const struct tree *node, double value)
{
  char range[160], words[224];
  const char *blank = unit_is_pure(parameter->unit) ? "" : " ";
  const char *unit = unit_is_pure(parameter->unit) ? "" : parameter->unit;
  if (!range_holds(&parameter->physical, value)) {
    range_text(&parameter->physical, parameter->unit, range, sizeof range);
    snprintf(words, sizeof words, "it must be %s", range);
    error_at_value(reader, node, words, "%s = %.6g%s%s is not possible", parameter->name, value,
                   blank, unit);
    return false;
  }
  if (!range_holds(&parameter->fit, value)) {
    range_text(&parameter->fit, parameter->unit, range, sizeof range);
    snprintf(words, sizeof words, "the fit holds for %s", range);
    warn_value(reader, node, words, "%s = %.6g%s%s is outside the range of the fit",
               parameter->name, value, blank, unit);
  }
  usual_check(reader, parameter, &parameter->usual, node, value);
  return true;
}

const char *text_read(struct scene_reader *reader, const struct tree *node, const char *name)
{
  if (node->kind != TREE_SCALAR) {
    error_at_value(reader, node, "one text", "'%s' is %s where a text is due", name,
                   node->kind == TREE_SEQUENCE ? "a list" : "a mapping");
    return NULL;
  }
  if (node->text[0] == 0) {
    error_at_value(reader, node, "one text", "'%s' has no value", name);
    return NULL;
  }
  return node->text;
}

/* Names sorted, equal ones in the order of the list. */
static int by_name(const void *one, const void *other)
{
  const struct tree *const *a = one, *const *b = other;
  int order = strcmp((*a)->text, (*b)->text);
  if (order == 0)
    order = ((*a)->place.line > (*b)->place.line) - ((*a)->place.line < (*b)->place.line);
  if (order == 0)
    order = ((*a)->place.column > (*b)->place.column) - ((*a)->place.column < (*b)->place.column);
  return order;
}

static void error_at_twice(struct scene_reader *reader, const struct names *names, const char *name)
{
  const struct tree **sorted = scene_take(names->count, sizeof *sorted);
  if (names->count)
    memcpy(sorted, names->node, names->count * sizeof *sorted);
  qsort(sorted, names->count, sizeof *sorted, by_name);
  for (size_t i = 1; i < names->count; i++)
    if (strcmp(sorted[i]->text, sorted[i - 1]->text) == 0)
      error_at_value(reader, sorted[i], NULL, "'%s' stands twice in '%s'", sorted[i]->text, name);
  free(sorted);
}

struct names names_read(struct scene_reader *reader, const struct tree *node, const char *name,
                        size_t most)
{
  char expected[64];
  size_t items = node->kind == TREE_SEQUENCE ? node->children : 1;
  struct names names = {scene_keep(reader, items, sizeof *names.name),
                        scene_keep(reader, items, sizeof *names.node), 0};
  if (items > most) {
    snprintf(expected, sizeof expected, "at most %zu", most);
    error_at_value(reader, node, expected, "'%s' has %zu names", name, items);
    return names;
  }
  for (size_t i = 0; i < items; i++) {
    const struct tree *item = node->kind == TREE_SEQUENCE ? node->child[i] : node;
    const char *text = text_read(reader, item, name);
    if (!text)
      continue;
    names.name[names.count] = text;
    names.node[names.count++] = item;
  }
  error_at_twice(reader, &names, name);
  return names;
}
