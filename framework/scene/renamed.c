/* Names that were given up: old spellings are refused, each with the name that it has now. A key is
 * a row by its path, so that the same word elsewhere stays what it is. */
#include <string.h>

#include "scene/scene_private.h"

enum kind { KEY, MEASURE, FIELD };

static const struct {
  enum kind kind;
  const char *old, *now;
} renamed[] = {
    {KEY, "solver.order", "stress_update"},
    {MEASURE, "pieces", "fragments"},
    {FIELD, "spalled", "damage"},
};

static const char *find(enum kind kind, const char *name)
{
  for (size_t i = 0; i < ARRAY_SIZE(renamed); i++)
    if (renamed[i].kind == kind && strcmp(renamed[i].old, name) == 0)
      return renamed[i].now;
  return NULL;
}

const char *renamed_key(const struct tree *child)
{
  char path[PATH_SIZE];
  return find(KEY, tree_path(child, path, sizeof path));
}

const char *renamed_field(const char *name)
{
  const char *now = find(MEASURE, name);
  return now ? now : find(FIELD, name);
}

const char *renamed_words(const char *old, const char *now, char *buffer, size_t size)
{
  snprintf(buffer, size, "what was called '%.60s' is called '%s' now", old, now);
  return buffer;
}
