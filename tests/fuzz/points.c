/* A CSV file: as the points of a body, with volumes and with a spacing, and as a table. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"
#include "tests/fuzz/fuzz.h"

#define MATERIALS                                                                                  \
  "gamut: 1\n"                                                                                     \
  "materials: {m: {density: 1000 kg/m3, eos: {model: linear, bulk_modulus: 2 GPa}}}\n"

#define MPM(geometry)                                                                              \
  "solver: {model: material_point_method, geometry: " geometry ", cell: 1 mm, end: 1 us}\n"

static const char *const scenes[] = {
    MATERIALS MPM("plane_strain")
        "bodies: {b: {material: m, shape: {points: {file: points.csv}}}}\n",
    MATERIALS MPM("axisymmetric")
        "bodies: {b: {material: m, shape: {points: {file: points.csv, spacing: 1 mm}}}}\n",
    MATERIALS "solver:\n"
              "  model: material_driver\n"
              "  end: 1 s\n"
              "  steps: 2\n"
              "  control: {xx: {strain_rate: {file: points.csv}}}\n"
              "bodies: {b: {material: m}}\n"};

static void read_scene(const char *text)
{
  struct bench *bench = bench_get();
  struct trace *trace = trace_new();
  struct scene *scene = NULL;
  bench_write("scene.yaml", text, strlen(text));
  gamut_status status = scene_read(bench_path("scene.yaml"), NULL, 0, bench->registry, bench->units,
                                   trace, &scene);
  demand((status == GAMUT_OK) == (scene != NULL), "a scene and its status disagree");
  demand(status == GAMUT_OK || trace_errors(trace) > 0, "a file is refused without a word");
  trace_discard(trace);
  scene_free(scene);
  trace_free(trace);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  bench_write("points.csv", data, size);
  for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++)
    read_scene(scenes[i]);
  return 0;
}
