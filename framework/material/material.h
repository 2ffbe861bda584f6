/* Binds the kernels of a material to blocks of points: parameters as arrays, callees, state pairs,
 * variants, statuses. */
#ifndef GAMUT_MATERIAL_ROOM_H
#define GAMUT_MATERIAL_ROOM_H

#include <gamut/plugin.h>

#include "base/error.h"
#include "descriptor/descriptor.h"
#include "field/field.h"
#include "registry/registry.h"
#include "scene/scene.h"
#include "schedule/schedule.h"

/* A kernel's operations as the core calls them. */
typedef void (*kernel_function)(const void *block);

/* One plugin instance made ready: its shared object open, its parameters as uniform arrays of
 * `size` values, its data prepared, its chosen variant. Shared by all threads, read-only in a step.
 * The run is what its `prepare` is handed; the instance's values must have their host. */
struct kernel;
gamut_status kernel_new(const struct instance *, struct registry *, struct arena *, size_t size,
                        const struct values *material_extra, double density, struct gamut_run *,
                        struct trace *, struct kernel **);
/* Calls a law (eos or strength) on a few points: it must write all its outputs and nothing else,
 * not depend on a point's company, and its slopes must be those of its results. GAMUT_PLUGIN if
 * not, or where it changes the processor's arithmetic. Its inverse likewise, but for the slopes. */
gamut_status kernel_try(const struct kernel *, struct trace *);
void kernel_free(struct kernel *);
const struct descriptor *kernel_descriptor(const struct kernel *);
const struct gamut_plugin *kernel_plugin(const struct kernel *);
/* The variant in force and the reason, for explain; "" if none. */
const char *kernel_variant(const struct kernel *);
/* Operation by number in the generated struct NAME_ops (0: first of the kind). Null if not given.
 */
kernel_function kernel_operation(const struct kernel *, size_t number);
/* Operation by its name: that of a task or variant too. */
kernel_function kernel_named(const struct kernel *, const char *name);
/* The message of a point's status word, or null; and its severity (GAMUT_FINE for 0). */
const struct message *status_message(const struct descriptor *, int64_t status);
enum gamut_severity status_severity(int64_t status);

/* One kernel alone: eval and conformance. */

/* A block with arrays of its own for `count` points: every parameter, input, output, state and
 * scratch array can be set and read by name. Laws that an elasticity kernel wants are bound from
 * `eos` and `strength` (may be null). */
struct bench;
gamut_status bench_new(const struct kernel *, const struct kernel *eos,
                       const struct kernel *strength, size_t count, struct trace *,
                       struct bench **);
void bench_free(struct bench *);
/* Array of a slot by name ("energy", "stress_xx", "plastic_strain_begin", "pressure_by_C0"); null
 * if the kernel has none. */
double *bench_array(struct bench *, const char *name);
int64_t *bench_status(struct bench *);
/* Offers (or withdraws) the derivative arrays. */
void bench_offer_derivatives(struct bench *, bool offer);
/* Calls an operation on the first `count` points. */
void bench_call(struct bench *, kernel_function, size_t count);
/* First and second derivatives of the plugin's `derivatives: of` output by its real parameters (and
 * reference_density): its own kernel's, or Richardson differences where it has none (or
 * `differences` is true). value[by], second[by * n + other]. */
gamut_status bench_derivatives(struct bench *, size_t point, bool differences, double *first,
                               double *second);

/* A material in a run. */

struct bound_material;
/* Binds the material's laws, declares its fields among `fields` and makes blocks for `threads`
 * threads. */
gamut_status material_new(const struct material *, struct gamut_run *, struct registry *,
                          struct arena *, struct fields *, size_t chunk, int threads,
                          struct trace *, struct bound_material **);
void material_free(struct bound_material *);
/* What the material's task reads and writes; for the scheduler. Borrowed. */
const struct gamut_use *material_uses(const struct bound_material *, size_t *count);
/* What the task offers to read and write, by number; null past the last. See schedule_offer.
 * Borrowed. */
