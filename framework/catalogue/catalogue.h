/* The fields that gamut knows by name. Plugins refer to these in `inputs` and `outputs`; state
 * variables that a descriptor declares join them. */
#ifndef GAMUT_CATALOGUE_H
#define GAMUT_CATALOGUE_H

#include <stddef.h>

#include <gamut/host.h>

/* X(name, where, components, unit, meaning). Symmetric tensors: xx yy zz xy yz zx. Full tensors:
 * row by row, xx xy xz yx yy yz zx zy zz. */
#define FIELD_CATALOGUE(X)                                                                         \
  X(position, GAMUT_AT_POINT, 3, "m", "where the point is")                                        \
  X(first_position, GAMUT_AT_POINT, 3, "m", "where the point was when the run started")            \
  X(velocity, GAMUT_AT_POINT, 3, "m/s", "velocity of the point")                                   \
  X(mass, GAMUT_AT_POINT, 1, "kg", "mass of the point")                                            \
  X(reference_volume, GAMUT_AT_POINT, 1, "m3", "volume at reference density")                      \
  X(volume_ratio, GAMUT_AT_POINT, 1, "1", "volume over reference volume, J")                       \
  X(velocity_gradient, GAMUT_AT_POINT, 9, "1/s",                                                   \
    "L at the beginning of the step; the step's deformation is I + time_step L")                   \
  X(deformation_gradient, GAMUT_AT_POINT, 9, "1",                                                  \
    "F, from the identity on; (I + time_step L) F at the end of a step, so that det F is J")       \
  X(stress, GAMUT_AT_POINT, 6, "Pa", "Cauchy stress with viscous pressure, tension positive")      \
  X(plastic_strain, GAMUT_AT_POINT, 1, "1", "equivalent plastic strain")                           \
  X(plastic_strain_rate, GAMUT_AT_POINT, 1, "1/s", "rate of equivalent plastic strain")            \
  X(plastic_dissipation, GAMUT_AT_POINT, 1, "J/m3",                                                \
    "plastic work of this step per reference volume")                                              \
  X(temperature, GAMUT_AT_POINT, 1, "K", "temperature")                                            \
  X(energy, GAMUT_AT_POINT, 1, "J/m3", "internal energy per reference volume")                     \
  X(sound_speed, GAMUT_AT_POINT, 1, "m/s", "longitudinal (eos: bulk) sound speed")                 \
  X(viscous_pressure, GAMUT_AT_POINT, 1, "Pa", "artificial viscous pressure, q")                   \
  X(external_force, GAMUT_AT_POINT, 3, "N", "force on the point from effects")                     \
  X(omega_squared, GAMUT_AT_POINT, 1, "1/s2",                                                      \
    "square of the highest frequency at the point; the step is bounded by 2/omega")                \
  X(removal, GAMUT_AT_POINT, 1, "1", "mark of who takes the point out of the run; 0: nobody")      \
  X(step_factor, GAMUT_AT_POINT, 1, "1", "how much longer the next step may be than this one")     \
  X(compression, GAMUT_AT_POINT, 1, "1", "rho/rho0 - 1, mu")                                       \
  X(pressure, GAMUT_AT_POINT, 1, "Pa", "pressure of the eos, positive in compression")             \
  X(pressure_slope_compression, GAMUT_AT_POINT, 1, "Pa", "dp/dmu at constant energy")              \
  X(pressure_slope_energy, GAMUT_AT_POINT, 1, "1", "dp/de at constant compression")                \
  X(flow_stress, GAMUT_AT_POINT, 1, "Pa", "flow stress of the strength law")                       \
  X(flow_stress_slope_plastic_strain, GAMUT_AT_POINT, 1, "Pa", "d(flow stress)/d(plastic strain)") \
  X(flow_stress_slope_plastic_strain_rate, GAMUT_AT_POINT, 1, "Pa s",                              \
    "d(flow stress)/d(plastic strain rate)")                                                       \
  X(flow_stress_slope_temperature, GAMUT_AT_POINT, 1, "Pa/K", "d(flow stress)/d(temperature)")     \
  X(shear_modulus_factor, GAMUT_AT_POINT, 1, "1", "what is left of the shear modulus")             \
  X(reference_density, GAMUT_AT_MATERIAL, 1, "kg/m3", "density at zero compression, rho0")         \
  X(time, GAMUT_AT_RUN, 1, "s", "at the beginning of the step")                                    \
  X(time_step, GAMUT_AT_RUN, 1, "s", "length of the step")                                         \
  X(cell_size, GAMUT_AT_RUN, 1, "m", "edge of a grid cell")

/* Y(name, access, unit, meaning): one number at a point that several may change in one step, by
 * that access alone. Where nobody does it is what the access starts from. */
#define FIELD_CATALOGUE_SHARED(Y)                                                                  \
  Y(flow_stress_factor, GAMUT_SCALE, "1",                                                          \
    "what is left of the flow stress: the core multiplies the law's results by it")                \
  Y(transfer_heat, GAMUT_ADD, "J/m3",                                                              \
    "heat that the point is given in the step, per reference volume; the solver takes it up")      \
  Y(opening_tension, GAMUT_LEAST, "Pa", "tension at which material opens; infinite: it does not")  \
  Y(closing_pressure, GAMUT_LEAST, "Pa", "pressure at which open material closes")

struct field_info {
  const char *name;
  enum gamut_where where;
  unsigned components;
  const char *unit, *meaning;
  enum gamut_access access; /* GAMUT_WRITE: whoever writes it decides */
};
/* What an access that several may have starts from: 0 of sums, 1 of products, infinity of the
 * least; 0 of the others. */
double access_neutral(enum gamut_access);

/* The entry of that name, or null. */
const struct field_info *catalogue_find(const char *name);
const struct field_info *catalogue_at(size_t index); /* null past the end */
/* "xx", "x", "" for component k of a field with n components; "0", "1" ... where n is none of 1, 2,
 * 3, 6, 9. No field has more than CATALOGUE_COMPONENTS_MAX. */
enum { CATALOGUE_COMPONENTS_MAX = 32 };
const char *component_name(unsigned components, unsigned k);

#endif
