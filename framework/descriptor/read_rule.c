/* Rules over parameters: constraints, alternative sets, variants. */
#include <math.h>
#include <string.h>

#include "descriptor/descriptor_private.h"

static const struct tree *item_of(const struct tree *list, size_t index)
{
  return list->kind == TREE_SEQUENCE ? list->child[index] : list;
}

static void read_constraints(struct reader *reader, const struct tree *node)
{
  struct descriptor *d = reader->descriptor;
  const char **names;
  size_t count = arithmetic_names(reader, &names);
  d->constraint = read_texts(reader, node, "constraints", &d->constraints);
  for (size_t i = 0; i < d->constraints; i++) {
    const char *text = d->constraint[i];
    if (!strpbrk(text, "<>") && !strstr(text, "==") && !strstr(text, "!="))
      reader_error_at_value(reader, item_of(node, i), "such as \"T_melt > T_room\"",
                            "'%s' compares nothing", text);
    check_expression(reader, item_of(node, i), text, names, count);
  }
}

/* A flow stress limits the shear that an elasticity builds up: without a shear modulus a law would
 * change nothing, in silence. A law of fluids says that it needs none. */
static void need_shear(struct reader *reader)
{
  struct descriptor *d = reader->descriptor;
  if (d->kind != GAMUT_KIND_STRENGTH)
    return;
  d->need = reader_keep(reader, 1, sizeof *d->need);
  d->need[d->needs++] = (struct need){"shear_modulus", {true, 0.0, INFINITY, true, true}};
}

static size_t read_ranges(struct reader *reader, const struct tree *node, const char *what,
                          struct need **list)
{
  char why[256];
  if (node->kind != TREE_MAPPING) {
    reader_error_at_value(reader, node, "{name: \"(0, inf)\"}", "'%s' is no mapping", what);
    return 0;
  }
  *list = reader_keep(reader, node->children, sizeof **list);
  for (size_t i = 0; i < node->children; i++) {
    struct need *need = &(*list)[i];
    const char *text = read_text(reader, node, node->child[i]->key, true);
    need->parameter = node->child[i]->key;
    if (text && !range_read(text, "1", reader->units, &need->range, why, sizeof why))
      reader_error_at_value(reader, node->child[i], NULL, "cannot read the range '%s': %s", text,
                            why);
  }
  return node->children;
}

static void read_needs(struct reader *reader, const struct tree *root)
{
  struct descriptor *d = reader->descriptor;
  const struct tree *needs = tree_get(root, "needs"), *usual = tree_get(root, "usual");
  if (needs)
    d->needs = read_ranges(reader, needs, "needs", &d->need);
  else
    need_shear(reader);
  if (usual)
    d->usuals = read_ranges(reader, usual, "usual", &d->usual);
}

static bool contains(const char *const *list, size_t count, const char *name)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(list[i], name) == 0)
      return true;
  return false;
}

static void check_declared(struct reader *reader, const struct tree *node, bool at_key,
                           const char *name)
{
  const char **known;
  size_t count = arithmetic_names(reader, &known);
  if (!contains(known, count, name))
    reader_error_at_unknown(reader, node, at_key, known, count,
                            "'%s' is no parameter with a number", name);
}

/* What formulas of one set may use: what the set gives, what it has derived so far, and parameters
 * that belong to no set. */
static size_t usable_names(struct reader *reader, const struct given_set *set, size_t derived,
                           const char ***names)
{
  struct descriptor *d = reader->descriptor;
  const char **all;
  size_t every = arithmetic_names(reader, &all), count = 0;
  *names = reader_keep(reader, every, sizeof **names);
  for (size_t i = 0; i < every; i++) {
    bool mine = contains(set->name, set->names, all[i]) || contains(set->derived, derived, all[i]);
    bool somewhere = false;
    for (size_t g = 0; g < d->givens && !somewhere; g++)
      somewhere = contains(d->given[g].name, d->given[g].names, all[i]) ||
                  contains(d->given[g].derived, d->given[g].derivations, all[i]);
    if (mine || !somewhere)
      (*names)[count++] = all[i];
  }
  return count;
}

