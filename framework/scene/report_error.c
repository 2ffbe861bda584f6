#include <ctype.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/scene_private.h"

void *scene_take(size_t count, size_t size)
{
  void *taken = calloc(count ? count : 1, size ? size : 1);
  if (!taken)
    memory_ended();
  return taken;
}

void *scene_keep(struct scene_reader *reader, size_t count, size_t size)
{
  size_t head = (sizeof(struct scene_piece) + 15) / 16 * 16;
  struct scene_store *store = (struct scene_store *)(void *)reader->scene;
  struct scene_piece *piece = scene_take(1, head + count * size);
  piece->next = store->piece;
  store->piece = piece;
  return (char *)piece + head;
}

char *scene_text(struct scene_reader *reader, const char *format, ...)
{
  char words[WORDS_SIZE];
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  char *text = scene_keep(reader, strlen(words) + 1, 1);
  return strcpy(text, words);
}

bool has_name(const char *const *name, size_t count, const char *wanted)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(name[i], wanted) == 0)
      return true;
  return false;
}

/* Records a fault; `path` null: the node's own. */
static void record(struct scene_reader *reader, const struct tree *node, bool at_key,
                   const char *path, const char *expected, const char *format, va_list list)
{
  char words[WORDS_SIZE], own[PATH_SIZE] = "";
  const struct tree *shown = node ? node : reader->here;
  const struct place *place = NULL;
  const bool shown_path = !trace_is_full(reader->trace);
  vsnprintf(words, sizeof words, format, list);
  if (shown) {
    place = at_key || !node ? &shown->key_place : &shown->place;
    if (shown_path) /* a path counts the items of lists */
      tree_path(shown, own, sizeof own);
  }
  if (!path && own[0])
    path = own;
  trace_fail_at(reader->trace, GAMUT_SCENE, place, path, expected, "%s", words);
  reader->faults++;
  if (reader->first == GAMUT_OK)
    reader->first = GAMUT_SCENE;
}

void error_at_value(struct scene_reader *reader, const struct tree *node, const char *expected,
                    const char *format, ...)
{
  va_list list;
  va_start(list, format);
  record(reader, node, false, NULL, expected, format, list);
  va_end(list);
}

void error_at_key(struct scene_reader *reader, const struct tree *node, const char *expected,
                  const char *format, ...)
{
  va_list list;
  va_start(list, format);
  record(reader, node, true, NULL, expected, format, list);
  va_end(list);
}

void error_at_missing(struct scene_reader *reader, const struct tree *node, const char *path,
                      const char *expected, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  record(reader, node, true, path, expected, format, list);
  va_end(list);
}

void error_at_place(struct scene_reader *reader, const struct place *place, const struct tree *node,
                    const char *expected, const char *format, ...)
{
  char words[WORDS_SIZE], path[PATH_SIZE];
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  trace_fail_at(reader->trace, GAMUT_SCENE, place, tree_path(node, path, sizeof path), expected,
                "%s", words);
  reader->faults++;
  if (reader->first == GAMUT_OK)
    reader->first = GAMUT_SCENE;
}

void warn_value(struct scene_reader *reader, const struct tree *node, const char *expected,
                const char *format, ...)
{
  char words[WORDS_SIZE], path[PATH_SIZE] = "";
  const struct tree *shown = node ? node : reader->here;
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  if (shown)
    tree_path(shown, path, sizeof path);
  trace_warn_at(reader->trace, shown ? &shown->place : NULL, path[0] ? path : NULL, expected, "%s",
                words);
}

char *list_text(const char *const *name, size_t count, char *buffer, size_t size)
{
  enum { LIST_MAX = 20 };
  size_t length = 0;
  buffer[0] = 0;
  for (size_t i = 0; i < count && length < size; i++) {
    if (size - length < 80 || i == LIST_MAX) {
      snprintf(buffer + length, size - length, " ...");
      break;
    }
    length += (size_t)snprintf(buffer + length, size - length, "%s%s", i ? ", " : "", name[i]);
  }
  return buffer;
}

const char *suggest(const struct scene_reader *reader, const char *word, const char *const *known,
                    size_t count, char *buffer, size_t size)
{
  if (trace_is_full(reader->trace))
    return NULL;
  const char *near = nearest(word, known, count);
  if (near) {
    snprintf(buffer, size, "did you mean '%s'?", near);
    return buffer;
  }
  if (count == 0)
    return NULL;
  snprintf(buffer, size, "known: ");
  list_text(known, count, buffer + 7, size - 7);
  return buffer;
}

const char *suggest_key(const struct scene_reader *reader, const char *word,
                        const struct tree *mapping, char *buffer, size_t size)
{
  if (trace_is_full(reader->trace) || !mapping)
    return NULL;
  const char **known = scene_take(mapping->children, sizeof *known);
  for (size_t i = 0; i < mapping->children; i++)
    known[i] = mapping->child[i]->key;
  const char *words = suggest(reader, word, known, mapping->children, buffer, size);
  free(known);
  return words;
}

void neighbour_add(struct scene_reader *reader, const char *where,
                   const struct parameter *parameter, size_t parameters, const char *const *key,
                   size_t keys)
{
  if (reader->neighbours < NEIGHBOURS_MAX)
    reader->neighbour[reader->neighbours++] =
        (struct neighbour){where, parameter, parameters, key, keys};
}

