#include "registry/registry.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "registry/registry_private.h"

static const struct place nowhere = {0};

static void entry_free(struct entry *entry)
{
  descriptor_free(entry->descriptor);
  free(entry->file);
  free(entry->kind);
  free(entry->name);
  free(entry->objects);
  free(entry->refusal);
  free(entry);
}

/* Kind and name of .../KIND/NAME/NAME.yaml, for a file that does not say it itself. */
static bool name_from_path(struct entry *entry)
{
  char path[PATH_MAX];
  snprintf(path, sizeof path, "%s", entry->file);
  char *slash = strrchr(path, '/');
  if (!slash)
    return false;
  *slash = 0;
  char *dot = strrchr(slash + 1, '.');
  if (dot)
    *dot = 0;
  entry->name = strdup(slash + 1);
  char *folder = strrchr(path, '/');
  if (folder)
    *folder = 0;
  const char *kind = strrchr(path, '/');
  entry->kind = strdup(kind ? kind + 1 : "");
  return entry->name && entry->kind;
}

gamut_status registry_take(struct registry *registry, const char *file, const char *objects,
                           bool aloud, struct trace *trace, struct entry **taken)
{
  bool failed;
  gamut_status status = GAMUT_OK;
  struct trace *silent = aloud ? NULL : trace_new();
  struct entry *entry = calloc(1, sizeof *entry);
  char real[PATH_MAX];
  *taken = NULL;
  if (entry) {
    entry->file = strdup(realpath(file, real) ? real : file);
    entry->objects = strdup(objects);
  }
  if (!entry || !entry->file || !entry->objects || !(aloud || silent)) {
    status = trace_fail(trace, GAMUT_INTERNAL, "no memory left");
    goto done;
  }
  status =
      descriptor_read(entry->file, registry->units, aloud ? trace : silent, &entry->descriptor);
  if (status == GAMUT_PLUGIN && !aloud) {
    struct place place = {.file = entry->file, .line = 1, .column = 1, .width = 1};
    trace_warn_at(trace, &place, NULL, "`gamut verify` on this file shows them",
                  "this plugin is skipped: its YAML has %zu fault%s", trace_errors(silent),
                  trace_errors(silent) == 1 ? "" : "s");
    status = name_from_path(entry) ? GAMUT_OK : trace_fail(trace, GAMUT_INTERNAL, "no memory left");
  }
  TRY(status);
  registry->entry = grow(registry->entry, registry->entries, sizeof(struct entry *), &failed);
  if (failed) {
    status = trace_fail(trace, GAMUT_INTERNAL, "no memory left");
    goto done;
  }
  registry->entry[registry->entries++] = entry;
  *taken = entry;

done:
  if (!*taken && entry)
    entry_free(entry);
  trace_free(silent);
  return status;
}

static int by_id(const void *one, const void *two)
{
  const struct entry *const *a = one, *const *b = two;
  return strcmp((*a)->descriptor->id, (*b)->descriptor->id);
}

static struct entry *find(const struct registry *registry, const char *id)
{
  for (size_t i = 0; i < registry->usables; i++)
    if (strcmp(registry->usable[i]->descriptor->id, id) == 0)
      return registry->usable[i];
  return NULL;
}

/* A second copy of the same plugin, as where a build tree and an installed gamut meet, is no news.
 */
static bool same_edition(const struct descriptor *one, const struct descriptor *other)
{
  return strcmp(one->version, other->version) == 0 && strcmp(one->digest, other->digest) == 0;
}

gamut_status registry_sort(struct registry *registry, struct entry *first, struct trace *trace)
{
  free(registry->usable);
  registry->usables = 0;
  registry->usable = calloc(registry->entries + 1, sizeof(struct entry *));
  if (!registry->usable)
    return trace_fail(trace, GAMUT_INTERNAL, "no memory left");
  if (first)
    registry->usable[registry->usables++] = first;
  for (size_t i = 0; i < registry->entries; i++) {
    struct entry *entry = registry->entry[i];
    if (!entry->descriptor || entry == first || entry->shadowed)
      continue;
    entry->shadowed = find(registry, entry->descriptor->id);
    if (!entry->shadowed)
      registry->usable[registry->usables++] = entry;
    else if (!same_edition(entry->descriptor, entry->shadowed->descriptor))
      trace_note(trace, "plugin %s of '%s' is shadowed by '%s'", entry->descriptor->id, entry->file,
                 entry->shadowed->file);
  }
  qsort(registry->usable, registry->usables, sizeof(struct entry *), by_id);
  return GAMUT_OK;
}

gamut_status registry_new(const struct registry_options *options, const struct units *units,
                          struct trace *trace, struct registry **made)
{
  gamut_status status = GAMUT_OK;
  struct registry *registry = calloc(1, sizeof *registry);
  *made = NULL;
  if (!registry)
    return trace_fail(trace, GAMUT_INTERNAL, "no memory left");
  registry->units = units;
  TRY(search_roots(registry, options, trace));
  for (size_t i = 0; i < registry->roots; i++)
    TRY(search_plugins(registry, &registry->root[i], trace));
  TRY(registry_sort(registry, NULL, trace));
  *made = registry;

done:
  if (status != GAMUT_OK)
    registry_free(registry);
  return status;
}

void registry_free(struct registry *registry)
{
  if (!registry)
    return;
  for (size_t i = 0; i < registry->entries; i++)
    entry_free(registry->entry[i]);
  for (size_t i = 0; i < registry->roots; i++) {
    free(registry->root[i].yaml);
    free(registry->root[i].objects);
    free(registry->root[i].skipped);
  }
  free(registry->entry);
  free(registry->usable);
  free(registry->root);
  free(registry);
}

size_t registry_count(const struct registry *registry)
{
  return registry->usables;
}

