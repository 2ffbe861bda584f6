/* Whether the files of a scene are still those of a result: a run that goes on with others would be
 * of no scene at all. */
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "base/memory.h"
#include "run/restart.h"
#include "store/file.h"

char *restart_files_text(const struct scene *scene)
{
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (!memory)
    return NULL;
  for (size_t i = 0; i < scene->input_files; i++)
    fprintf(memory, "%s %s\n", scene->input_file[i].digest, scene->input_file[i].key);
  return memory_close(memory, &text);
}

static gamut_status check(const struct scene *scene, const char *key, const char *digest,
                          const char *folder, struct trace *trace)
{
  for (size_t i = 0; i < scene->input_files; i++) {
    const struct input_file *file = &scene->input_file[i];
    const struct tree *node = tree_at(scene->tree, file->key);
    if (strcmp(file->key, key) == 0 && strcmp(file->digest, digest) != 0)
      return trace_fail_at(trace, GAMUT_SCENE, node ? &node->place : NULL, key,
                           "the file as it was, or --force to run the scene anew",
                           "'%s' was changed after the run in '%s' had begun", file->path, folder);
  }
  return GAMUT_OK;
}

gamut_status restart_same_files(const struct scene *scene, const char *was, const char *folder,
                                struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  char *lines = memory_copy(was), *rest = NULL;
  for (char *line = strtok_r(lines, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
    char *key = strchr(line, ' ');
    if (!key) {
      status = trace_fail(trace, GAMUT_OUTPUT, "the list of files in the checkpoint is damaged");
      goto done;
    }
    *key++ = '\0';
    TRY(check(scene, key, line, folder, trace));
  }
done:
  free(lines);
  return status;
}

gamut_status restart_same_summary(const struct scene *scene, const char *folder,
                                  struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  char *path = file_path(folder, "summary.json");
  json_t *summary = path ? json_load_file(path, 0, NULL) : NULL, *file;
  size_t index;
  json_array_foreach(json_object_get(summary, "input_files"), index, file)
  {
    const char *key = json_string_value(json_object_get(file, "key"));
    const char *digest = json_string_value(json_object_get(file, "digest"));
    if (key && digest)
      TRY(check(scene, key, digest, folder, trace));
  }
done:
  json_decref(summary);
  free(path);
  return status;
}
