/* The top of a plugin's YAML: who it is, and rules that span sections. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "descriptor/descriptor_private.h"

#define KIND(kind) (1U << (kind))
enum {
  EVERY = (1U << GAMUT_KINDS) - 1,
  LAWS = KIND(GAMUT_KIND_EOS) | KIND(GAMUT_KIND_STRENGTH),
  KERNELS = LAWS | KIND(GAMUT_KIND_ELASTICITY) | KIND(GAMUT_KIND_EFFECT),
  SOLVER = KIND(GAMUT_KIND_SOLVER),
  MEASURES = SOLVER | KIND(GAMUT_KIND_EFFECT) | KIND(GAMUT_KIND_ELASTICITY)
};

/* Which section has a meaning for which kinds. */
static const struct {
  const char *key;
  unsigned kinds;
} sections[] = {
    {"plugin", EVERY},
    {"version", EVERY},
    {"summary", EVERY},
    {"formula", EVERY},
    {"notes", EVERY},
    {"source", EVERY},
    {"parameters", EVERY},
    {"one_of", EVERY},
    {"constraints", EVERY},
    {"given", EVERY},
    {"needs", LAWS},
    {"usual", KIND(GAMUT_KIND_EOS)},
    {"requires", EVERY},
    {"provides", EVERY},
    {"messages", EVERY},
    {"inputs", KERNELS},
    {"outputs", KERNELS | SOLVER},
    {"scratch", KERNELS},
    {"state", KERNELS | SOLVER},
    {"laws", KIND(GAMUT_KIND_ELASTICITY) | SOLVER},
    {"inverse", KIND(GAMUT_KIND_STRENGTH)},
    {"prepare", KERNELS},
    {"derivatives", LAWS},
    {"variants", LAWS | KIND(GAMUT_KIND_ELASTICITY)},
    {"tasks", KIND(GAMUT_KIND_EFFECT)},
    {"body_parameters", SOLVER},
    {"material_parameters", KIND(GAMUT_KIND_EFFECT) | KIND(GAMUT_KIND_ELASTICITY)},
    {"phases", SOLVER},
    {"axis", SOLVER},
    {"yields", KIND(GAMUT_KIND_ESTIMATOR)},
    {"adaptive", KIND(GAMUT_KIND_ESTIMATOR)},
    {"omits_failed_runs", KIND(GAMUT_KIND_ESTIMATOR)},
    {"measures", MEASURES},
};

/* Structs of the public headers: a plugin's block would be a second one of that name. */
static bool is_public(const char *name)
{
  static const char *const tag[] = {
      "batch",        "body",   "chunk",       "eos_law",         "field",
      "host",         "law",    "moments",     "plane",           "plugin",
      "reaction",     "report", "row_cost",    "run",             "run_head",
      "set",          "stream", "study_shape", "study_parameter", "study_quantity",
      "strength_law", "task",   "use",         "table_column",    "values"};
  if (strcmp(name, "gamut") == 0)
    return true;
  for (size_t i = 0; strncmp(name, "gamut_", 6) == 0 && i < ARRAY_SIZE(tag); i++)
    if (strcmp(name + 6, tag[i]) == 0)
      return true;
  return false;
}

/* "kind/name" */
static bool read_identity(struct reader *reader, const struct tree *root)
{
  struct descriptor *d = reader->descriptor;
  const char *kinds[GAMUT_KINDS];
  for (int k = 0; k < GAMUT_KINDS; k++)
    kinds[k] = kind_name((enum gamut_kind)k);
  d->id = read_text(reader, root, "plugin", true);
  if (!d->id)
    return false;
  const struct tree *node = tree_get(root, "plugin");
  const char *slash = strchr(d->id, '/');
  if (!slash) {
    reader_error_at_value(reader, node, "kind/name, such as eos/linear", "'%s' names no kind",
                          d->id);
    return false;
  }
  const char *kind = reader_text(reader, d->id, (size_t)(slash - d->id));
  d->name = slash + 1;
  if (!kind_from_name(kind, &d->kind)) {
    char expected[256] = "";
    const char *near = nearest(kind, kinds, ARRAY_SIZE(kinds));
    if (near)
      snprintf(expected, sizeof expected, "did you mean '%s'?", near);
    else
      for (size_t k = 0; k < ARRAY_SIZE(kinds); k++)
        snprintf(expected + strlen(expected), sizeof expected - strlen(expected), "%s%s",
                 k ? ", " : "known are ", kinds[k]);
    reader_error_at_value(reader, node, expected, "'%s' is no kind of plugin", kind);
    return false;
  }
  if (is_reserved(d->name) || is_public(d->name)) {
    reader_error_at_value(reader, node, "another name", "a plugin cannot be called '%s'", d->name);
    return false;
  }
  return check_name(reader, node, false, d->name);
}