const struct descriptor *registry_at(const struct registry *registry, size_t index)
{
  return index < registry->usables ? registry->usable[index]->descriptor : NULL;
}

const struct descriptor *registry_find(const struct registry *registry, const char *id)
{
  const struct entry *entry = find(registry, id);
  return entry ? entry->descriptor : NULL;
}

struct entry *registry_entry(const struct registry *registry, const struct descriptor *descriptor)
{
  for (size_t i = 0; i < registry->entries; i++)
    if (registry->entry[i]->descriptor == descriptor)
      return registry->entry[i];
  return NULL;
}

/* A plugin whose YAML was skipped: now that somebody wants it, its faults are reported. */
static bool tell_faults(const struct registry *registry, const char *kind, const char *name,
                        struct trace *trace)
{
  for (size_t i = 0; i < registry->entries; i++) {
    const struct entry *entry = registry->entry[i];
    struct descriptor *descriptor = NULL;
    if (entry->descriptor || strcmp(entry->name, name) != 0 ||
        (kind_from_name(entry->kind, &(enum gamut_kind){0}) && strcmp(entry->kind, kind) != 0))
      continue;
    gamut_status status = descriptor_read(entry->file, registry->units, trace, &descriptor);
    descriptor_free(descriptor);
    return status != GAMUT_OK;
  }
  return false;
}

const struct descriptor *registry_expect(const struct registry *registry, enum gamut_kind kind,
                                         const char *name, const struct place *place,
                                         const char *path, struct trace *trace)
{
  char expected[512] = "";
  size_t count = 0, length = 0;
  const struct descriptor *other = NULL;
  const char **known = calloc(registry->usables + 1, sizeof *known);
  const struct descriptor *found = NULL;
  if (!known) {
    trace_fail(trace, GAMUT_INTERNAL, "no memory left");
    return NULL;
  }
  for (size_t i = 0; i < registry->usables && !found; i++) {
    const struct descriptor *d = registry->usable[i]->descriptor;
    bool same = strcmp(d->name, name) == 0;
    if (d->kind == kind)
      known[count++] = d->name;
    if (same && d->kind == kind)
      found = d;
    else if (same)
      other = d;
  }
  if (found || tell_faults(registry, kind_name(kind), name, trace))
    goto done;
  const char *near = nearest(name, known, count);
  if (near)
    length = (size_t)snprintf(expected, sizeof expected, "did you mean '%s'?", near);
  else
    length = (size_t)snprintf(expected, sizeof expected, "installed: %s", count ? "" : "none");
  for (size_t i = 0; !near && i < count && length < sizeof expected; i++)
    length += (size_t)snprintf(expected + length, sizeof expected - length, "%s%s", i ? ", " : "",
                               known[i]);
  if (other)
    trace_fail_at(trace, GAMUT_SCENE, place, path, expected,
                  "'%s' is a plugin of kind %s, and %s is due here", name, kind_name(other->kind),
                  kind_name(kind));
  else
    trace_fail_at(trace, GAMUT_SCENE, place, path, expected, "no plugin %s/%s is installed",
                  kind_name(kind), name);

done:
  free(known);
  return found;
}

gamut_status registry_add(struct registry *registry, const char *path, struct trace *trace,
                          const struct descriptor **descriptor)
{
  char real[PATH_MAX], file[2 * PATH_MAX];
  struct entry *entry = NULL;
  struct stat info;
  *descriptor = NULL;
  if (!realpath(path, real))
    return trace_fail_at(trace, GAMUT_PLUGIN, &nowhere, NULL,
                         "kind/name, a file NAME.yaml or a folder NAME that holds it",
                         "there is no plugin at '%s'", path);
  snprintf(file, sizeof file, "%s", real);
  if (is_folder(real)) {
    snprintf(file, sizeof file, "%s/%s.yaml", real, strrchr(real, '/') + 1);
    if (lstat(file, &info) != 0)
      return trace_fail_at(trace, GAMUT_PLUGIN, &nowhere, NULL,
                           "a plugin's folder and its YAML have one name", "'%s' is missing", file);
  }
  for (size_t i = 0; i < registry->usables; i++)
    if (strcmp(registry->usable[i]->file, file) == 0) {
      *descriptor = registry->usable[i]->descriptor;
      return GAMUT_OK;
    }
  char objects[2 * PATH_MAX];
  snprintf(objects, sizeof objects, "%s", file);
  *strrchr(objects, '/') = 0;
  gamut_status status = registry_take(registry, file, objects, true, trace, &entry);
  if (status == GAMUT_OK) {
    status = registry_sort(registry, entry, trace);
    *descriptor = entry->descriptor;
  }
  return status;
}

void registry_paths(const struct registry *registry, FILE *file)
{
  fputs("looked for plugins in this order:\n", file);
  for (size_t i = 0; i < registry->roots; i++) {
    const struct root *root = &registry->root[i];
    fprintf(file, "  %s (%s): ", root->yaml, root->origin);
    if (root->skipped)
      fprintf(file, "skipped, %s\n", root->skipped);
    else
      fprintf(file, "%zu plugin%s\n", root->found, root->found == 1 ? "" : "s");
    if (!root->skipped && strcmp(root->yaml, root->objects) != 0)
      fprintf(file, "    shared objects in %s\n", root->objects);
  }
  for (size_t i = 0; i < registry->entries; i++) {
    const struct entry *entry = registry->entry[i];
    if (!entry->descriptor)
      fprintf(file, "  %s: skipped, its YAML has faults\n", entry->file);
    else if (entry->shadowed)
      fprintf(file, "  %s: %s is shadowed by %s\n", entry->file, entry->descriptor->id,
              entry->shadowed->file);
  }
}
