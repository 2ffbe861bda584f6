/* The inside of a material in a run. */
#ifndef GAMUT_MATERIAL_PRIVATE_H
#define GAMUT_MATERIAL_PRIVATE_H

#include "material/law.h"

enum { ELASTICITY, STRENGTH, EOS, ROLES };

/* What one thread needs to update a block. */
struct thread_state {
  struct image *image;
  struct law *law[ROLES]; /* of strength and eos */
  double *scratch;
  double *zero, *sink;
  struct tally tally[ROLES];
  double step_factor; /* smallest asked for since it was last taken */
};

struct bound_material {
  const struct material *material;
  struct gamut_run *run;        /* whose it is */
  struct kernel *kernel[ROLES]; /* strength and eos may be null */
  struct links links[ROLES];
  struct gamut_use *use;
  size_t uses;
  struct thread_state *per_thread;
  size_t threads, chunk;
  struct arena *arena;
  size_t temperature, plastic_strain; /* components that fill a law's arguments; SIZE_MAX: none */
  size_t step_factor;                 /* component, where the elasticity gives one */
  size_t flow_stress_factor;          /* component, where an effect writes it; SIZE_MAX: none */
  struct deformation {                /* components; SIZE_MAX: nobody reads it */
    size_t gradient, velocity_gradient, time_step;
  } deformation;
};

/* deformation.c: F at the end of the step where somebody reads it. */
gamut_status deformation_declare(struct fields *, struct trace *);
void deformation_resolve(struct bound_material *, const struct task *, const struct fields *);
void deformation_update(const struct bound_material *, const struct gamut_chunk *);

#endif
