/* The stages of a step, in order, and what they leave for each other in the block's scratch arrays.
 */
#ifndef HYPOELASTIC_H
#define HYPOELASTIC_H

#include "hypoelastic.gamut.h"

/* Names of the scratch arrays. Those of the return are free again for the energy. */
enum hypoelastic_scratch {
  HYPOELASTIC_TRIAL, /* 6: trial deviator in the midpoint frame, then the returned one */
  HYPOELASTIC_TURN =
      HYPOELASTIC_TRIAL + 6, /* 3: axis of half the step's rotation times tan(angle / 4) */
  HYPOELASTIC_TRIAL_SIZE = HYPOELASTIC_TURN + 3, /* von Mises stress of the trial deviator */
  HYPOELASTIC_STRAIN_SIZE,                       /* equivalent deviatoric strain of the step */
  HYPOELASTIC_WORK_BEGIN,                        /* rotated begin deviator : strain */
  HYPOELASTIC_WORK_TRIAL,  /* trial deviator : strain, then deviatoric work per reference volume */
  HYPOELASTIC_VOLUME_STEP, /* J1 - J0 */
  HYPOELASTIC_COMPRESSION, /* at the end */
  HYPOELASTIC_INCREMENT,   /* of plastic strain */
  HYPOELASTIC_FLOW,        /* flow stress at the end of the step */
  HYPOELASTIC_EXCESS,      /* trial size over the flow stress without flow */
  HYPOELASTIC_LOWER,
  HYPOELASTIC_UPPER,        /* bracket of the increment */
  HYPOELASTIC_ACTIVE,       /* 1 while the point still iterates */
  HYPOELASTIC_OUTSIDE,      /* 1 where Newton's step left the bracket */
  HYPOELASTIC_ENERGY_KNOWN, /* energy without the work of the end pressure */
  HYPOELASTIC_SHEAR,        /* shear modulus of the step, where the strength changes it */
  HYPOELASTIC_SCRATCH_USED
};

static_assert(HYPOELASTIC_SCRATCH_USED <= HYPOELASTIC_SCRATCH,
              "hypoelastic_scratch in hypoelastic.yaml is too small");

/* The value of one of two numbers, where `mask` is 1 or 0: exact for finite numbers. Where the
 * other one is what stands in memory already, compilers turn `?:` into a conditional store and the
 * loop into a slow one. */
GAMUT_INLINE double hypoelastic_choose(double mask, double one, double other)
{
  return mask * one + (1.0 - mask) * other;
}

/* One value a step: that of its begin, at the pressure and compression of its end. */
GAMUT_INLINE const double *hypoelastic_shear(const struct hypoelastic *b)
{
  const bool changed = b->strength && b->strength->shear_modulus_factor;
  return changed ? b->scratch[HYPOELASTIC_SHEAR] : b->shear_modulus;
}

/* The volume at the end of the step; before all else. */
void hypoelastic_volume(const struct hypoelastic *);
/* The strength without flow: what yields, and the shear modulus; before the trial. */
void hypoelastic_strength(const struct hypoelastic *);
void hypoelastic_trial(const struct hypoelastic *);
void hypoelastic_return(const struct hypoelastic *);
void hypoelastic_turn(const struct hypoelastic *);
void hypoelastic_pressure(const struct hypoelastic *);
void hypoelastic_start(const struct hypoelastic *);

/* The points with active[i] > 0, ascending; returns how many. */
size_t hypoelastic_lanes(const double *active, size_t count, uint32_t *lane);

#endif
