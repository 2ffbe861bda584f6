/* Whether a scene and its plugins are still those of a result. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "run/restart.h"

const char *restart_path(char path[RESTART_PATH], const char *group, const char *name,
                         const char *what)
{
  snprintf(path, RESTART_PATH, "%s/%s/%s", group, name, what);
  return path;
}

const char *restart_component(char text[RESTART_PATH], const struct field *field,
                              unsigned component)
{
  snprintf(text, RESTART_PATH, "%s_%u", field->name, component);
  return text;
}

char *restart_scene_text(const struct tree *tree)
{
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (!memory)
    return NULL;
  tree_write(tree, memory);
  return memory_close(memory, &text);
}

char *restart_plugins_text(const struct gamut_run *run)
{
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (!memory)
    return NULL;
  for (size_t i = 0; i < registry_count(run->registry); i++) {
    const struct descriptor *d = registry_at(run->registry, i);
    if (!registry_is_open(run->registry, d))
      continue;
    const char *level = registry_level(run->registry, d);
    fprintf(memory, "%s %s %s %s\n", d->id, d->version, d->digest, level ? level : "baseline");
  }
  return memory_close(memory, &text);
}

struct difference {
  const struct tree *was, *now; /* one of them null: the key is new, or gone */
};

static bool may_change(const struct tree *t)
{
  char path[1024];
  tree_path(t, path, sizeof path);
  return strcmp(path, "outputs") == 0 || strcmp(path, "solver.end") == 0;
}

static bool differ(const struct tree *was, const struct tree *now, struct difference *found);

static bool mappings_differ(const struct tree *was, const struct tree *now,
                            struct difference *found)
{
  for (size_t i = 0; i < was->children; i++) {
    const struct tree *child = was->child[i], *other = tree_get(now, child->key);
    if (may_change(child))
      continue;
    if (!other) {
      *found = (struct difference){child, NULL};
      return true;
    }
    if (differ(child, other, found))
      return true;
  }
  for (size_t i = 0; i < now->children; i++)
    if (!may_change(now->child[i]) && !tree_get(was, now->child[i]->key)) {
      *found = (struct difference){NULL, now->child[i]};
      return true;
    }
  return false;
}

static bool differ(const struct tree *was, const struct tree *now, struct difference *found)
{
  *found = (struct difference){was, now};
  if (was->kind != now->kind)
    return true;
  if (was->kind == TREE_SCALAR)
    return strcmp(was->text, now->text) != 0;
  if (was->kind == TREE_MAPPING)
    return mappings_differ(was, now, found);
  if (was->children != now->children)
    return true;
  for (size_t i = 0; i < was->children; i++)
    if (differ(was->child[i], now->child[i], found))
      return true;
  return false;
}

static void short_text(const struct tree *t, char *text, size_t size)
{
  if (!t)
    snprintf(text, size, "absent");
  else if (t->kind == TREE_SCALAR)
    snprintf(text, size, "'%.80s'", t->text);
  else
    snprintf(text, size, "a %s of %zu", t->kind == TREE_SEQUENCE ? "list" : "mapping", t->children);
}

gamut_status restart_same_scene(const struct tree *was, const struct tree *now, const char *folder,
                                struct trace *trace)
{
  struct difference found;
  char path[1024], before[120], after[120];
  if (!differ(was, now, &found))
    return GAMUT_OK;
  tree_path(found.now ? found.now : found.was, path, sizeof path);
  short_text(found.was, before, sizeof before);
  short_text(found.now, after, sizeof after);
  return trace_fail_at(trace, GAMUT_SCENE, found.now ? &found.now->place : NULL, path,
                       "--resume may change solver.end and outputs, nothing else",
                       "the run in '%s' is one of another scene: '%s' was %s and is %s", folder,
                       path, before, after);
}

enum { WORD = 200 };
struct line {
  char id[WORD], version[WORD], digest[WORD], level[WORD];
};

static bool read_line(const char **text, struct line *line)
{
  int length = 0;
  if (sscanf(*text, "%199s %199s %199s %199s%n", line->id, line->version, line->digest, line->level,
             &length) != 4)
    return false;
  *text += length;
  return true;
}

static bool find_line(const char *text, const char *id, struct line *line)
{
  while (read_line(&text, line))
    if (strcmp(line->id, id) == 0)
      return true;
  return false;
}

static gamut_status same_plugin(const struct line *was, const struct line *now, const char *folder,
                                struct trace *trace)
{
  const char *what = strcmp(was->digest, now->digest) != 0     ? "another interface"
                     : strcmp(was->version, now->version) != 0 ? "another version"
                                                               : NULL;
  if (what)
    return trace_fail_at(trace, GAMUT_PLUGIN, NULL, NULL,
                         "use the plugin of that run, or --force to run the scene anew",
                         "%s has %s than in the run in '%s': it is %s (%s), it was %s (%s)",
                         now->id, what, folder, now->version, now->digest, was->version,
                         was->digest);
  if (strcmp(was->level, now->level) != 0)
    trace_warn_at(trace, NULL, NULL, NULL,
                  "%s ran at instruction-set level %s and goes on at %s: the last bits may differ "
                  "from those of an uninterrupted run",
                  now->id, was->level, now->level);
  return GAMUT_OK;
}

gamut_status restart_same_plugins(const struct gamut_run *run, const char *was, const char *folder)
{
  gamut_status status = GAMUT_OK;
  struct line before, after;
  char *now = restart_plugins_text(run);
  if (!now)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (const char *text = now; read_line(&text, &after);)
    if (find_line(was, after.id, &before))
      TRY(same_plugin(&before, &after, folder, run->trace));
done:
  free(now);
  return status;
}
