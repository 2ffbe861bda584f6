
#include "@NAME@.gamut.h"

struct state {
  struct gamut_run *run;
  struct gamut_field position, velocity, mass;
  struct gamut_set **set;
  double longest, *kinetic;
};

static gamut_status move(void *self, const struct gamut_chunk *chunk)
{
  const struct state *s = self;
  double step = gamut_time_step(s->run);
  for (unsigned k = 0; k < 3; k++) {
    const double *x = gamut_begin(chunk, s->position, k), *v = gamut_begin(chunk, s->velocity, k);
    double *end = gamut_end(chunk, s->position, k);
    GAMUT_EACH (i, chunk)
      end[i] = x[i] + step * v[i];
  }
  return GAMUT_OK;
}

static void destroy(void *self)
{
  struct state *s = self;
  if (!s)
    return;
  gamut_release(s->run, s->set);
  gamut_release(s->run, s);
}

static gamut_status make(struct state *s, const struct gamut_values *values)
{
  static const struct gamut_use uses[] = {{"position", GAMUT_READ_BEGIN},
                                          {"position", GAMUT_WRITE},
                                          {"velocity", GAMUT_READ_BEGIN},
                                          {"mass", GAMUT_READ_BEGIN}};
  const struct gamut_task task = {.name = "move", .phase = "move", .extent = GAMUT_PER_CHUNK,
                                  .uses = uses, .use_count = 4, .essential = true, .run = move,
                                  .self = s};
  gamut_status status = gamut_field_named(s->run, "position", &s->position);
  if (status == GAMUT_OK)
    status = gamut_field_named(s->run, "velocity", &s->velocity);
  if (status == GAMUT_OK)
    status = gamut_field_named(s->run, "mass", &s->mass);
  for (size_t i = 0; status == GAMUT_OK && i < gamut_bodies(s->run); i++)
    status = gamut_points(s->run, gamut_body_at(s->run, i), 1, &s->set[i]);
  if (status == GAMUT_OK)
    status = gamut_add_task(s->run, &task);
  if (status == GAMUT_OK)
    status =
        GAMUT_HOST(s->run)->ledger(s->run, "energy", "kinetic", "J", GAMUT_STORED, &s->kinetic);
  s->longest = gamut_real(values, "step");
  return status;
}

static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  struct state *s = gamut_allocate(run, "@NAME@", sizeof *s);
  if (!s)
    return GAMUT_INTERNAL;
  s->run = run;
  s->set = gamut_allocate(run, "@NAME@", gamut_bodies(run) * sizeof(struct gamut_set *));
  gamut_status status = s->set ? make(s, values) : GAMUT_INTERNAL;
  if (status == GAMUT_OK)
    *self = s;
  else
    destroy(s);
  return status;
}

static double *array(const struct state *s, size_t body, struct gamut_field field, unsigned k)
{
  return GAMUT_HOST(s->run)->stored(s->set[body], field, k);
}

/* One point a body, at the middle of its box; the other slots of its block are padding. */
static gamut_status start_body(struct state *s, size_t index)
{
  const struct gamut_host *host = GAMUT_HOST(s->run);
  const struct gamut_body *body = gamut_body_at(s->run, index);
  const size_t first[2] = {0, GAMUT_LANES};
  uint32_t source[GAMUT_LANES] = {0};
  double lower[3], upper[3], x[3], v[3], volume = 1;
  if (!host->body_bounds(body, lower, upper))
    return gamut_fail(s->run, GAMUT_SCENE, "body %s has no shape", host->body_name(body));
  for (int k = 0; k < 3; k++) {
    bool bounded = isfinite(lower[k]) && isfinite(upper[k]);
    x[k] = bounded ? 0.5 * (lower[k] + upper[k]) : 0;
    volume *= bounded ? upper[k] - lower[k] : 1;
  }
  host->body_velocity(body, x, v);
  for (unsigned k = 0; k < 3; k++) {
    array(s, index, s->position, k)[0] = x[k];
    array(s, index, s->velocity, k)[0] = v[k];
  }
  array(s, index, s->mass, 0)[0] = volume * host->body_density(s->run, body);
  for (uint32_t i = 1; i < GAMUT_LANES; i++)
    source[i] = UINT32_C(1) << 31;
  return host->arrange(s->run, s->set[index], source, GAMUT_LANES, first, 1);
}

static gamut_status after(void *self)
{
  struct state *s = self;
  double sum = 0;
  for (size_t i = 0; i < gamut_bodies(s->run); i++)
    for (unsigned k = 0; k < 3; k++) {
      double v = array(s, i, s->velocity, k)[0];
      sum += 0.5 * array(s, i, s->mass, 0)[0] * v * v;
    }
  *s->kinetic = sum;
  return GAMUT_OK;
}

static gamut_status start(void *self)
{
  struct state *s = self;
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; status == GAMUT_OK && i < gamut_bodies(s->run); i++)
    status = start_body(s, i);
  return status == GAMUT_OK ? after(s) : status;
}

static gamut_status next(void *self, double *step)
{
  const struct state *s = self;
  *step = *step < s->longest ? *step : s->longest;
  return GAMUT_OK;
}

static gamut_status measure(void *self, const char *name, const struct gamut_body *body,
                            const struct gamut_values *arguments, double *value)
{
  const struct state *s = self;
  (void)body;
  (void)arguments;
  switch (@NAME@_measure_of(name)) {
  case @UPPER@_MEASURE_MEAN_POSITION_X:
    *value = 0;
    for (size_t i = 0; i < gamut_bodies(s->run); i++)
      *value += array(s, i, s->position, 0)[0] / (double)gamut_bodies(s->run);
    return GAMUT_OK;
  }
  return GAMUT_PLUGIN; /* declared, and unknown here: the core names it */
}

GAMUT_SOLVER(@NAME@, .create = create, .destroy = destroy, .start = start, .next = next,
             .after = after, .measure = measure)
