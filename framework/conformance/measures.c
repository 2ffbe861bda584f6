/* Measures by code: each that is declared is answered, and a name that nobody declares is refused,
 * so that no measure falls into the branch of another. */
#include <stdlib.h>
#include <string.h>

#include "conformance/scene_run.h"

static bool is_by_code(const struct measure *measure)
{
  return !measure->formula && measure->at != MEASURE_POINT;
}

/* Values that the arguments accept. */
static gamut_status make_arguments(struct proof *proof, const struct measure *measure,
                                   struct specimen *arguments, struct trace *trace)
{
  struct settings settings = {0};
  const struct descriptor list = {.id = measure->name,
                                  .kind = proof->descriptor->kind,
                                  .parameter = measure->argument,
                                  .parameters = measure->arguments};
  base_of_table(&list, measure->argument, measure->arguments, &settings);
  gamut_status status =
      specimen_values(arguments, &list, &settings, "arguments", proof->units, trace);
  settings_free(&settings);
  return status;
}

static gamut_status ask(struct proof *proof, struct gamut_run *run, const char *name,
                        const struct specimen *arguments, char **said)
{
  double value = 0;
  struct trace *trace = trace_new();
  check_begin(&proof->checks, "the measure %s", name);
  gamut_status status =
      run_measure(run, proof->descriptor, name, arguments->values, &value, trace);
  *said = trace_text(trace);
  trace_free(trace);
  return status;
}

static void prove_one(struct proof *proof, struct gamut_run *run, const char *name,
                      const struct specimen *arguments)
{
  char *said;
  gamut_status status = ask(proof, run, name, arguments, &said);
  /* It may have a reason to give no value in this scene. */
  check_that(&proof->checks, status != GAMUT_PLUGIN && status != GAMUT_INTERNAL,
             "the measure %s is known%s", name,
             status == GAMUT_OK ? "" : " (it has no value in this scene)");
  if (status != GAMUT_OK)
    check_say(&proof->checks, "%s", said ? said : "");
  free(said);
  status = ask(proof, run, "a_measure_that_nobody_declares", arguments, &said);
  check_that(&proof->checks, status == GAMUT_PLUGIN,
             "a measure that nobody declares is refused, asked for like %s%s", name,
             status == GAMUT_PLUGIN ? ""
             : status == GAMUT_OK   ? ": it was answered; return GAMUT_PLUGIN in the last `else`"
                                    : ": it was refused, but not with GAMUT_PLUGIN");
  free(said);
}

void prove_measures(struct proof *proof, struct gamut_run *run)
{
  const struct descriptor *d = proof->descriptor;
  for (size_t i = 0; i < d->measures; i++) {
    struct specimen arguments = {0};
    struct trace *trace = trace_new();
    if (!is_by_code(&d->measure[i]))
      ;
    else if (make_arguments(proof, &d->measure[i], &arguments, trace) == GAMUT_OK)
      prove_one(proof, run, d->measure[i].name, &arguments);
    else
      check_skip(&proof->checks, "its arguments cannot be guessed", "the measure %s",
                 d->measure[i].name);
    specimen_close(&arguments);
    trace_free(trace);
  }
}
