/* Random numbers of a run: streams, random fields, parameters that differ from point to point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "random/stream.h"
#include "registry/guard.h"
#include "run/host.h"

struct field_operations {
  size_t size;
  GAMUT_RANDOM_FIELD_OPS(void)
};

/* A random field that the scene names, made when it is first asked for. */
struct sampled_field {
  const struct value *value;
  char path[256]; /* what it is for, for people */
  const struct field_operations *ops;
  void *self;
  struct sampled_field *next;
};

struct gamut_stream host_stream(const struct gamut_run *run, const char *name)
{
  return stream_make(run->options.seed ? run->options.seed : run->scene->seed,
                     run->options.realisation, name);
}

uint64_t host_realisation(const struct gamut_run *run)
{
  return run->options.realisation;
}

bool host_domain(const struct gamut_run *run, double lower[3], double upper[3])
{
  const struct geometry *geometry = values_geometry(run->scene->solver.values);
  const int axes = geometry ? (int)geometry->axes : 3;
  bool any = false;
  for (int k = 0; k < 3; k++)
    lower[k] = upper[k] = 0.0;
  for (size_t b = 0; b < run->scene->bodies; b++) {
    double low[3], high[3];
    if (!run_host.body_bounds(&run->scene->body[b], low, high))
      continue;
    if (geometry && geometry->axisymmetric)
      low[0] = fmax(low[0], 0.0);
    for (int k = 0; k < axes; k++) {
      bool finite = isfinite(low[k]) && isfinite(high[k]);
      lower[k] = !finite ? lower[k] : any ? fmin(lower[k], low[k]) : low[k];
      upper[k] = !finite ? upper[k] : any ? fmax(upper[k], high[k]) : high[k];
    }
    any = true;
  }
  return any;
}

static gamut_status make_field(struct gamut_run *run, const struct value *value,
                               struct sampled_field **out)
{
  gamut_status status;
  const struct gamut_plugin *plugin;
  struct sampled_field *field = calloc(1, sizeof *field);
  if (!field)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  TRY(registry_open(run->registry, value->model, run->trace, &plugin));
  field->value = value;
  field->ops = plugin->ops;
  if (!field->ops->create || !field->ops->destroy || !field->ops->sample) {
    status = trace_fail(run->trace, GAMUT_PLUGIN,
                        "%s lacks one of the operations create, destroy, sample", value->model->id);
    goto done;
  }
  TRY(GUARDED(value->model->id, field->ops->create(run, value->group, &field->self)));
  tree_path(value->node, field->path, sizeof field->path);
  field->next = run->sampled_field;
  run->sampled_field = field;
  *out = field;
done:
  if (status != GAMUT_OK)
    free(field);
  return status;
}

bool random_field_at(const struct gamut_run *run, size_t index, const char **path,
                     const char **plugin)
{
  const struct sampled_field *field = run->sampled_field;
  while (field && index-- > 0)
    field = field->next;
  if (!field)
    return false;
  *path = field->path;
  *plugin = field->value->model->id;
  return true;
}

static gamut_status find_field(struct gamut_run *run, const struct value *value,
                               struct sampled_field **out)
{
  for (struct sampled_field *field = run->sampled_field; field; field = field->next)
    if (field->value == value) {
      *out = field;
      return GAMUT_OK;
    }
  return make_field(run, value, out);
}

void random_free(struct gamut_run *run)
{
  while (run->sampled_field) {
    struct sampled_field *field = run->sampled_field;
    run->sampled_field = field->next;
    field->ops->destroy(field->self);
    free(field);
  }
}

/* Opens the plugins of all random fields below, so that later runs of a study only look them up. */
static gamut_status open_fields(struct gamut_run *run, const struct values *values)
{
  gamut_status status = GAMUT_OK;
  const struct gamut_plugin *plugin;
  for (size_t i = 0; values && i < values->count; i++) {
    if (values->value[i].model)
      TRY(registry_open(run->registry, values->value[i].model, run->trace, &plugin));
    TRY(open_fields(run, values->value[i].group));
  }
done:
  return status;
}