/* The file is called NAME.yaml. Below a folder that is called like a kind, the folders agree too.
 */
static void check_place(struct reader *reader, const struct tree *root, const char *file)
{
  struct descriptor *d = reader->descriptor;
  const struct tree *node = tree_get(root, "plugin");
  char path[PATH_MAX], expected[256];
  if (!realpath(file, path))
    snprintf(path, sizeof path, "%s", file);
  d->file = reader_text(reader, path, strlen(path));
  char *slash = strrchr(path, '/');
  const char *base = slash ? slash + 1 : path;
  snprintf(expected, sizeof expected, "%s.yaml", d->name);
  if (strcmp(base, expected) != 0)
    reader_error_at_value(reader, node, expected, "plugin '%s' stands in a file called '%s'",
                          d->name, base);
  if (!slash) {
    d->folder = ".";
    return;
  }
  *slash = 0;
  d->folder = reader_text(reader, path, strlen(path));
  enum gamut_kind kind;
  char *folder = strrchr(path, '/');
  if (!folder || folder == path)
    return;
  *folder++ = 0;
  const char *above = strrchr(path, '/');
  if (!above || !kind_from_name(above + 1, &kind))
    return;
  if (kind != d->kind)
    reader_error_at_value(reader, node, NULL, "plugin '%s' stands in the folder of the kind '%s'",
                          d->id, above + 1);
  else if (strcmp(folder, d->name) != 0)
    reader_error_at_value(reader, node, NULL, "plugin '%s' stands in a folder called '%s'", d->name,
                          folder);
}

static void check_sections(struct reader *reader, const struct tree *root)
{
  struct descriptor *d = reader->descriptor;
  const char *known[ARRAY_SIZE(sections)];
  for (size_t i = 0; i < ARRAY_SIZE(sections); i++)
    known[i] = sections[i].key;
  check_keys(reader, root, known, ARRAY_SIZE(known), "a plugin's YAML");
  for (size_t i = 0; i < ARRAY_SIZE(sections); i++) {
    const struct tree *node = tree_get(root, sections[i].key);
    if (node && !(sections[i].kinds & KIND(d->kind)))
      reader_error_at_key(reader, node, NULL, "'%s' has no meaning for plugins of kind %s",
                          sections[i].key, kind_name(d->kind));
  }
}

static void check_outputs(struct reader *reader, const struct tree *root)
{
  static const char *const must[GAMUT_KINDS][2] = {
      [GAMUT_KIND_EOS] = {"pressure", "sound_speed"},
      [GAMUT_KIND_STRENGTH] = {"flow_stress"},
  };
  const struct descriptor *d = reader->descriptor;
  for (size_t m = 0; m < 2 && must[d->kind][m]; m++) {
    bool found = false;
    for (size_t i = 0; i < d->outputs && !found; i++)
      found = strcmp(d->output[i].name, must[d->kind][m]) == 0;
    const struct tree *outputs = tree_get(root, "outputs");
    if (!found)
      reader_error_at_key(reader, outputs ? outputs : root, NULL, "a plugin of kind %s writes '%s'",
                          kind_name(d->kind), must[d->kind][m]);
  }
}

static void check_names(struct reader *reader, const struct tree *root, const char *section,
                        const struct parameter *parameter, size_t count)
{
  const struct descriptor *d = reader->descriptor;
  for (size_t i = 0; i < count; i++)
    if (!kernel_sees(&parameter[i]) &&
        parameter_named(d->parameter, d->parameters, parameter[i].name))
      reader_error_at_key(
          reader, tree_get(tree_get(root, section), parameter[i].name), "another name",
          "'%s' is declared twice, under 'parameters' and under '%s'", parameter[i].name, section);
}

static void check_prepared(struct reader *reader, const struct tree *section,
                           const struct parameter *parameter, size_t count, bool prepare)
{
  for (size_t i = 0; section && i < count; i++)
    if (parameter[i].prepared && !prepare)
      reader_error_at_key(reader, tree_get(section->child[i], "prepared"), NULL,
                          "no `prepare` reads '%s'", parameter[i].name);
}

