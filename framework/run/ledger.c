#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/inside.h"

/* Growth of stored energy beyond what was supplied that no rounding explains. */
static const double energy_tolerance = 0.05;

gamut_status ledger_open(struct gamut_run *run, const char *account, const char *name,
                         const char *unit, enum gamut_ledger_role role, double **value)
{
  struct ledger_line *lines = realloc(run->ledger, (run->lines + 1) * sizeof *lines);
  if (lines)
    run->ledger = lines;
  double **values = realloc(run->line_value, (run->lines + 1) * sizeof(*values));
  if (values)
    run->line_value = values;
  double *cell = arena_take(run->arena, "ledger", sizeof *cell);
  if (!lines || !values || !cell)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  lines[run->lines] = (struct ledger_line){
      .account = strdup(account), .name = strdup(name), .unit = strdup(unit), .role = role};
  values[run->lines++] = cell;
  *value = cell;
  return GAMUT_OK;
}

void ledger_free(struct gamut_run *run)
{
  for (size_t i = 0; i < run->lines; i++) {
    free(run->ledger[i].account);
    free(run->ledger[i].name);
    free(run->ledger[i].unit);
  }
  free(run->ledger);
  free(run->line_value);
}

static void read_lines(struct gamut_run *run)
{
  for (size_t i = 0; i < run->lines; i++)
    run->ledger[i].value = *run->line_value[i];
}

void ledger_start(struct gamut_run *run)
{
  read_lines(run);
  for (size_t i = 0; i < run->lines; i++)
    run->ledger[i].start = run->ledger[i].value;
}

struct balance {
  double stored, start, supplied, lost, scale;
};

/* Accounts of one unit share a scale: a momentum that is zero by symmetry is judged by the others.
 */
static double scale_of(const struct gamut_run *run, const char *unit)
{
  double scale = 0.0;
  for (size_t i = 0; i < run->lines; i++) {
    const struct ledger_line *line = &run->ledger[i];
    if (strcmp(line->unit, unit) == 0)
      scale = fmax(scale, fmax(fabs(line->value), fabs(line->start)));
  }
  return scale;
}

static struct balance balance_of(const struct gamut_run *run, const char *account)
{
  struct balance b = {0};
  for (size_t i = 0; i < run->lines; i++) {
    const struct ledger_line *line = &run->ledger[i];
    if (strcmp(line->account, account) != 0)
      continue;
    b.scale = scale_of(run, line->unit);
    if (line->role == GAMUT_STORED) {
      b.stored += line->value;
      b.start += line->start;
    } else if (line->role == GAMUT_SUPPLIED) {
      b.supplied += line->value - line->start;
    } else {
      b.lost += line->value - line->start;
    }
  }
  return b;
}

const struct ledger_line *run_ledger(const struct gamut_run *run, size_t *count)
{
  *count = run->lines;
  return run->ledger;
}

double run_ledger_residual(const struct gamut_run *run, const char *account, double *scale)
{
  struct balance b = balance_of(run, account);
  *scale = b.scale;
  return b.stored - b.start - b.supplied + b.lost;
}

gamut_status ledger_check(struct gamut_run *run)
{
  read_lines(run);
  struct balance b = balance_of(run, "energy");
  double created = b.stored - b.start - b.supplied;
  double scale = fabs(b.start) + fabs(b.supplied);
  if (!(created > energy_tolerance * scale && scale > 0.0) && isfinite(b.stored))
    return GAMUT_OK;
  char point[768];
  describe_fastest(run, point, sizeof point);
  return trace_fail(
      run->trace, GAMUT_NUMERICS,
      "energy was created: %.6g J more than the %.6g J that the bodies had and were "
      "given, at t = %.6g s, step %llu of %.3g s. The step is too long for this state "
      "(a smaller `courant`, or no fixed `step`), or the shape functions let points "
      "slip (a smoother `shape`)%s%s",
      created, scale, run->time, (unsigned long long)run->steps, run->step,
      *point ? ". Fastest is " : "", point);
}
