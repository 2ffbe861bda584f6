#include "material/law.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "registry/guard.h"

static bool has_row(const struct kernel *kernel, size_t slot)
{
  switch (kernel->slot[slot].kind) {
  case SLOT_PARAMETER:
  case SLOT_MATERIAL_PARAMETER: return slot_varies(kernel, slot);
  case SLOT_INPUT: return !kernel->uniform[slot];
  case SLOT_OUTPUT:
  case SLOT_STATE_BEGIN:
  case SLOT_STATE_END: return true;
  default: return false;
  }
}

static bool is_result(const struct slot *slot)
{
  return slot->kind == SLOT_OUTPUT || slot->kind == SLOT_STATE_END;
}

static void call(const struct law *law, struct image *image)
{
  const char *before = guard_enter(law->kernel->descriptor->id);
  law->kernel->main(image);
  guard_leave(before);
}

/* What effects leave of the flow stress, they leave of all that follows from it. */
static void scale_all(struct law *law)
{
  const double *factor = law->factor;
  for (size_t k = 0; factor && k < law->scales; k++) {
    double *to = law->image->pointer[law->scaled[k]];
    for (size_t i = 0; to && i < law->image->count; i++)
      to[i] *= factor[i];
  }
}

static void scale_listed(struct law *law, const uint32_t *lane, size_t lanes)
{
  const double *factor = law->factor;
  for (size_t k = 0; factor && k < law->scales; k++) {
    double *to = law->image->pointer[law->scaled[k]];
    for (size_t i = 0; to && i < lanes; i++)
      to[lane[i]] *= factor[lane[i]];
  }
}

/* Evaluates every point in place. */
static void evaluate_all(struct law *law)
{
  memset(law->image->status, 0, law->image->count * sizeof *law->image->status);
  call(law, law->image);
  scale_all(law);
}

static void gather(struct law *law, const uint32_t *lane, size_t lanes)
{
  for (size_t r = 0; r < law->arguments; r++) {
    const double *from = law->image->pointer[law->row[r]];
    double *to = law->compact->pointer[law->row[r]];
    for (size_t i = 0; i < lanes; i++)
      to[i] = from[lane[i]];
  }
}

static void spread(struct law *law, const uint32_t *lane, size_t lanes)
{
  for (size_t r = law->arguments; r < law->arguments + law->results; r++) {
    const double *from = law->compact->pointer[law->row[r]];
    double *to = law->image->pointer[law->row[r]];
    for (size_t i = 0; i < lanes; i++)
      to[lane[i]] = from[i];
  }
  for (size_t i = 0; i < lanes; i++)
    law->image->status[lane[i]] = law->compact->status[i];
}

static void evaluate(struct law *law, const uint32_t *lane, size_t lanes)
{
  law->evaluated += lane ? lanes : law->image->count;
  if (!lane) {
    evaluate_all(law);
    return;
  }
  gather(law, lane, lanes);
  memset(law->compact->status, 0, lanes * sizeof *law->compact->status);
  law->compact->count = lanes;
  call(law, law->compact);
  spread(law, lane, lanes);
  scale_listed(law, lane, lanes);
}

static void evaluate_strength(const struct gamut_strength_law *strength, const uint32_t *lane,
                              size_t lanes)
{
  evaluate((struct law *)((char *)(size_t)strength - offsetof(struct law, strength)), lane, lanes);
}

static void evaluate_eos(const struct gamut_eos_law *eos, const uint32_t *lane, size_t lanes)
{
  evaluate((struct law *)((char *)(size_t)eos - offsetof(struct law, eos)), lane, lanes);
}

double *law_row(const struct law *law, const char *name)
{
  for (size_t s = 0; s < law->kernel->slots; s++)
    if (has_row(law->kernel, s) && strcmp(law->kernel->slot[s].name, name) == 0)
      return law->image->pointer[s];
  return NULL;
}

