#include "descriptor/descriptor_private.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "expression/expression.h"

void *reader_keep(struct reader *reader, size_t count, size_t size)
{
  struct descriptor_store *store = (struct descriptor_store *)(void *)reader->descriptor;
  size_t head = (sizeof(struct keep) + 15) / 16 * 16;
  struct keep *kept = calloc(1, head + (count ? count : 1) * size);
  if (!kept)
    memory_ended();
  kept->next = store->kept;
  store->kept = kept;
  return (char *)kept + head;
}

char *reader_text(struct reader *reader, const char *text, size_t length)
{
  char *copy = reader_keep(reader, length + 1, 1);
  memcpy(copy, text, length);
  return copy;
}

static void record(struct reader *reader, const struct tree *node, const struct place *place,
                   const char *expected, const char *format, va_list list)
{
  char words[512], path[256];
  vsnprintf(words, sizeof words, format, list);
  tree_path(node, path, sizeof path);
  trace_fail_at(reader->trace, GAMUT_PLUGIN, place, path[0] ? path : NULL, expected, "%s", words);
  reader->faults++;
}

void reader_error_at_value(struct reader *reader, const struct tree *node, const char *expected,
                           const char *format, ...)
{
  va_list list;
  va_start(list, format);
  record(reader, node, &node->place, expected, format, list);
  va_end(list);
}

void reader_error_at_key(struct reader *reader, const struct tree *node, const char *expected,
                         const char *format, ...)
{
  va_list list;
  va_start(list, format);
  record(reader, node, &node->key_place, expected, format, list);
  va_end(list);
}

void reader_error_at_unknown(struct reader *reader, const struct tree *node, bool at_key,
                             const char *const *known, size_t count, const char *format, ...)
{
  char expected[512] = "";
  const char *near = nearest(at_key ? node->key : node->text, known, count);
  if (near) {
    snprintf(expected, sizeof expected, "did you mean '%s'?", near);
  } else {
    size_t length = (size_t)snprintf(expected, sizeof expected, "known are ");
    for (size_t i = 0; i < count && length < sizeof expected; i++)
      length += (size_t)snprintf(expected + length, sizeof expected - length, "%s%s", i ? ", " : "",
                                 known[i]);
  }
  va_list list;
  va_start(list, format);
  record(reader, node, at_key ? &node->key_place : &node->place, count ? expected : NULL, format,
         list);
  va_end(list);
}

bool check_keys(struct reader *reader, const struct tree *node, const char *const *known,
                size_t count, const char *what)
{
  if (node->kind != TREE_MAPPING) {
    reader_error_at_value(reader, node, "keys with values, \"key: value\"", "%s is no mapping",
                          what);
    return false;
  }
  for (size_t i = 0; i < node->children; i++) {
    struct tree *child = node->child[i];
    child->used = true;
    bool found = false;
    for (size_t k = 0; k < count && !found; k++)
      found = strcmp(child->key, known[k]) == 0;
    if (!found)
      reader_error_at_unknown(reader, child, true, known, count, "unknown key '%s' in %s",
                              child->key, what);
  }
  return true;
}

bool is_name(const char *name)
{
  if (!isalpha((unsigned char)name[0]) || strlen(name) > 63)
    return false;
  for (const char *c = name; *c; c++)
    if (!isalnum((unsigned char)*c) && *c != '_')
      return false;
  return true;
}

bool check_name(struct reader *reader, const struct tree *node, bool at_key, const char *name)
{
  if (is_name(name))
    return true;
  (at_key ? reader_error_at_key : reader_error_at_value)(
      reader, node, "a letter, then letters, digits and '_', at most 63 of them",
      "'%s' cannot be a name", name);
  return false;
}

bool is_reserved(const char *name)
{
  static const char *const word[] = {
      "auto",     "break",    "case",   "char",     "const",    "continue", "default",  "do",
      "double",   "else",     "enum",   "extern",   "float",    "for",      "goto",     "if",
      "inline",   "int",      "long",   "register", "restrict", "return",   "short",    "signed",
      "sizeof",   "static",   "struct", "switch",   "typedef",  "union",    "unsigned", "void",
      "volatile", "while",    "asm",    "bool",     "true",     "false",    "NULL",     "NAN",
      "INFINITY", "HUGE_VAL", "linux",  "unix",     "count",    "status",   "sqrt",     "exp",
      "log",      "log10",    "sin",    "cos",      "tan",      "asin",     "acos",     "atan",
      "sinh",     "cosh",     "tanh",   "abs",      "min",      "max",      "pow",      "pi",
  };
  for (size_t i = 0; i < ARRAY_SIZE(word); i++)
    if (strcmp(word[i], name) == 0)
      return true;
  return false;
}

