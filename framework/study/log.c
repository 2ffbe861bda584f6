/* study.log: one line a finished run, exact numbers, a sum over the line, forced to the disk.
 *
 *   gamut-study 3 DIGEST
 *   curve QUANTITY COUNT AXIS...
 *   steps LEVEL COUNT STEP...              that all runs of the level take
 *   nominal LEVEL MODE REALISATION STEPS POINTS WORK WALL CPU PARAMETERS... RESULTS... ok|failed
 *     REASON
 *   run NUMBER LEVEL MODE REALISATION ... as of the nominal run
 *
 * RESULTS ends, where runs are no sample, in COUNT AXIS... VALUE... of each of the run's own
 * curves. Each line is followed by " ~" and eight hex digits. A line that was cut off by the end of
 * the program is taken off when the study goes on. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory.h"
#include "store/file.h"
#include "study/study_private.h"

uint32_t log_sum(const char *line, size_t size)
{
  uint64_t h = hash_bytes(HASH_START, line, size);
  return (uint32_t)(h ^ h >> 32);
}

/* What is behind the text: defaults. */
static uint64_t hash_values(uint64_t h, const struct values *values)
{
  for (size_t i = 0; values && i < values->count; i++) {
    const struct value *value = &values->value[i];
    h = hash_bytes(h, &value->real, sizeof value->real);
    if (value->number)
      h = hash_bytes(h, value->number, value->numbers * sizeof *value->number);
    h = hash_values(h, value->group);
  }
  return h;
}

void log_digest(struct study *study)
{
  const struct scene *scene = study->scene;
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    memory_ended();
  tree_write(scene->tree, file);
  for (size_t i = 0; i < registry_count(study->registry); i++) {
    const struct descriptor *d = registry_at(study->registry, i);
    if (registry_is_open(study->registry, d))
      fprintf(file, "%s %s %s\n", d->id, d->version, d->digest);
  }
  memory_close(file, &text);
  uint64_t h = hash_bytes(HASH_START, text, size);
  free(text);
  h = hash_bytes(h, &scene->seed, sizeof scene->seed);
  for (size_t i = 0; i < scene->input_files; i++)
    h = hash_bytes(h, scene->input_file[i].digest, sizeof scene->input_file[i].digest);
  h = hash_values(h, scene->solver.values);
  h = hash_values(h, scene->estimator.values);
  for (size_t i = 0; i < scene->materials; i++) {
    h = hash_values(h, scene->material[i].eos.values);
    h = hash_values(h, scene->material[i].strength.values);
    h = hash_values(h, scene->material[i].elasticity.values);
  }
  for (size_t i = 0; i < scene->effects; i++)
    h = hash_values(h, scene->effect[i].instance.values);
  snprintf(study->digest, sizeof study->digest, "%016" PRIx64, h);
}

gamut_status log_there(struct study *study)
{
  struct stat open, named;
  if (study->log < 0 || (fstat(study->log, &open) == 0 && lstat(study->log_path, &named) == 0 &&
                         open.st_ino == named.st_ino && open.st_dev == named.st_dev))
    return GAMUT_OK;
  return trace_fail_at(study->trace, GAMUT_OUTPUT, NULL, NULL,
                       "leave the folder alone while a study writes there",
                       "'%s' was removed or replaced while it was written", study->log_path);
}

/* Adds the sum; takes the text and gives a longer one, or null. */
static char *with_sum(char *text, size_t size)
{
  char *whole = realloc(text, size + LOG_SUM_LENGTH + 2);
  if (whole)
    sprintf(whole + size, " ~%08" PRIx32 "\n", log_sum(whole, size));
  else
    free(text);
  return whole;
}

/* The line goes out in one piece, or the study ends: what is not in the log was not run. */
static gamut_status append(struct study *study, char *text, size_t size)
{
  gamut_status status = log_there(study);
  char *whole = with_sum(text, size);
  if (!whole)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  if (status == GAMUT_OK) {
    size += LOG_SUM_LENGTH + 1;
    ssize_t written = write(study->log, whole, size);
    int fault = written == (ssize_t)size ? file_sync(study->log) : written < 0 ? errno : 0;
    if (written != (ssize_t)size || fault) {
      log_close(study); /* nothing may follow a line that was cut off */
      status = trace_fail(study->trace, GAMUT_OUTPUT, "cannot write " RESULT_LOG ": %s",
                          fault ? strerror(fault) : "the disk took a part only");
    }
  }
  free(whole);
  return status;
}

gamut_status log_axes(struct study *study)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; study->log >= 0 && i < study->quantities; i++) {
    const struct measured *m = &study->measured[i];
    char *text = NULL;
    size_t size = 0;
    if (!m->curve)
      continue;
    FILE *file = open_memstream(&text, &size);
    if (!file)
      return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
    fprintf(file, "curve %zu %zu", i, m->count);
    for (size_t k = 0; k < m->count; k++)
      fprintf(file, " %a", m->at[k]);
    memory_close(file, &text);
    TRY(append(study, text, size));
  }