/* Arguments the law does not read and results it does not give still have a row: scratch for the
 * caller to write, zeros to read. */
static double *row_or_spare(const struct law *law, const char *name, double *spare)
{
  double *row = law_row(law, name);
  return row ? row : spare;
}

static void show_strength(struct law *law, double *unread, double *zero)
{
  law->strength = (struct gamut_strength_law){
      .evaluate = evaluate_strength,
      .plastic_strain = row_or_spare(law, "plastic_strain", unread),
      .plastic_strain_rate = row_or_spare(law, "plastic_strain_rate", unread),
      .temperature = row_or_spare(law, "temperature", unread),
      .pressure = law_row(law, "pressure"),
      .compression = law_row(law, "compression"),
      .shear_modulus_factor = law_row(law, "shear_modulus_factor"),
      .flow_stress = row_or_spare(law, "flow_stress", zero),
      .flow_stress_slope_plastic_strain =
          row_or_spare(law, "flow_stress_slope_plastic_strain", zero),
      .flow_stress_slope_plastic_strain_rate =
          row_or_spare(law, "flow_stress_slope_plastic_strain_rate", zero),
      .flow_stress_slope_temperature = row_or_spare(law, "flow_stress_slope_temperature", zero)};
}

static void show_eos(struct law *law, double *unread, double *zero)
{
  law->eos = (struct gamut_eos_law){
      .evaluate = evaluate_eos,
      .compression = row_or_spare(law, "compression", unread),
      .energy = row_or_spare(law, "energy", unread),
      .pressure = row_or_spare(law, "pressure", zero),
      .pressure_slope_compression = row_or_spare(law, "pressure_slope_compression", zero),
      .pressure_slope_energy = row_or_spare(law, "pressure_slope_energy", zero),
      .sound_speed = row_or_spare(law, "sound_speed", zero)};
}

static bool list_rows(struct law *law, struct arena *arena, const char *label)
{
  const struct kernel *kernel = law->kernel;
  law->row = arena_take(arena, label, (kernel->slots + 1) * sizeof *law->row);
  for (int results = 0; law->row && results < 2; results++)
    for (size_t s = 0; s < kernel->slots; s++) {
      if (!has_row(kernel, s) || is_result(&kernel->slot[s]) != (results == 1))
        continue;
      law->row[law->arguments + law->results] = s;
      *(results ? &law->results : &law->arguments) += 1;
    }
  return law->row != NULL;
}

static bool list_scaled(struct law *law, struct arena *arena, const char *label)
{
  static const char flow[] = "flow_stress";
  const struct kernel *kernel = law->kernel;
  const char *of = kernel->descriptor->derivative_of;
  law->scaled = arena_take(arena, label, (kernel->slots + 1) * sizeof *law->scaled);
  for (size_t s = 0; law->scaled && s < kernel->slots; s++) {
    const struct slot *slot = &kernel->slot[s];
    const bool derivative = slot->kind == SLOT_DERIVATIVE || slot->kind == SLOT_SECOND_DERIVATIVE;
    if (derivative ? of && strcmp(of, flow) == 0
                   : slot->kind == SLOT_OUTPUT && strncmp(slot->name, flow, sizeof flow - 1) == 0)
      law->scaled[law->scales++] = s;
  }
  return law->scaled != NULL;
}

/* Inputs that nobody sets: as where they are absent. */
static void fill_absent(struct law *law)
{
  const struct kernel *kernel = law->kernel;
  for (size_t s = 0; s < kernel->slots; s++) {
    const double value = has_row(kernel, s) ? slot_absent(kernel, s) : 0.0;
    double *row = law->image->pointer[s];
    for (size_t i = 0; value != 0.0 && i < law->rows; i++)
      row[i] = value;
  }
}

