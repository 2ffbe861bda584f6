#include <stdlib.h>
#include <string.h>

#include <yaml.h>

#include "tree/load.h"
#include "tree/problem.h"
#include "tree/tree_private.h"

/* Anchors are looked up one by one, so a file of nothing but anchors would take for ever. */
enum { ANCHORS_MAX = 1000 };

struct anchor {
  char *name;
  struct tree *tree;
};

struct reader {
  yaml_parser_t parser;
  struct origin *origin;
  struct trace *trace;
  gamut_status blame, found; /* found: what was wrong without ending the reading */
  struct tree *root;
  struct anchor *anchor;
  size_t anchors, nodes;
};

static gamut_status no_memory(struct reader *reader)
{
  return trace_fail(reader->trace, GAMUT_INTERNAL, "no memory left to read '%s'",
                    reader->origin->name);
}

static gamut_status next_event(struct reader *reader, yaml_event_t *event)
{
  if (yaml_parser_parse(&reader->parser, event))
    return GAMUT_OK;
  return problem_report(&reader->parser, reader->origin, reader->blame, reader->trace);
}

static struct place place_of(const struct reader *reader, const yaml_event_t *event)
{
  yaml_mark_t start = event->start_mark, end = event->end_mark;
  bool spans = event->type == YAML_SCALAR_EVENT || event->type == YAML_ALIAS_EVENT;
  size_t width = spans && end.line == start.line ? end.column - start.column : 1;
  return origin_place(reader->origin, start.line + 1, start.column + 1, width);
}

static gamut_status refuse(const struct reader *reader, const struct place *place,
                           const char *expected, const char *text)
{
  return trace_fail_at(reader->trace, reader->blame, place, NULL, expected, "%s", text);
}

static gamut_status count_node(struct reader *reader, const struct place *place, int depth)
{
  if (depth > TREE_DEPTH_MAX)
    return trace_fail_at(reader->trace, reader->blame, place, NULL, NULL,
                         "nested deeper than %d levels", TREE_DEPTH_MAX);
  if (++reader->nodes > TREE_NODES_MAX)
    return trace_fail_at(reader->trace, reader->blame, place, NULL,
                         "do aliases (*name) repeat each other?",
                         "more than %d values, with all aliases written out", TREE_NODES_MAX);
  return GAMUT_OK;
}

static gamut_status note_anchor(struct reader *reader, const struct place *place, const char *name,
                                struct tree *tree)
{
  if (name == NULL)
    return GAMUT_OK;
  if (reader->anchors == ANCHORS_MAX)
    return refuse(reader, place, NULL, "more than 1000 anchors (&name)");
  if (reader->anchor == NULL)
    reader->anchor = calloc(ANCHORS_MAX, sizeof *reader->anchor);
  char *copy = strdup(name);
  if (reader->anchor == NULL || copy == NULL) {
    free(copy);
    return no_memory(reader);
  }
  reader->anchor[reader->anchors++] = (struct anchor){copy, tree};
  return GAMUT_OK;
}

/* Hangs a node below `parent`, or makes it the root. */
static gamut_status add(struct reader *reader, struct tree *parent, struct tree *node)
{
  if (node == NULL)
    return no_memory(reader);
  if (parent == NULL)
    reader->root = node;
  return GAMUT_OK;
}

static gamut_status copy_alias(struct reader *reader, const struct place *place,
                               const struct tree *from, struct tree *parent, const char *key,
                               int depth)
{
  gamut_status status = count_node(reader, place, depth);
  if (status != GAMUT_OK)
    return status;
  struct tree *copy = node_copy_shallow(parent, from, key);
  TRY(add(reader, parent, copy));
  for (size_t k = 0; k < from->children; k++)
    TRY(copy_alias(reader, place, from->child[k], copy, from->child[k]->key, depth + 1));
done:
  return status;
}

static gamut_status read_alias(struct reader *reader, const char *name, const struct place *place,
                               struct tree *parent, const char *key, int depth)
{
  const struct tree *target = NULL;
  for (size_t k = reader->anchors; k-- > 0 && target == NULL;)
    if (strcmp(reader->anchor[k].name, name) == 0)
      target = reader->anchor[k].tree;
  if (target == NULL)
    return trace_fail_at(reader->trace, reader->blame, place, NULL,
                         "text that begins with * needs quotes",
                         "no anchor '&%.60s' before this alias", name);
  for (const struct tree *above = parent; above != NULL; above = above->parent)
    if (above == target)
      return refuse(reader, place, NULL, "this alias stands inside what it repeats");
  return copy_alias(reader, place, target, parent, key, depth);
}

