/* Where plugins are looked for, and what is found there. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "registry/registry_private.h"
#include "tree/load.h"

#ifndef GAMUT_PLUGIN_FOLDER
#define GAMUT_PLUGIN_FOLDER ""
#endif

static const struct place nowhere = {0};

char *path_join(const char *one, const char *two)
{
  size_t length = strlen(one) + strlen(two) + 2;
  char *path = malloc(length);
  if (path)
    snprintf(path, length, "%s%s%s", one, two[0] ? "/" : "", two);
  return path;
}

void *grow(void *list, size_t count, size_t size, bool *failed)
{
  void *larger = realloc(list, (count + 1) * size);
  *failed = !larger;
  if (!larger)
    return list;
  memset((char *)larger + count * size, 0, size);
  return larger;
}

bool is_folder(const char *path)
{
  struct stat info;
  return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool is_file(const char *path)
{
  struct stat info;
  return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

/* Why a folder is not safe, or null. Whoever owns the program can do anything to its user anyway,
 * so that owner is trusted as the user and root are. */
static const char *unsafe(const char *folder, bool in_place)
{
  struct stat info;
  uid_t owner = 0;
  char program[PATH_MAX];
  if (stat(folder, &info) != 0)
    return errno == ENOENT ? "it does not exist" : strerror(errno);
  if (!S_ISDIR(info.st_mode))
    return "it is no folder";
  if (!program_place(program, sizeof program, &owner))
    owner = 0;
  if (info.st_uid != 0 && info.st_uid != geteuid() && info.st_uid != owner)
    return "it belongs to another user";
  if (info.st_mode & S_IWOTH)
    return "everybody may write to it";
  if ((info.st_mode & S_IWGRP) && !in_place)
    return "its group may write to it";
  return NULL;
}

static const char *unsafe_part(const char *path, uid_t program_owner)
{
  struct stat info;
  if (lstat(path, &info) != 0)
    return strerror(errno);
  if (info.st_uid != 0 && info.st_uid != geteuid() && info.st_uid != program_owner)
    return "belongs to another user";
  /* In a sticky folder nobody can replace what is another's. */
  if ((info.st_mode & S_IWOTH) && !(S_ISDIR(info.st_mode) && (info.st_mode & S_ISVTX)))
    return "may be written by everybody";
  return NULL;
}

const char *path_unsafe(const char *path, char *part, size_t size)
{
  char real[PATH_MAX], program[PATH_MAX];
  uid_t owner = 0;
  const char *why = NULL;
  if (!program_place(program, sizeof program, &owner))
    owner = 0;
  snprintf(part, size, "%s", path);
  if (!realpath(path, real))
    return strerror(errno);
  for (char *at = real; !why && at;) {
    char *end = strchr(at + 1, '/');
    snprintf(part, size, "%.*s", end ? (int)(end - real) : (int)strlen(real), real);
    why = unsafe_part(part, owner);
    at = end;
  }
  return why;
}

struct search {
  struct registry *registry;
  struct trace *trace;
  const char *origin;
  bool in_place; /* the tree that the program itself was built in: a group may share it */
  bool quiet;    /* a folder that nobody named need not exist */
};

static gamut_status add_root(const struct search *search, const char *yaml, const char *objects)
{
  struct registry *registry = search->registry;
  char real_yaml[PATH_MAX], real_objects[PATH_MAX];
  const char *why = NULL, *blamed = yaml;
  bool failed;
  registry->root = grow(registry->root, registry->roots, sizeof *registry->root, &failed);
  if (failed)
    return trace_fail(search->trace, GAMUT_INTERNAL, "no memory left");
  if (yaml[0] != '/')
    why = "it is not absolute";
  else if (!realpath(yaml, real_yaml))
    why = errno == ENOENT ? "it does not exist" : strerror(errno);
  else
    why = unsafe(real_yaml, search->in_place);
  if (!why) {
    blamed = objects;
    if (!realpath(objects, real_objects))
      why = errno == ENOENT ? "it does not exist" : strerror(errno);
    else
      why = unsafe(real_objects, search->in_place);
  }
  for (size_t i = 0; i < registry->roots && !why; i++)
    if (!registry->root[i].skipped && strcmp(registry->root[i].yaml, real_yaml) == 0)
      return GAMUT_OK;
  struct root *root = &registry->root[registry->roots++];
  root->origin = search->origin;
  root->yaml = strdup(why ? blamed : real_yaml);
  root->objects = strdup(why ? blamed : real_objects);
  root->skipped = why ? strdup(why) : NULL;
  if (!root->yaml || !root->objects || (why && !root->skipped))
    return trace_fail(search->trace, GAMUT_INTERNAL, "no memory left");
  if (why && !(search->quiet && strcmp(why, "it does not exist") == 0))
    trace_warn_at(search->trace, &nowhere, NULL,
                  "plugin folders are absolute, belong to you or root, and only their owner may "
                  "write to them",
                  "plugin folder '%s' (%s) is skipped: %s", blamed, search->origin, why);
  return GAMUT_OK;
}

