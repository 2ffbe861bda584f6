#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sweep.gamut.h"

/* One run a level; its values are the study's to show. */
struct state {
  uint64_t parameters, asked, wanted;
};

static gamut_status create(struct gamut_run *run, const struct gamut_values *values,
                           const struct gamut_study_shape *shape, void **self)
{
  struct state *s = calloc(1, sizeof *s);
  (void)values; /* the study makes the levels of them */
  if (!s)
    return gamut_fail(run, GAMUT_INTERNAL, "out of memory");
  s->parameters = shape->parameters;
  s->wanted = shape->levels ? shape->levels : 1;
  *self = s;
  return GAMUT_OK;
}

static void destroy(void *self)
{
  free(self);
}

static gamut_status ask(void *self, struct gamut_batch *batch)
{
  struct state *s = self;
  uint64_t rows = s->wanted - s->asked;
  batch->rows = rows < batch->capacity ? (size_t)rows : batch->capacity;
  for (size_t r = 0; r < batch->rows; r++, s->asked++) {
    batch->level[r] = (int)s->asked;
    for (size_t k = 0; k < s->parameters; k++)
      batch->sample[r * s->parameters + k] = NAN;
  }
  return GAMUT_OK;
}

static gamut_status tell(void *self, const struct gamut_batch *batch)
{
  (void)self, (void)batch;
  return GAMUT_OK;
}

static size_t save(const void *self, void *bytes)
{
  if (bytes)
    memcpy(bytes, self, sizeof(struct state));
  return sizeof(struct state);
}

static gamut_status restore(void *self, const void *bytes, size_t size)
{
  if (size != sizeof(struct state))
    return GAMUT_OUTPUT;
  memcpy(self, bytes, size);
  return GAMUT_OK;
}

GAMUT_ESTIMATOR(sweep, .create = create, .destroy = destroy, .ask = ask, .tell = tell, .save = save,
                .restore = restore)
