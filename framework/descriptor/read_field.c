/* What a plugin reads, writes, remembers and calls: inputs, outputs, state, scratch, laws,
 * derivatives. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"
#include "descriptor/descriptor_private.h"

/* What an optional input reads where nobody gives it a value. */
static void read_absent(struct reader *reader, const struct tree *own, struct field_use *use)
{
  const struct field_info *entry = catalogue_find(use->name);
  const char *text = own ? read_text(reader, own, "absent", false) : NULL;
  use->absent = entry ? access_neutral(entry->access) : 0.0;
  if (!text)
    return;
  const struct tree *node = tree_get(own, "absent");
  char expected[128];
  snprintf(expected, sizeof expected, "%s, or inf", unit_example(use->unit));
  if (!use->optional)
    reader_error_at_value(reader, node, "a '?' behind the name", "'%s' is never absent", use->name);
  else if (entry && entry->where != GAMUT_AT_POINT)
    reader_error_at_value(reader, node, "no 'absent'", "'%s' has a value in every scene",
                          use->name);
  else if (strcmp(text, "inf") == 0)
    use->absent = INFINITY;
  else if (unit_read_bare(reader->units, text, use->unit, &use->absent) != UNIT_OK)
    reader_error_at_value(reader, node, expected, "'%s' is no quantity in %s", text, use->unit);
}

/* "name" or "name?" or "name: {unit: .., components: .., absent: ..}" (a sequence item). */
static bool read_field(struct reader *reader, const struct tree *item, struct field_use *use)
{
  static const char *const keys[] = {"unit", "components", "absent"};
  const struct tree *own = NULL;
  if (item->kind == TREE_MAPPING && item->children == 1)
    own = item->child[0];
  const char *written = own ? own->key : item->text;
  if (item->kind == TREE_SEQUENCE || written[0] == 0) {
    reader_error_at_value(reader, item, "a name, or \"name: {unit: Pa, components: 1}\"",
                          "this is no field");
    return false;
  }
  size_t length = strlen(written);
  use->optional = written[length - 1] == '?';
  use->name = use->optional ? reader_text(reader, written, length - 1) : written;
  if (!check_name(reader, own ? own : item, own != NULL, use->name))
    return false;
  const struct field_info *entry = catalogue_find(use->name);
  if (own && check_keys(reader, own, keys, ARRAY_SIZE(keys), use->name)) {
    use->unit = read_unit(reader, own, "unit", !entry);
    use->components =
        (unsigned)read_whole(reader, own, "components", 1, CATALOGUE_COMPONENTS_MAX, 1);
  }
  if (entry) {
    use->unit = entry->unit;
    use->components = entry->components;
  } else if (!own) {
    const char *known[128];
    size_t count = 0;
    for (const struct field_info *v; count < ARRAY_SIZE(known) && (v = catalogue_at(count));
         count++)
      known[count] = v->name;
    char expected[256];
    const char *near = nearest(use->name, known, count);
    snprintf(expected, sizeof expected,
             "%s%s%sanother plugin's state is written \"%s: {unit: .., "
             "components: ..}\"",
             near ? "did you mean '" : "", near ? near : "", near ? "'? " : "", use->name);
    reader_error_at_value(reader, item, expected, "unknown field '%s'", use->name);
    return false;
  }
  if (!use->unit)
    use->unit = "1";
  read_absent(reader, own, use);
  return true;
}

static size_t read_uses(struct reader *reader, const struct tree *node, struct field_use **list)
{
  if (!node)
    return 0;
  if (node->kind != TREE_SEQUENCE) {
    reader_error_at_value(reader, node, "[pressure, sound_speed]", "'%s' is no list", node->key);
    return 0;
  }
  size_t count = 0;
  *list = reader_keep(reader, node->children, sizeof **list);
  for (size_t i = 0; i < node->children; i++)
    if (read_field(reader, node->child[i], &(*list)[count]))
      count++;
  return count;
}

