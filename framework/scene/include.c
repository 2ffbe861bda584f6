#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/scene_private.h"

enum { INCLUDE_DEPTH_MAX = 16, INCLUDES_MAX = 100, ANCESTORS_MAX = 32 };

/* The files that are being read, outermost first. */
struct chain {
  const char *shown[INCLUDE_DEPTH_MAX];
  char *real[INCLUDE_DEPTH_MAX];
  size_t depth;
  size_t files;  /* read so far, each as often as it is asked for */
  size_t values; /* in them all; at most as many as one file may have */
};

/* Where a key `model` names a plugin: solver, materials.*.*, effects.*, uncertainty.estimator.
 * Names may hold dots, so that steps are counted, not dots. */
static bool names_plugin(const struct tree *node)
{
  char path[PATH_SIZE];
  tree_path(node, path, sizeof path);
  size_t steps = 0;
  for (const struct tree *at = node; at->parent; at = at->parent)
    steps++;
  return strcmp(path, "solver") == 0 || strcmp(path, "uncertainty.estimator") == 0 ||
         (strncmp(path, "effects.", 8) == 0 && steps == 2) ||
         (strncmp(path, "materials.", 10) == 0 && steps == 3);
}

/* Parameters of one plugin mean nothing to another: where `over` names another model than `base`,
 * nothing of the old one stays. */
static void forget_other_models(struct tree *base, const struct tree *over)
{
  if (base->kind != TREE_MAPPING || over->kind != TREE_MAPPING)
    return;
  const struct tree *old = tree_get(base, "model"), *new = tree_get(over, "model");
  if (old && new &&strcmp(old->text, new->text) != 0 && names_plugin(base))
    tree_clear(base);
  for (size_t i = 0; i < base->children; i++) {
    const struct tree *child = tree_get(over, base->child[i]->key);
    if (child)
      forget_other_models(base->child[i], child);
  }
}

static bool exists(const char *path)
{
  return access(path, F_OK) == 0;
}

/* "a/b/" becomes "a/", "" and "../" become "../" and "../../". False where it gets too long. */
static bool step_up(char *folder, size_t size)
{
  size_t length = strlen(folder), last = length ? length - 1 : 0;
  while (last > 0 && folder[last - 1] != '/')
    last--;
  if (length > 0 && strcmp(folder + last, "../") != 0) {
    folder[last] = 0;
    return true;
  }
  if (length + 4 > size)
    return false;
  memcpy(folder + length, "../", 4);
  return true;
}

/* In gamut's own folder `inputs`. */
static bool locate_data(const char *name, char *path, size_t size)
{
  char place[PATH_MAX];
  snprintf(place, sizeof place, "inputs/%s", name);
  return installed_data(place, path, size);
}

/* Looks beside the including file, in the folders `inputs` at and above it, in gamut's own. */
static bool locate(const char *from, const char *name, char *path, size_t size)
{
  const char *slash = strrchr(from, '/');
  char folder[PATH_MAX], real[PATH_MAX];
  snprintf(path, size, "%s", name);
  if (name[0] == '/')
    return exists(path);
  snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - from + 1) : 0, from);
  snprintf(path, size, "%s%s", folder, name);
  if (exists(path))
    return true;
  for (int i = 0; i < ANCESTORS_MAX; i++) {
    if (!realpath(folder[0] ? folder : ".", real))
      break;
    const char *last = strrchr(real, '/');
    snprintf(path, size, "%s%s", folder, name);
    if (last && strcmp(last + 1, "inputs") == 0 && exists(path))
      return true;
    snprintf(path, size, "%sinputs/%s", folder, name);
    if (exists(path))
      return true;
    if (strcmp(real, "/") == 0 || !step_up(folder, sizeof folder))
      break;
  }
  return locate_data(name, path, size);
}

static size_t node_count(const struct tree *tree)
{
  size_t count = 1;
  for (size_t i = 0; i < tree->children; i++)
    count += node_count(tree->child[i]);
  return count;
}

