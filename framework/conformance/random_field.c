/* random_field: moments over realisations, and the same point the same value in any company. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/stub_host.h"
#include "random/stream.h"

enum { POINTS = 64, REALISATIONS = 4000 };

struct field_operations {
  size_t size;
  GAMUT_RANDOM_FIELD_OPS(void)
};

struct places {
  double x[3][POINTS];
  int64_t id[POINTS];
};

static void places_fill(struct proof *proof, struct places *places)
{
  for (size_t i = 0; i < POINTS; i++) {
    places->id[i] = (int64_t)(1000 + 7 * i);
    for (int k = 0; k < 3; k++)
      places->x[k][i] = draw(proof) * 0.1;
  }
}

static gamut_status sample(const struct field_operations *ops, const void *self,
                           uint64_t realisation, const struct places *places, size_t from,
                           size_t count, double *value)
{
  const struct gamut_stream stream = stream_make(1, realisation, "conformance");
  const double *const position[3] = {places->x[0] + from, places->x[1] + from, places->x[2] + from};
  return ops->sample(self, &stream, count, position, places->id + from, value);
}

static void prove_company(struct proof *proof, const struct field_operations *ops, const void *self,
                          const struct places *places)
{
  double whole[POINTS], part[POINTS];
  size_t different = 0;
  check_begin(&proof->checks, "the same points in other company");
  gamut_status status = sample(ops, self, 3, places, 0, POINTS, whole);
  for (size_t from = 0; status == GAMUT_OK && from + 5 <= POINTS; from += 3) {
    status = sample(ops, self, 3, places, from, 5, part);
    different += memcmp(part, whole + from, 5 * sizeof *part) != 0;
  }
  check_figure(&proof->checks, status == GAMUT_OK ? (double)different : NAN, 0,
               "groups of points with other bits in other company");
  status = sample(ops, self, 4, places, 0, POINTS, part);
  check_that(&proof->checks, status == GAMUT_OK && memcmp(part, whole, sizeof whole) != 0,
             "another realisation has other values");
}

static void prove_moments(struct proof *proof, const struct field_operations *ops, const void *self,
                          const struct places *places)
{
  static double value[POINTS], sum[POINTS], squares[POINTS];
  gamut_status status = GAMUT_OK;
  double mean = 0, variance = 0;
  check_begin(&proof->checks, "moments");
  memset(sum, 0, sizeof sum);
  memset(squares, 0, sizeof squares);
  for (uint64_t r = 0; status == GAMUT_OK && r < REALISATIONS; r++) {
    status = sample(ops, self, r, places, 0, POINTS, value);
    for (size_t i = 0; i < POINTS; i++) {
      sum[i] += value[i];
      squares[i] += value[i] * value[i];
    }
  }
  for (size_t i = 0; i < POINTS; i++) {
    double m = sum[i] / REALISATIONS;
    mean = fmax(mean, fabs(m));
    variance = fmax(variance, fabs(squares[i] / REALISATIONS - m * m - 1));
  }
  if (status != GAMUT_OK)
    mean = variance = NAN;
  /* Five standard errors: one of 64 points passes that by chance once in 30000 suites. */
  check_figure(&proof->checks, mean, 5 / sqrt(REALISATIONS), "mean at a point over %d realisations",
               REALISATIONS);
  check_figure(&proof->checks, variance, 5 * sqrt(2.0 / REALISATIONS),
               "variance at a point over %d realisations, off 1", REALISATIONS);
}

void prove_random_field(struct proof *proof)
{
  struct bare_run run;
  struct places places;
  void *self = NULL;
  check_begin(&proof->checks, "making the field");
  if (bare_run_new(&run, proof)) {
    const struct field_operations *ops = run.ops;
    places_fill(proof, &places);
    bool made = ops->create && ops->destroy && ops->sample &&
                ops->create(bare_run_handle(&run), run.specimen.values, &self) == GAMUT_OK;
    if (check_that(&proof->checks, made, "the field can be made")) {
      prove_company(proof, ops, self, &places);
      prove_moments(proof, ops, self, &places);
      ops->destroy(self);
    }
    bare_run_say(&run, &proof->checks);
  }
  bare_run_free(&run);
}
