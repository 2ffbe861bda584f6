/* Values that hold others: lists and maps, whose entries the scene names, and the forms of a value
 * that may be written in several ways. */
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

/* Room for the number of an entry. */
enum { NUMBER_SIZE = 24 };

static bool of_words(const struct parameter *parameter)
{
  return parameter->of->type == VALUE_TEXT || parameter->of->type == VALUE_BODY;
}

/* A word alone is a list of one. */
static size_t entries_of(const struct tree *node)
{
  return !node ? 0 : node->kind == TREE_SCALAR ? 1 : node->children;
}

static const struct tree *entry_of(const struct tree *node, size_t index)
{
  return node->kind == TREE_SCALAR ? node : node->child[index];
}

/* Values of parameters of their own, one an entry: those of a list are called by their numbers. */
static struct values *entries_new(const struct parameter *parameter, const struct tree *node,
                                  const char *path)
{
  const size_t count = entries_of(node);
  struct parameter *own = scene_take(count, sizeof *own + NUMBER_SIZE);
  char *number = (char *)(own + count);
  for (size_t i = 0; i < count; i++, number += NUMBER_SIZE) {
    own[i] = *parameter->of;
    own[i].name = number;
    if (parameter->type == VALUE_MAP)
      own[i].name = node->child[i]->key;
    else
      snprintf(number, NUMBER_SIZE, "%zu", i);
  }
  struct values *values = values_new(own, count, node, path);
  values->own = own;
  return values;
}

/* Whether the node holds as many entries as there may be, written as they should. */
static bool entries_expected(struct scene_reader *reader, const struct parameter *parameter,
                             const struct tree *node)
{
  char what[160], expected[160];
  const size_t count = entries_of(node), least = parameter->size_min, most = parameter->size_max;
  snprintf(what, sizeof what, "'%s'", parameter->name);
  if (parameter->type == VALUE_MAP && !expect_mapping(reader, node, what))
    return false;
  if (parameter->type == VALUE_LIST && !(parameter_forms(parameter) >> node->kind & 1U)) {
    error_at_value(reader, node, "a list, \"[one, other]\"", "%s is %s where a list is due", what,
                   node->kind == TREE_MAPPING ? "a mapping"
                   : node->text[0]            ? "a plain value"
                                              : "empty");
    return false;
  }
  if (count >= least && count <= most)
    return true;
  if (count < least)
    snprintf(expected, sizeof expected, "at least %zu", least);
  else
    snprintf(expected, sizeof expected, "at most %zu", most);
  error_at_value(reader, node, expected, "%s has %zu entries", what, count);
  return false;
}

/* An entry that is a plain value is called like its list in messages, other ones by their name. */
static void entry_read(struct scene_reader *reader, const struct parameter *parameter,
                       const struct tree *node, struct values *entries, size_t index)
{
  char what[192];
  const struct parameter *own = &entries->parameter[index];
  struct value *value = &entries->value[index];
  struct parameter shown = *own;
  *value = (struct value){.parameter = own, .node = node, .given = true};
  if (parameter->type == VALUE_MAP)
    expect_name(reader, node, "an entry");
  if (own->type == VALUE_GROUP) {
    if (parameter->type == VALUE_MAP)
      snprintf(what, sizeof what, "'%s'", own->name);
    else
      snprintf(what, sizeof what, "entry %s of '%s'", own->name, parameter->name);
    value->present = group_read(reader, own, node, entries->path, what, false, value);
    return;
  }
  if (parameter->type == VALUE_LIST && !own->member && !own->of)
    shown.name = parameter->name;
  value->present = value_read(reader, &shown, node, entries->path, value);
}

static int by_text(const void *one, const void *other)
{
  const struct value *const *a = one, *const *b = other;
  const int order = strcmp((*a)->text, (*b)->text);
  return order ? order : (*a > *b) - (*a < *b);
}

/* No text stands twice in a list of them. */
static void twice_check(struct scene_reader *reader, const struct parameter *parameter,
                        const struct values *entries)
{
  const struct value **sorted = scene_take(entries->count, sizeof *sorted);
  size_t count = 0;
  for (size_t i = 0; i < entries->count; i++)
    if (entries->value[i].text)
      sorted[count++] = &entries->value[i];
  if (count)
    qsort(sorted, count, sizeof *sorted, by_text);
  for (size_t i = 1; i < count; i++)
    if (strcmp(sorted[i]->text, sorted[i - 1]->text) == 0)
      error_at_value(reader, sorted[i]->node, NULL, "'%s' stands twice in '%s'", sorted[i]->text,
                     parameter->name);
  free(sorted);
}

