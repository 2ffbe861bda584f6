/* What plugins say, as messages for people: for the host tables of runs, studies and checks. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "run/host.h"

enum { WORDS = 1024 };

gamut_status host_messages_fail(struct trace *trace, gamut_status status, const struct tree *node,
                                const char *format, va_list list)
{
  char text[WORDS], path[512];
  vsnprintf(text, sizeof text, format, list);
  if (status != GAMUT_SCENE || !node)
    return trace_fail(trace, status, "%s", text);
  return trace_fail_at(trace, status, &node->place, tree_path(node, path, sizeof path), NULL, "%s",
                       text);
}

/* What stands at the path below a node; as far down as there is something. */
static const struct tree *below(const struct tree *node, const char *path)
{
  char key[256];
  while (node && *path) {
    const size_t length = strcspn(path, ".");
    snprintf(key, sizeof key, "%.*s", (int)length, path);
    const struct tree *part = tree_get(node, key);
    if (!part)
      break;
    node = part;
    path += length + (path[length] == '.');
  }
  return node;
}

gamut_status host_messages_fail_at(struct trace *trace, const struct gamut_values *values,
                                   const char *path, const char *expected, const char *format,
                                   va_list list)
{
  char text[WORDS], where[512];
  const struct value *value = values_find(values, path);
  const struct tree *node = value && value->node ? value->node : below(values->node, path);
  vsnprintf(text, sizeof text, format, list);
  snprintf(where, sizeof where, "%s%s%s", values->path ? values->path : "",
           values->path && *values->path && *path ? "." : "", path);
  return trace_fail_at(trace, GAMUT_SCENE, node ? &node->place : NULL, where, expected, "%s", text);
}

void host_messages_warn(struct trace *trace, const char *format, va_list list)
{
  char text[WORDS];
  vsnprintf(text, sizeof text, format, list);
  trace_warn_at(trace, NULL, NULL, NULL, "%s", text);
}

void host_messages_note(struct trace *trace, const char *format, va_list list)
{
  char text[WORDS];
  vsnprintf(text, sizeof text, format, list);
  trace_note(trace, "%s", text);
}
