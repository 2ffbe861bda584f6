/* What plugins say, as messages for people: for the host tables of runs, studies and checks. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
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

/* The line of a row, "curve.3", of a table that comes from a file. */
static bool place_of_row(const struct gamut_values *values, const char *path, struct place *place)
{
  char name[256], *end;
  const char *dot = strrchr(path, '.');
  if (!dot || (size_t)(dot - path) >= sizeof name || dot[1] < '0' || dot[1] > '9')
    return false;
  snprintf(name, sizeof name, "%.*s", (int)(dot - path), path);
  const struct value *table = values_find(values, name);
  const size_t row = strtoul(dot + 1, &end, 10);
  if (*end || !table || !table->file || !table->file->line || !table->parameter->choices ||
      row >= table->numbers / table->parameter->choices)
    return false;
  *place = (struct place){
      .file = table->file->path, .line = (int)table->file->line[row], .column = 1, .width = 1};
  return true;
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
  struct place row;
  const struct place *place = place_of_row(values, path, &row) ? &row : node ? &node->place : NULL;
  return trace_fail_at(trace, GAMUT_SCENE, place, where, expected, "%s", text);
}

/* A line of a file for messages; the caller frees it. */
static char *line_of(const struct value_file *file, size_t line)
{
  const char *at = file->content;
  for (size_t k = 1; k < line && at; k++)
    at = strchr(at, '\n') ? strchr(at, '\n') + 1 : NULL;
  return at ? strndup(at, strcspn(at, "\r\n")) : NULL;
}

gamut_status host_messages_fail_in_file(struct trace *trace, const struct gamut_values *values,
                                        const char *path, size_t line, const char *expected,
                                        const char *format, va_list list)
{
  char text[WORDS], where[512];
  const struct value *value = values_find(values, path);
  if (!value || !value->file || !value->file->content)
    return host_messages_fail_at(trace, values, path, expected, format, list);
  vsnprintf(text, sizeof text, format, list);
  snprintf(where, sizeof where, "%s%s%s", values->path ? values->path : "",
           values->path && *values->path ? "." : "", path);
  char *source = line_of(value->file, line);
  const struct place place = {
      .file = value->file->path, .line = (int)line, .column = 1, .width = 1, .source = source};
  gamut_status status = trace_fail_at(trace, GAMUT_SCENE, &place, where, expected, "%s", text);
  free(source);
  return status;
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
