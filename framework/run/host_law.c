/* Laws of a solver's own: kernels of a body's material with arrays that the solver fills. */
#include <stdlib.h>
#include <string.h>

#include "material/law.h"
#include "run/host.h"

struct gamut_law {
  const struct instance *instance;
  const struct values *extra;
  size_t count;
  bool placed; /* random fields of its parameters have been drawn */
  struct kernel *kernel;
  struct bench *bench;
  struct gamut_law *next;
};

void host_laws_free(struct gamut_run *run)
{
  while (run->law) {
    struct gamut_law *law = run->law;
    run->law = law->next;
    bench_free(law->bench);
    kernel_free(law->kernel);
    free(law);
  }
}

gamut_status host_law(struct gamut_run *run, const struct gamut_body *body, const char *kind,
                      size_t count, struct gamut_law **out)
{
  gamut_status status;
  const struct material *material = &run->scene->material[body->material];
  const struct instance *instance = strcmp(kind, "strength") == 0 ? &material->strength
                                    : strcmp(kind, "eos") == 0    ? &material->eos
                                                                  : NULL;
  *out = NULL;
  if (!instance)
    return trace_fail(run->trace, GAMUT_PLUGIN, "%s asks for a law of the kind '%s'",
                      run->scene->solver.descriptor->id, kind);
  struct gamut_law *law = calloc(1, sizeof *law);
  if (!law)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  law->instance = instance;
  law->extra = material->extra;
  law->count = count;
  law->next = run->law;
  run->law = law;
  if (!instance->descriptor)
    return trace_fail_at(run->trace, GAMUT_SCENE, material->node ? &material->node->place : NULL,
                         kind, NULL, "%s needs the %s of material '%s', which has none",
                         run->scene->solver.descriptor->id, kind, material->name);
  if (instance == &material->strength)
    TRY(strength_fits(material, run->scene->solver.descriptor, run->trace));
  TRY(kernel_new(instance, run->registry, run->arena, GAMUT_LANES, material->extra,
                 material->density, run, run->trace, &law->kernel));
  TRY(kernel_try(law->kernel, run->trace));
  TRY(bench_new(law->kernel, NULL, NULL, count, run->trace, &law->bench));
  double *temperature = bench_array(law->bench, "temperature");
  for (size_t i = 0; temperature && i < count; i++)
    temperature[i] = body->temperature;
  *out = law;
done:
  return status;
}

/* Draws the parameters that differ from point to point and writes them to the law's arrays. */
static gamut_status place_values(struct gamut_run *run, struct gamut_law *law,
                                 const struct values *values, const struct descriptor *descriptor,
                                 const double *const position[3], const int64_t *id)
{
  gamut_status status = GAMUT_OK;
  struct pointwise *points = pointwise_new(values, descriptor);
  if (!points)
    return GAMUT_OK;
  double **number = calloc(values->count, sizeof(*number));
  bool good = number != NULL;
  for (size_t k = 0; good && k < values->count; k++)
    if (pointwise_varies(points, k))
      good = (number[k] = calloc(law->count + 1, sizeof(double))) != NULL;
  if (good)
    status = random_draw(run, points, values, law->count, position, id, number);
  else
    status = trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t k = 0; number && k < values->count; k++) {
    double *array = number[k] ? bench_array(law->bench, values->value[k].parameter->name) : NULL;
    if (array && status == GAMUT_OK)
      memcpy(array, number[k], law->count * sizeof *array);
    free(number[k]);
  }
  free(number);
  pointwise_free(points);
  return status;
}

gamut_status host_law_places(struct gamut_run *run, struct gamut_law *law,
                             const double *const position[3], const int64_t *id)
{
  gamut_status status;
  TRY(place_values(run, law, law->instance->values, law->instance->descriptor, position, id));
  TRY(place_values(run, law, law->extra, NULL, position, id));
  law->placed = true;
done:
  return status;
}

/* A field that the solver does not ask for would be left out in silence. */
static gamut_status check_placed(struct gamut_run *run, const struct values *values,
                                 const struct descriptor *descriptor)
{
  struct pointwise *points = pointwise_new(values, descriptor);
  size_t first = 0;
  while (points && !values->value[first].model)
    first++;
  pointwise_free(points);
  if (!points)
    return GAMUT_OK;
  const struct value *value = &values->value[first];
  return trace_fail_at(run->trace, GAMUT_SCENE, value->node ? &value->node->place : NULL,
                       values->path, "leave 'field' out: then it is one random number",
                       "%s does not let '%s' vary in space", run->scene->solver.descriptor->id,
                       value->parameter->name);
}

gamut_status host_laws_check(struct gamut_run *run)
{
  gamut_status status = GAMUT_OK;
  for (const struct gamut_law *law = run->law; law; law = law->next) {
    if (law->placed)
      continue;
    TRY(check_placed(run, law->instance->values, law->instance->descriptor));
    TRY(check_placed(run, law->extra, NULL));
  }
done:
  return status;
}

double *host_law_array(struct gamut_law *law, const char *name)
{
  return bench_array(law->bench, name);
}

/* As status_severity has it: the word's upper part. */
static int64_t worst_of(const int64_t *word, size_t count)
{
  int64_t worst = 0;
  for (size_t i = 0; i < count; i++)
    worst = word[i] > worst ? word[i] : worst;
  return worst;
}

bool host_law_call(struct gamut_law *law, const char *operation, size_t count, int64_t *worst)
{
  enum gamut_kind kind = kernel_descriptor(law->kernel)->kind;
  kernel_function function = NULL;
  const char *name;
  for (size_t i = 0; !function && (name = kind_operation(kind, i)); i++)
    if (strcmp(name, operation) == 0)
      function = kernel_operation(law->kernel, i);
  if (!function)
    return false;
  bench_call(law->bench, function, count);
  if (worst)
    *worst = worst_of(bench_status(law->bench), count);
  return true;
}

const char *host_law_message(const struct gamut_law *law, int64_t word)
{
  const struct message *message = status_message(kernel_descriptor(law->kernel), word);
  return message ? message->text : "";
}