/* The pairs "YAMLDIR SODIR" of a build tree, relative to its folder. */
static gamut_status add_pairs(const struct search *search, const char *folder, FILE *file)
{
  gamut_status status = GAMUT_OK;
  char line[2 * PATH_MAX], path[2][2 * PATH_MAX + PATH_MAX];
  while (status == GAMUT_OK && fgets(line, sizeof line, file)) {
    line[strcspn(line, "\n")] = 0;
    char *blank = strrchr(line, ' ');
    if (!blank)
      continue;
    *blank = 0;
    const char *part[2] = {line, blank + 1};
    for (int k = 0; k < 2; k++)
      snprintf(path[k], sizeof path[k], "%s%s%s", part[k][0] == '/' ? "" : folder,
               part[k][0] == '/' ? "" : "/", part[k]);
    status = add_root(search, path[0], path[1]);
  }
  return status;
}

/* Whether what stands there is no file and no link to one, which is then said. */
static bool is_odd(const char *file, const char *due, const char *then, struct trace *trace)
{
  struct stat info;
  char why[256] = "it is no file", *text = NULL;
  size_t size;
  if (lstat(file, &info) != 0 || is_file(file))
    return false;
  text_load(file, 0, &text, &size, why, sizeof why);
  free(text);
  const struct place place = {.file = file};
  trace_warn_at(trace, &place, NULL, due, "%s: %s", then, why);
  return true;
}

static bool is_odd_plugin(const char *file, struct trace *trace)
{
  return is_odd(file, "a plugin's YAML is a file, or a link to one", "this plugin is skipped",
                trace);
}

/* A folder of plugins, or a build tree with its plugins.path. */
static gamut_status add_folder(const struct search *search, const char *folder)
{
  char path[PATH_MAX + 32];
  snprintf(path, sizeof path, "%s/plugins.path", folder);
  FILE *file =
      folder[0] == '/' && (search->in_place || !unsafe(folder, false)) ? text_open(path) : NULL;
  if (!file && !search->in_place) {
    is_odd(path, "a plugins.path names the folders of a build tree", "it is passed over",
           search->trace);
    return add_root(search, folder, folder);
  }
  if (!file)
    return GAMUT_OK;
  gamut_status status = add_pairs(search, folder, file);
  fclose(file);
  return status;
}

static gamut_status add_list(const struct search *search, const char *list)
{
  gamut_status status = GAMUT_OK;
  while (list && *list && status == GAMUT_OK) {
    size_t length = strcspn(list, ":");
    char folder[PATH_MAX];
    if (length > 0 && length < sizeof folder) {
      memcpy(folder, list, length);
      folder[length] = 0;
      while (length > 1 && folder[length - 1] == '/')
        folder[--length] = 0;
      status = add_folder(search, folder);
    }
    list += strcspn(list, ":");
    list += *list == ':';
  }
  return status;
}