const char *read_text(struct reader *reader, const struct tree *mapping, const char *key,
                      bool required)
{
  const struct tree *node = tree_get(mapping, key);
  if (!node) {
    if (required)
      reader_error_at_key(reader, mapping, NULL, "'%s' is missing", key);
    return NULL;
  }
  if (node->kind != TREE_SCALAR || node->text[0] == 0) {
    reader_error_at_value(reader, node, "one text", "'%s' has no value", key);
    return NULL;
  }
  return node->text;
}

bool read_flag(struct reader *reader, const struct tree *mapping, const char *key, bool standard)
{
  const struct tree *node = tree_get(mapping, key);
  if (!node)
    return standard;
  if (node->kind == TREE_SCALAR && strcmp(node->text, "true") == 0)
    return true;
  if (node->kind != TREE_SCALAR || strcmp(node->text, "false") != 0)
    reader_error_at_value(reader, node, "true or false", "'%s' is neither true nor false", key);
  return false;
}

long read_whole(struct reader *reader, const struct tree *mapping, const char *key, long lower,
                long upper, long standard)
{
  const struct tree *node = tree_get(mapping, key);
  if (!node)
    return standard;
  char *after = NULL, expected[96];
  long value = node->kind == TREE_SCALAR ? strtol(node->text, &after, 10) : 0;
  if (node->kind == TREE_SCALAR && after != node->text && *after == 0 && value >= lower &&
      value <= upper)
    return value;
  snprintf(expected, sizeof expected, "a whole number from %ld to %ld", lower, upper);
  reader_error_at_value(reader, node, expected, "'%s' cannot be '%s'", key, node->text);
  return standard;
}

const char **read_texts(struct reader *reader, const struct tree *node, const char *what,
                        size_t *count)
{
  *count = 0;
  if (!node)
    return NULL;
  if (node->kind == TREE_SCALAR && node->text[0]) {
    const char **one = reader_keep(reader, 1, sizeof *one);
    one[(*count)++] = node->text;
    return one;
  }
  if (node->kind != TREE_SEQUENCE) {
    reader_error_at_value(reader, node, "a list, \"[one, two]\"", "'%s' is no list", what);
    return NULL;
  }
  const char **list = reader_keep(reader, node->children, sizeof *list);
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *item = node->child[i];
    if (item->kind != TREE_SCALAR || item->text[0] == 0) {
      reader_error_at_value(reader, item, "one text", "an item of '%s' has no value", what);
      continue;
    }
    bool twice = false;
    for (size_t k = 0; k < *count && !twice; k++)
      twice = strcmp(list[k], item->text) == 0;
    if (twice)
      reader_error_at_value(reader, item, NULL, "'%s' stands twice in '%s'", item->text, what);
    else
      list[(*count)++] = item->text;
  }
  return list;
}

const char *read_unit(struct reader *reader, const struct tree *mapping, const char *key,
                      bool required)
{
  const char *unit = read_text(reader, mapping, key, required);
  if (unit && strcmp(unit, "1") != 0 && !unit_alike(reader->units, unit, unit)) {
    reader_error_at_value(reader, tree_get(mapping, key),
                          "a unit such as Pa, kg/m3, 1/s; 1 for pure numbers", "'%s' is no unit",
                          unit);
    return NULL;
  }
  return unit;
}

size_t arithmetic_names(struct reader *reader, const char ***names)
{
  const struct descriptor *descriptor = reader->descriptor;
  size_t count = 0;
  *names = reader_keep(reader, descriptor->parameters, sizeof **names);
  for (size_t i = 0; i < descriptor->parameters; i++) {
    const enum value_type type = descriptor->parameter[i].type;
    if (type == VALUE_REAL || type == VALUE_INTEGER || type == VALUE_BOOLEAN)
      (*names)[count++] = descriptor->parameter[i].name;
  }
  return count;
}

bool check_expression(struct reader *reader, const struct tree *node, const char *text,
                      const char *const *names, size_t count)
{
  char why[256] = "";
  struct expression *expression = expression_new(text, names, count, why, sizeof why);
  if (!expression)
    reader_error_at_value(reader, node, NULL, "cannot read '%s': %s", text, why);
  expression_free(expression);
  return expression != NULL;
}
