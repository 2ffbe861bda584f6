/* What the bar keeps between two load steps. One list serves saving and restoring; what the scene
 * gives (grid, softness, weights) is made again. */
#include <string.h>

#include "bar.h"
#include "restart.h"

/* Bytes that go out (`to`), come in (`from`), or are only counted (neither). */
struct archive {
  unsigned char *to;
  const unsigned char *from;
  size_t at, size;
};

static void pass(struct archive *a, void *data, size_t bytes)
{
  if (a->from && bytes <= a->size - a->at)
    memcpy(data, a->from + a->at, bytes);
  else if (a->to)
    memcpy(a->to + a->at, data, bytes);
  a->at += a->from && bytes > a->size - a->at ? a->size - a->at : bytes;
}

static void pass_families(struct families *f, size_t bonds, struct archive *a)
{
  double *const array[] = {f->internal,     f->stress,        f->plastic,    f->direction,
                           f->trial_stress, f->trial_plastic, f->trial_slope};
  for (int k = 0; k < 3; k++)
    pass(a, f->turn[k], f->depth * bonds * sizeof(double));
  for (size_t k = 0; k < sizeof array / sizeof array[0]; k++)
    pass(a, array[k], bonds * sizeof(double));
  pass(a, f->count, bonds);
  pass(a, f->trial_count, bonds);
  pass(a, f->below, bonds);
}

static void pass_load(struct load *load, struct archive *a)
{
  pass(a, &load->rung, sizeof load->rung);
  pass(a, &load->level, sizeof load->level);
  pass(a, &load->leg, sizeof load->leg);
  pass(a, &load->increment, sizeof load->increment);
  pass(a, &load->from, sizeof load->from);
  pass(a, &load->step, sizeof load->step);
  pass(a, &load->tip, sizeof load->tip);
  pass(a, &load->ended, sizeof load->ended);
}

static void pass_bar(struct bar *bar, struct archive *a)
{
  double *const array[] = {bar->internal,   bar->flow,       bar->stress,      bar->strain,
                           bar->old_stress, bar->old_strain, bar->older_strain};
  for (size_t k = 0; k < sizeof array / sizeof array[0]; k++)
    if (array[k])
      pass(a, array[k], bar->bonds * sizeof(double));
  pass(a, &bar->force, sizeof bar->force);
  pass(a, &bar->next_stress, sizeof bar->next_stress);
  pass(a, &bar->mean_strain, sizeof bar->mean_strain);
  pass(a, &bar->nominal_stress, sizeof bar->nominal_stress);
  pass(a, bar->level, sizeof bar->level);
  pass(a, &bar->levels, sizeof bar->levels);
  pass(a, &bar->loop, sizeof bar->loop);
  pass(a, &bar->rupture, sizeof bar->rupture);
  pass(a, &bar->saturated, sizeof bar->saturated);
  pass(a, &bar->newton, sizeof bar->newton);
  pass(a, &bar->iterations, sizeof bar->iterations);
  pass_load(&bar->load, a);
  pass_families(&bar->families, bar->bonds, a);
}

size_t bar_save(const void *self, void *bytes)
{
  struct archive a = {.to = bytes};
  pass_bar((struct bar *)(size_t)self, &a);
  return a.at;
}

gamut_status bar_restore(void *self, const void *bytes, size_t size)
{
  struct bar *bar = self;
  struct archive a = {.from = bytes, .size = size};
  if (size != bar_save(bar, NULL))
    return gamut_fail(bar->run, GAMUT_OUTPUT,
                      "the state of the bar in the checkpoint does not fit this solver");
  pass_bar(bar, &a);
  return GAMUT_OK;
}
