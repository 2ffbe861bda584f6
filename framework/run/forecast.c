/* What is known of a run before it is made. */
#include <stdlib.h>

#include "base/clock.h"
#include "run/run_private.h"

/* Scenes beyond are not started for a check, which stays cheap. */
static const size_t start_most = (size_t)256 << 20;
static const double long_run = 3600.0;

bool forecast_steps(struct gamut_run *run, struct forecast *f)
{
  bool more = true;
  *f = (struct forecast){0};
  if (advance_start(run) != GAMUT_OK)
    return false;
  if (run->solver->describe)
    run->solver->describe(run->solver_self, &f->step, f->limit, sizeof f->limit);
  double begun = clock_seconds(CLOCK_MONOTONIC);
  int taken = 0;
  while (more && taken < TRIAL_STEPS) {
    if (advance_step(run, &more) != GAMUT_OK)
      return false;
    taken += more;
  }
  if (!(f->step > 0.0))
    f->step = run->step;
  f->steps = f->step > 0.0 && run->end > 0.0 ? run->end / f->step : 0.0;
  f->seconds = taken ? f->steps * (clock_seconds(CLOCK_MONOTONIC) - begun) / taken : 0.0;
  return true;
}

static void warn_long(struct gamut_run *run, struct trace *trace)
{
  struct forecast f;
  struct trace *own = trace_new(); /* what happens in a trial step is no finding of a check */
  const struct value *end = values_find(run->scene->solver.values, "end");
  run->trace = own;
  bool good = forecast_steps(run, &f);
  run->trace = trace;
  trace_free(own);
  if (good && f.seconds > long_run)
    trace_warn_at(trace, end && end->node ? &end->node->place : NULL, "solver.end",
                  "a larger cell or an earlier end, if that was not meant",
                  "the run takes about %.3g hours on this machine: %.3g steps of %.3g %s",
                  f.seconds / 3600.0, f.steps, f.step, run->scene->solver.descriptor->axis_unit);
}

gamut_status run_check(struct gamut_run *run, struct trace *trace)
{
  gamut_status status;
  double step;
  if (arena_bytes(run->arena) > start_most) {
    trace_note(trace,
               "this run takes %.3g GB: it was planned but not started, so what only the start can "
               "see was not checked",
               1e-9 * (double)arena_bytes(run->arena));
    return GAMUT_OK;
  }
  TRY(run_start(run, trace));
  TRY(advance_first_step(run, &step));
  warn_long(run, trace);
done:
  return status;
}
