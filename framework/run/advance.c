#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "base/clock.h"
#include "catalogue/catalogue.h"
#include "registry/guard.h"
#include "run/run_private.h"

/* How often the progress is printed, in wall seconds. */
static const double progress_every = 0.1;

/* More steps than a year of computing has. */
static const double STEPS_MAX = 1e13;

static const char *solver_of(const struct gamut_run *run)
{
  return run->scene->solver.descriptor->id;
}

static void set_uniform_field(struct gamut_run *run, const char *name, double value)
{
  const struct field *field = fields_find(run->fields, name);
  if (field)
    run_host.set_uniform(run, field->handle, value);
}

gamut_status advance_start(struct gamut_run *run)
{
  gamut_status status;
  if (run->started)
    return run->start;
  run->started = true;
  set_uniform_field(run, "time_step", 0.0);
  set_uniform_field(run, "time", run->time);
  TRY(GUARDED(solver_of(run), run->solver->start(run->solver_self)));
  for (size_t s = 0; s < run->scene->bodies; s++)
    given_start(run->set[s]);
  TRY(given_check(run));
  TRY(host_laws_check(run));
  TRY(start_check(run));
  TRY(stop_check(run));
  ledger_start(run);
  TRY(observe_start(run));
  removal_start(run);
done:
  if (status == GAMUT_INTERNAL && run->too_large)
    status = GAMUT_SCENE;
  run->start = status;
  return status;
}

gamut_status run_start(struct gamut_run *run, struct trace *trace)
{
  run->trace = trace;
  return advance_start(run);
}

static bool has_given_steps(const struct gamut_run *run)
{
  return run->options.given.count > 0 && run->end > 0.0;
}

static bool is_sliver(double left, double step)
{
  return left - step < 1e-9 * step;
}

/* The longest step that may be taken from here. */
static double longest_step(const struct gamut_run *run)
{
  const struct run_steps *given = &run->options.given;
  const double left = run->end > 0.0 ? run->end - run->time : INFINITY;
  if (!has_given_steps(run) || run->steps >= given->count)
    return left;
  const double step = given->step[run->steps];
  return step > left || is_sliver(left, step) ? left : step;
}

static gamut_status check_given(const struct gamut_run *run, double given, double needed)
{
  if (!(needed < given) || needed == 0.0) /* 0: the solver has come to its end */
    return GAMUT_OK;
  return trace_fail_at(run->trace, GAMUT_NUMERICS, NULL, "uncertainty.step_margin",
                       "a larger margin; off: each run takes its own steps",
                       "at t = %.6g s the run needs a step of %.6g s or less, but all runs of the "
                       "study take one of %.6g s here (step %llu)",
                       run->time, needed, given, (unsigned long long)run->steps);
}

static gamut_status choose_step(struct gamut_run *run, double *step)
{
  gamut_status status;
  const double left = run->end - run->time, longest = longest_step(run);
  double factor = INFINITY;
  for (size_t m = 0; m < run->scene->materials; m++)
    if (run->material[m])
      factor = fmin(factor, material_step_factor(run->material[m]));
  *step = longest;
  if (run->steps > 0)
    *step = fmin(*step, factor * run->step);
  TRY(GUARDED(solver_of(run), run->solver->next(run->solver_self, step)));
  if (has_given_steps(run))
    TRY(check_given(run, longest, *step));
  /* A sliver of a last step would be all rounding. */
  if (run->end > 0.0 && *step > 0.0 && is_sliver(left, *step))
    *step = left;
  if (!(*step >= 0.0) || (run->end > 0.0 && *step > left))
    status = trace_fail(run->trace, GAMUT_NUMERICS,
                        "the solver asks for a step of %g s at t = %g s", *step, run->time);
  else if (run->end > 0.0 && *step > 0.0 && left > STEPS_MAX * *step)
    status = trace_fail_at(run->trace, GAMUT_NUMERICS, NULL, "solver.end",
                           "speeds and stresses too large, or a forced step too short",
                           "at t = %g s a step is %g s: the run would never end", run->time, *step);
done:
  return status;
}

gamut_status advance_first_step(struct gamut_run *run, double *step)
{
  return choose_step(run, step);
}

static gamut_status keep_step(struct gamut_run *run, double step)
{
  if (!run->options.keep_steps)
    return GAMUT_OK;
  if (run->steps == run->taken_capacity) {
    const size_t capacity = 2 * run->taken_capacity + 1024;
    double *grown = realloc(run->taken, capacity * sizeof *grown);
    if (!grown)
      return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
    run->taken = grown;
    run->taken_capacity = capacity;
  }
  run->taken[run->steps] = step;
  return GAMUT_OK;
}