/* What a law is given reaches its kernels, by itself or in what is prepared. */
static void check_prepare(struct reader *reader, const struct tree *root)
{
  const struct descriptor *d = reader->descriptor;
  const struct tree *section = tree_get(root, "parameters");
  check_prepared(reader, section, d->parameter, d->parameters, d->prepare);
  check_prepared(reader, tree_get(root, "material_parameters"), d->material_parameter,
                 d->material_parameters, false);
  check_prepared(reader, tree_get(root, "body_parameters"), d->body_parameter, d->body_parameters,
                 false);
  if (d->prepare && d->kind == GAMUT_KIND_EFFECT && !d->tasks)
    reader_error_at_key(reader, tree_get(root, "prepare"), "operations create and destroy",
                        "'%s' has no kernels that could carry what is prepared", d->id);
  const bool law = (KIND(d->kind) & KERNELS) && d->kind != GAMUT_KIND_EFFECT;
  for (size_t i = 0; law && !d->prepare && i < d->parameters; i++)
    if (!kernel_sees(&d->parameter[i]) && !d->parameter[i].prepared)
      reader_error_at_key(reader, section->child[i], "'prepare: true', and an operation that does",
                          "kernels see no value of type %s, and nothing prepares '%s' for them",
                          value_type_name(d->parameter[i].type), d->parameter[i].name);
}

static void read_all(struct reader *reader, const struct tree *root, const char *file)
{
  struct descriptor *d = reader->descriptor;
  if (root->kind != TREE_MAPPING) {
    reader_error_at_value(reader, root, "keys with values, beginning with \"plugin: kind/name\"",
                          "this is no plugin's YAML");
    return;
  }
  if (!read_identity(reader, root))
    return;
  check_place(reader, root, file);
  check_sections(reader, root);
  d->version = read_text(reader, root, "version", true);
  d->summary = read_text(reader, root, "summary", true);
  d->formula = read_text(reader, root, "formula", false);
  d->notes = read_text(reader, root, "notes", false);
  d->source = read_texts(reader, tree_get(root, "source"), "source", &d->sources);
  d->parameters =
      read_parameters(reader, tree_get(root, "parameters"), DECLARED_PARAMETER, &d->parameter);
  d->body_parameters = read_parameters(reader, tree_get(root, "body_parameters"),
                                       DECLARED_PARAMETER, &d->body_parameter);
  d->material_parameters = read_parameters(reader, tree_get(root, "material_parameters"),
                                           DECLARED_PARAMETER, &d->material_parameter);
  read_one_of(reader, tree_get(root, "one_of"), d->parameter, d->parameters, &d->one_of);
  check_names(reader, root, "material_parameters", d->material_parameter, d->material_parameters);
  read_fields(reader, root);
  read_rules(reader, root);
  read_messages(reader, root);
  read_services(reader, root);
  check_outputs(reader, root);
  check_prepare(reader, root);
  check_layout(reader, root);
  check_geometry(reader, root);
}

gamut_status descriptor_read(const char *file, const struct units *units, struct trace *trace,
                             struct descriptor **descriptor)
{
  struct tree *root = NULL;
  *descriptor = NULL;
  gamut_status status = tree_read(file, GAMUT_PLUGIN, trace, &root);
  if (status != GAMUT_OK)
    return status;
  struct descriptor_store *store = calloc(1, sizeof *store);
  if (!store) {
    tree_free(root);
    return trace_fail(trace, GAMUT_INTERNAL, "no memory left for '%s'", file);
  }
  store->shown.tree = root;
  struct reader reader = {.units = units, .trace = trace, .descriptor = &store->shown};
  read_all(&reader, root, file);
  if (reader.faults) {
    descriptor_free(&store->shown);
    return GAMUT_PLUGIN;
  }
  descriptor_seal(&store->shown);
  *descriptor = &store->shown;
  return GAMUT_OK;
}

void descriptor_free(struct descriptor *descriptor)
{
  if (!descriptor)
    return;
  struct descriptor_store *store = (struct descriptor_store *)(void *)descriptor;
  for (struct keep *kept = store->kept, *next; kept; kept = next) {
    next = kept->next;
    free(kept);
  }
  tree_free(store->shown.tree);
  free(store);
}
