/* The bar's inside, shared by its files. Names follow the theory (docs/theory/gamut_bar.md); arrays
 * have one value a bond. SI throughout.
 *
 *   strain   = stress / E + w pi               pi: plastic strain of each family
 *   internal = w (E strain)                    T: nonlocal average of the bonds' elastic stresses
 *   s + E~ pi(s) = T,  E~ = w E                s: stress of the family on the law's curve */
#ifndef BAR_H
#define BAR_H

#include "gamut_bar.gamut.h"

struct bar;

/* sums.c: sums in a fixed order, whatever the threads. */

double sum_of_products(size_t count, const double *x, const double *y);
double largest(size_t count, const double *x); /* of absolute values; NaN if one is NaN */

/* operator_dense.c, operator_interpolated.c: y = G x, G the symmetric pair kernel. */

struct pair_kernel {
  void (*apply)(const void *self, const double *x, double *y);
  void *self;
};
/* Rows of every bond's reach. `noise` (may be null): factor 1 + noise of pair p < q, row by row. */
gamut_status dense_new(struct bar *, const double *noise, struct pair_kernel *);
/* Cubic interpolation between coarse nodes: memory and work grow with the bonds, not their square.
 */
gamut_status interpolated_new(struct bar *, struct pair_kernel *);

/* family.c: stresses of the families with Masing memory. */

enum { FAMILY_CHUNK = 512 };

/* One chunk of families: the law with arrays of its own. */
struct family_law {
  struct gamut_law *law;
  size_t from, count;              /* bonds */
  double *given, *inverse;         /* stress in, plastic strain out */
  double *strain, *flow, *slope;   /* plastic strain in, flow stress and slope out */
  double *modulus, *yield, *n, *K; /* of ramberg_osgood; null where the law has none */
};

struct families {
  size_t depth; /* of the stacks */
  struct family_law *law;
  size_t laws;
  double *turn[3];      /* reversal points: T, s, pi; [level * bonds + bond] */
  unsigned char *count; /* how many each family remembers */
  double *internal, *stress, *plastic, *direction; /* as committed */
  /* of the last evaluation */
  double *trial_stress, *trial_plastic, *trial_slope;
  unsigned char *trial_count, *below; /* turns that count; those below the turn under way */
};

gamut_status families_new(struct bar *, size_t depth);
gamut_status families_start(struct bar *);
/* Stress, plastic strain and d(plastic strain)/dT at these T, from what is remembered. */
gamut_status families_evaluate(struct bar *, const double *internal);
/* Remembers the last evaluation, which was at these T. */
gamut_status families_commit(struct bar *, const double *internal);

/* load.c: the path of the force. */

enum { LEVELS_MAX = 64 };

struct load {
  enum gamut_bar_load kind;
  double reference, growth, strain_limit, stress_limit;
  long rung;                                              /* monotonic: of the step to come */
  long levels, cycles, increments, level, leg, increment; /* cyclic */
  double from;                                            /* stress at which the leg began */
  const double *row;                                      /* table: step, stress */
  size_t rows;
  uint64_t step;
  bool tip; /* the step under way ends at a positive tip or on a rung */
  bool ended;
};

gamut_status load_new(struct bar *);
/* The stress to go to next; false where the path ends. */
bool load_next(struct bar *, double *stress);
/* After a step: where the path stands. */
void load_stepped(struct bar *);

struct level {
  double stress, strain; /* amplitudes, at the tensile tip */
};

struct loop {
  double area, last_tip_strain, energy, closure;
  bool begun, closed;
};

struct rupture {
  bool broken;
  size_t bond;
  double stress, strain;
};

struct bar {
  struct gamut_run *run;
  const struct gamut_values *values;
  const struct gamut_body *body;
  struct gamut_set *set;
  size_t bonds;
  int threads;
  double span, area, density;            /* length of the bar, its mean area, of the scene */
  double modulus;                        /* Young's, nominal */
  double yield, n, K;                    /* of ramberg_osgood; n is NaN for other laws */
  double failure_stress, failure_strain; /* NaN where not known */
  bool random;                           /* some noise is given */
  size_t redraws, clipped;               /* random grids thrown away; noises kept within bounds */