bool entries_read(struct scene_reader *reader, const struct parameter *parameter,
                  const struct tree *node, const char *path, struct value *value)
{
  char below[PATH_SIZE];
  const size_t faults = reader->faults;
  const bool outside = reader->pointwise;
  if (node && !entries_expected(reader, parameter, node))
    node = NULL;
  reader->pointwise = false;
  value->group = entries_new(parameter, node, path_below(path, parameter->name, below));
  for (size_t i = 0; i < value->group->count; i++)
    entry_read(reader, parameter, entry_of(node, i), value->group, i);
  if (parameter->type == VALUE_LIST && of_words(parameter))
    twice_check(reader, parameter, value->group);
  reader->pointwise = outside;
  return reader->faults == faults;
}

/* The form in which a node is written; its words come before what any text may be. */
static const struct parameter *form_of(const struct parameter *parameter, const struct tree *node)
{
  size_t number;
  for (size_t i = 0; i < parameter->members; i++)
    if (parameter_is_word(&parameter->member[i]) &&
        word_known(&parameter->member[i], node, &number))
      return &parameter->member[i];
  for (size_t i = 0; i < parameter->members; i++)
    if (!parameter_is_word(&parameter->member[i]) &&
        parameter_forms(&parameter->member[i]) >> node->kind & 1U)
      return &parameter->member[i];
  return NULL;
}

static void error_at_form(struct scene_reader *reader, const struct parameter *parameter,
                          const struct tree *node)
{
  char expected[WORDS_SIZE] = "";
  size_t length = 0;
  for (size_t i = 0; i < parameter->members && length < sizeof expected; i++)
    length += (size_t)snprintf(expected + length, sizeof expected - length, "%s%s",
                               i ? "; or " : "", parameter->member[i].doc);
  if (node->kind == TREE_SCALAR)
    error_at_value(reader, node, expected, "'%s' cannot be '%.40s'", parameter->name, node->text);
  else
    error_at_value(reader, node, expected, "'%s' cannot be %s", parameter->name,
                   node->kind == TREE_MAPPING ? "a mapping" : "a list");
}

bool one_of_read(struct scene_reader *reader, const struct parameter *parameter,
                 const struct tree *node, const char *path, struct value *value)
{
  char below[PATH_SIZE];
  const struct section none = {.parameter = parameter->member,
                               .count = parameter->members,
                               .path = path_below(path, parameter->name, below),
                               .what = parameter->name,
                               .lenient = true};
  const struct parameter *form = node ? form_of(parameter, node) : NULL;
  value->group = section_read(reader, &none);
  value->group->node = node;
  if (node && !form)
    error_at_form(reader, parameter, node);
  if (!form)
    return false;
  struct value *chosen = &value->group->value[form - parameter->member];
  struct parameter shown = *form; /* in messages and paths it is called as the scene calls it */
  shown.name = parameter->name;
  values_free(chosen->group);
  *chosen = (struct value){.parameter = form, .node = node, .given = true};
  chosen->present = value_read(reader, &shown, node, path, chosen);
  return chosen->present;
}

unsigned alternative_given(const struct section *section)
{
  for (size_t i = 0; section->one_of && section->one_of->sets && i < section->count; i++)
    if (section->parameter[i].set && tree_get(section->node, section->parameter[i].name))
      return section->parameter[i].set;
  return 0;
}

void alternatives_check(struct scene_reader *reader, const struct section *section, unsigned given)
{
  char expected[WORDS_SIZE];
  const struct parameter *first = NULL;
  bool meant = section->lenient;
  if (!section->one_of || !section->one_of->sets)
    return;
  alternatives_text(section->parameter, section->count, expected, sizeof expected);
  for (size_t i = 0; i < section->count; i++) {
    const struct parameter *p = &section->parameter[i];
    const struct tree *node = p->set ? tree_get(section->node, p->name) : NULL;
    meant = meant || (p->set && is_typo_of(reader, section->node, p->name));
    if (node && first && p->set != given)
      error_at_key(reader, node, expected, "'%s' and '%s' are both given in %s", first->name,
                   p->name, section->what);
    first = node && !first ? p : first;
  }
  if (!given && section->one_of->needed && !meant)
    error_at_missing(reader, section->node, section->path, expected,
                     "%s lacks one of its alternatives", section->what);
}
