#include <math.h>
#include <stdio.h>

#include "stations.gamut.h"

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  *self = (void *)(uintptr_t)values;
  for (size_t i = 0; i < gamut_entries(values, "stations"); i++)
    if (gamut_real(gamut_entry(values, "stations", i), "weight") > 100.0)
      return gamut_fail_at(run, gamut_entry(values, "stations", i), "weight", "at most 100",
                           "the station '%s' is too heavy",
                           gamut_entry_name(values, "stations", i));
  return GAMUT_OK;
}

static double distance(const struct gamut_values *station)
{
  double place[3];
  gamut_space_vector(station, "place", place);
  const double length = sqrt(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]);
  return stations_stations_side_of(station) == STATIONS_STATIONS_SIDE_FAR ? -length : length;
}

static double level(const struct gamut_values *values)
{
  if (gamut_given(values, "level.word"))
    return stations_level_word_of(values) == STATIONS_LEVEL_WORD_ROOF ? 10.0 : 0.0;
  if (gamut_given(values, "level.height"))
    return gamut_real(values, "level.height");
  return gamut_given(values, "level.law")
             ? gamut_real(values, "level.law.first") + gamut_real(values, "level.law.rate")
             : -1.0;
}

static double over_steps(const struct gamut_values *values, const char *one, const char *other)
{
  double sum = 0.0;
  for (size_t i = 0; i < gamut_entries(values, "steps"); i++) {
    const struct gamut_values *step = gamut_entry(values, "steps", i);
    sum += gamut_given(step, one) ? gamut_real(step, one) : 0.0;
    sum += other && gamut_given(step, other) ? gamut_real(step, other) : 0.0;
  }
  return sum;
}

/* Entries that are no groups are asked for by their path. */
static double heights(const struct gamut_values *values)
{
  double sum = 0.0;
  char path[64];
  for (size_t i = 0; i < gamut_entries(values, "heights"); i++) {
    snprintf(path, sizeof path, "heights.%s", gamut_entry_name(values, "heights", i));
    sum += gamut_real(values, path);
  }
  return sum;
}

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  const struct gamut_values *values = self, *station = NULL;
  (void)body;
  enum stations_measure which = stations_measure_of(name);
  if (which == STATIONS_MEASURE_WEIGHT || which == STATIONS_MEASURE_DISTANCE)
    station = gamut_entry(values, "stations", (size_t)gamut_choice(arguments, "station"));
  *value = 0.0;
  switch (which) {
  case STATIONS_MEASURE_WEIGHT:
    *value = gamut_real(station, "weight");
    return GAMUT_OK;
  case STATIONS_MEASURE_DISTANCE:
    *value = distance(station);
    return GAMUT_OK;
  case STATIONS_MEASURE_GROWTH:
    *value = over_steps(values, "slope", NULL);
    return GAMUT_OK;
  case STATIONS_MEASURE_FACTOR:
    *value = over_steps(values, "factor", "start");
    return GAMUT_OK;
  case STATIONS_MEASURE_HEIGHT:
    *value = heights(values);
    return GAMUT_OK;
  case STATIONS_MEASURE_WORDS:
    *value = (double)gamut_entries(values, "labels");
    return GAMUT_OK;
  case STATIONS_MEASURE_LEVEL:
    *value = level(values);
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN;
}

GAMUT_EFFECT(stations, .create = create, .measure = measure)
