/* Names that other codes, papers and habits use, and what gamut has instead: one table for every
 * unknown key. What a name may mean in several places is said once, with all of them. */
#include <string.h>
#include <strings.h>

#include "scene/scene_private.h"

static const struct {
  const char *name, *instead;
} foreign[] = {
    {"diameter", "shapes have 'radius', half of it"},
    {"height", "shapes have 'length', along 'axis:'; the extent of a body is the measure 'extent'"},
    {"width", "a box has 'size: [..]' or 'min:' and 'max:'"},
    {"damage", "there is no damage law; 'gamut list' shows the effects, 'spall' tears material"},
    {"failure", "'gamut list' shows the effects: 'spall' tears material, 'erosion' takes it away"},
    {"contact", "bodies meet on the grid; 'gamut list' shows the effects, such as 'rigid_wall'"},
    {"D1", "there is no damage law of Johnson and Cook (D1 to D5)"},
    {"D2", "there is no damage law of Johnson and Cook (D1 to D5)"},
    {"D3", "there is no damage law of Johnson and Cook (D1 to D5)"},
    {"D4", "there is no damage law of Johnson and Cook (D1 to D5)"},
    {"D5", "there is no damage law of Johnson and Cook (D1 to D5)"},
    {"dt", "the solver chooses its steps; 'solver.courant' is their share of the stable one"},
    {"timestep", "the solver chooses its steps; 'solver.courant' is their share of the stable one"},
    {"time_step",
     "the solver chooses its steps; 'solver.courant' is their share of the stable one"},
    {"cfl", "'solver.courant'"},
    {"mesh", "'solver.cell' is the size of a cell; points are laid out in the bodies' shapes"},
    {"grid", "'solver.cell' is the size of a cell, 'solver.domain' bounds the grid"},
    {"dx", "'solver.cell' is the size of a cell"},
    {"h", "'solver.cell' is the size of a cell"},
    {"cell_size", "'solver.cell'"},
    {"element_size", "'solver.cell'"},
    {"resolution", "'solver.cell' is the size of a cell, a length"},
    {"particles", "'points_per_cell' of a body"},
    {"ppc", "'points_per_cell' of a body"},
    {"tmax", "'solver.end'"},
    {"t_end", "'solver.end'"},
    {"tend", "'solver.end'"},
    {"end_time", "'solver.end'"},
    {"duration", "'solver.end'"},
    {"termination", "'solver.end'"},
    {"gravity", "the effect {model: gravity, acceleration: [..]}"},
    {"youngs", "'youngs_modulus' under 'elasticity:'"},
    {"E", "'youngs_modulus' under 'elasticity:'"},
    {"nu", "'poissons_ratio' under 'elasticity:'"},
    {"poisson", "'poissons_ratio' under 'elasticity:'"},
    {"G", "'shear_modulus' under 'elasticity:'"},
    {"shear", "'shear_modulus' under 'elasticity:'"},
    {"K", "'bulk_modulus' under 'eos: {model: linear, ..}'"},
    {"bulk", "'bulk_modulus' under 'eos: {model: linear, ..}'"},
    {"rho", "'density' of the material"},
    {"rho0", "'density' of the material"},
    {"sigma_y", "the yield stress is a parameter of the 'strength:'; 'gamut show' lists them"},
    {"sigy", "the yield stress is a parameter of the 'strength:'; 'gamut show' lists them"},
    {"yield", "the yield stress is a parameter of the 'strength:'; 'gamut show' lists them"},
    {"epsdot0", "'reference_rate' of a strength law; 'gamut show' lists its parameters"},
    {"cp", "'specific_heat' of the material"},
    {"heat_capacity", "'specific_heat' of the material"},
    {"Tm", "'T_melt' of a strength law"},
    {"Tr", "'T_room' of a strength law"},
    {"c0", "'C0' under 'eos: {model: mie_gruneisen, ..}'"},
    {"s", "'S1' under 'eos: {model: mie_gruneisen, ..}'"},
    {"gamma", "'gamma0' under 'eos: {model: mie_gruneisen, ..}'"},
    {"initial_velocity", "'velocity' of a body"},
    {"v0", "'velocity' of a body"},
    {"boundary_conditions", "effects: 'rigid_wall', 'boundary'; 'gamut list' shows them"},
    {"bc", "effects: 'rigid_wall', 'boundary'; 'gamut list' shows them"},
    {"parts", "'bodies:'"},
    {"sections", "'bodies:'"},
    {"geometry", "'geometry' of the solver, 'shape' of a body"},
    {"output", "'outputs:'"},
    {"plot", "'outputs.every' or 'outputs.frames', with 'outputs.fields'"},
    {"dump", "'outputs.every' or 'outputs.frames', with 'outputs.fields'"},
    {"probes", "'quantities:', with 'at: {point: [..]}'"},
    {"tracers", "'quantities:', with 'at: {points: [..]}'"},
    {"history", "'quantities:'"},
};

const char *foreign_name(const char *key)
{
  for (size_t i = 0; i < ARRAY_SIZE(foreign); i++)
    if (strcmp(foreign[i].name, key) == 0)
      return foreign[i].instead;
  for (size_t i = 0; i < ARRAY_SIZE(foreign); i++)
    if (strlen(key) > 2 && strcasecmp(foreign[i].name, key) == 0)
      return foreign[i].instead;
  return NULL;
}

bool foreign_comma(const struct tree *child)
{
  const char *key = child->key;
  return key && key[0] >= '0' && key[0] <= '9' && child->kind == TREE_SCALAR && child->text[0] == 0;
}
