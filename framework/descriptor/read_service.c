/* What a plugin offers and asks for: requires, provides, phases, axis, measures, parameters that it
 * adds to bodies and materials. */
#include <string.h>

#include "catalogue/catalogue.h"
#include "descriptor/descriptor_private.h"

/* Names that a measure's formula may use: components of the fields of the catalogue and of this
 * plugin. */
static void add_components(struct reader *reader, const char *name, unsigned components,
                           const char **names, size_t *count)
{
  for (unsigned k = 0; k < components; k++) {
    const char *part = component_name(components, k);
    /* A name that is too long has been reported, and is still read. */
    const size_t size = strlen(name) + 1 + strlen(part) + 1;
    char *text = reader_keep(reader, size, 1);
    snprintf(text, size, "%s%s%s", name, part[0] ? "_" : "", part);
    const char *kept = text;
    for (size_t i = 0; i < *count && kept; i++)
      if (strcmp(names[i], kept) == 0)
        kept = NULL;
    if (kept)
      names[(*count)++] = kept;
  }
}

static size_t measurable_names(struct reader *reader, const char ***names)
{
  const struct descriptor *d = reader->descriptor;
  size_t room = 0, count = 0;
  for (size_t i = 0; catalogue_at(i); i++)
    room += catalogue_at(i)->components;
  room += (d->inputs + d->outputs + d->states) * CATALOGUE_COMPONENTS_MAX;
  *names = reader_keep(reader, room, sizeof **names);
  for (size_t i = 0; catalogue_at(i); i++)
    add_components(reader, catalogue_at(i)->name, catalogue_at(i)->components, *names, &count);
  for (size_t i = 0; i < d->inputs; i++)
    add_components(reader, d->input[i].name, d->input[i].components, *names, &count);
  for (size_t i = 0; i < d->outputs; i++)
    add_components(reader, d->output[i].name, d->output[i].components, *names, &count);
  for (size_t i = 0; i < d->states; i++)
    add_components(reader, d->state[i].name, d->state[i].components, *names, &count);
  return count;
}

/* A field's own name is enough: with components it is measured by component. */
static bool is_measurable(const char *name, const char *const *names, size_t count)
{
  size_t length = strlen(name);
  for (size_t i = 0; i < count; i++)
    if (strncmp(names[i], name, length) == 0 && (names[i][length] == 0 || names[i][length] == '_'))
      return true;
  return false;
}

/* A unit is taken from a field that an argument of the same measure names. */
static void check_unit_of(struct reader *reader, const struct tree *node,
                          const struct measure *measure, const char *unit_of)
{
  const struct parameter *by =
      unit_of ? parameter_named(measure->argument, measure->arguments, unit_of) : NULL;
  if (unit_of && (!by || by->type != VALUE_TEXT))
    reader_error_at_value(reader, tree_get(node, "unit_of"),
                          "an argument of type text, which names a field",
                          "measure '%s' has no such argument '%s'", measure->name, unit_of);
}

static void read_measure(struct reader *reader, const struct tree *node, const char *const *names,
                         size_t count, struct measure *measure)
{
  static const char *const keys[] = {"unit",      "at",      "formula", "doc",
                                     "arguments", "against", "unit_of"};
  static const char *const places[] = {"point", "body", "run"};
  measure->name = node->key;
  measure->unit = "1";
  check_name(reader, node, true, node->key);
  if (!check_keys(reader, node, keys, ARRAY_SIZE(keys), "a measure"))
    return;
  measure->unit_of = read_text(reader, node, "unit_of", false);
  const char *unit = read_unit(reader, node, "unit", !measure->unit_of);
  if (unit && measure->unit_of)
    reader_error_at_value(reader, tree_get(node, "unit"), NULL,
                          "'unit_of' leaves the unit to the scene: 'unit' cannot stand beside it");
  measure->unit = unit ? unit : "1";
  measure->doc = read_text(reader, node, "doc", true);
  measure->formula = read_text(reader, node, "formula", false);
  const char *at = read_text(reader, node, "at", true);
  bool known = !at;
  for (size_t i = 0; at && i < ARRAY_SIZE(places); i++)
    if (strcmp(at, places[i]) == 0) {
      measure->at = (enum measure_at)i;
      known = true;
    }
  if (!known)
    reader_error_at_unknown(reader, tree_get(node, "at"), false, places, ARRAY_SIZE(places),
                            "'%s' is no place of a measure", at);
  if (measure->formula)
    check_expression(reader, tree_get(node, "formula"), measure->formula, names, count);
  else if (known && measure->at == MEASURE_POINT && !is_measurable(measure->name, names, count))
    reader_error_at_key(reader, node, "a formula, or the name of a field",
                        "measure '%s' at points has no formula", node->key);
  measure->arguments =
      read_parameters(reader, tree_get(node, "arguments"), DECLARED_ARGUMENT, &measure->argument);
  check_unit_of(reader, node, measure, measure->unit_of);
  for (size_t i = 0; i < measure->arguments; i++) {
    const struct tree *argument = tree_get(node, "arguments")->child[i];
    check_unit_of(reader, argument, measure, measure->argument[i].unit_of);
    check_entry_of(reader, argument, &measure->argument[i]);
  }
}

