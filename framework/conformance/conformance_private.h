/* Inside the conformance room: what the suites of all kinds share. */
#ifndef GAMUT_CONFORMANCE_PRIVATE_H
#define GAMUT_CONFORMANCE_PRIVATE_H

#include <stdint.h>

#include "bench/difference.h"
#include "bench/specimen.h"
#include "conformance/check.h"

/* One plugin under test. */
struct proof {
  struct registry *registry;
  const struct descriptor *descriptor;
  const struct units *units;
  struct checks checks;
  struct tree *known;   /* NAME.test.yaml, or null */
  struct settings base; /* parameters that the plugin accepts */
  struct slot *slot;
  size_t slots;
  uint64_t seed; /* of the draws: fixed, so that a failure can be seen again */
};

/* A trace's messages as text to be freed. */
char *trace_text(struct trace *);
/* Uniform in [0, 1). */
double draw(struct proof *);
/* A number between the ends; over a wide positive range by its logarithm. */
double draw_between(struct proof *, double lower, double upper);

/* Parameters that a plugin accepts: those of its first known answer, else its defaults and the
 * middle of its ranges. False if none was found; `why` gets the refusal. */
bool find_base(const struct descriptor *, const struct tree *known, const struct units *,
               struct settings *, char *why, size_t size);
/* Values for the parameters of a table that need one, put into the settings. */
void base_of_table(const struct descriptor *, const struct parameter *, size_t count,
                   struct settings *);
/* The range that draws of a parameter come from: its fit, else around the base value. */
void draw_range(const struct parameter *, double base, double *lower, double *upper);
/* Draws every real parameter; corner 0 draws inside, 1 takes all low ends, 2 all high ends, 3 and
 * more one parameter at an end. Refused draws are drawn again. False if no draw was accepted. */
bool draw_settings(struct proof *, size_t corner, struct specimen *);

/* Where an input or state of that name is tried. */
struct span {
  double lower, upper, step; /* step: size of a change that matters, for differences */
  const double *special;     /* degenerate values */
  size_t specials;
};
struct span span_of(const char *name);

/* The suites. Each is called after the common one, with the shared object open. */
void prove_common(struct proof *, bool based); /* based: base parameters were found */
void prove_object(struct proof *);
void prove_known_answers(struct proof *);
void prove_eos(struct proof *);
void prove_strength(struct proof *);
void prove_elasticity(struct proof *);
void prove_effect(struct proof *);
void prove_estimator(struct proof *);
void prove_random_field(struct proof *);
void prove_solver(struct proof *);

/* Runs the scene NAME.scene.yaml of the plugin's folder: ends, balances, same bits on 1, 2, 3
 * threads. */
void prove_scene(struct proof *);

/* Blocks of points with guard bands: arrays are BLOCK_ROOM long, calls use at most BLOCK_POINTS. */
enum { BLOCK_POINTS = 256, BLOCK_ROOM = BLOCK_POINTS + 24 };

/* One kernel in a bench of BLOCK_ROOM points, with the arrays of all slots. */
struct block {
  struct proof *proof;
  struct bench *bench;
  double **array; /* one a slot; null for laws and derivatives that are not offered */
  double **kept;  /* copies of the inputs */
};
bool block_new(struct block *, struct proof *, struct bench *);
void block_free(struct block *);
/* Fills every parameter and input with draws. Round 0 holds corners and degenerate states. */
void block_draw(struct block *, size_t round);
/* Fills outputs with a mark that no computation gives, statuses with 0. */
void block_mark(struct block *);
bool is_mark(double);
/* Calls a kernel; whether it left rounding, flushing and traps alone. They are put back. */
bool bench_call_kept(struct bench *, kernel_function, size_t count);

/* What a kernel must write: all outputs, or those that its task names. */
struct work {
  kernel_function function;
  const char *label;
  const struct kernel_task *task; /* null: all outputs */
  bool derivatives;               /* writes the derivative arrays instead */
  kernel_function flags;          /* whose flags excuse a value that is not finite; null: its own */
};
/* Finite or flagged, repeatable, blocks of 0, 1, 7, 256, inputs untouched, outputs written. */
void prove_work(struct block *, const struct work *);

/* Index of the first slot of that kind and name, or SIZE_MAX. */
size_t slot_named(const struct proof *, enum slot_kind, const char *name);
/* Slopes "X_slope_Y" against differences, own derivatives against differences. */
void prove_slopes(struct proof *, struct block *, kernel_function);
void prove_derivatives(struct proof *, struct block *, kernel_function);

#endif
