/* What a body gives its points: temperature, and energy where it gives that or a pressure. */
#include <math.h>

#include "material/material_private.h"

/* Points the parameters of a law that have a random field at the values of a slot and its
 * neighbours; whether there are any. */
static bool follow_parameters(const struct law *law, const struct point_set *set, size_t slot)
{
  bool any = false;
  for (size_t s = 0; law && s < law->kernel->slots; s++) {
    const struct field *field =
        slot_varies(law->kernel, s) ? fields_find(set->fields, law->kernel->path[s]) : NULL;
    double *array = field ? set_stored(set, field->handle, 0) : NULL;
    if (array)
      law->image->pointer[s] = array + slot;
    any = any || array;
  }
  return any;
}

/* Energy at which the eos gives the pressure at zero compression. */
static gamut_status energy_of_pressure(struct bound_material *bound, const struct gamut_body *body,
                                       double *energy, struct trace *trace)
{
  struct law *law = bound->per_thread[0].law[EOS];
  double e = 0.0;
  for (int i = 0; law && i < 60; i++) {
    law_begin(law, GAMUT_LANES);
    for (int k = 0; k < GAMUT_LANES; k++) {
      law->eos.compression[k] = 0.0;
      law->eos.energy[k] = e;
    }
    law->eos.evaluate(&law->eos, NULL, 0);
    double miss = law->eos.pressure[0] - body->pressure, slope = law->eos.pressure_slope_energy[0];
    if (fabs(miss) <= 1e-14 * fabs(body->pressure)) {
      *energy = e;
      return GAMUT_OK;
    }
    if (!(fabs(slope) > 0.0))
      break;
    e -= miss / slope;
  }
  return trace_fail_at(trace, GAMUT_SCENE, &body->node->place, "pressure",
                       "give `energy:`, or an eos whose pressure depends on energy",
                       "body '%s' cannot start at %g Pa: its eos has no energy for that",
                       body->name, body->pressure);
}

gamut_status material_initial(struct bound_material *bound, struct point_set *set,
                              const struct gamut_body *body, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  double energy = body->has_energy ? body->energy : 0.0;
  bool sought = body->has_pressure && body->pressure != 0.0;
  bool differs = sought && follow_parameters(bound->per_thread[0].law[EOS], set, 0);
  if (sought)
    TRY(energy_of_pressure(bound, body, &energy, trace));
  const struct { const char *name; double value; } initial[] = {
      {"temperature", body->temperature}, {"energy", energy}};
  for (int f = 0; f < 2; f++) {
    const struct field *field = fields_find(set->fields, initial[f].name);
    double *array = field ? set_stored(set, field->handle, 0) : NULL;
    for (size_t i = 0; array && i < set->open.slots; i++)
      array[i] = initial[f].value;
    for (size_t i = 0; differs && f == 1 && array && i < set->open.slots; i++) {
      follow_parameters(bound->per_thread[0].law[EOS], set, i);
      TRY(energy_of_pressure(bound, body, &array[i], trace));
    }
  }
done:
  return status;
}