static const char *chain_text(const struct chain *chain, const char *last, char *buffer,
                              size_t size)
{
  size_t length = 0;
  buffer[0] = 0;
  for (size_t i = 0; i < chain->depth && length < size; i++)
    length += (size_t)snprintf(buffer + length, size - length, "%s includes ", chain->shown[i]);
  if (length < size)
    snprintf(buffer + length, size - length, "%s", last);
  return buffer;
}

static bool file_read(struct scene_reader *, const char *file, const struct tree *item,
                      struct chain *, struct tree **);

static bool item_read(struct scene_reader *reader, const struct tree *item, struct chain *chain,
                      struct tree **root)
{
  char path[2 * PATH_MAX], words[WORDS_SIZE];
  const char *text = text_read(reader, item, "include");
  if (!text)
    return false;
  if (!locate(chain->shown[chain->depth - 1], text, path, sizeof path)) {
    error_at_value(reader, item,
                   "a path from this file's folder, or from a folder 'inputs' above it or of gamut",
                   "included file '%s' is not found (%s)", text,
                   chain_text(chain, text, words, sizeof words));
    return false;
  }
  return file_read(reader, path, item, chain, root);
}

static bool version_check(struct scene_reader *reader, const struct tree *root)
{
  const struct tree *version = tree_get(root, "gamut");
  if (!version)
    error_at_missing(reader, root, "gamut", "the first line of a scene or card is 'gamut: 1'",
                     "'gamut' is missing");
  else if (version->kind != TREE_SCALAR || strcmp(version->text, "1") != 0)
    error_at_value(reader, version, "gamut: 1", "this gamut reads scenes of format 1");
  else
    return true;
  return false;
}

/* Puts what the file includes below it: later ones win over earlier ones, the file over all. */
static bool includes_read(struct scene_reader *reader, struct chain *chain, struct tree **root)
{
  const struct tree *include = tree_get(*root, "include");
  struct tree *base = NULL, *one;
  bool fine = true;
  if (!include)
    return true;
  size_t items = include->kind == TREE_SEQUENCE ? include->children : 1;
  for (size_t i = 0; i < items; i++) {
    one = NULL;
    if (!item_read(reader, include->kind == TREE_SEQUENCE ? include->child[i] : include, chain,
                   &one)) {
      tree_free(one);
      fine = false;
    } else if (!base) {
      base = one;
    } else {
      forget_other_models(base, one);
      tree_merge(base, one);
    }
  }
  tree_drop(tree_get(*root, "include"));
  if (base) {
    forget_other_models(base, *root);
    tree_merge(base, *root);
    *root = base;
  }
  return fine;
}

/* Whether the file is being read already; `item` is the line that asks for it again. */
static bool is_circular(struct scene_reader *reader, const char *file, const char *real,
                        const struct tree *item, const struct chain *chain)
{
  char words[WORDS_SIZE];
  bool again = false;
  for (size_t i = 0; i < chain->depth && real; i++)
    again = again || (chain->real[i] && strcmp(chain->real[i], real) == 0);
  if (again)
    error_at_value(reader, item, "a file that does not lead back to itself", "circular include: %s",
                   chain_text(chain, file, words, sizeof words));
  else if (chain->depth == INCLUDE_DEPTH_MAX)
    error_at_value(reader, item, NULL, "includes are nested deeper than %d", INCLUDE_DEPTH_MAX);
  return again || chain->depth == INCLUDE_DEPTH_MAX;
}

/* Files that each include the next several times are many, and deep in no way. */
static bool is_one_too_many(struct scene_reader *reader, const struct tree *item,
                            struct chain *chain)
{
  if (chain->files > INCLUDES_MAX)
    return true; /* reported once */
  if (chain->files++ < INCLUDES_MAX)
    return false;
  error_at_value(reader, item, "do files include each other several times?",
                 "more than %d files are read for one scene", INCLUDES_MAX);
  return true;
}

