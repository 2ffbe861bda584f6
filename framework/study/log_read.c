/* Reads study.log (log.c says what stands there), as far as it is whole. */
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/study_private.h"

static bool next_number(char **text, double *value)
{
  char *after;
  *value = strtod(*text, &after);
  bool good = after != *text;
  *text = after;
  return good;
}

static bool next_whole(char **text, uint64_t *value)
{
  char *after;
  errno = 0;
  *value = strtoull(*text, &after, 10);
  bool good = after != *text && errno == 0;
  *text = after;
  return good;
}

static bool read_curve(struct study *study, char *text)
{
  uint64_t index, count;
  if (!next_whole(&text, &index) || !next_whole(&text, &count) || index >= study->quantities ||
      count > strlen(text) || !study->measured[index].curve)
    return false;
  struct measured *m = &study->measured[index];
  free(m->at);
  m->at = calloc(count + 1, sizeof *m->at);
  m->count = count;
  bool good = m->at != NULL;
  for (size_t k = 0; good && k < count; k++)
    good = next_number(&text, &m->at[k]);
  measured_place(study);
  return good;
}

static bool read_steps(struct study *study, char *text)
{
  uint64_t level, count;
  if (!study->nominal || !next_whole(&text, &level) || !next_whole(&text, &count) ||
      level >= level_count(study) || count > strlen(text))
    return false;
  struct common_steps *steps = &study->nominal[level].steps;
  free(steps->step);
  *steps = (struct common_steps){calloc(count + 1, sizeof *steps->step), count};
  bool good = steps->step != NULL;
  for (size_t k = 0; good && k < count; k++)
    good = next_number(&text, &steps->step[k]);
  return good;
}

static bool logged_room(struct study *study, uint64_t number)
{
  enum { RUNS_MAX = 1 << 28 };
  if (number < study->logs)
    return true;
  size_t count = 2 * study->logs > number ? 2 * study->logs : (size_t)number + 64;
  struct outcome *grown = number < RUNS_MAX ? realloc(study->logged, count * sizeof *grown) : NULL;
  if (!grown)
    return false;
  memset(grown + study->logs, 0, (count - study->logs) * sizeof *grown);
  study->logged = grown;
  study->logs = count;
  return true;
}

static bool read_own(char **text, struct own_curve *own)
{
  uint64_t count;
  if (!next_whole(text, &count) || count > strlen(*text))
    return false;
  own->at = calloc(count + 1, sizeof *own->at);
  own->value = calloc(count + 1, sizeof *own->value);
  own->count = count;
  bool good = own->at && own->value;
  for (size_t k = 0; good && k < count; k++)
    good = next_number(text, &own->at[k]);
  for (size_t k = 0; good && k < count; k++)
    good = next_number(text, &own->value[k]);
  return good;
}

static bool read_outcome(struct study *study, char *text, struct outcome *o)
{
  uint64_t level, mode;
  outcome_clear(o);
  bool good = next_whole(&text, &level) && next_whole(&text, &mode) && mode == GAMUT_ROW_RUN &&
              next_whole(&text, &o->realisation) && next_whole(&text, &o->steps) &&
              next_whole(&text, &o->points) && next_number(&text, &o->work) &&
              next_number(&text, &o->wall) && next_number(&text, &o->cpu) && outcome_room(study, o);
  o->level = level;
  for (size_t i = 0; good && i < study->parameters; i++)
    good = next_number(&text, &o->parameter[i]);
  for (size_t i = 0; good && i < study->results; i++)
    good = next_number(&text, &o->result[i]);
  for (size_t i = 0; good && i < o->owns; i++)
    good = !study->measured[i].curve || read_own(&text, &o->own[i]);
  if (good && strncmp(text, " failed ", 8) == 0)
    good = (o->reason = strdup(text + 8)) != NULL;
  else
    good = good && strcmp(text, " ok") == 0;
  o->done = good && !(o->reason && study->options.retry_failed);
  return good;
}

static bool read_nominal(struct study *study, char *text)
{
  char *after = text;
  uint64_t level;
  return study->nominal && next_whole(&after, &level) && level < level_count(study) &&
         read_outcome(study, text, &study->nominal[level].outcome);
}

static bool read_run(struct study *study, char *text)
{
  uint64_t number;
  return next_whole(&text, &number) && logged_room(study, number) &&
         read_outcome(study, text, &study->logged[number]);
}

/* Takes off the sum at the end of a line; false if it is not that of the line. */
static bool take_sum(char *line)
{
  size_t length = strlen(line);
  char expected[LOG_SUM_LENGTH + 1];
  if (length < LOG_SUM_LENGTH)
    return false;
  snprintf(expected, sizeof expected, " ~%08" PRIx32, log_sum(line, length - LOG_SUM_LENGTH));
  bool good = strcmp(line + length - LOG_SUM_LENGTH, expected) == 0;
  line[length - LOG_SUM_LENGTH] = 0;
  return good;
}

static gamut_status refuse(struct study *study, const char *path, size_t line, const char *why)
{
  return trace_fail_at(study->trace, GAMUT_OUTPUT, NULL, NULL,
                       "use another folder, or --force to begin anew",
                       "cannot go on with '%s', line %zu: %s", path, line, why);
}

static gamut_status read_line(struct study *study, const char *path, char *line, size_t number)
{
  if (number == 1) {
    char expected[64];
    snprintf(expected, sizeof expected, RESULT_LOG_MARK LOG_VERSION "%s", study->digest);
    if (strncmp(line, RESULT_LOG_MARK LOG_VERSION, strlen(RESULT_LOG_MARK LOG_VERSION)) != 0)
      return refuse(study, path, number, "it is no log of this gamut's studies");
    if (strcmp(line, expected) != 0)
      return refuse(study, path, number,
                    "the scene, a file that it names, the seed or a plugin is another than it was");
    return GAMUT_OK;
  }
  bool good = false;
  if (strncmp(line, "curve ", 6) == 0)
    good = read_curve(study, line + 6);
  else if (strncmp(line, "run ", 4) == 0)
    good = read_run(study, line + 4);
  else if (strncmp(line, "nominal ", 8) == 0)
    good = read_nominal(study, line + 8);
  else if (strncmp(line, "steps ", 6) == 0)
    good = read_steps(study, line + 6);
  return good ? GAMUT_OK : refuse(study, path, number, "it cannot be understood");
}

gamut_status log_read(struct study *study, const char *path, FILE *file)
{
  gamut_status status = GAMUT_OK;
  char *line = NULL;
  size_t room = 0, number = 0;
  off_t good = 0;
  ssize_t length;
  while ((length = getline(&line, &room, file)) > 0) {
    bool whole = line[length - 1] == '\n';
    line[whole ? length - 1 : length] = 0;
    if (!whole || strlen(line) != (size_t)length - 1 || !take_sum(line)) {
      bool last = getline(&line, &room, file) <= 0;
      if (number > 0 && last)
        break; /* cut off in the middle of writing */
      TRY(refuse(study, path, number + 1, "it is damaged"));
    }
    TRY(read_line(study, path, line, ++number));
    good += length;
  }
  if (number == 0)
    TRY(refuse(study, path, 1, "it is empty"));
  if (ftruncate(study->log, good) != 0)
    status = trace_fail(study->trace, GAMUT_OUTPUT, "cannot write '%s': %s", path, strerror(errno));
done:
  free(line);
  return status;
}
