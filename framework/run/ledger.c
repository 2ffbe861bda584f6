#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "run/run_private.h"

/* Growth of stored energy beyond what was supplied that no rounding explains. */
static const double energy_tolerance = 0.05;
/* A residual over its scale that no rounding explains. */
static const double residual_tolerance = 1e-10;

/* Of an account; `scale` of the unit, where the line is the first of that. */
struct balance {
  double stored, start, supplied, lost, scale;
};

/* The numbers of the first lines of the same account and of the same unit. */
static void find_alike(struct gamut_run *run, size_t line)
{
  struct ledger_line *own = &run->ledger[line];
  own->first = own->alike = line;
  for (size_t i = line; i-- > 0;) {
    if (strcmp(run->ledger[i].account, own->account) == 0)
      own->first = i;
    if (strcmp(run->ledger[i].unit, own->unit) == 0)
      own->alike = i;
  }
}

gamut_status ledger_open(struct gamut_run *run, const char *account, const char *name,
                         const char *unit, enum gamut_ledger_role role, double **value)
{
  struct ledger_line *lines = realloc(run->ledger, (run->lines + 1) * sizeof *lines);
  if (lines)
    run->ledger = lines;
  double **values = realloc(run->line_value, (run->lines + 1) * sizeof(*values));
  if (values)
    run->line_value = values;
  struct balance *balances = realloc(run->balance, (run->lines + 1) * sizeof *balances);
  if (balances)
    run->balance = balances;
  double *cell = arena_take(run->arena, "ledger", sizeof *cell);
  if (!lines || !values || !balances || !cell)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  lines[run->lines] = (struct ledger_line){.account = memory_copy(account),
                                           .name = memory_copy(name),
                                           .unit = memory_copy(unit),
                                           .role = role};
  values[run->lines] = cell;
  find_alike(run, run->lines++);
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
  free(run->balance);
}

/* The values as the plugins left them, after a step or the start. */
static void read_lines(struct gamut_run *run)
{
  for (size_t i = 0; i < run->lines; i++) {
    struct ledger_line *line = &run->ledger[i];
    line->turnover += fabs(*run->line_value[i] - line->value);
    line->value = *run->line_value[i];
  }
}

void ledger_start(struct gamut_run *run)
{
  read_lines(run);
  for (size_t i = 0; i < run->lines; i++) {
    run->ledger[i].start = run->ledger[i].value;
    run->ledger[i].turnover = fabs(run->ledger[i].value);
  }
}

/* All accounts at once. What rounding is measured by is not what is there now, which may be nothing
 * after much came and went. Accounts of one unit share it: a momentum that is zero by symmetry is
 * judged by the others. */
static void add_up(const struct gamut_run *run)
{
  memset(run->balance, 0, run->lines * sizeof *run->balance);
  for (size_t i = 0; i < run->lines; i++) {
    const struct ledger_line *line = &run->ledger[i];
    struct balance *b = &run->balance[line->first], *unit = &run->balance[line->alike];
    unit->scale = fmax(unit->scale, line->turnover);
    if (line->role == GAMUT_STORED) {
      b->stored += line->value;
      b->start += line->start;
    } else if (line->role == GAMUT_SUPPLIED) {
      b->supplied += line->value - line->start;
    } else {
      b->lost += line->value - line->start;
    }
  }
}

static double residual_of(const struct balance *b)
{
  return b->stored - b->start - b->supplied + b->lost;
}

const struct ledger_line *run_ledger(const struct gamut_run *run, size_t *count)
{
  *count = run->lines;
  return run->ledger;
}

double run_ledger_residual(const struct gamut_run *run, const char *account, double *scale)
{
  size_t i = 0;
  while (i < run->lines && strcmp(run->ledger[i].account, account) != 0)
    i++;
  *scale = 0.0;
  if (i == run->lines)
    return 0.0;
  add_up(run);
  *scale = run->balance[run->ledger[i].alike].scale;
  return residual_of(&run->balance[i]);
}

static gamut_status check_growth(struct gamut_run *run, const struct balance *b)
{
  double created = b->stored - b->start - b->supplied;
  double scale = fabs(b->start) + fabs(b->supplied);
  if (!(created > energy_tolerance * scale && scale > 0.0) && isfinite(b->stored))
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

static gamut_status check_residual(struct gamut_run *run, const struct ledger_line *line)
{
  double residual = residual_of(&run->balance[line->first]);
  double scale = run->balance[line->alike].scale;
  if (fabs(residual) <= residual_tolerance * scale)
    return GAMUT_OK;
  return trace_fail(run->trace, GAMUT_NUMERICS,
                    "the ledger does not close: %s is off by %.6g %s at t = %.6g s, step %llu. "
                    "That is %.1e of the %.6g %s that went through its largest line, and more than "
                    "%.0e is no rounding: solver or effects book wrongly, or lose what they should "
                    "keep, and no figure of this run can be relied on",
                    line->account, residual, line->unit, run->time, (unsigned long long)run->steps,
                    fabs(residual) / scale, scale, line->unit, residual_tolerance);
}

gamut_status ledger_check(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  if (run->lines == 0)
    return GAMUT_OK;
  read_lines(run);
  add_up(run);
  for (size_t i = 0; i < run->lines; i++) {
    const struct ledger_line *line = &run->ledger[i];
    if (line->first != i)
      continue;
    if (strcmp(line->account, "energy") == 0)
      TRY(check_growth(run, &run->balance[i]));
    /* Moments about an origin are small differences of large ones: printed, not judged. */
    if (strncmp(line->account, "angular_momentum", strlen("angular_momentum")) != 0)
      TRY(check_residual(run, line));
  }
done:
  return status;
}