/* The measure that is a curve's axis. */
static void read_against(struct reader *reader, const struct tree *node, struct measure *measure)
{
  const struct descriptor *d = reader->descriptor;
  const char *name = read_text(reader, node, "against", false);
  if (!name)
    return;
  for (size_t i = 0; i < d->measures; i++)
    if (strcmp(d->measure[i].name, name) == 0)
      measure->against = &d->measure[i];
  const struct measure *axis = measure->against;
  if (!axis || axis == measure || axis->at != measure->at || axis->arguments ||
      axis->at == MEASURE_POINT)
    reader_error_at_value(reader, tree_get(node, "against"),
                          "another measure at the same body or run, no arguments",
                          "measure '%s' cannot be taken against '%s'", measure->name, name);
}

static void read_measures(struct reader *reader, const struct tree *node)
{
  struct descriptor *d = reader->descriptor;
  if (!node)
    return;
  if (node->kind != TREE_MAPPING) {
    reader_error_at_value(reader, node, "{name: {unit: Pa, at: point, doc: ...}}",
                          "'measures' is no mapping");
    return;
  }
  const char **names;
  size_t count = measurable_names(reader, &names);
  d->measure = reader_keep(reader, node->children, sizeof *d->measure);
  for (size_t i = 0; i < node->children; i++)
    read_measure(reader, node->child[i], names, count, &d->measure[d->measures++]);
  for (size_t i = 0; i < node->children; i++)
    read_against(reader, node->child[i], &d->measure[i]);
}

static void read_axis(struct reader *reader, const struct tree *node)
{
  static const char *const keys[] = {"name", "unit"};
  struct descriptor *d = reader->descriptor;
  if (!node || !check_keys(reader, node, keys, ARRAY_SIZE(keys), "'axis'"))
    return;
  const char *name = read_text(reader, node, "name", true);
  const char *unit = read_unit(reader, node, "unit", true);
  d->axis = name ? name : d->axis;
  d->axis_unit = unit ? unit : d->axis_unit;
}

static void read_yields(struct reader *reader, const struct tree *root)
{
  static const char *const known[] = {"moments", "table"};
  const char *text = read_text(reader, root, "yields", false);
  if (!text)
    return;
  reader->descriptor->yields_table = strcmp(text, known[1]) == 0;
  if (!reader->descriptor->yields_table && strcmp(text, known[0]) != 0)
    reader_error_at_value(reader, tree_get(root, "yields"), "moments or table",
                          "an estimator cannot yield '%s'", text);
}

void read_services(struct reader *reader, const struct tree *root)
{
  struct descriptor *d = reader->descriptor;
  d->require = read_texts(reader, tree_get(root, "requires"), "requires", &d->requirements);
  d->provide = read_texts(reader, tree_get(root, "provides"), "provides", &d->provisions);
  d->phase = read_texts(reader, tree_get(root, "phases"), "phases", &d->phases);
  if (d->kind == GAMUT_KIND_SOLVER) {
    d->axis = "time";
    d->axis_unit = "s";
  }
  read_axis(reader, tree_get(root, "axis"));
  read_yields(reader, root);
  d->adaptive = read_flag(reader, root, "adaptive", false);
  d->omits_failed_runs = read_flag(reader, root, "omits_failed_runs", true);
  read_measures(reader, tree_get(root, "measures"));
}