done:
  return status;
}

static void write_own(FILE *file, const struct own_curve *own)
{
  fprintf(file, " %zu", own->count);
  for (size_t k = 0; k < own->count; k++)
    fprintf(file, " %a", own->at[k]);
  for (size_t k = 0; k < own->count; k++)
    fprintf(file, " %a", own->value[k]);
}

static void write_outcome(const struct study *study, const struct outcome *o, FILE *file)
{
  fprintf(file, " %zu %d %" PRIu64 " %" PRIu64 " %" PRIu64 " %a %a %a", o->level, (int)o->mode,
          o->realisation, o->steps, o->points, o->work, o->wall, o->cpu);
  for (size_t i = 0; i < study->parameters; i++)
    fprintf(file, " %a", o->parameter[i]);
  for (size_t i = 0; i < study->results; i++)
    fprintf(file, " %a", o->result[i]);
  for (size_t i = 0; i < o->owns; i++)
    if (study->measured[i].curve)
      write_own(file, &o->own[i]);
  fprintf(file, o->reason ? " failed " : " ok");
  for (const char *c = o->reason ? o->reason : ""; *c; c++)
    fputc(*c == '\n' || *c == '\r' ? ' ' : *c, file);
}

static gamut_status log_outcome(struct study *study, const char *head, const struct outcome *o)
{
  char *text = NULL;
  size_t size = 0;
  if (study->log < 0)
    return GAMUT_OK;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  fputs(head, file);
  write_outcome(study, o, file);
  memory_close(file, &text);
  return append(study, text, size);
}

static gamut_status log_steps(struct study *study, size_t level)
{
  const struct common_steps *steps = &study->nominal[level].steps;
  char *text = NULL;
  size_t size = 0;
  if (study->log < 0 || steps->count == 0)
    return GAMUT_OK;
  FILE *file = open_memstream(&text, &size);
  if (!file)
    return trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
  fprintf(file, "steps %zu %zu", level, steps->count);
  for (size_t k = 0; k < steps->count; k++)
    fprintf(file, " %a", steps->step[k]);
  memory_close(file, &text);
  return append(study, text, size);
}

/* The steps come first: where the line of the run is, they are. */
gamut_status log_nominal(struct study *study, size_t level)
{
  const gamut_status status = log_steps(study, level);
  return status == GAMUT_OK ? log_outcome(study, "nominal", &study->nominal[level].outcome)
                            : status;
}

gamut_status log_run(struct study *study, size_t number, const struct outcome *o)
{
  char head[40];
  snprintf(head, sizeof head, "run %zu", number);
  return log_outcome(study, head, o);
}

static gamut_status open_file(struct study *study)
{
  study->log = open(study->log_path, O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  return study->log >= 0 ? GAMUT_OK
                         : trace_fail(study->trace, GAMUT_OUTPUT, "cannot open '%s': %s",
                                      study->log_path, strerror(errno));
}

static gamut_status find_path(struct study *study, const char *folder)
{
  free(study->log_path);
  study->log_path = file_path(folder, RESULT_LOG);
  return study->log_path ? GAMUT_OK : trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
}

/* The log is born with its first line. */
gamut_status log_begin(struct study *study, const char *folder)
{
  gamut_status status;
  char header[64], *text = NULL;
  TRY(find_path(study, folder));
  snprintf(header, sizeof header, RESULT_LOG_MARK LOG_VERSION "%s", study->digest);
  text = strdup(header);
  if (text)
    text = with_sum(text, strlen(text));
  if (!text) {
    status = trace_fail(study->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  TRY(file_replace(folder, RESULT_LOG, text, strlen(text), study->trace));
  status = open_file(study);
done:
  free(text);
  return status;
}

void log_close(struct study *study)
{
  if (study->log >= 0)
    close(study->log);
  study->log = -1;
}

gamut_status log_resume(struct study *study, const char *folder, bool *there)
{
  gamut_status status;
  FILE *file = NULL;
  int copy = -1;
  *there = false;
  TRY(find_path(study, folder));
  *there = study->options.resume && file_exists(study->log_path);
  if (!*there)
    goto done;
  TRY(open_file(study));
  copy = fcntl(study->log, F_DUPFD_CLOEXEC, 0);
  file = copy >= 0 ? fdopen(copy, "r") : NULL;
  status = file ? log_read(study, study->log_path, file)
                : trace_fail(study->trace, GAMUT_OUTPUT, "cannot read '%s': %s", study->log_path,
                             strerror(errno));
done:
  if (file)
    fclose(file);
  else if (copy >= 0)
    close(copy);
  return status;
}

bool log_has_axes(const struct study *study)
{
  for (size_t i = 0; i < study->quantities; i++)
    if (study->measured[i].curve && !study->measured[i].at)
      return false;
  return true;
}
