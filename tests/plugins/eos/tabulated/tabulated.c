#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tabulated.gamut.h"

struct tabulated_data {
  size_t rows;
  double *compression, *pressure; /* behind each other */
};

static struct tabulated_data *data_new(size_t rows)
{
  struct tabulated_data *data = calloc(1, sizeof *data + 2 * rows * sizeof(double));
  if (!data)
    return NULL;
  data->rows = rows;
  data->compression = (double *)(data + 1);
  data->pressure = data->compression + rows;
  return data;
}

static void release(struct tabulated_data *data)
{
  free(data);
}

static gamut_status from_table(struct gamut_run *run, const struct gamut_values *values,
                               struct tabulated_data **data)
{
  size_t rows;
  const double *row = gamut_table(values, "curve", &rows);
  *data = data_new(rows);
  for (size_t i = 0; *data && i < rows; i++) {
    (*data)->compression[i] = row[2 * i];
    (*data)->pressure[i] = row[2 * i + 1];
  }
  return *data ? GAMUT_OK : gamut_fail(run, GAMUT_INTERNAL, "out of memory");
}

static gamut_status from_pairs(struct gamut_run *run, const struct gamut_values *values,
                               struct tabulated_data **data)
{
  size_t size, rows = 0;
  const char *line = gamut_file(values, "pairs", &size);
  *data = data_new(size / 4 + 1); /* a row has four characters at least */
  if (!*data)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  for (; *line; line += strcspn(line, "\n"), line += *line == '\n', rows++) {
    char *middle, *end;
    const double compression = strtod(line, &middle), pressure = strtod(middle, &end);
    if (middle == line || end == middle || (*end != '\n' && *end != 0))
      return gamut_fail_in_file(run, values, "pairs", rows + 1, "such as '0.05 1.2e10'",
                                "no pair of numbers");
    (*data)->compression[rows] = compression;
    (*data)->pressure[rows] = pressure;
  }
  (*data)->rows = rows;
  return rows >= 3 ? GAMUT_OK
                   : gamut_fail_in_file(run, values, "pairs", rows, "at least 3 rows",
                                        "the curve ends after %zu", rows);
}

/* Rising compressions, and the pressures made as stiff as the scene says. */
static gamut_status finish(struct gamut_run *run, const struct gamut_values *values,
                           struct tabulated_data *data)
{
  static const char expected[] = "a compression above that of the row before, and above -1";
  const double stiffness = gamut_real(values, "stiffness");
  for (size_t i = 0; i < data->rows; i++) {
    char row[32];
    const double least = i ? data->compression[i - 1] : -1.0;
    data->pressure[i] *= stiffness;
    if (data->compression[i] > least)
      continue;
    snprintf(row, sizeof row, "curve.%zu", i);
    return gamut_given(values, "pairs")
               ? gamut_fail_in_file(run, values, "pairs", i + 1, expected, "the curve turns back")
               : gamut_fail_at(run, values, row, expected, "the curve turns back");
  }
  return GAMUT_OK;
}

static gamut_status prepare(struct gamut_run *run, const struct gamut_values *values,
                            struct tabulated_data **out)
{
  struct tabulated_data *data = NULL;
  gamut_status status = gamut_given(values, "pairs") ? from_pairs(run, values, &data)
                                                     : from_table(run, values, &data);
  if (status == GAMUT_OK)
    status = finish(run, values, data);
  if (status == GAMUT_OK)
    *out = data;
  else
    release(data);
  return status;
}

/* The last row whose compression is not above mu, but the first or the last but one at most. */
static size_t row_below(const struct tabulated_data *data, double mu)
{
  size_t low = 0, high = data->rows - 1;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    *(data->compression[middle] <= mu ? &low : &high) = middle;
  }
  return low;
}

static void pressure(const struct tabulated *b)
{
  const struct tabulated_data *data = b->data;
  for (size_t i = 0; i < b->count; i++) {
    const double mu = b->compression[i], ratio = 1.0 + mu, gamma0 = b->gamma0[i];
    const size_t k = row_below(data, mu);
    const double slope = (data->pressure[k + 1] - data->pressure[k]) /
                         (data->compression[k + 1] - data->compression[k]);
    const double p =
        data->pressure[k] + slope * (mu - data->compression[k]) + gamma0 * b->energy[i];
    const double square = slope + p * gamma0 / (ratio * ratio);
    b->pressure[i] = p;
    b->pressure_slope_compression[i] = slope;
    b->pressure_slope_energy[i] = gamma0;
    b->sound_speed[i] = sqrt((square > 0.0 ? square : 0.0) / b->reference_density[i]);
    GAMUT_FLAG(b, i, !(square > 0.0), TABULATED_SOFT);
    GAMUT_FLAG(b, i, mu < data->compression[0] || mu > data->compression[data->rows - 1],
               TABULATED_OUTSIDE);
  }
}

GAMUT_EOS(tabulated, .pressure = pressure, .prepare = prepare, .release = release)
