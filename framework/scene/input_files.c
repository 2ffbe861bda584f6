/* The record of files that a scene names and whose contents are part of it: tables, points, what
 * plugins read. Included files need no entry, they are in the tree. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "scene/input_files.h"
#include "scene/scene_private.h"

void input_file_record(struct scene_reader *reader, const struct tree *node, const char *path,
                       const char *bytes, size_t size)
{
  char key[PATH_SIZE];
  struct scene *scene = reader->scene;
  if (!scene) /* values alone, of no scene */
    return;
  struct input_file *grown =
      realloc(scene->input_file, (scene->input_files + 1) * sizeof *scene->input_file);
  if (!grown)
    memory_ended();
  scene->input_file = grown;
  struct input_file *file = &grown[scene->input_files++];
  file->key = scene_text(reader, "%s", tree_path(node, key, sizeof key));
  file->path = scene_text(reader, "%s", path);
  snprintf(file->digest, sizeof file->digest, "%016" PRIx64, hash_bytes(HASH_START, bytes, size));
}

json_t *input_files_json(const struct scene *scene)
{
  json_t *all = json_array();
  for (size_t i = 0; i < scene->input_files; i++) {
    const struct input_file *file = &scene->input_file[i];
    json_array_append_new(all, json_pack("{s:s, s:s, s:s}", "key", file->key, "file", file->path,
                                         "digest", file->digest));
  }
  return all;
}