static int by_key(const void *one, const void *other)
{
  const struct tree *a = *(struct tree *const *)one, *b = *(struct tree *const *)other;
  int order = strcmp(a->key, b->key);
  if (order == 0)
    order = (a->key_place.line > b->key_place.line) - (a->key_place.line < b->key_place.line);
  if (order == 0)
    order =
        (a->key_place.column > b->key_place.column) - (a->key_place.column < b->key_place.column);
  return order;
}

/* Sorted, so that a mapping of many keys takes no quadratic time. */
static gamut_status check_duplicates(struct reader *reader, const struct tree *mapping)
{
  size_t count = mapping->children, first = 0;
  if (count < 2)
    return GAMUT_OK;
  struct tree **sorted = malloc(count * sizeof *sorted);
  if (sorted == NULL)
    return no_memory(reader);
  memcpy(sorted, mapping->child, count * sizeof *sorted);
  qsort(sorted, count, sizeof *sorted, by_key);
  for (size_t k = 1; k < count; k++) {
    if (strcmp(sorted[k]->key, sorted[first]->key) != 0) {
      first = k;
      continue;
    }
    char path[300];
    reader->found = trace_fail_at(reader->trace, reader->blame, &sorted[k]->key_place,
                                  tree_path(sorted[k], path, sizeof path), "remove one of them",
                                  "key '%.60s' is given twice, first at line %d", sorted[k]->key,
                                  sorted[first]->key_place.line);
  }
  free(sorted);
  return GAMUT_OK;
}

static gamut_status read_node(struct reader *, struct tree *parent, const char *key,
                              const struct place *key_place, const yaml_event_t *, int depth);

static gamut_status read_sequence(struct reader *reader, struct tree *sequence, int depth)
{
  gamut_status status = GAMUT_OK;
  while (status == GAMUT_OK) {
    yaml_event_t event;
    status = next_event(reader, &event);
    if (status != GAMUT_OK)
      break;
    bool end = event.type == YAML_SEQUENCE_END_EVENT;
    if (!end)
      status = read_node(reader, sequence, NULL, NULL, &event, depth + 1);
    yaml_event_delete(&event);
    if (end)
      break;
  }
  return status;
}

static bool has_zero(const yaml_event_t *event)
{
  return memchr(event->data.scalar.value, '\0', event->data.scalar.length) != NULL;
}

static gamut_status check_key(const struct reader *reader, const yaml_event_t *event,
                              const struct place *place)
{
  if (event->type != YAML_SCALAR_EVENT)
    return refuse(reader, place, "a key is a word",
                  "a list, a mapping or an alias cannot be a key");
  if (event->data.scalar.length == 0 || has_zero(event))
    return refuse(reader, place, NULL, "a key is empty or has a zero byte in it");
  if (event->data.scalar.anchor != NULL || event->data.scalar.tag != NULL)
    return refuse(reader, place, NULL, "a key cannot have an anchor (&name) or a tag (!name)");
  return GAMUT_OK;
}

static gamut_status read_mapping(struct reader *reader, struct tree *mapping, int depth)
{
  gamut_status status = GAMUT_OK;
  for (;;) {
    yaml_event_t key, value;
    status = next_event(reader, &key);
    if (status != GAMUT_OK)
      return status;
    if (key.type == YAML_MAPPING_END_EVENT) {
      yaml_event_delete(&key);
      return check_duplicates(reader, mapping);
    }
    struct place place = place_of(reader, &key);
    status = check_key(reader, &key, &place);
    if (status == GAMUT_OK)
      status = next_event(reader, &value);
    if (status == GAMUT_OK) {
      const char *word = (const char *)key.data.scalar.value;
      status = read_node(reader, mapping, word, &place, &value, depth + 1);
      yaml_event_delete(&value);
    }
    yaml_event_delete(&key);
    if (status != GAMUT_OK)
      return status;
  }
}

static const char *anchor_of(const yaml_event_t *event)
{
  const yaml_char_t *anchor = event->type == YAML_SCALAR_EVENT ? event->data.scalar.anchor
                              : event->type == YAML_SEQUENCE_START_EVENT
                                  ? event->data.sequence_start.anchor
                                  : event->data.mapping_start.anchor;
  return (const char *)anchor;
}

static bool has_tag(const yaml_event_t *event)
{
  return (event->type == YAML_SCALAR_EVENT && event->data.scalar.tag != NULL) ||
         (event->type == YAML_SEQUENCE_START_EVENT && event->data.sequence_start.tag != NULL) ||
         (event->type == YAML_MAPPING_START_EVENT && event->data.mapping_start.tag != NULL);
}