static void read_state(struct reader *reader, const struct tree *node, struct state_variable *state)
{
  static const char *const keys[] = {"unit", "components", "initial", "doc"};
  state->name = node->key;
  state->unit = "1";
  state->components = 1;
  if (!check_name(reader, node, true, node->key) ||
      !check_keys(reader, node, keys, ARRAY_SIZE(keys), node->key))
    return;
  const struct field_info *entry = catalogue_find(node->key);
  const char *unit = read_unit(reader, node, "unit", !entry);
  unsigned standard = entry ? entry->components : 1;
  state->components =
      (unsigned)read_whole(reader, node, "components", 1, CATALOGUE_COMPONENTS_MAX, standard);
  state->doc = read_text(reader, node, "doc", !entry);
  if (entry) {
    if (unit && strcmp(unit, entry->unit) != 0)
      reader_error_at_value(reader, tree_get(node, "unit"), entry->unit, "'%s' has another unit",
                            node->key);
    if (state->components != entry->components)
      reader_error_at_value(reader, tree_get(node, "components"), NULL, "'%s' has %u components",
                            node->key, entry->components);
    unit = entry->unit;
    state->components = entry->components;
    if (!state->doc)
      state->doc = entry->meaning;
  }
  state->unit = unit ? unit : "1";
  const char *initial = read_text(reader, node, "initial", false);
  if (initial && unit_read_bare(reader->units, initial, state->unit, &state->initial) != UNIT_OK)
    reader_error_at_value(reader, tree_get(node, "initial"), unit_example(state->unit),
                          "the initial value '%s' is no quantity in %s", initial, state->unit);
}

static void read_states(struct reader *reader, const struct tree *node)
{
  struct descriptor *d = reader->descriptor;
  if (!node)
    return;
  if (node->kind != TREE_MAPPING) {
    reader_error_at_value(reader, node, "{name: {unit: Pa, doc: ...}}", "'state' is no mapping");
    return;
  }
  d->state = reader_keep(reader, node->children, sizeof *d->state);
  for (size_t i = 0; i < node->children; i++)
    read_state(reader, node->child[i], &d->state[d->states++]);
}

static void read_laws(struct reader *reader, const struct tree *node)
{
  static const char *const known[] = {"eos", "strength"};
  struct descriptor *d = reader->descriptor;
  size_t count;
  const char **text = read_texts(reader, node, "laws", &count);
  d->law = reader_keep(reader, count, sizeof *d->law);
  for (size_t i = 0; i < count; i++) {
    size_t length = strlen(text[i]);
    bool optional = text[i][length - 1] == '?';
    const char *name = optional ? reader_text(reader, text[i], length - 1) : text[i];
    if (strcmp(name, "eos") != 0 && strcmp(name, "strength") != 0)
      reader_error_at_unknown(reader, node->kind == TREE_SEQUENCE ? node->child[i] : node, false,
                              known, ARRAY_SIZE(known), "'%s' is no law", name);
    else
      d->law[d->laws++] = (struct field_use){.name = name, .optional = optional};
  }
}

static const struct field_use *use_named(const struct field_use *use, size_t count,
                                         const char *name)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(use[i].name, name) == 0)
      return &use[i];
  return NULL;
}

static void read_derivatives(struct reader *reader, const struct tree *node)
{
  static const char *const keys[] = {"of", "by"};
  struct descriptor *d = reader->descriptor;
  if (!node || !check_keys(reader, node, keys, ARRAY_SIZE(keys), "'derivatives'"))
    return;
  d->derivative_of = read_text(reader, node, "of", true);
  if (d->derivative_of && !use_named(d->output, d->outputs, d->derivative_of))
    reader_error_at_value(reader, tree_get(node, "of"), NULL, "'%s' is no output",
                          d->derivative_of);
  const struct tree *by = tree_get(node, "by");
  if (!by)
    reader_error_at_key(reader, node, NULL, "'by' is missing");
  d->derivative_by = read_texts(reader, by, "by", &d->derivatives);
  for (size_t i = 0; i < d->derivatives; i++) {
    const struct parameter *parameter =
        parameter_named(d->parameter, d->parameters, d->derivative_by[i]);
    const struct field_use *input = use_named(d->input, d->inputs, d->derivative_by[i]);
    const bool real = parameter && parameter->type == VALUE_REAL && !parameter->prepared;
    if (!real && !(input && input->components == 1))
      reader_error_at_value(
          reader, by->kind == TREE_SEQUENCE ? by->child[i] : by, NULL,
          "'%s' is neither a real parameter that kernels see nor an input with one "
          "component",
          d->derivative_by[i]);
  }
  if (!d->derivative_of)
    d->derivatives = 0;
}

void read_fields(struct reader *reader, const struct tree *root)
{
  struct descriptor *d = reader->descriptor;
  d->inputs = read_uses(reader, tree_get(root, "inputs"), &d->input);
  d->outputs = read_uses(reader, tree_get(root, "outputs"), &d->output);
  read_states(reader, tree_get(root, "state"));
  d->scratch = (size_t)read_whole(reader, root, "scratch", 0, 256, 0);
  read_laws(reader, tree_get(root, "laws"));
  d->inverse = read_flag(reader, root, "inverse", false);
  d->prepare = read_flag(reader, root, "prepare", false);
  read_derivatives(reader, tree_get(root, "derivatives"));
}