/* The key as a neighbour or a group below spells it: exactly, or the nearest. */
static const char *elsewhere(const struct scene_reader *reader, const char *key,
                             const struct parameter *parameter, size_t count, bool exactly,
                             char *where, size_t size)
{
  for (size_t i = 0; i < count + reader->neighbours; i++) {
    struct neighbour n = {0};
    if (i >= count)
      n = reader->neighbour[i - count];
    else if (parameter[i].type == VALUE_GROUP)
      n = (struct neighbour){NULL, parameter[i].member, parameter[i].members, NULL, 0};
    size_t names = n.keys + n.parameters;
    const char **name = scene_take(names, sizeof *name);
    for (size_t k = 0; k < names; k++)
      name[k] = k < n.keys ? n.key[k] : n.parameter[k - n.keys].name;
    const char *found = NULL;
    if (exactly)
      found = has_name(name, names, key) ? key : NULL;
    else if (names)
      found = nearest(key, name, names);
    free(name);
    if (found && n.where)
      snprintf(where, size, "%s", n.where);
    else if (found)
      snprintf(where, size, "under '%s:'", parameter[i].name);
    if (found)
      return found;
  }
  return NULL;
}

void error_at_unknown(struct scene_reader *reader, const struct tree *child,
                      const struct parameter *parameter, size_t count, const char *const *also,
                      size_t others, const char *what)
{
  char expected[WORDS_SIZE], where[128], list[WORDS_SIZE - 64];
  if (trace_is_full(reader->trace)) {
    error_at_key(reader, child, NULL, "unknown key '%s' in %s", child->key, what);
    return;
  }
  const char **known = scene_take(count + others, sizeof *known);
  for (size_t i = 0; i < count + others; i++)
    known[i] = i < others ? also[i] : parameter[i - others].name;
  const char *found = elsewhere(reader, child->key, parameter, count, true, where, sizeof where);
  const char *near = nearest(child->key, known, count + others);
  if (near && !found && !foreign_name(child->key) && reader->guesses < GUESSES_MAX)
    reader->guess[reader->guesses++] = (struct guess){child->parent, near};
  const char *instead = foreign_name(child->key), *now = renamed_key(child);
  if (now && !has_name(known, count + others, now))
    now = NULL;
  if (foreign_comma(child)) {
    snprintf(expected, sizeof expected,
             "a comma ends a value: write a decimal point, such as 5.5 for 5,5");
  } else if (now) {
    renamed_words(child->key, now, expected, sizeof expected);
  } else if (found) {
    snprintf(expected, sizeof expected, "'%s' belongs %s", found, where);
  } else if (instead) {
    snprintf(expected, sizeof expected, "%s", instead);
  } else if (near) {
    snprintf(expected, sizeof expected, "did you mean '%s'?", near);
  } else {
    found = elsewhere(reader, child->key, parameter, count, false, where, sizeof where);
    if (found)
      snprintf(expected, sizeof expected, "did you mean '%s' %s?", found, where);
    else
      snprintf(expected, sizeof expected, "known: %s",
               list_text(known, count + others, list, sizeof list));
  }
  error_at_key(reader, child, count + others || found || instead || now ? expected : NULL,
               "unknown key '%s' in %s", child->key, what);
  free(known);
}

bool is_typo_of(const struct scene_reader *reader, const struct tree *mapping, const char *name)
{
  for (size_t i = 0; i < reader->guesses; i++)
    if (reader->guess[i].mapping == mapping && strcmp(reader->guess[i].name, name) == 0)
      return true;
  return false;
}

bool expect_mapping(struct scene_reader *reader, const struct tree *node, const char *what)
{
  if (node->kind == TREE_MAPPING)
    return true;
  error_at_value(reader, node, "keys with values, 'key: value'", "%s is %s where a mapping is due",
                 what,
                 node->kind == TREE_SEQUENCE ? "a list"
                 : node->text[0]             ? "a plain value"
                                             : "empty");
  return false;
}

bool expect_members(struct scene_reader *reader, const struct tree *node, const char *what,
                    const char *member, bool needed, size_t most)
{
  char expected[96];
  if (!expect_mapping(reader, node, what))
    return false;
  if (node->children == 0 && needed)
    error_at_value(reader, node, member, "%s is empty", what);
  else if (node->children <= most)
    return true;
  else {
    snprintf(expected, sizeof expected, "at most %zu", most);
    error_at_key(reader, node, expected, "%s has %zu members", what, node->children);
  }
  return false;
}

void expect_keys(struct scene_reader *reader, const struct tree *node, const char *const *known,
                 size_t count, const char *what)
{
  for (size_t i = 0; i < node->children; i++) {
    if (!has_name(known, count, node->child[i]->key))
      error_at_unknown(reader, node->child[i], NULL, 0, known, count, what);
  }
}

/* A path `b.c` would mean both the member c of `b` and `b.c` itself. */
static bool beside_its_first_part(struct scene_reader *reader, const struct tree *node)
{
  char first[64], expected[192], path[PATH_SIZE];
  for (const char *dot = strchr(node->key, '.'); dot; dot = strchr(dot + 1, '.')) {
    snprintf(first, sizeof first, "%.*s", (int)(dot - node->key), node->key);
    if (!tree_get(node->parent, first))
      continue;
    snprintf(expected, sizeof expected, "another name for one of them, such as '%s_%s'", first,
             dot + 1);
    error_at_key(reader, node, expected, "'%s' beside '%s': '%s.%s' would mean two things",
                 node->key, first, tree_path(node->parent, path, sizeof path), node->key);
    return true;
  }
  return false;
}

bool expect_name(struct scene_reader *reader, const struct tree *node, const char *what)
{
  bool fine = isalnum((unsigned char)node->key[0]) && strlen(node->key) < 64;
  for (const char *c = node->key; *c && fine; c++)
    fine = isalnum((unsigned char)*c) || *c == '_' || *c == '-' || *c == '.';
  if (!fine)
    error_at_key(reader, node,
                 "letters, digits, '_', '-' and '.', at most 63 of them, first a letter or digit",
                 "'%s' cannot be the name of %s", node->key, what);
  return fine && !beside_its_first_part(reader, node);
}