struct run_steps run_steps_taken(const struct gamut_run *run)
{
  const bool whole = run->taken && run->end > 0.0 && run->time == run->end && !run->resumed;
  return whole && !run->fixed_steps ? (struct run_steps){run->taken, run->steps}
                                    : (struct run_steps){NULL, 0};
}

bool run_steps_fixed(const struct gamut_run *run)
{
  return run->fixed_steps;
}

static uint64_t count_points(const struct gamut_run *run)
{
  uint64_t points = 0;
  for (size_t s = 0; s < run->scene->bodies; s++)
    points += run->set[s]->open.points;
  return points;
}

gamut_status advance_step(struct gamut_run *run, bool *more)
{
  gamut_status status;
  bool due;
  double step;
  *more = !(run->end > 0.0) || run->time < run->end;
  if (!*more)
    return GAMUT_OK;
  TRY(choose_step(run, &step));
  *more = step > 0.0;
  if (!*more)
    return GAMUT_OK;
  run->step = step;
  TRY(keep_step(run, step));
  TRY(observe_before(run, step, &due));
  set_uniform_field(run, "time_step", step);
  set_uniform_field(run, "time", run->time);
  const struct step_context context = {run->set,     run->scene->bodies, run->scratch,
                                       run->uniform, run->threads,       run->chunk};
  run->work += (double)count_points(run);
  TRY(schedule_step(run->schedule, &context));
  run->time = run->end > 0.0 && step >= run->end - run->time ? run->end : run->time + step;
  run->steps++;
  TRY(stop_check(run));
  if (run->solver->after)
    TRY(GUARDED(solver_of(run), run->solver->after(run->solver_self)));
  TRY(ledger_check(run));
  TRY(observe_after(run, due, false));
  TRY(frames_due(run));
done:
  return status;
}

static void tell_progress(const struct gamut_run *run, double since)
{
  if (!run->options.progress)
    return;
  double done = run->end > 0.0 ? run->time / run->end : 0.0;
  double rate = since > 0.0 ? run->work / since : 0.0;
  run->options.progress(run->options.progress_self, done, run->time, run->steps, rate);
}

static gamut_status advance_all(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  double begun = clock_seconds(CLOCK_MONOTONIC), reported = begun;
  for (bool more = true; more;) {
    TRY(advance_step(run, &more));
    double now = clock_seconds(CLOCK_MONOTONIC);
    if (now - reported > progress_every || !more) {
      reported = now;
      tell_progress(run, now - begun);
    }
    if (more && run->options.stop && *run->options.stop) {
      if (run->store && run_can_stop(run))
        TRY(checkpoint_write(run));
      status = GAMUT_STOPPED;
      goto done;
    }
    if (more)
      TRY(checkpoint_due(run));
  }
done:
  return status;
}

gamut_status run_march(struct gamut_run *run, struct trace *trace)
{
  gamut_status status, written;
  double wall = clock_seconds(CLOCK_MONOTONIC), cpu = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
  run->trace = trace;
  TRY(advance_start(run));
  if (!run->resumed)
    TRY(frames_write(run));
  checkpoint_start(run);
  TRY(advance_all(run));
done:
  run->wall = clock_seconds(CLOCK_MONOTONIC) - wall;
  run->cpu = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  /* The last state is worth most when something went wrong. */
  written = run->started ? frames_write(run) : GAMUT_OK;
  if (status == GAMUT_OK || status == GAMUT_STOPPED) {
    gamut_status observed = observe_after(run, false, true);
    if (status == GAMUT_OK)
      status = observed != GAMUT_OK ? observed : written;
  }
  return status;
}

/* The kernel counts in kilobytes. */
static size_t resident_bytes(void)
{
  struct rusage used;
  return getrusage(RUSAGE_SELF, &used) == 0 ? (size_t)used.ru_maxrss * 1024 : 0;
}

struct run_cost run_cost_of(const struct gamut_run *run)
{
  struct run_cost cost = {.points = count_points(run),
                          .steps = run->steps,
                          .work = run->work,
                          .wall = run->wall,
                          .cpu = run->cpu,
                          .bytes = arena_bytes(run->arena),
                          .peak = arena_peak(run->arena),
                          .resident = resident_bytes()};
  cost.bytes_per_point = cost.points ? (double)cost.bytes / (double)cost.points : 0.0;
  return cost;
}

const struct schedule *run_schedule(const struct gamut_run *run)
{
  return run->schedule;
}

const struct fields *run_fields(const struct gamut_run *run)
{
  return run->fields;
}

const struct arena *run_arena(const struct gamut_run *run)
{
  return run->arena;
}

struct history *const *run_histories(const struct gamut_run *run, size_t *count)
{
  *count = run->probes;
  return run->history;
}

double run_time(const struct gamut_run *run)
{
  return run->time;
}
