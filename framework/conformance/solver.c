/* solver: a small scene runs to its end, its ledger closes, and threads do not change a bit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "conformance/scene_run.h"

/* What one run of the scene left, to compare bits. */
struct outcome {
  gamut_status status;
  bool ended;
  double *value;
  size_t count;
  uint64_t steps;
  double worst; /* ledger residual over its scale */
  char account[64];
};

static void keep_histories(struct outcome *outcome, const struct gamut_run *run)
{
  size_t count, total = 0;
  struct history *const *history = run_histories(run, &count);
  for (size_t i = 0; i < count; i++)
    total += 2 * history[i]->count;
  outcome->value = calloc(total + 1, sizeof *outcome->value);
  for (size_t i = 0; outcome->value && i < count; i++)
    for (size_t k = 0; k < history[i]->count; k++) {
      outcome->value[outcome->count++] = history[i]->time[k];
      outcome->value[outcome->count++] = history[i]->value[k];
    }
}

static void keep_ledger(struct outcome *outcome, const struct gamut_run *run)
{
  size_t count;
  const struct ledger_line *line = run_ledger(run, &count);
  for (size_t i = 0; i < count; i++) {
    double scale, residual = run_ledger_residual(run, line[i].account, &scale);
    double relative = residual == 0 ? 0 : fabs(residual) / scale;
    if (!(relative <= outcome->worst)) {
      outcome->worst = relative;
      snprintf(outcome->account, sizeof outcome->account, " (%s)", line[i].account);
    }
  }
}

static void run_scene(struct proof *proof, const char *file, int threads, struct outcome *outcome)
{
  struct scene_run made;
  scene_run_make(&made, proof, file, NULL, 0, threads);
  *outcome = (struct outcome){.status = made.status, .ended = made.status == GAMUT_OK};
  if (outcome->ended) {
    keep_histories(outcome, made.run);
    keep_ledger(outcome, made.run);
    outcome->steps = run_cost_of(made.run).steps;
    if (threads == 1)
      prove_measures(proof, made.run);
  }
  scene_run_free(&made);
}

/* `label` is how people know the scene. False if it does not run to its end. */
static bool prove_file(struct proof *proof, const char *file, const char *label)
{
  struct outcome outcome[3] = {{0}};
  for (int k = 0; k < 3; k++) {
    check_begin(&proof->checks, "the scene %s on %d threads", label, k + 1);
    run_scene(proof, file, k + 1, &outcome[k]);
    if (outcome[k].status != GAMUT_OK)
      break;
  }
  bool ended = outcome[2].ended;
  check_that(&proof->checks, ended, "the scene %s runs to its end (%llu steps)", label,
             (unsigned long long)outcome[0].steps);
  if (ended) {
    size_t different = 0;
    for (int k = 1; k < 3; k++)
      different +=
          outcome[k].count != outcome[0].count ||
          memcmp(outcome[k].value, outcome[0].value, outcome[0].count * sizeof(double)) != 0;
    check_figure(&proof->checks, outcome[0].worst, 1e-10, "residual of the ledger, relative%s",
                 outcome[0].account);
    check_figure(&proof->checks, (double)different, 0,
                 "runs on 2 and 3 threads with other bits (%zu numbers compared)",
                 outcome[0].count);
  }
  for (int k = 0; k < 3; k++)
    free(outcome[k].value);
  return ended;
}

/* An effect must run somewhere: where it brings no scene, in the usual one. */
static void prove_usual_scene(struct proof *proof)
{
  const char *name = proof->descriptor->name;
  char *file = usual_scene_new(proof);
  if (!file)
    check_that(&proof->checks, false, "the usual scene of an effect can be written");
  else if (!prove_file(proof, file, "that effects without one are tried in"))
    check_say(&proof->checks, "put a scene that uses effect/%s, and runs, into %s.scene.yaml", name,
              name);
  usual_scene_free(file);
}

void prove_scene(struct proof *proof)
{
  const struct descriptor *d = proof->descriptor;
  char name[256];
  snprintf(name, sizeof name, "%s.scene.yaml", d->name);
  char *file = plugin_file(d, name);
  if (!file)
    return;
  if (access(file, R_OK) == 0)
    prove_file(proof, file, name);
  else if (d->kind == GAMUT_KIND_EFFECT)
    prove_usual_scene(proof);
  else
    check_skip(&proof->checks, "no such file", "the scene %s", name);
  free(file);
}

void prove_solver(struct proof *proof)
{
  const struct descriptor *d = proof->descriptor;
  check_that(&proof->checks, d->axis != NULL, "the solver says along which axis it advances");
  check_that(&proof->checks, d->phases > 0, "the solver lists its phases");
  prove_scene(proof);
}