gamut_status search_roots(struct registry *registry, const struct registry_options *options,
                          struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct search search = {.registry = registry, .trace = trace};
  char folder[PATH_MAX], data[PATH_MAX + 64] = "";
  uid_t owner;
  search.origin = "--plugin-path";
  TRY(add_list(&search, options->plugin_path));
  search.origin = "GAMUT_PLUGIN_PATH";
  TRY(add_list(&search, secure_getenv("GAMUT_PLUGIN_PATH")));
  search.quiet = true;
  if (options->user_plugins) {
    const char *xdg = secure_getenv("XDG_DATA_HOME"), *home = secure_getenv("HOME");
    if (xdg && xdg[0])
      snprintf(data, sizeof data, "%s/gamut/plugins", xdg);
    else if (home && home[0])
      snprintf(data, sizeof data, "%s/.local/share/gamut/plugins", home);
    search.origin = "your plugins";
    if (data[0])
      TRY(add_root(&search, data, data));
  }
  search.origin = "the build tree";
  search.in_place = true;
  if (program_place(folder, sizeof folder, &owner))
    TRY(add_folder(&search, folder));
  search.in_place = false;
  search.origin = "installed";
  if (program_place(folder, sizeof folder, &owner) &&
      installed_beside(folder, GAMUT_PLUGIN_FOLDER, data, sizeof data) && is_folder(data))
    TRY(add_root(&search, data, data));
  else if (GAMUT_PLUGIN_FOLDER[0])
    TRY(add_root(&search, GAMUT_PLUGIN_FOLDER, GAMUT_PLUGIN_FOLDER));

done:
  return status;
}

static gamut_status take_at(struct registry *registry, struct root *root, const char *below,
                            const char *name, struct trace *trace)
{
  char file[2 * PATH_MAX];
  struct entry *entry = NULL;
  gamut_status status = GAMUT_OK;
  snprintf(file, sizeof file, "%s%s%s/%s.yaml", root->yaml, below[0] ? "/" : "", below, name);
  if (is_odd_plugin(file, trace) || !is_file(file))
    return GAMUT_OK;
  char *objects = path_join(root->objects, below);
  if (!objects)
    return trace_fail(trace, GAMUT_INTERNAL, "no memory left");
  status = registry_take(registry, file, objects, false, trace, &entry);
  free(objects);
  root->found += entry != NULL;
  return status;
}

/* Whether NAME.yaml in a folder of anything is a plugin's: it has the key `plugin`. */
static bool claims_to_be_plugin(const char *folder, const char *name)
{
  char file[2 * PATH_MAX];
  struct tree *root = NULL;
  struct trace *silent = trace_new();
  snprintf(file, sizeof file, "%s/%s.yaml", folder, name);
  bool claims = silent && tree_read(file, GAMUT_PLUGIN, silent, &root) == GAMUT_OK &&
                tree_get(root, "plugin");
  tree_free(root);
  trace_free(silent);
  return claims;
}

static int visible(const struct dirent *item)
{
  return item->d_name[0] != '.';
}

static gamut_status take_item(struct registry *registry, struct root *root, const char *item,
                              struct trace *trace)
{
  enum gamut_kind kind;
  char path[PATH_MAX + 512], below[1024];
  gamut_status status = GAMUT_OK;
  size_t length = strlen(item);
  snprintf(path, sizeof path, "%s/%s", root->yaml, item);
  if (length > 5 && strcmp(item + length - 5, ".yaml") == 0) {
    char name[512];
    snprintf(name, sizeof name, "%.*s", (int)(length - 5), item);
    if (!strchr(name, '.') && !is_odd_plugin(path, trace) && claims_to_be_plugin(root->yaml, name))
      status = take_at(registry, root, "", name, trace);
    return status;
  }
  if (!is_folder(path))
    return GAMUT_OK;
  if (!kind_from_name(item, &kind))
    return take_at(registry, root, item, item, trace);
  struct dirent **list = NULL;
  int count = scandir(path, &list, visible, alphasort);
  for (int i = 0; i < count; i++) {
    snprintf(below, sizeof below, "%s/%s", item, list[i]->d_name);
    if (status == GAMUT_OK)
      status = take_at(registry, root, below, list[i]->d_name, trace);
    free(list[i]);
  }
  free(list);
  return status;
}

gamut_status search_plugins(struct registry *registry, struct root *root, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct dirent **list = NULL;
  if (root->skipped)
    return GAMUT_OK;
  int count = scandir(root->yaml, &list, visible, alphasort);
  if (count < 0)
    trace_warn_at(trace, &nowhere, NULL, NULL, "plugin folder '%s' cannot be read: %s", root->yaml,
                  strerror(errno));
  for (int i = 0; i < count; i++) {
    if (status == GAMUT_OK)
      status = take_item(registry, root, list[i]->d_name, trace);
    free(list[i]);
  }
  free(list);
  return status;
}
