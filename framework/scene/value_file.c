/* Files that a scene names beside it. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"
#include "tree/load.h"

enum { FILE_BYTES_MAX = 256 << 20 };

bool path_beside(const struct tree *name, char *path, size_t size)
{
  const char *from = name->place.file ? name->place.file : "";
  const char *slash = strrchr(from, '/');
  const bool absolute = name->text[0] == '/' || !slash;
  const int length =
      snprintf(path, size, "%.*s%s", absolute ? 0 : (int)(slash - from + 1), from, name->text);
  return length < (int)size;
}

struct value_file *value_file_new(const char *path)
{
  struct value_file *file = scene_take(1, sizeof *file);
  const size_t size = strlen(path) + 1;
  file->path = memcpy(scene_take(size, 1), path, size);
  return file;
}

void value_file_free(struct value_file *file)
{
  if (!file)
    return;
  free(file->path);
  free(file->content);
  free(file->line);
  free(file);
}

bool file_value_read(struct scene_reader *reader, const struct parameter *parameter,
                     const struct tree *node, struct value *value)
{
  char path[PATH_MAX], why[160] = "the name is too long", *content = NULL;
  size_t length = 0;
  if (node->kind != TREE_SCALAR || node->text[0] == 0) {
    error_at_value(reader, node, "a path, from the folder of the file that it stands in",
                   "'%s' names no file", parameter->name);
    return false;
  }
  if (!path_beside(node, path, sizeof path) ||
      !text_load(path, FILE_BYTES_MAX, &content, &length, why, sizeof why)) {
    error_at_value(reader, node, "a file beside this one", "file '%.300s' of '%s': %s", path,
                   parameter->name, why);
    free(content);
    return false;
  }
  input_file_record(reader, node, path, content, length);
  value->file = value_file_new(path);
  value->file->content = content;
  value->file->length = length;
  value->text = value->file->path;
  return true;
}
