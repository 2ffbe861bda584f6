/* The common steps of a level: those of its run at the means, made shorter by a margin, so that two
 * runs differ by their parameters and not by where their steps lie. */
#include <math.h>
#include <stdlib.h>

#include "study/study_private.h"

/* What the run at the means did with its time. */
struct walk {
  struct run_steps taken;
  size_t now;   /* the step that holds the present time */
  double until; /* its end */
};

static void walk_to(struct walk *walk, double time)
{
  while (walk->now + 1 < walk->taken.count && time >= walk->until * (1 - 1e-12))
    walk->until += walk->taken.step[++walk->now];
}

/* The shortest of the steps that one from here would reach into. */
static double allowed(const struct walk *walk, double time, double margin)
{
  double step = (1 - margin) * walk->taken.step[walk->now], begin = walk->until;
  for (size_t k = walk->now + 1; k < walk->taken.count && begin < time + step; k++) {
    step = fmin(step, (1 - margin) * walk->taken.step[k]);
    begin += walk->taken.step[k];
  }
  return step;
}

static bool push(struct common_steps *steps, size_t *capacity, double step)
{
  if (steps->count == *capacity) {
    *capacity = 2 * *capacity + 1024;
    double *grown = realloc(steps->step, *capacity * sizeof *grown);
    if (!grown)
      return false;
    steps->step = grown;
  }
  steps->step[steps->count++] = step;
  return true;
}

bool steps_make(struct run_steps taken, double end, double margin, struct common_steps *steps)
{
  struct walk walk = {taken, 0, taken.count ? taken.step[0] : 0};
  size_t capacity = 0;
  *steps = (struct common_steps){0};
  for (double time = 0; taken.count > 0 && time < end;) {
    const double left = end - time;
    walk_to(&walk, time);
    double step = allowed(&walk, time, margin);
    if (left - step < 1e-9 * step)
      step = left;
    else if (left < 2 * step) /* the last two share what is left, so that none is tiny */
      step = 0.5 * left;
    if (!push(steps, &capacity, step))
      return false;
    time = step >= left ? end : time + step;
  }
  return true;
}

struct run_steps steps_of(const struct study *study, size_t level)
{
  const struct nominal *nominal = study->nominal ? &study->nominal[level] : NULL;
  return nominal && nominal->outcome.done
             ? (struct run_steps){nominal->steps.step, nominal->steps.count}
             : (struct run_steps){NULL, 0};
}
