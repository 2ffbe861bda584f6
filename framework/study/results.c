#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/study_private.h"

/* Curves of single runs are kept up to this many numbers. */
enum { KEPT_NUMBERS = 1 << 25 };
enum { PARTS = 10 }; /* axis, moments and the run at the means of a curve */

/* Columns with the memory behind them. The runs at the means, where there are any, are the first
 * rows; each has the number -1, and its level. */
struct table {
  struct table_column *column;
  size_t columns;
  void **memory;
  size_t memories;
  size_t rows;
  bool failed;
};

static void *keep(struct table *table, void *memory)
{
  table->failed = table->failed || !memory;
  table->memory[table->memories++] = memory;
  return memory;
}

static double *number_column(struct table *table, const char *group, const char *name,
                             const char *unit, const char *meaning)
{
  double *value = keep(table, calloc(table->rows + 1, sizeof *value));
  table->column[table->columns++] = (struct table_column){group, name, unit, meaning, value, NULL};
  return value;
}

static const char **text_column(struct table *table, const char *group, const char *name,
                                const char *meaning)
{
  const char **text = keep(table, calloc(table->rows + 1, sizeof *text));
  table->column[table->columns++] = (struct table_column){group, name, NULL, meaning, NULL, text};
  return text;
}

/* The outcome that a row is of. */
static const struct outcome *row_of(const struct study *study, size_t row)
{
  const size_t above = nominals_done(study);
  return row < above ? nominal_done(study, row) : &study->outcome[row - above];
}

static void add_run(struct table *table, const struct study *study)
{
  double *run = number_column(table, NULL, "run", "1", "number of the run");
  double *level = number_column(table, NULL, "level", "1", "number of its level");
  double *realisation =
      number_column(table, NULL, "realisation", "1", "number of its random fields");
  const char **state = text_column(table, NULL, "status", "ok or failed");
  const size_t above = nominals_done(study);
  for (size_t r = 0; !table->failed && r < table->rows; r++) {
    const struct outcome *o = row_of(study, r);
    run[r] = r < above ? -1 : (double)(r - above);
    level[r] = (double)o->level;
    realisation[r] = (double)o->realisation;
    state[r] = o->reason ? "failed" : r < above ? "nominal" : "ok";
  }
}

static void add_varied(struct table *table, const struct study *study)
{
  for (size_t k = 0; k < study->varies; k++) {
    const char **text = text_column(table, "varied", study->varied[k], "as the level has it");
    for (size_t r = 0; !table->failed && r < table->rows; r++)
      text[r] = keep(table, level_text(study, row_of(study, r)->level, k));
  }
}

/* A parameter that levels set has no draw of its own. */
static bool is_varied(const struct study *study, const char *path)
{
  for (size_t k = 0; k < study->varies; k++)
    if (strcmp(study->varied[k], path) == 0)
      return true;
  return false;
}

static void add_numbers(struct table *table, const struct study *study)
{
  for (size_t i = 0; i < study->parameters; i++) {
    const struct random_parameter *random = &study->scene->random_parameter[i];
    if (is_varied(study, random->path))
      continue;
    double *value = number_column(table, "parameters", random->path, random->parameter->unit,
                                  random->parameter->doc);
    for (size_t r = 0; value && r < table->rows; r++)
      value[r] = row_of(study, r)->parameter[i];
  }
  for (size_t i = 0; i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    if (m->curve)
      continue;
    double *value = number_column(table, "quantities", m->quantity->name, m->unit,
                                  m->quantity->measure ? m->quantity->measure->doc : NULL);
    for (size_t r = 0; value && r < table->rows; r++)
      value[r] = row_of(study, r)->result[m->first];
  }
}

static void add_ending(struct table *table, const struct study *study)
{
  double *steps = number_column(table, NULL, "steps", "1", "time steps");
  const char **reason = text_column(table, NULL, "reason", "why it failed");
  for (size_t r = 0; !table->failed && r < table->rows; r++) {
    const struct outcome *o = row_of(study, r);
    steps[r] = (double)o->steps;
    reason[r] = o->reason ? o->reason : "";
  }
}

static gamut_status write_table(struct study *study, struct store *store)
{
  gamut_status status;
  size_t columns = 8 + study->varies + study->parameters + study->quantities;
  struct table table = {.rows = study->runs + nominals_done(study)};
  table.column = calloc(columns, sizeof *table.column);
  table.memory = calloc(columns + study->varies * table.rows, sizeof *table.memory);
  table.failed = !table.column || !table.memory;
  if (!table.failed) {
    add_run(&table, study);
    add_varied(&table, study);
    add_numbers(&table, study);
    add_ending(&table, study);
  }
  status = table.failed ? trace_fail(study->trace, GAMUT_INTERNAL, "out of memory")
                        : store_table(store, "study.csv", "study", table.column, table.columns,
                                      table.rows, nominals_done(study), study->trace);
  for (size_t i = 0; i < table.memories; i++)
    free(table.memory[i]);
  free(table.memory);
  free(table.column);
  return status;
}