static bool file_read(struct scene_reader *reader, const char *file, const struct tree *item,
                      struct chain *chain, struct tree **root)
{
  *root = NULL;
  char *real = realpath(file, NULL);
  if (is_one_too_many(reader, item, chain) || is_circular(reader, file, real, item, chain)) {
    free(real);
    return false;
  }
  gamut_status status = tree_read(file, GAMUT_SCENE, reader->trace, root);
  if (status != GAMUT_OK) {
    reader->faults++;
    reader->first = reader->first ? reader->first : status;
    free(real);
    return false;
  }
  chain->values += node_count(*root);
  if (chain->values > TREE_NODES_MAX) {
    error_at_value(reader, item ? item : *root, NULL, "more than %d values, with all includes read",
                   TREE_NODES_MAX);
    free(real);
    return false;
  }
  chain->shown[chain->depth] = file;
  chain->real[chain->depth++] = real;
  bool fine = expect_mapping(reader, *root, "the file") && version_check(reader, *root);
  fine = includes_read(reader, chain, root) && fine;
  free(chain->real[--chain->depth]);
  return fine || (*root)->kind == TREE_MAPPING;
}

static bool sets_model(const struct scene_override *override)
{
  size_t length = strlen(override->path);
  return length > 6 && strcmp(override->path + length - 6, ".model") == 0;
}

/* What is over by the time that overrides are put in. */
static bool belongs_to_file(const char *path)
{
  size_t length = strcspn(path, ".[");
  return (length == 5 && strncmp(path, "gamut", length) == 0) ||
         (length == 7 && strncmp(path, "include", length) == 0);
}

/* An option is one word: faults name it, not a line and a column of it. */
static void stand_for_option(struct tree *tree)
{
  tree->place.line = tree->key_place.line = 0;
  for (size_t i = 0; i < tree->children; i++)
    stand_for_option(tree->child[i]);
}

static void override_put(struct scene_reader *reader, struct tree *root,
                         const struct scene_override *override)
{
  char name[PATH_SIZE + 128], parent[PATH_SIZE];
  struct tree *value = NULL;
  gamut_status status = GAMUT_OK;
  snprintf(name, sizeof name, "--set %s=%.100s", override->path,
           override->node ? "" : override->value);
  if (!override->node)
    status = tree_parse(override->value, strlen(override->value), name, GAMUT_SCENE, reader->trace,
                        &value);
  else if (!(value = tree_copy(override->node)))
    status = trace_fail(reader->trace, GAMUT_INTERNAL, "out of memory");
  if (status == GAMUT_OK && !override->node)
    stand_for_option(value);
  if (status == GAMUT_OK && belongs_to_file(override->path))
    status =
        trace_fail_at(reader->trace, GAMUT_USAGE, &value->place, override->path,
                      "write it in a scene of its own", "'%s' belongs to a file", override->path);
  if (status == GAMUT_OK && sets_model(override)) {
    snprintf(parent, sizeof parent, "%.*s", (int)strlen(override->path) - 6, override->path);
    struct tree *node = tree_at(root, parent);
    const struct tree *old = tree_get(node, "model");
    if (old && names_plugin(node) && strcmp(old->text, value->text) != 0)
      tree_clear(node);
  }
  if (status == GAMUT_OK)
    status = tree_put(root, override->path, value, reader->trace);
  else
    tree_free(value);
  if (status != GAMUT_OK) {
    reader->faults++;
    reader->first = reader->first ? reader->first : status;
  }
}

/* Models first: choosing one drops the parameters of another, not those that are set with it. */
void overrides_put(struct scene_reader *reader, struct tree *root,
                   const struct scene_override *override, size_t overrides)
{
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < overrides; i++)
      if (sets_model(&override[i]) == (pass == 0))
        override_put(reader, root, &override[i]);
}

struct tree *include_read(struct scene_reader *reader, const char *file,
                          const struct scene_override *override, size_t overrides)
{
  struct chain chain = {.depth = 0};
  struct tree *root;
  if (!file_read(reader, file, NULL, &chain, &root) || root->kind != TREE_MAPPING) {
    tree_free(root);
    return NULL;
  }
  overrides_put(reader, root, override, overrides);
  return root;
}