const struct gamut_use *material_offers(const struct bound_material *, size_t number,
                                        size_t *count);
/* After planning: what the task of the material on one set reads where, by what the plan says. */
void material_resolve(struct bound_material *, const struct task *, const struct fields *);
/* The first point of a chunk whose flow_stress_factor is no factor (negative, no number), and that
 * number; SIZE_MAX: all are. */
size_t material_bad_factor(const struct bound_material *, const struct gamut_chunk *,
                           double *factor);
/* State at the end of the step from the state at its beginning. Any thread. Repeatable. */
void material_update(struct bound_material *, const struct gamut_chunk *);
/* Counts what the last update of this chunk flagged. Once a step and chunk. */
void material_tally(struct bound_material *, const struct gamut_chunk *);
/* The smallest `step_factor` that a point's elasticity gave since the last call: the next step may
 * be at most so many times this one. Infinity where none is given. */
double material_step_factor(struct bound_material *);
/* At how many points its strength or its eos was evaluated so far. */
uint64_t material_evaluations(const struct bound_material *, enum gamut_kind);
/* Fills temperature and energy of a set's points from its body; energy from pressure where the body
 * gives that (Newton on the eos at zero compression). */
gamut_status material_initial(struct bound_material *, struct point_set *,
                              const struct gamut_body *, struct trace *);
/* The state that belongs to these: the elasticity's `start`. Writes the end of the chunk. */
void material_start(struct bound_material *, const struct gamut_chunk *);
const struct kernel *material_kernel(const struct bound_material *, enum gamut_kind);

/* An effect's kernels bound the same way. by_material[m] holds the kernel with the parameters of
 * material m. */
struct bound_effect;
gamut_status effect_new(const struct kernel *const *by_material, size_t materials, struct arena *,
                        struct fields *, int threads, struct trace *, struct bound_effect **);
void effect_free(struct bound_effect *);
/* What a task of the descriptor reads and writes. Owned by the bound effect. */
const struct gamut_use *effect_uses(struct bound_effect *, size_t task, size_t *count);
/* After planning: whether reads mean the beginning or the end of the step. */
void effect_resolve(struct bound_effect *, size_t task, const struct task *);
void effect_call(struct bound_effect *, size_t task, size_t material, const struct gamut_chunk *);

/* Messages of points. */

/* Counts of what kernels flagged, summed over threads. */
struct flag_report {
  const struct descriptor *plugin;
  const struct message *message;
  uint64_t count;
};
/* A point that may not go on: the lowest by (set, id) since the last call. */
struct flag_stop {
  const struct descriptor *plugin;
  const struct message *message;
  size_t set;
  int64_t id;
};
/* Report `index` with a count above zero; false past the end. */
bool material_flag(const struct bound_material *, size_t index, struct flag_report *);
bool material_stopped(struct bound_material *, struct flag_stop *);
bool effect_flag(const struct bound_effect *, size_t index, struct flag_report *);
bool effect_stopped(struct bound_effect *, struct flag_stop *);

/* Points that a kernel stops may leave the run instead: their mark goes into the component of the
 * field `removal`. */
struct spare {
  size_t component;
  double *mark; /* one a set; 0: there the run stops. Null: everywhere */
};
/* Borrowed. */
void material_spare(struct bound_material *, const struct spare *);
void effect_spare(struct bound_effect *, const struct spare *);

/* For checkpoints: the counts so far, and going on from those of another run. */
enum { FLAG_COUNTS = 64, MATERIAL_COUNTS = 3 * FLAG_COUNTS };
void material_counts(const struct bound_material *, int64_t count[MATERIAL_COUNTS]);
void material_go_on(struct bound_material *, const int64_t count[MATERIAL_COUNTS]);
void effect_counts(const struct bound_effect *, int64_t count[FLAG_COUNTS]);
void effect_go_on(struct bound_effect *, const int64_t count[FLAG_COUNTS]);
/* Gives back what material_step_factor took. */
void material_step_factor_keep(struct bound_material *, double factor);

#endif