/* The common axis, moments and runs of a curve where they overlap; all in one piece of memory. */
static double *cut_curve(const struct study *study, const struct measured *m, bool with_runs,
                         struct table_curve *curve)
{
  size_t *kept = calloc(m->count + 1, sizeof *kept);
  size_t runs = with_runs ? study->runs : 0;
  double *memory = calloc((PARTS + runs) * m->count + 1, sizeof *memory);
  if (!kept || !memory) {
    free(kept);
    free(memory);
    return NULL;
  }
  size_t n = curve_overlap(study, m, kept);
  const struct gamut_moments *moments = &study->moments;
  const double *source[PARTS] = {m->at,
                                 moments->mean + m->first,
                                 moments->variance + m->first,
                                 moments->mean_error + m->first,
                                 moments->variance_error + m->first,
                                 moments->mean_lower + m->first,
                                 moments->mean_upper + m->first,
                                 moments->variance_lower + m->first,
                                 moments->variance_upper + m->first,
                                 study->nominal[0].outcome.result + m->first};
  for (size_t s = 0; s < PARTS; s++)
    for (size_t i = 0; i < n; i++)
      memory[s * n + i] = source[s][kept[i]];
  for (size_t r = 0; r < runs; r++)
    for (size_t i = 0; i < n; i++)
      memory[(PARTS + r) * n + i] =
          study->outcome[r].reason ? NAN : study->outcome[r].result[m->first + kept[i]];
  *curve = (struct table_curve){.name = m->quantity->name,
                                .unit = m->unit,
                                .axis = m->axis,
                                .axis_unit = m->axis_unit,
                                .meaning = m->quantity->measure ? m->quantity->measure->doc : NULL,
                                .count = n,
                                .at = memory,
                                .mean = memory + n,
                                .variance = memory + 2 * n,
                                .mean_error = memory + 3 * n,
                                .variance_error = memory + 4 * n,
                                .mean_interval = {memory + 5 * n, memory + 6 * n},
                                .variance_interval = {memory + 7 * n, memory + 8 * n},
                                .nominal = memory + 9 * n,
                                .run = memory + PARTS * n,
                                .runs = runs};
  free(kept);
  return memory;
}

static gamut_status write_curves(struct study *study, struct store *store)
{
  gamut_status status = GAMUT_OK;
  struct table_curve *curve = calloc(study->quantities + 1, sizeof *curve);
  double **memory = calloc(study->quantities + 1, sizeof *memory);
  size_t curves = 0;
  bool with_runs = study->results * study->runs <= KEPT_NUMBERS;
  bool good = curve && memory;
  for (size_t i = 0; good && i < study->quantities; i++) {
    if (!study->measured[i].curve)
      continue;
    memory[curves] = cut_curve(study, &study->measured[i], with_runs, &curve[curves]);
    good = memory[curves++] != NULL;
  }
  if (!good)
    status = trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  else
    status = store_curves(store, "study/curves", curve, curves, study->trace);
  if (status == GAMUT_OK && curves && !with_runs)
    trace_note(study->trace, "the curves of single runs are too many for results.h5; study.log has "
                             "them");
  for (size_t i = 0; memory && i < curves; i++)
    free(memory[i]);
  free(memory);
  free(curve);
  return status;
}

/* The curves of runs that are no sample, those of one quantity side by side. */
static gamut_status write_members(struct study *study, struct store *store)
{
  gamut_status status;
  struct table_member *member = calloc(study->quantities * study->runs + 1, sizeof *member);
  char **label = calloc(study->runs + 1, sizeof *label);
  size_t members = 0;
  for (size_t r = 0; label && r < study->runs; r++)
    label[r] = level_label(study, study->outcome[r].level);
  for (size_t i = 0; member && label && i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    for (size_t r = 0; m->curve && r < study->runs; r++) {
      const struct outcome *o = &study->outcome[r];
      if (o->done && !o->reason)
        member[members++] = (struct table_member){
            .name = m->quantity->name,
            .unit = m->unit,
            .axis = m->axis,
            .axis_unit = m->axis_unit,
            .meaning = m->quantity->measure ? m->quantity->measure->doc : NULL,
            .label = label[r] ? label[r] : "",
            .run = r,
            .count = o->own[i].count,
            .at = o->own[i].at,
            .value = o->own[i].value};
    }
  }
  status = member && label ? store_members(store, "study/curves", member, members, study->trace)
                           : trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t r = 0; label && r < study->runs; r++)
    free(label[r]);
  free(label);
  free(member);
  return status;
}

gamut_status results_write(struct study *study, struct store *store, gamut_status outcome)
{
  gamut_status status;
  char *summary = study_summary(study, outcome);
  TRY(store_scene(store, study->scene->tree, study->trace));
  TRY(write_table(study, store));
  if (study->table)
    TRY(write_members(study, store));
  else if (outcome == GAMUT_OK)
    TRY(write_curves(study, store));
  TRY(report_write(study, store));
  if (summary)
    TRY(store_summary(store, summary, study->trace));
  TRY(store_finish(store, study->trace));
done:
  free(summary);
  return status;
}