gamut_status random_open(struct gamut_run *run)
{
  gamut_status status;
  const struct scene *scene = run->scene;
  TRY(open_fields(run, scene->solver.values));
  for (size_t m = 0; m < scene->materials; m++) {
    TRY(open_fields(run, scene->material[m].eos.values));
    TRY(open_fields(run, scene->material[m].strength.values));
    TRY(open_fields(run, scene->material[m].elasticity.values));
    TRY(open_fields(run, scene->material[m].extra));
  }
  for (size_t e = 0; e < scene->effects; e++)
    TRY(open_fields(run, scene->effect[e].instance.values));
done:
  return status;
}

static gamut_status sample_field(struct gamut_run *run, const struct value *value, const char *name,
                                 size_t count, const double *const position[3], const int64_t *id,
                                 double *sampled)
{
  gamut_status status;
  struct sampled_field *field = NULL;
  const struct gamut_stream stream = host_stream(run, name);
  TRY(find_field(run, value, &field));
  run->sampling = value;
  status = GUARDED(value->model->id,
                   field->ops->sample(field->self, &stream, count, position, id, sampled));
  run->sampling = NULL;
  TRY(status);
  for (size_t i = 0; i < count; i++)
    if (!isfinite(sampled[i])) {
      status =
          trace_fail(run->trace, GAMUT_NUMERICS, "%s gave no finite value of '%s' at point %lld",
                     value->model->id, name, (long long)id[i]);
      goto done;
    }
done:
  return status;
}

gamut_status host_sample(struct gamut_run *run, const struct gamut_values *values, const char *path,
                         const char *name, size_t count, const double *const position[3],
                         const int64_t *id, double *value, bool *given)
{
  const struct value *field = values_find(values, path);
  *given = field && field->present && field->model;
  return *given ? sample_field(run, field, name, count, position, id, value) : GAMUT_OK;
}

/* Numbers of a field become values of the parameter: its distribution is kept. */
static void translate(const struct sampled_field *field, const struct distribution *d, size_t count,
                      double *number)
{
  bool other = offsetof(struct field_operations, below) < field->ops->size && field->ops->below;
  const double most = 1.0 - 0x1p-53;
  for (size_t i = 0; i < count; i++) {
    double u = other ? field->ops->below(field->self, number[i]) : NAN;
    number[i] = isnan(u) ? distribution_of_normal(d, number[i])
                         : distribution_quantile(d, fmin(fmax(u, 1.0 - most), most));
  }
}

static gamut_status draw_one(struct gamut_run *run, const struct values *values, size_t index,
                             size_t count, const double *const position[3], const int64_t *id,
                             double *number)
{
  gamut_status status;
  char name[512];
  struct sampled_field *field;
  const struct value *value = &values->value[index];
  snprintf(name, sizeof name, "%s.%s", values->path, value->parameter->name);
  TRY(sample_field(run, value, name, count, position, id, number));
  TRY(find_field(run, value, &field));
  translate(field, value->random, count, number);
done:
  return status;
}

static gamut_status work_out(struct gamut_run *run, const struct pointwise *points,
                             const struct values *values, size_t count,
                             const double *const position[3], const int64_t *id,
                             double *const *number)
{
  gamut_status status = GAMUT_OK;
  char why[256], where[512];
  double *row = calloc(values->count, sizeof *row);
  if (!row)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t k = 0; k < values->count; k++)
    row[k] = values->value[k].present ? values->value[k].real : 0.0;
  for (size_t i = 0; i < count; i++) {
    size_t wrong;
    for (size_t k = 0; k < values->count; k++)
      if (number[k])
        row[k] = number[k][i];
    if (!pointwise_work_out(points, row, &wrong, why, sizeof why)) {
      const struct tree *node = values->value[wrong].node;
      snprintf(where, sizeof where, "%s.%s", values->path, values->value[wrong].parameter->name);
      status = trace_fail_at(run->trace, GAMUT_SCENE, node ? &node->place : NULL, where,
                             "a smaller spread, or truncate: [lower, upper] that keeps to it",
                             "at point %lld (%.6g, %.6g, %.6g) m: %s", (long long)id[i],
                             position[0][i], position[1][i], position[2][i], why);
      goto done;
    }
    for (size_t k = 0; k < values->count; k++)
      if (number[k])
        number[k][i] = row[k];
  }
done:
  free(row);
  return status;
}

