/* What a study would cost: the runs that its estimator asks for, each as the forecast of one. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "random/distribution_types.h"
#include "registry/guard.h"
#include "study/study_private.h"

enum { RUNS_COUNTED = 1 << 20 };

/* Given nothing but failures, an estimator asks for what it would at least. */
static gamut_status count_runs(struct study *study, struct study_forecast *f)
{
  gamut_status status;
  struct gamut_batch *batch = &study->batch;
  const char *name = study->scene->estimator.descriptor->id;
  for (size_t i = 0; i < batch->capacity * study->results; i++)
    study->batch_result[i] = NAN;
  f->more = study->scene->estimator.descriptor->adaptive;
  do {
    TRY(estimator_ask(study));
    if (batch->rows > 0)
      TRY(GUARDED(name, study->ops->tell(study->self, batch)));
    f->runs += batch->rows;
    f->more = f->more || f->runs >= RUNS_COUNTED;
  } while (batch->rows > 0 && f->runs < RUNS_COUNTED);
done:
  return status;
}

/* Common steps are shorter than those of the run that was forecast. */
static double slower(const struct study *study, const struct gamut_run *run)
{
  const double margin = study->scene->step_margin;
  return !study->table && margin >= 0 && !run_steps_fixed(run) ? 1 / (1 - margin) : 1;
}

gamut_status study_forecast(struct study *study, const struct gamut_run *run,
                            const struct run_forecast *one, struct study_forecast *f)
{
  gamut_status status;
  *f = (struct study_forecast){.threads = study->threads, .nominal = !study->table};
  TRY(measured_plan(study, run));
  TRY(estimator_new(study));
  TRY(count_runs(study, f));
  const double runs = (double)f->runs;
  if (runs < f->threads)
    f->threads = f->runs > 0 ? (int)f->runs : 1;
  if (one->known)
    f->seconds = one->seconds * (ceil(runs / f->threads) * slower(study, run) + f->nominal);
  f->bytes = (double)one->bytes * f->threads +
             runs * (double)(study->results + study->parameters) * sizeof(double);
done:
  return status;
}

void study_explain(const struct study *study, const struct study_forecast *f, FILE *file)
{
  fprintf(file, "\nstudy %s: %s%zu runs%s, %d side by side",
          study->scene->estimator.descriptor->name, f->more ? "at least " : "", f->runs,
          f->nominal ? " and the run at the means" : "", f->threads);
  if (f->seconds > 0)
    fprintf(file, ": about %.3g s", f->seconds);
  fprintf(file, ", %.3g MB\n", f->bytes / 1e6);
  for (size_t i = 0; i < study->parameters; i++) {
    const struct random_parameter *random = &study->scene->random_parameter[i];
    const char *unit = random->parameter->unit ? random->parameter->unit : "1";
    fprintf(file, "    %s: %s, mean %.6g %s, standard deviation %.6g %s%s\n", random->path,
            random->distribution->type->name, random->distribution->mean, unit,
            random->distribution->deviation, unit,
            random->distribution->truncated ? ", before it is truncated" : "");
  }
}

static json_t *parameter_json(const struct random_parameter *random)
{
  const struct distribution *d = random->distribution;
  return json_pack("{s:s, s:s, s:s, s:f, s:f, s:b}", "path", random->path, "distribution",
                   d->type->name, "unit", random->parameter->unit ? random->parameter->unit : "1",
                   "mean", d->mean, "sd", d->deviation, "truncated", (int)d->truncated);
}

char *study_explain_json(const struct study *study, const struct study_forecast *f, const char *run)
{
  json_t *root = json_loads(run, 0, NULL), *entry = json_object(), *all = json_array();
  for (size_t i = 0; i < study->parameters; i++)
    json_array_append_new(all, parameter_json(&study->scene->random_parameter[i]));
  json_object_set_new(entry, "estimator", json_string(study->scene->estimator.descriptor->name));
  json_object_set_new(entry, "runs", json_integer((json_int_t)f->runs));
  json_object_set_new(entry, "at_least", json_boolean(f->more));
  json_object_set_new(entry, "nominal", json_boolean(f->nominal));
  json_object_set_new(entry, "threads", json_integer(f->threads));
  json_object_set_new(entry, "seconds", f->seconds > 0 ? json_real(f->seconds) : json_null());
  json_object_set_new(entry, "bytes", json_real(f->bytes));
  json_object_set_new(entry, "parameters", all);
  json_object_set_new(root, "study", entry);
  char *text = json_dumps(root, JSON_INDENT(1));
  json_decref(root);
  return text;
}
