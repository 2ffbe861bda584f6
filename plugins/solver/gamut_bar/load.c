/* The path of the nominal stress. */
#include "bar.h"

/* A law without a yield stress of its own yields at this plastic strain. */
static const double offset = 0.002;

static gamut_status find_reference(struct bar *bar)
{
  const struct gamut_host *host = GAMUT_HOST(bar->run);
  const struct family_law *law = &bar->families.law[0];
  struct load *load = &bar->load;
  load->reference = bar->yield;
  if (gamut_given(bar->values, "reference_stress"))
    load->reference = gamut_real(bar->values, "reference_stress");
  if (load->reference > 0.0)
    return GAMUT_OK;
  law->strain[0] = offset;
  host->law_call(law->law, "flow_stress", 1, NULL);
  load->reference = law->flow[0];
  return load->reference > 0.0 && load->reference < HUGE_VAL
             ? GAMUT_OK
             : gamut_fail_at(bar->run, bar->values, "reference_stress", "such as '500 MPa'",
                             "the strength gives no stress for the path to begin at");
}

/* More load steps than anybody waits for. */
static const double steps_most = 1e8;

static gamut_status count_fits(struct bar *bar, const char *path, double steps)
{
  return steps <= steps_most ? GAMUT_OK
                             : gamut_fail_at(bar->run, bar->values, path, "at most 1e8 load steps",
                                             "the path of the load has %.3g steps", steps);
}

static gamut_status monotonic(struct bar *bar)
{
  struct load *load = &bar->load;
  load->strain_limit = bar->failure_strain;
  if (gamut_given(bar->values, "strain_limit"))
    load->strain_limit = gamut_real(bar->values, "strain_limit");
  if (!(load->strain_limit > 0.0))
    return gamut_fail_at(bar->run, bar->values, "strain_limit", "a strain, such as 0.1",
                         "'strain_limit' is missing: the strength has no failure_strain to end at");
  double end = bar->failure_stress > 0.0 ? bar->failure_stress : 30.0 * load->reference;
  load->stress_limit = 3.0 * end;
  const double rungs =
      log(load->stress_limit / load->reference / gamut_real(bar->values, "start")) /
      log(load->growth);
  const gamut_status status = count_fits(bar, "growth", rungs);
  if (status != GAMUT_OK)
    return status;
  load->rung = (long)ceil(log(gamut_real(bar->values, "start")) / log(load->growth) - 1e-9);
  return GAMUT_OK;
}

static gamut_status table(struct bar *bar)
{
  struct load *load = &bar->load;
  load->row = gamut_table(bar->values, "load_table", &load->rows);
  if (load->rows < 1)
    return gamut_fail_at(bar->run, bar->values, "load_table", "rows of step and stress",
                         "'load_table' is missing: load is table");
  for (size_t i = 0; i < load->rows; i++)
    if (!(load->row[2 * i] > (i ? load->row[2 * i - 2] : -1e-300)))
      return gamut_fail_at(bar->run, bar->values, "load_table", "growing steps from 0 on",
                           "the step goes back in row %zu of the table", i + 1);
  return count_fits(bar, "load_table", load->row[2 * load->rows - 2]);
}

static gamut_status cyclic(struct bar *bar)
{
  const struct load *load = &bar->load;
  return count_fits(bar, "increments",
                    2.0 * (double)load->levels * (double)load->cycles * (double)load->increments);
}

gamut_status load_new(struct bar *bar)
{
  struct load *load = &bar->load;
  load->kind = gamut_bar_load_of(bar->values);
  load->growth = gamut_real(bar->values, "growth");
  load->levels = gamut_integer(bar->values, "levels");
  load->cycles = gamut_integer(bar->values, "cycles");
  load->increments = gamut_integer(bar->values, "increments");
  gamut_status status = find_reference(bar);
  if (status != GAMUT_OK)
    return status;
  switch (load->kind) {
  case GAMUT_BAR_LOAD_MONOTONIC:
    return monotonic(bar);
  case GAMUT_BAR_LOAD_CYCLIC:
    return cyclic(bar);
  case GAMUT_BAR_LOAD_TABLE:
    return table(bar);
  }
  return gamut_fail(bar->run, GAMUT_PLUGIN, "gamut_bar does not know this load");
}

