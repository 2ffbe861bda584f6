/* A scene, as `gamut check` reads it; and what is written of it reads back to the same. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"
#include "tests/fuzz/fuzz.h"
#include "tree/tree.h"

static char *text_of(const struct tree *tree, size_t *size)
{
  char *text = NULL;
  FILE *memory = open_memstream(&text, size);
  demand(memory != NULL, "no memory");
  tree_write(tree, memory);
  fclose(memory);
  return text;
}

static void write_and_read(const struct tree *tree)
{
  size_t size, again;
  struct tree *copy = NULL;
  struct trace *trace = trace_new();
  char *text = text_of(tree, &size);
  if (tree_parse(text, size, "written", GAMUT_SCENE, trace, &copy) != GAMUT_OK) {
    trace_print(trace, stderr);
    demand(size > TREE_BYTES_MAX, "what was written of a scene cannot be read");
  } else {
    char *second = text_of(copy, &again);
    demand(size == again && memcmp(text, second, size) == 0,
           "what was written of a scene reads back to another");
    free(second);
  }
  tree_free(copy);
  free(text);
  trace_free(trace);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  struct bench *bench = bench_get();
  struct trace *trace = trace_new();
  struct scene *scene = NULL;
  bench_write("scene.yaml", data, size);
  gamut_status status = scene_read(bench_path("scene.yaml"), NULL, 0, bench->registry, bench->units,
                                   trace, &scene);
  demand((status == GAMUT_OK) == (scene != NULL), "a scene and its status disagree");
  demand(status == GAMUT_OK || trace_errors(trace) > 0, "a scene is refused without a word");
  trace_discard(trace);
  if (scene)
    write_and_read(scene->tree);
  scene_free(scene);
  trace_free(trace);
  return 0;
}