  /* per bond */
  double *length, *place, *section, *volume; /* place: of the midpoint */
  double *stiffness;                         /* E */
  double *mass_density;
  double *softness;     /* R at failure */
  double *yield_factor; /* kappa */
  double *limit;        /* strain at which the family breaks */
  double *spread;       /* standard deviation of its weights, m */
  double *scale;        /* a of the symmetric Sinkhorn scaling */
  double *root;         /* a sqrt(V) */
  double *softening;    /* E~ = w E */
  struct pair_kernel kernel;
  const char *operator_name;
  size_t scalings;
  struct families families;
  struct load load;

  /* state */
  double *internal, *flow, *stress, *strain; /* T, w pi, sigma, eps */
  double force;
  double next_stress;                 /* nominal, where the step under way goes */
  double mean_strain, nominal_stress; /* of the bar: lengthening and force over its mean area */
  struct level level[LEVELS_MAX];
  size_t levels;
  struct loop loop;
  struct rupture rupture;
  size_t saturated, newton, iterations;

  /* dynamics */
  bool dynamic;
  double time_step;
  double *node_mass, *old_strain, *older_strain, *factor, *right;

  /* work space */
  double *work[12];
  double *old_stress;
  struct display *display;
  struct gamut_field position;
  double *supplied, *stored, *lost, *damped; /* ledger */
};

double *bar_array(struct bar *, const char *label); /* one value a bond; null: failed */

/* grid.c */
gamut_status grid_new(struct bar *);
/* softness.c: E, R, kappa, failure strains from the nominal values and the noise. */
gamut_status softness_new(struct bar *);
/* weights.c */
gamut_status weights_new(struct bar *);
void weights_apply(const struct bar *, const double *x, double *y, double *work); /* y = w x */
/* y = V^1/2 w V^-1/2 x */
void weights_apply_symmetric(const struct bar *, const double *x, double *y, double *work);
/* noise.c: values of a noise the scene names; *given false where it names none. */
gamut_status noise_of_bonds(struct bar *, const char *name, double *value, bool *given);
gamut_status noise_of_pairs(struct bar *, double **value, bool *given);
/* conjugate_gradients.c: (1 - w Q w C) x = right, with Q = E or its dynamic counterpart. Overwrites
 * right. */
gamut_status solve_tangent(struct bar *, const double *slope, double *right, double *x);
/* equilibrium.c: brings the bar to the force. */
gamut_status equilibrium(struct bar *, double force);
/* inertia.c */
gamut_status inertia_new(struct bar *);
void inertia_begin(struct bar *, double force);
void inertia_stress(struct bar *, const double *flow, double *stress);
void inertia_apply(struct bar *, const double *x, double *y); /* y = Q x, symmetric scaling */
void inertia_commit(struct bar *);
/* rupture.c */
void bonds_look(struct bar *);
double bond_state(const struct bar *, size_t bond); /* 0 active, 1 saturated, 2 broken */
/* ledger.c */
gamut_status ledger_new(struct bar *);
/* Between equilibrium and families_commit. */
void ledger_step(struct bar *, double old_force, double old_strain);
/* measures.c */
gamut_status measure_bar(void *self, const char *name, const struct gamut_body *,
                         const struct gamut_values *arguments, double *value);
/* gamuts.c: deformation-gamuts, J/m3; NaN for laws other than Ramberg and Osgood's. */
double nonlocal_gamut(const struct bar *, size_t bond);
double local_gamut(const struct bar *, size_t bond);
/* bond_fields.c: fields at points. */
gamut_status show_new(struct bar *);
void show_start(struct bar *);
void show_positions(struct bar *);

#endif
