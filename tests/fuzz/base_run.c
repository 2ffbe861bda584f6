#include "tests/fuzz/base_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "scene/scene.h"
#include "store/checkpoint.h"
#include "tests/fuzz/fuzz.h"

static const char text[] =
    "gamut: 1\n"
    "include: [materials/copper.yaml]\n"
    "solver: {model: material_point_method, geometry: axisymmetric, cell: 1 mm, end: 3 us}\n"
    "bodies:\n"
    "  bar: {material: copper, shape: {cylinder: {radius: 2 mm, length: 3 mm}},\n"
    "        velocity: [0 m/s, -150 m/s]}\n"
    "effects:\n"
    "  wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}\n"
    "  heat: {model: adiabatic_heating}\n"
    "  viscosity: {model: artificial_viscosity}\n"
    "quantities:\n"
    "  length: {measure: extent, body: bar, axis: y}\n"
    "  peak: {measure: pressure, at: {body: bar, points: [[0 mm, 1 mm], [0 mm, 2 mm]]},\n"
    "         reduce: max}\n"
    "  force: {measure: normal_force, effect: wall, reduce: at end}\n"
    "outputs: {frames: 2, fields: [velocity, stress, plastic_strain], checkpoint: {every: 1 us}}\n";

static struct base_file take(const char *name)
{
  struct base_file file = {0};
  struct stat information;
  FILE *stream = fopen(bench_path(name), "rb");
  demand(stream && fstat(fileno(stream), &information) == 0, "the run left no files");
  file.size = (size_t)information.st_size;
  file.data = malloc(file.size);
  demand(file.data && fread(file.data, 1, file.size, stream) == file.size, "a file is cut");
  fclose(stream);
  return file;
}

static struct base {
  struct scene *scene;
  struct store_place place;
  char run[256];
  struct base_file checkpoint, results;
} base;

static void keep_place(const struct store *store)
{
  base.place = store_place_of(store);
  snprintf(base.run, sizeof base.run, "%s", base.place.run);
  base.place.run = base.run;
  base.place.xdmf = "";
}

static gamut_status run_it(struct trace *trace)
{
  gamut_status status;
  struct gamut_run *run = NULL;
  struct store *store = NULL;
  struct bench *bench = bench_get();
  size_t count;
  const struct run_options options = {.threads = 1};
  bench_write("base.yaml", text, sizeof text - 1);
  TRY(scene_read(bench_path("base.yaml"), NULL, 0, bench->registry, bench->units, trace,
                 &base.scene));
  TRY(run_new(base.scene, bench->registry, &options, trace, &run));
  TRY(run_start(run, trace));
  TRY(store_open(bench_path("base"), false, trace, &store));
  run_record(run, store);
  TRY(store_scene(store, base.scene->tree, trace));
  TRY(run_march(run, trace));
  struct history *const *histories = run_histories(run, &count);
  TRY(store_histories(store, histories, count, trace));
  TRY(store_summary(store, "{}", trace));
  keep_place(store);
done:
  run_free(run);
  store_close(store);
  return status;
}

static const struct base *base_get(void)
{
  if (base.scene)
    return &base;
  struct trace *trace = trace_new();
  if (run_it(trace) != GAMUT_OK) {
    trace_print(trace, stderr);
    demand(0, "the run to be changed does not run");
  }
  trace_free(trace);
  base.checkpoint = take("base/" CHECKPOINT_FILE);
  base.results = take("base/results.h5");
  return &base;
}

struct scene *base_scene(void)
{
  return base_get()->scene;
}

const struct store_place *base_place(void)
{
  return &base_get()->place;
}

const struct base_file *base_checkpoint(void)
{
  return &base_get()->checkpoint;
}

const struct base_file *base_results(void)
{
  return &base_get()->results;
}