gamut_status random_draw(struct gamut_run *run, const struct pointwise *points,
                         const struct values *values, size_t count, const double *const position[3],
                         const int64_t *id, double *const *number)
{
  gamut_status status = GAMUT_OK;
  for (size_t k = 0; k < values->count; k++)
    if (number[k] && values->value[k].model)
      TRY(draw_one(run, values, k, count, position, id, number[k]));
  TRY(work_out(run, points, values, count, position, id, number));
done:
  return status;
}

/* The real points of a set, in the order of its slots. */
struct crowd {
  size_t count;
  size_t *slot;
  int64_t *id;
  double *x[3];
};

static void crowd_free(struct crowd *crowd)
{
  free(crowd->slot);
  free(crowd->id);
  for (int k = 0; k < 3; k++)
    free(crowd->x[k]);
}

static bool crowd_fill(struct crowd *crowd, const struct gamut_run *run,
                       const struct point_set *set)
{
  const size_t slots = set->open.slots;
  const struct field *position = fields_find(run->fields, "position");
  *crowd = (struct crowd){.slot = calloc(slots + 1, sizeof *crowd->slot),
                          .id = calloc(slots + 1, sizeof *crowd->id)};
  bool good = crowd->slot && crowd->id;
  for (int k = 0; k < 3; k++)
    good = (crowd->x[k] = calloc(slots + 1, sizeof(double))) != NULL && good;
  for (size_t s = 0; good && s < slots; s++) {
    if (set->id[s] < 0)
      continue;
    crowd->slot[crowd->count] = s;
    crowd->id[crowd->count] = set->id[s];
    for (unsigned k = 0; position && k < position->handle.components && k < 3; k++) {
      const double *x = set_stored(set, position->handle, k);
      crowd->x[k][crowd->count] = x ? x[s] : 0.0;
    }
    crowd->count++;
  }
  return good;
}

/* Padding holds what the point before it holds. */
static void put_stored(const struct gamut_run *run, const struct point_set *set, const char *path,
                       const struct crowd *crowd, const double *number)
{
  const struct field *field = fields_find(run->fields, path);
  double *stored = field ? set_stored(set, field->handle, 0) : NULL;
  if (!stored)
    return;
  for (size_t i = 0; i < crowd->count; i++)
    stored[crowd->slot[i]] = number[i];
  for (size_t s = 1; s < set->open.slots; s++)
    if (set->id[s] < 0)
      stored[s] = stored[s - 1];
}

static gamut_status scatter(struct gamut_run *run, const struct point_set *set,
                            const struct values *values, const struct descriptor *descriptor)
{
  gamut_status status = GAMUT_OK;
  struct crowd crowd = {0};
  struct pointwise *points = pointwise_new(values, descriptor);
  if (!points)
    return GAMUT_OK;
  double **number = calloc(values->count, sizeof(*number));
  bool good = number && crowd_fill(&crowd, run, set);
  for (size_t k = 0; good && k < values->count; k++)
    if (pointwise_varies(points, k))
      good = (number[k] = calloc(crowd.count + 1, sizeof(double))) != NULL;
  if (good)
    status = random_draw(run, points, values, crowd.count, (const double *const *)crowd.x, crowd.id,
                         number);
  else
    status = trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t k = 0; number && k < values->count; k++) {
    char path[512];
    snprintf(path, sizeof path, "%s.%s", values->path, values->value[k].parameter->name);
    if (status == GAMUT_OK && number[k])
      put_stored(run, set, path, &crowd, number[k]);
    free(number[k]);
  }
  free(number);
  crowd_free(&crowd);
  pointwise_free(points);
  return status;
}

gamut_status random_scatter(struct gamut_run *run, const struct point_set *set)
{
  gamut_status status;
  const struct material *material = &run->scene->material[set->material];
  TRY(scatter(run, set, material->eos.values, material->eos.descriptor));
  TRY(scatter(run, set, material->strength.values, material->strength.descriptor));
  TRY(scatter(run, set, material->elasticity.values, material->elasticity.descriptor));
  TRY(scatter(run, set, material->extra, NULL));
  for (size_t e = 0; e < run->effects; e++) {
    const struct instance *instance = &run->effect[e].effect->instance;
    TRY(scatter(run, set, instance->values, instance->descriptor));
  }
done:
  return status;
}
