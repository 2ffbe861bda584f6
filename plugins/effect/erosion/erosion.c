#include "erosion.gamut.h"

struct erosion_effect {
  double strain, least, largest, temperature; /* limits; beyond any number where there is none */
  double mark;
  const struct gamut_removed *gone;
  struct gamut_field plastic_strain, volume_ratio, hot, removal;
  bool by_strain, by_volume, by_heat;
};

static void take_above(const struct gamut_chunk *chunk, const double *value, double limit,
                       double mark, double *removal)
{
  GAMUT_EACH (i, chunk)
    removal[i] = value[i] >= limit && removal[i] == 0.0 ? mark : removal[i];
}

static gamut_status take(void *self, const struct gamut_chunk *chunk)
{
  const struct erosion_effect *e = self;
  const double mark = e->mark, least = e->least, largest = e->largest;
  double *removal = gamut_end(chunk, e->removal, 0);
  if (e->by_strain)
    take_above(chunk, gamut_end(chunk, e->plastic_strain, 0), e->strain, mark, removal);
  if (e->by_heat)
    take_above(chunk, gamut_end(chunk, e->hot, 0), e->temperature, mark, removal);
  if (!e->by_volume)
    return GAMUT_OK;
  const double *ratio = gamut_end(chunk, e->volume_ratio, 0);
  GAMUT_EACH (i, chunk) {
    const bool goes = ratio[i] < least || ratio[i] > largest;
    removal[i] = goes && removal[i] == 0.0 ? mark : removal[i];
  }
  return GAMUT_OK;
}

static gamut_status read_limits(struct gamut_run *run, const struct gamut_values *values,
                                struct erosion_effect *e)
{
  size_t count;
  e->by_strain = gamut_given(values, "plastic_strain");
  e->by_heat = gamut_given(values, "temperature");
  e->by_volume = gamut_given(values, "volume_ratio");
  if (e->by_strain)
    e->strain = gamut_real(values, "plastic_strain");
  if (e->by_heat)
    e->temperature = gamut_real(values, "temperature");
  if (e->by_volume) {
    const double *range = gamut_vector(values, "volume_ratio", &count);
    e->least = range[0];
    e->largest = range[1];
    if (!(e->least < 1.0 && e->largest > 1.0))
      return gamut_fail_at(run, values, "volume_ratio", "[least, largest] on both sides of 1",
                           "points at their reference volume would go");
  }
  if (!e->by_strain && !e->by_heat && !e->by_volume && !gamut_boolean(values, "flagged") &&
      !gamut_boolean(values, "lost"))
    return gamut_fail_at(run, values, "plastic_strain",
                         "plastic_strain, volume_ratio, temperature, flagged or lost",
                         "the scene does not say which points go");
  return GAMUT_OK;
}

/* The task is there even where only flagged or lost points go: it makes the field. */
static gamut_status open_task(struct gamut_run *run, struct erosion_effect *e)
{
  struct gamut_use uses[4] = {{"removal", GAMUT_ADD}};
  size_t count = 1;
  gamut_status status = gamut_field_named(run, "removal", &e->removal);
  if (e->by_strain && status == GAMUT_OK) {
    uses[count++] = (struct gamut_use){"plastic_strain", GAMUT_READ};
    status = gamut_field_named(run, "plastic_strain", &e->plastic_strain);
  }
  if (e->by_volume && status == GAMUT_OK) {
    uses[count++] = (struct gamut_use){"volume_ratio", GAMUT_READ};
    status = gamut_field_named(run, "volume_ratio", &e->volume_ratio);
  }
  if (e->by_heat && status == GAMUT_OK) {
    uses[count++] = (struct gamut_use){"temperature", GAMUT_READ};
    status = gamut_field_named(run, "temperature", &e->hot);
  }
  const struct gamut_task task = {.name = "erosion",
                                  .phase = "removal",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = uses,
                                  .use_count = count,
                                  .run = take,
                                  .self = e};
  return status == GAMUT_OK ? gamut_add_task(run, &task) : status;
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  const struct gamut_removal rule = {.flagged = gamut_boolean(values, "flagged"),
                                     .lost = gamut_boolean(values, "lost"),
                                     .most = gamut_real(values, "most")};
  struct erosion_effect *e = gamut_allocate(run, "erosion", sizeof *e);
  if (e == NULL)
    return GAMUT_INTERNAL;
  gamut_status status = read_limits(run, values, e);
  if (status == GAMUT_OK)
    status = GAMUT_HOST(run)->removal(run, &rule, &e->gone, &e->mark);
  if (status == GAMUT_OK)
    status = open_task(run, e);
  if (status != GAMUT_OK)
    gamut_release(run, e);
  else
    *self = e;
  return status;
}

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  (void)body;
  (void)arguments;
  const struct erosion_effect *e = self;
  switch (erosion_measure_of(name)) {
  case EROSION_MEASURE_ERODED_MASS:
    *value = e->gone->mass;
    return GAMUT_OK;
  case EROSION_MEASURE_ERODED_ENERGY:
    *value = e->gone->kinetic + e->gone->internal;
    return GAMUT_OK;
  case EROSION_MEASURE_ERODED_POINTS:
    *value = e->gone->points;
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}

GAMUT_EFFECT(erosion, .create = create, .measure = measure)
