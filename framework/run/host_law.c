/* Laws of a solver's own: kernels of a body's material with arrays that the solver fills. */
#include <stdlib.h>
#include <string.h>

#include "run/host.h"

struct gamut_law {
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
  const struct instance *instance =
      strcmp(kind, "strength") == 0 ? &material->strength : &material->eos;
  struct gamut_law *law = calloc(1, sizeof *law);
  *out = NULL;
  if (!law)
    return trace_fail(run->trace, GAMUT_INTERNAL, "out of memory");
  law->next = run->law;
  run->law = law;
  if (!instance->descriptor)
    return trace_fail(run->trace, GAMUT_SCENE, "%s needs the %s of material '%s', which has none",
                      run->scene->solver.descriptor->id, kind, material->name);
  TRY(kernel_new(instance, run->registry, run->arena, GAMUT_LANES, material->extra,
                 material->density, run->trace, &law->kernel));
  TRY(bench_new(law->kernel, NULL, NULL, count, run->trace, &law->bench));
  double *temperature = bench_array(law->bench, "temperature");
  for (size_t i = 0; temperature && i < count; i++)
    temperature[i] = body->temperature;
  *out = law;
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
  const struct descriptor *d = kernel_descriptor(law->kernel);
  size_t index = (size_t)(word % 256);
  return word > 0 && index < d->messages ? d->message[index].text : "";
}