/* Reads what the event begins and hangs it below `parent`. The event stays the caller's. */
static gamut_status read_node(struct reader *reader, struct tree *parent, const char *key,
                              const struct place *key_place, const yaml_event_t *event, int depth)
{
  gamut_status status = GAMUT_OK;
  struct place place = place_of(reader, event);
  if (event->type == YAML_ALIAS_EVENT) {
    TRY(read_alias(reader, (const char *)event->data.alias.anchor, &place, parent, key, depth));
    if (key_place != NULL)
      parent->child[parent->children - 1]->key_place = *key_place;
    goto done;
  }
  TRY(count_node(reader, &place, depth));
  if (has_tag(event))
    return refuse(reader, &place, "text that begins with ! needs quotes",
                  "a tag (!name) has no meaning here");
  bool scalar = event->type == YAML_SCALAR_EVENT;
  if (scalar && has_zero(event))
    return refuse(reader, &place, NULL, "a zero byte in text");
  enum tree_kind kind = scalar                                     ? TREE_SCALAR
                        : event->type == YAML_SEQUENCE_START_EVENT ? TREE_SEQUENCE
                                                                   : TREE_MAPPING;
  const char *text = scalar ? (const char *)event->data.scalar.value : "";
  struct tree *node = node_new(parent, kind, text, key, reader->origin);
  TRY(add(reader, parent, node));
  node->quoted =
      scalar && (event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE || strchr(text, '\n') != NULL);
  node->place = place;
  node->key_place = key_place != NULL ? *key_place : place;
  TRY(note_anchor(reader, &place, anchor_of(event), node));
  if (kind == TREE_SEQUENCE)
    TRY(read_sequence(reader, node, depth));
  else if (kind == TREE_MAPPING)
    TRY(read_mapping(reader, node, depth));
done:
  return status;
}

static gamut_status refuse_empty(const struct reader *reader)
{
  struct place file = origin_place(reader->origin, 0, 0, 1);
  return refuse(reader, &file, NULL, "there is nothing in it");
}

/* The events of a stream: start, documents (start, node, end), end. */
static gamut_status read_stream(struct reader *reader)
{
  gamut_status status;
  for (int documents = 0;;) {
    yaml_event_t event;
    status = next_event(reader, &event);
    if (status != GAMUT_OK)
      return status;
    yaml_event_type_t type = event.type;
    struct place place = place_of(reader, &event);
    if (type == YAML_DOCUMENT_START_EVENT && ++documents > 1)
      status = refuse(reader, &place, "remove '---' and what follows, or write two files",
                      "a second document begins here");
    else if (type == YAML_SCALAR_EVENT || type == YAML_SEQUENCE_START_EVENT ||
             type == YAML_MAPPING_START_EVENT || type == YAML_ALIAS_EVENT)
      status = read_node(reader, NULL, NULL, NULL, &event, 1);
    yaml_event_delete(&event);
    if (status != GAMUT_OK)
      return status;
    if (type == YAML_STREAM_END_EVENT)
      break;
  }
  const struct tree *root = reader->root;
  if (root == NULL || (root->kind == TREE_SCALAR && root->text[0] == '\0' && !root->quoted))
    return refuse_empty(reader);
  return reader->found;
}

gamut_status tree_parse(const char *text, size_t size, const char *name, gamut_status blame,
                        struct trace *trace, struct tree **root)
{
  struct reader reader = {.trace = trace, .blame = blame, .found = GAMUT_OK};
  struct place file = {.file = name};
  gamut_status status = GAMUT_OK;
  *root = NULL;
  if (size > TREE_BYTES_MAX)
    return trace_fail_at(trace, blame, &file, NULL, NULL,
                         "the text has %zu bytes; at most %d are read", size, TREE_BYTES_MAX);
  if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) { /* a byte order mark is no text */
    text += 3;
    size -= 3;
  }
  bool started = yaml_parser_initialize(&reader.parser);
  reader.origin = origin_new(name, text, size);
  if (reader.origin == NULL || !started) {
    status = trace_fail(trace, GAMUT_INTERNAL, "no memory left to read '%s'", name);
    goto done;
  }
  TRY(source_check(reader.origin, text, size, blame, trace));
  yaml_parser_set_encoding(&reader.parser, YAML_UTF8_ENCODING);
  yaml_parser_set_input_string(&reader.parser, (const unsigned char *)text, size);
  TRY(read_stream(&reader));
  *root = reader.root;
  reader.root = NULL;
done:
  tree_free(reader.root);
  for (size_t k = 0; k < reader.anchors; k++)
    free(reader.anchor[k].name);
  free(reader.anchor);
  origin_release(reader.origin);
  if (started)
    yaml_parser_delete(&reader.parser);
  return status;
}

gamut_status tree_read(const char *file, gamut_status blame, struct trace *trace,
                       struct tree **root)
{
  char *text, why[160];
  size_t size;
  struct place place = {.file = file};
  *root = NULL;
  if (!text_load(file, TREE_BYTES_MAX, &text, &size, why, sizeof why))
    return trace_fail_at(trace, blame, &place, NULL, NULL, "%s", why);
  gamut_status status = tree_parse(text, size, file, blame, trace, root);
  free(text);
  return status;
}
