#include "report/report.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "report/readable.h"

struct progress {
  FILE *file;
  double end, started;
  const char *unit;
  bool terminal, open; /* open: the line on the terminal has no end yet */
  int tenth;           /* the last one printed */
};

struct progress *progress_new(FILE *file, double end, const char *axis_unit)
{
  struct progress *p = calloc(1, sizeof *p);
  if (!p)
    return NULL;
  *p = (struct progress){
      .file = file, .end = end, .started = clock_seconds(CLOCK_MONOTONIC), .unit = axis_unit};
  p->terminal = isatty(fileno(file)) == 1;
  return p;
}

void progress_free(struct progress *p)
{
  if (p && p->open)
    fputc('\n', p->file);
  free(p);
}

/* "1:05", "2:00:10" */
static void clock_text(double seconds, char *text, size_t size)
{
  if (!(seconds < 360000 * 100.0)) {
    snprintf(text, size, "?");
    return;
  }
  long whole = lround(seconds);
  if (whole >= 3600)
    snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  else
    snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
}

static void write_line(struct progress *p, double done, double time, uint64_t step, double rate)
{
  char at[48], end[48], left[32], speed[64] = "";
  double elapsed = clock_seconds(CLOCK_MONOTONIC) - p->started;
  readable(p->end, p->unit, end, sizeof end);
  readable_like(time, p->end, p->unit, at, sizeof at);
  if (rate > 0) {
    readable_rate(rate, speed, sizeof speed - 2);
    strcat(speed, ", ");
  }
  if (done < 1) {
    clock_text(done > 0 ? elapsed * (1 - done) / done : NAN, left, sizeof left);
    fprintf(p->file, "%3.0f %%  %s of %s, step %llu, %s%s left", 100 * done, at, end,
            (unsigned long long)step, speed, left);
  } else {
    clock_text(elapsed, left, sizeof left);
    fprintf(p->file, "%3.0f %%  %s, %llu steps, %stook %s", 100 * done, at,
            (unsigned long long)step, speed, left);
  }
}

void progress_tell(void *progress, double done, double time, uint64_t step, double rate)
{
  struct progress *p = progress;
  if (!p)
    return;
  done = fmin(fmax(done, 0), 1);
  if (p->terminal) {
    fputc('\r', p->file);
    write_line(p, done, time, step, rate);
    fputs("\033[K", p->file); /* what a longer line has left */
    p->open = true;
  } else {
    int tenth = (int)(10 * done + 1e-9);
    if (tenth <= p->tenth)
      return;
    p->tenth = tenth;
    write_line(p, done, time, step, rate);
    fputc('\n', p->file);
  }
  fflush(p->file);
}

struct runs_progress {
  FILE *file;
  double started;
  bool terminal, open, begun;
  size_t from; /* runs that the log had */
  int tenth;
};

struct runs_progress *runs_progress_new(FILE *file)
{
  struct runs_progress *p = calloc(1, sizeof *p);
  if (!p)
    return NULL;
  *p = (struct runs_progress){.file = file, .started = clock_seconds(CLOCK_MONOTONIC)};
  p->terminal = isatty(fileno(file)) == 1;
  return p;
}

void runs_progress_free(struct runs_progress *p)
{
  if (p && p->open)
    fputc('\n', p->file);
  free(p);
}

static void write_runs(struct runs_progress *p, size_t done, size_t asked, size_t failed)
{
  char left[32];
  double elapsed = clock_seconds(CLOCK_MONOTONIC) - p->started, made = (double)(done - p->from);
  fprintf(p->file, "%3.0f %%  %zu of %zu runs done", 100.0 * (double)done / (double)asked, done,
          asked);
  if (failed)
    fprintf(p->file, ", %zu failed", failed);
  clock_text(done < asked ? elapsed * (double)(asked - done) / made : elapsed, left, sizeof left);
  fprintf(p->file, done < asked ? ", %s left" : ", took %s", left);
}

void runs_progress_tell(void *progress, size_t done, size_t asked, size_t failed)
{
  struct runs_progress *p = progress;
  if (!p || asked == 0 || done == 0)
    return;
  if (!p->begun)
    p->from = done - 1;
  p->begun = true;
  if (p->terminal) {
    fputc('\r', p->file);
    write_runs(p, done, asked, failed);
    fputs("\033[K", p->file);
    p->open = true;
  } else {
    int tenth = (int)(10.0 * (double)done / (double)asked + 1e-9);
    if (tenth <= p->tenth)
      return;
    p->tenth = tenth;
    write_runs(p, done, asked, failed);
    fputc('\n', p->file);
  }
  fflush(p->file);
}