gamut_status law_new(const struct kernel *kernel, struct arena *arena, size_t rows,
                     struct law **out)
{
  static const char label[] = "laws of materials";
  struct law *law = arena_take(arena, label, sizeof *law);
  if (!law)
    return GAMUT_INTERNAL;
  *out = law;
  law->kernel = kernel;
  law->rows = rows;
  law->stride = rows + ARRAY_PAD;
  law->image = image_new(kernel, arena, rows, label);
  law->compact = image_new(kernel, arena, rows, label);
  size_t count = 2; /* the two spare rows come last */
  for (size_t s = 0; s < kernel->slots; s++)
    count += has_row(kernel, s);
  law->memory = arena_take(arena, label, count * law->stride * sizeof(double));
  law->gathered = arena_take(arena, label, count * law->stride * sizeof(double));
  if (!law->image || !law->compact || !law->memory || !law->gathered ||
      !list_rows(law, arena, label) || !list_scaled(law, arena, label))
    return GAMUT_INTERNAL;
  size_t row = 0;
  for (size_t s = 0; s < kernel->slots; s++)
    if (has_row(kernel, s)) {
      law->image->pointer[s] = law->memory + row * law->stride;
      law->compact->pointer[s] = law->gathered + row * law->stride;
      row++;
    }
  double *unread = law->memory + row * law->stride, *zero = unread + law->stride;
  show_strength(law, unread, zero);
  show_eos(law, unread, zero);
  fill_absent(law);
  return GAMUT_OK;
}

void law_free(struct law *law, struct arena *arena)
{
  if (!law)
    return;
  struct image *image[] = {law->image, law->compact};
  for (int i = 0; i < 2; i++)
    if (image[i]) {
      arena_give(arena, image[i]->status);
      arena_give(arena, image[i]);
    }
  arena_give(arena, law->memory);
  arena_give(arena, law->gathered);
  arena_give(arena, law->row);
  arena_give(arena, law->scaled);
  arena_give(arena, law);
}

static bool reads(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->inputs; i++)
    if (strcmp(d->input[i].name, name) == 0)
      return !d->input[i].optional;
  return false;
}

static bool gives(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->outputs; i++)
    if (strcmp(d->output[i].name, name) == 0)
      return true;
  return false;
}

gamut_status strength_fits(const struct material *material, const struct descriptor *caller,
                           struct trace *trace)
{
  const struct descriptor *d = material->strength.descriptor;
  const struct tree *node = material->strength.node ? material->strength.node : material->node;
  const bool pressed = reads(d, "pressure") || reads(d, "compression");
  const bool stiffened = gives(d, "shear_modulus_factor");
  if (pressed && !descriptor_provides(caller, "strength_pressure"))
    return trace_fail_at(trace, GAMUT_SCENE, node ? &node->place : NULL, NULL,
                         "another strength, or who calls it by elasticity/hypoelastic",
                         "%s of material '%s' reads the pressure or the compression, which %s does "
                         "not give it: it does not provide 'strength_pressure'",
                         d->id, material->name, caller->id);
  if (stiffened && !descriptor_provides(caller, "shear_modulus_factor"))
    return trace_fail_at(trace, GAMUT_SCENE, node ? &node->place : NULL, NULL,
                         "another strength, or who calls it by elasticity/hypoelastic",
                         "%s of material '%s' changes the shear modulus, which %s does not take "
                         "up: it does not provide 'shear_modulus_factor'",
                         d->id, material->name, caller->id);
  return GAMUT_OK;
}

void law_begin(struct law *law, size_t count)
{
  law->image->count = count;
  memset(law->image->status, 0, count * sizeof *law->image->status);
}

void law_clear(struct law *law)
{
  size_t count = 2;
  for (size_t s = 0; s < law->kernel->slots; s++)
    count += has_row(law->kernel, s);
  memset(law->memory, 0, count * law->stride * sizeof(double));
  memset(law->gathered, 0, count * law->stride * sizeof(double));
  memset(law->image->status, 0, law->rows * sizeof *law->image->status);
  fill_absent(law);
}
