/* Fields of the bonds for frames and quantities; those that nobody wants are not kept. */
#include <string.h>

#include "bar.h"

static double of_mass(const struct bar *bar, size_t i)
{
  return bar->mass_density[i] * bar->volume[i];
}
static double of_strain(const struct bar *bar, size_t i)
{
  return bar->strain[i];
}
static double of_plastic(const struct bar *bar, size_t i)
{
  return bar->flow[i];
}
static double of_family_strain(const struct bar *bar, size_t i)
{
  return bar->families.internal[i] / bar->softening[i];
}
static double of_family_stress(const struct bar *bar, size_t i)
{
  return bar->families.stress[i];
}
static double of_modulus(const struct bar *bar, size_t i)
{
  return bar->stiffness[i];
}
static double of_softness(const struct bar *bar, size_t i)
{
  return bar->softness[i];
}
static double of_yield_factor(const struct bar *bar, size_t i)
{
  return bar->yield_factor[i];
}
static double of_spread(const struct bar *bar, size_t i)
{
  return bar->spread[i];
}
static double of_length(const struct bar *bar, size_t i)
{
  return bar->length[i];
}
static double of_area(const struct bar *bar, size_t i)
{
  return bar->section[i];
}

static const struct shown {
  const char *field;
  double (*value)(const struct bar *, size_t bond);
} shown[] = {{"mass", of_mass},
             {"strain", of_strain},
             {"bond_plastic_strain", of_plastic},
             {"family_strain", of_family_strain},
             {"family_stress", of_family_stress},
             {"bond_modulus", of_modulus},
             {"softness", of_softness},
             {"yield_factor", of_yield_factor},
             {"interaction_length", of_spread},
             {"bond_length", of_length},
             {"bond_area", of_area},
             {"local_gamut", local_gamut},
             {"nonlocal_gamut", nonlocal_gamut},
             {"bond_state", bond_state}};
enum { SHOWN = sizeof shown / sizeof shown[0] };

/* One field: its own task, so that nothing is worked out for nobody. */
struct display {
  struct bar *bar;
  const struct shown *what; /* null: stress */
  struct gamut_field field;
};

static double shown_value(const struct display *d, size_t bond, unsigned component)
{
  if (d->what)
    return d->what->value(d->bar, bond);
  return component == 0 ? d->bar->stress[bond] : 0.0;
}

static gamut_status show_chunk(void *self, const struct gamut_chunk *chunk)
{
  const struct display *d = self;
  size_t bonds = d->bar->bonds;
  for (unsigned k = 0; k < d->field.components; k++) {
    double *to = gamut_end(chunk, d->field, k);
    for (size_t i = 0; to && i < chunk->count; i++) {
      size_t bond = chunk->slot + i < bonds ? chunk->slot + i : bonds - 1;
      to[i] = shown_value(d, bond, k);
    }
  }
  return GAMUT_OK;
}

static gamut_status add_display(struct bar *bar, const char *field, const struct shown *what,
                                struct display *d)
{
  *d = (struct display){.bar = bar, .what = what};
  gamut_status status = gamut_field_named(bar->run, field, &d->field);
  const struct gamut_use use = {field, GAMUT_WRITE};
  const struct gamut_task task = {.name = "show",
                                  .phase = "show",
                                  .extent = GAMUT_PER_CHUNK,
                                  .uses = &use,
                                  .use_count = 1,
                                  .run = show_chunk,
                                  .self = d};
  return status == GAMUT_OK ? gamut_add_task(bar->run, &task) : status;
}

gamut_status show_new(struct bar *bar)
{
  struct display *d = gamut_allocate(bar->run, "fields", (SHOWN + 1) * sizeof *d);
  if (!d)
    return GAMUT_INTERNAL;
  bar->display = d;
  gamut_status status = add_display(bar, "stress", NULL, &d[SHOWN]);
  for (size_t k = 0; status == GAMUT_OK && k < SHOWN; k++)
    status = add_display(bar, shown[k].field, &shown[k], &d[k]);
  return status;
}

/* The midpoints, carried by the strains of the bonds left of them. */
void show_positions(struct bar *bar)
{
  double *x = GAMUT_HOST(bar->run)->stored(bar->set, bar->position, 0), moved = 0.0;
  for (size_t i = 0; x && i < bar->set->slots; i++) {
    if (i >= bar->bonds) {
      x[i] = x[bar->bonds - 1];
      continue;
    }
    double longer = bar->length[i] * bar->strain[i];
    x[i] = bar->place[i] + moved + 0.5 * longer;
    moved += longer;
  }
}

void show_start(struct bar *bar)
{
  show_positions(bar);
  for (size_t k = 0; k <= SHOWN; k++) {
    const struct display *d = &bar->display[k];
    for (unsigned c = 0; c < d->field.components; c++) {
      double *to = GAMUT_HOST(bar->run)->stored(bar->set, d->field, c);
      for (size_t i = 0; to && i < bar->set->slots; i++)
        to[i] = shown_value(d, i < bar->bonds ? i : bar->bonds - 1, c);
    }
  }
}
