#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "random/correlation.h"
#include "random/stream.h"
#include "study/study_private.h"

/* A constraint that takes nearly all is no truncation but another study than was meant. */
enum { TRIALS = 4096, ATTEMPTS_MAX = 10000, CUTS_MAX = 64 };
static const double least_left = 0.01, least_told = 1e-6;

static double correlated(const struct study *study, const double *normal, size_t i)
{
  double sum = 0;
  if (!study->lower)
    return normal[i];
  for (size_t k = 0; k <= i; k++)
    sum += study->lower[i * study->parameters + k] * (isnan(normal[k]) ? 0 : normal[k]);
  return sum;
}

void draw_row(const struct study *study, const double *normal, double *parameter)
{
  for (size_t i = 0; i < study->parameters; i++) {
    const struct distribution *d = study->scene->random_parameter[i].distribution;
    parameter[i] =
        isnan(normal[i]) ? d->mean : distribution_of_normal(d, correlated(study, normal, i));
  }
}

/* Normal variables of one attempt; the first one's are the estimator's. */
static void attempt_normals(const struct study *study, struct gamut_stream *stream,
                            uint64_t attempt, const double *first, double *normal)
{
  for (size_t i = 0; i < study->parameters; i++)
    normal[i] =
        first && isnan(first[i]) ? NAN : stream->normal(stream, attempt * study->parameters + i);
}

/* The scene of the probe may have fewer parameters: a level has made one certain. */
static const struct random_parameter *conflict_of(struct study *study, const double *parameter,
                                                  double *room, char *conflict, size_t size)
{
  for (size_t i = 0; i < study->probe.scene->random_parameters; i++)
    room[i] = parameter[study->probe.parameter[i]];
  return scene_conflict(study->probe.scene, room, conflict, size);
}

gamut_status draw_run(struct study *study, const double *normal, struct outcome *outcome)
{
  gamut_status status = GAMUT_OK;
  char conflict[200];
  struct gamut_stream stream =
      stream_make(study->scene->seed, outcome->realisation, "uncertainty.again");
  double *room = calloc(2 * study->parameters + 1, sizeof *room);
  if (!room)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  draw_row(study, normal, outcome->parameter);
  if (!study->probe.scene)
    goto done;
  TRY(worker_take(study, &study->probe, outcome->level, study->trace));
  for (uint64_t attempt = 0; attempt < ATTEMPTS_MAX; attempt++) {
    if (!conflict_of(study, outcome->parameter, room, conflict, sizeof conflict))
      break;
    outcome->again = true;
    attempt_normals(study, &stream, attempt, normal, room);
    draw_row(study, room, outcome->parameter);
  }
done:
  free(room);
  return status;
}

/* Counts one draw against a constraint. */
static void count_cut(struct study *study, const struct random_parameter *parameter,
                      const char *conflict)
{
  for (size_t i = 0; i < study->cuts; i++)
    if (study->cut[i].parameter == parameter && strcmp(study->cut[i].constraint, conflict) == 0) {
      study->cut[i].share += 1.0 / TRIALS;
      return;
    }
  if (study->cuts == study->parameters + CUTS_MAX)
    return;
  struct cut *cut = &study->cut[study->cuts++];
  *cut = (struct cut){.parameter = parameter, .share = 1.0 / TRIALS};
  snprintf(cut->constraint, sizeof cut->constraint, "%s", conflict);
}

/* How much of what is drawn is against constraints, by trial. */
static gamut_status try_constraints(struct study *study)
{
  double *room = calloc(3 * study->parameters + 1, sizeof *room);
  char conflict[200];
  size_t left = TRIALS;
  if (!room)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  for (uint64_t trial = 0; trial < TRIALS; trial++) {
    struct gamut_stream stream = stream_make(study->scene->seed, trial, "uncertainty.trial");
    double *normal = room + study->parameters, *parameter = normal + study->parameters;
    attempt_normals(study, &stream, 0, NULL, normal);
    draw_row(study, normal, parameter);
    const struct random_parameter *mends =
        conflict_of(study, parameter, room, conflict, sizeof conflict);
    if (!mends)
      continue;
    left--;
    for (size_t i = 0; i < study->parameters; i++)
      if (strcmp(study->scene->random_parameter[i].path, mends->path) == 0)
        count_cut(study, &study->scene->random_parameter[i], conflict);
  }
  free(room);
  return (double)left >= least_left * TRIALS ? GAMUT_OK : GAMUT_SCENE;
}

static gamut_status tell_cuts(struct study *study, gamut_status status)
{
  for (size_t i = 0; i < study->cuts; i++) {
    const struct cut *cut = &study->cut[i];
    const char *path = cut->parameter->path;
    if (cut->constraint[0] && status != GAMUT_OK)
      return trace_fail_at(study->trace, GAMUT_SCENE, &cut->parameter->node->place, path,
                           "a distribution of which more than 1 % keeps to it",
                           "nothing is left to draw: %.3g %% of the draws are against '%s'",
                           100 * cut->share, cut->constraint);
    if (cut->constraint[0])
      trace_note(study->trace,
                 "about %.3g %% of the draws are against '%s' and made again (%s: truncate)",
                 100 * cut->share, cut->constraint, path);
    else
      trace_note(study->trace, "%.3g %% of the distribution of %s is cut off by 'truncate'",
                 100 * cut->share, path);
  }
  return status;
}

/* Whether a constraint may ask for another draw. */
static bool may_conflict(const struct study *study)
{
  for (size_t i = 0; i < study->parameters; i++) {
    const struct random_parameter *random = &study->scene->random_parameter[i];
    if (random->distribution->conforms && random->descriptor &&
        (random->descriptor->constraints || random->descriptor->givens))
      return true;
  }
  return false;
}

static gamut_status judge_truncation(struct study *study)
{
  gamut_status status = GAMUT_OK;
  study->cut = calloc(study->parameters + CUTS_MAX, sizeof *study->cut);
  if (!study->cut)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  for (size_t i = 0; i < study->parameters; i++) {
    const double share = distribution_cut(study->scene->random_parameter[i].distribution);
    if (share > least_told)
      study->cut[study->cuts++] =
          (struct cut){.parameter = &study->scene->random_parameter[i], .share = share};
  }
  if (may_conflict(study)) {
    TRY(worker_take(study, &study->probe, 0, study->trace));
    status = try_constraints(study);
  }
  status = tell_cuts(study, status);
done:
  return status;
}

gamut_status draw_prepare(struct study *study)
{
  const struct scene *scene = study->scene;
  size_t n = study->parameters = scene->random_parameters;
  study->table = scene->estimator.descriptor->yields_table;
  if (scene->correlation) {
    study->lower = calloc(n * n + 1, sizeof *study->lower);
    if (!study->lower || !correlation_factor(scene->correlation, n, study->lower))
      return trace_fail(study->trace, GAMUT_INTERNAL, "the correlation cannot be factored");
  }
  return study->table ? GAMUT_OK : judge_truncation(study);
}
