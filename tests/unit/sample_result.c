#include "tests/unit/sample_result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BAR = SAMPLE_COLUMNS * SAMPLE_ROWS, COMPONENTS = 1 + 3 + 6 + 9 };

struct sample {
  int64_t id[2][BAR];
  double position[2][2][BAR];
  double value[2][COMPONENTS][BAR];
};

static const struct measure extent = {.name = "extent", .unit = "m", .doc = "size of the body"};
static const struct measure force = {.name = "force", .unit = "N", .doc = "force on the wall"};

/* Radius grows towards the foot and the bar gets shorter as `share` goes from 0 to 1. */
static void fill(struct sample *s, double share)
{
  const double radius = 3.81e-3, length = 25.4e-3;
  for (int i = 0; i < BAR; ++i) {
    double a = (i % SAMPLE_COLUMNS + 0.5) / SAMPLE_COLUMNS;
    double b = (i / SAMPLE_COLUMNS + 0.5) / SAMPLE_ROWS;
    double foot = share * exp(-6 * b);
    s->id[0][i] = i;
    s->position[0][0][i] = radius * a * (1 + 0.9 * foot);
    s->position[0][1][i] = length * (b * (1 - 0.35 * share) + 0.1 * share * b * b);
    s->value[0][0][i] = 2 * foot;
    for (int k = 1; k < COMPONENTS; ++k)
      s->value[0][k][i] = 1e6 * k * (1 + a + 2 * b);
    s->value[0][2][i] = -190 * (1 - share) * b;
  }
  for (int i = 0; i < SAMPLE_ANVIL; ++i) {
    s->id[1][i] = BAR + i;
    s->position[1][0][i] = 4e-4 * (i % 20 + 0.5);
    s->position[1][1][i] = -4e-4 * (i / 20 + 0.5);
    for (int k = 0; k < COMPONENTS; ++k)
      s->value[1][k][i] = 0.1 * k;
  }
}

/* The first `lost` points of the bar are gone, and the anvil where it is. */
static gamut_status write_frame(struct store *store, int frame, size_t lost, size_t anvil,
                                struct trace *trace)
{
  struct sample *s = calloc(1, sizeof *s);
  if (!s)
    return trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  const double *table[4][2 * 9];
  static const unsigned components[4] = {1, 3, 6, 9};
  fill(s, (double)frame / (SAMPLE_FRAMES - 1));
  for (unsigned f = 0, first = 0; f < 4; first += components[f++]) {
    for (unsigned set = 0; set < 2; ++set) {
      for (unsigned k = 0; k < components[f]; ++k)
        table[f][set * components[f] + k] = s->value[set][first + k] + (set == 0 ? lost : 0);
    }
  }
  const struct frame_set sets[2] = {
      {"bar",
       BAR - lost,
       s->id[0] + lost,
       {s->position[0][0] + lost, s->position[0][1] + lost, NULL},
       2},
      {"anvil", anvil, s->id[1], {s->position[1][0], s->position[1][1], NULL}, 2}};
  const struct frame_field fields[4] = {
      {"plastic_strain", "1", "equivalent plastic strain", 1, table[0]},
      {"velocity", "m/s", "velocity of the point", 3, table[1]},
      {"stress", "Pa", "Cauchy stress", 6, table[2]},
      {"velocity_gradient", "1/s", "L", 9, table[3]}};
  gamut_status status =
      store_frame(store, 20e-6 * frame, (uint64_t)(100 * frame), sets, 2, fields, 4, trace);
  free(s);
  return status;
}

gamut_status sample_frame(struct store *store, int frame, struct trace *trace)
{
  return write_frame(store, frame, 0, SAMPLE_ANVIL, trace);
}

static gamut_status histories(struct store *store, struct trace *trace)
{
  static const struct quantity quantity[2] = {
      {.name = "length", .measure = &extent, .every = 1e-6},
      {.name = "wall_force", .measure = &force, .every = 1e-6}};
  struct history *history[2] = {history_new(&quantity[0], 80e-6), history_new(&quantity[1], 80e-6)};
  for (int i = 0; i <= 800; ++i) {
    double share = i / 800.0;
    history_tell(history[0], 80e-6 * share, 25.4e-3 * (1 - 0.25 * share), i == 800);
    history_tell(history[1], 80e-6 * share, 2e4 * exp(-3 * share) * fabs(sin(40 * share)),
                 i == 800);
  }
  gamut_status status = store_histories(store, history, 2, trace);
  history_free(history[0]);
  history_free(history[1]);
  return status;
}

gamut_status sample_result(const char *folder, bool replace, bool shrinks, struct trace *trace,
                           struct store **store)
{
  static const char scene[] = "gamut: 1\n"
                              "title: 'Taylor bar, a \"sample\" that''s made up'\n"
                              "solver: {model: material_point_method, geometry: axisymmetric}\n";
  struct tree *tree = NULL;
  gamut_status status = GAMUT_OK;
  *store = NULL;
  TRY(tree_parse(scene, strlen(scene), "sample", GAMUT_SCENE, trace, &tree));
  TRY(store_open(folder, replace, trace, store));
  TRY(store_scene(*store, tree, trace));
  for (int frame = 0; frame < SAMPLE_FRAMES; ++frame)
    TRY(write_frame(*store, frame, shrinks ? 200 * (size_t)frame : 0,
                    shrinks && frame > 1 ? 0 : SAMPLE_ANVIL, trace));
  TRY(histories(*store, trace));
  TRY(store_summary(*store, "{\"gamut\": \"0.1.0\"}\n", trace));
done:
  tree_free(tree);
  return status;
}