static void read_given_names(struct reader *reader, const struct tree *node, struct given_set *set)
{
  static const char *const keys[] = {"set", "then"};
  if (!check_keys(reader, node, keys, ARRAY_SIZE(keys), "a set of 'given'"))
    return;
  const struct tree *names = tree_get(node, "set"), *then = tree_get(node, "then");
  if (!names)
    reader_error_at_value(reader, node, "{set: [a, b], then: {c: \"a * b\"}}", "'set' is missing");
  set->name = read_texts(reader, names, "set", &set->names);
  for (size_t i = 0; i < set->names; i++)
    check_declared(reader, item_of(names, i), false, set->name[i]);
  if (!then)
    return;
  if (then->kind != TREE_MAPPING) {
    reader_error_at_value(reader, then, "{c: \"a * b\"}", "'then' is no mapping");
    return;
  }
  set->derived = reader_keep(reader, then->children, sizeof *set->derived);
  set->formula = reader_keep(reader, then->children, sizeof *set->formula);
  for (size_t i = 0; i < then->children; i++) {
    const struct tree *child = then->child[i];
    check_declared(reader, child, true, child->key);
    if (contains(set->name, set->names, child->key))
      reader_error_at_key(reader, child, NULL,
                          "'%s' is given by this set, so it cannot follow from it", child->key);
    set->derived[i] = child->key;
    set->formula[i] = read_text(reader, then, child->key, true);
    if (!set->formula[i])
      set->formula[i] = "0";
    set->derivations++;
  }
}

static void read_given(struct reader *reader, const struct tree *node)
{
  struct descriptor *d = reader->descriptor;
  if (!node)
    return;
  if (node->kind != TREE_SEQUENCE || node->children < 2) {
    reader_error_at_value(reader, node, "a list of two sets or more", "'given' offers no choice");
    return;
  }
  d->given = reader_keep(reader, node->children, sizeof *d->given);
  for (size_t i = 0; i < node->children; i++)
    read_given_names(reader, node->child[i], &d->given[d->givens++]);
  for (size_t g = 0; g < d->givens; g++) {
    const struct given_set *set = &d->given[g];
    const struct tree *then = tree_get(node->child[g], "then");
    for (size_t i = 0; i < set->derivations; i++) {
      const char **names;
      size_t count = usable_names(reader, set, i, &names);
      check_expression(reader, then->child[i], set->formula[i], names, count);
    }
  }
}

static void read_variants(struct reader *reader, const struct tree *node)
{
  static const char *const keys[] = {"when", "kernel", "drops"};
  struct descriptor *d = reader->descriptor;
  if (!node)
    return;
  if (node->kind != TREE_SEQUENCE) {
    reader_error_at_value(reader, node, "[{when: \"C == 0\", kernel: name}]",
                          "'variants' is no list");
    return;
  }
  const char **names;
  size_t count = arithmetic_names(reader, &names);
  d->variant = reader_keep(reader, node->children, sizeof *d->variant);
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *item = node->child[i];
    struct variant *variant = &d->variant[d->variants];
    if (!check_keys(reader, item, keys, ARRAY_SIZE(keys), "a variant"))
      continue;
    variant->when = read_text(reader, item, "when", true);
    variant->kernel = read_text(reader, item, "kernel", true);
    const struct tree *drops = tree_get(item, "drops");
    variant->drop = read_texts(reader, drops, "drops", &variant->drops);
    if (variant->when)
      check_expression(reader, tree_get(item, "when"), variant->when, names, count);
    for (size_t k = 0; k < variant->drops; k++) {
      bool input = false;
      for (size_t n = 0; n < d->inputs && !input; n++)
        input = strcmp(d->input[n].name, variant->drop[k]) == 0;
      if (!input)
        reader_error_at_value(reader, item_of(drops, k), NULL, "'%s' is no input",
                              variant->drop[k]);
    }
    if (variant->when && variant->kernel)
      d->variants++;
  }
}

void read_rules(struct reader *reader, const struct tree *root)
{
  read_constraints(reader, tree_get(root, "constraints"));
  read_needs(reader, root);
  read_given(reader, tree_get(root, "given"));
  read_variants(reader, tree_get(root, "variants"));
}