static double next_rung(struct load *load)
{
  load->tip = load->rung >= 0;
  return load->reference * pow(load->growth, (double)load->rung);
}

/* Leg 0 goes up to the level, then legs go down and up; steps are small where the curve is flat,
 * near the tips. */
static double next_of_leg(struct bar *bar)
{
  static const double pi = 3.14159265358979323846;
  struct load *load = &bar->load;
  double tip = load->reference * pow(load->growth, (double)load->level);
  double to = load->leg % 2 ? -tip : tip;
  long increments = load->leg == 0 && load->level > 0 ? 1 : load->increments;
  if (load->increment == 0)
    load->from = bar->nominal_stress;
  load->increment++;
  load->tip = load->increment == increments;
  if (load->tip)
    return to;
  double way = 0.5 * (1.0 - cos(pi * (double)load->increment / (double)increments));
  return load->from + (to - load->from) * way;
}

static double next_of_table(const struct load *load)
{
  double step = (double)(load->step + 1);
  const double *row = load->row, *last = row + 2 * (load->rows - 1);
  if (step <= row[0])
    return row[0] > 0.0 ? row[1] * step / row[0] : row[1];
  while (row < last && row[2] < step)
    row += 2;
  if (row == last)
    return row[1];
  return row[1] + (row[3] - row[1]) * ((step - row[0]) / (row[2] - row[0]));
}

bool load_next(struct bar *bar, double *stress)
{
  struct load *load = &bar->load;
  if (load->ended)
    return false;
  switch (load->kind) {
  case GAMUT_BAR_LOAD_MONOTONIC:
    *stress = next_rung(load);
    return true;
  case GAMUT_BAR_LOAD_CYCLIC:
    *stress = next_of_leg(bar);
    return true;
  case GAMUT_BAR_LOAD_TABLE:
    *stress = next_of_table(load);
    return true;
  }
  return false;
}

static void keep_level(struct bar *bar, long level)
{
  if (level < 0 || level >= LEVELS_MAX)
    return;
  bar->level[level] = (struct level){bar->nominal_stress, bar->mean_strain};
  if (bar->levels <= (size_t)level)
    bar->levels = (size_t)level + 1;
}

static void close_loop(struct bar *bar)
{
  struct loop *loop = &bar->loop;
  if (bar->load.leg > 0 && loop->begun) {
    loop->energy = loop->area;
    loop->closure = bar->mean_strain - loop->last_tip_strain;
    loop->closed = true;
  }
  loop->begun = true;
  loop->area = 0.0;
  loop->last_tip_strain = bar->mean_strain;
}

static void end_leg(struct bar *bar)
{
  struct load *load = &bar->load;
  if (load->leg % 2 == 0) {
    close_loop(bar);
    keep_level(bar, load->level);
  }
  load->increment = 0;
  if (++load->leg <= 2 * load->cycles)
    return;
  load->leg = 0;
  load->ended = ++load->level >= load->levels;
}

void load_stepped(struct bar *bar)
{
  struct load *load = &bar->load;
  load->step++;
  switch (load->kind) {
  case GAMUT_BAR_LOAD_MONOTONIC:
    keep_level(bar, load->rung++);
    load->ended = bar->mean_strain > load->strain_limit || bar->nominal_stress > load->stress_limit;
    break;
  case GAMUT_BAR_LOAD_CYCLIC:
    if (load->tip)
      end_leg(bar);
    break;
  case GAMUT_BAR_LOAD_TABLE:
    load->ended = (double)load->step >= load->row[2 * load->rows - 2];
    break;
  }
}
