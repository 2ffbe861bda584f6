/* Binds the kernels of a material to blocks of points: parameters as arrays, callees, state pairs,
 * variants, statuses. */
#ifndef GAMUT_MATERIAL_ROOM_H
#define GAMUT_MATERIAL_ROOM_H

#include <gamut/plugin.h>

#include "descriptor/descriptor.h"
#include "error/error.h"
#include "field/field.h"
#include "registry/registry.h"
#include "scene/scene.h"

/* A kernel's operations as the core calls them. */
typedef void (*kernel_function)(const void *block);

/* One plugin instance made ready: its shared object open, its parameters as uniform arrays of `size`
 * values, its chosen variant. Shared by all threads, read-only in a step. */
struct kernel;
gamut_status kernel_new(const struct instance *, struct registry *, struct arena *, size_t size,
                        const struct values *material_extra, double density, struct trace *,
                        struct kernel **);
void kernel_free(struct kernel *);
const struct descriptor *kernel_descriptor(const struct kernel *);
const struct gamut_plugin *kernel_plugin(const struct kernel *);
/* The variant in force and the reason, for explain; "" if none. */
const char *kernel_variant(const struct kernel *);
/* Operation by number in the generated struct NAME_ops (0: first of the kind). Null if not given. */
kernel_function kernel_operation(const struct kernel *, size_t number);
/* Operation of a task or variant by its name. */
kernel_function kernel_named(const struct kernel *, const char *name);

/* ---- one kernel alone: eval and conformance ---------------------------------------------------- */

/* A block with arrays of its own for `count` points: every parameter, input, output, state and scratch
 * array can be set and read by name. Laws that an elasticity kernel wants are bound from `eos` and
 * `strength` (may be null). */
struct bench;
gamut_status bench_new(const struct kernel *, const struct kernel *eos,
                       const struct kernel *strength, size_t count, struct trace *, struct bench **);
void bench_free(struct bench *);
/* Array of a slot by name ("energy", "stress_xx", "plastic_strain_begin", "pressure_by_C0"); null if
 * the kernel has none. */
double *bench_array(struct bench *, const char *name);
int64_t *bench_status(struct bench *);
/* Offers (or withdraws) the derivative arrays. */
void bench_offer_derivatives(struct bench *, bool offer);
/* Calls an operation on the first `count` points. */
void bench_call(struct bench *, kernel_function, size_t count);
/* First and second derivatives of the plugin's `derivatives: of` output by its real parameters (and
 * reference_density): its own kernel's, or Richardson differences where it has none (or `differences`
 * is true). value[by], second[by * n + other]. */
gamut_status bench_derivatives(struct bench *, size_t point, bool differences, double *first,
                               double *second);

/* ---- a material in a run ----------------------------------------------------------------------- */

struct bound_material;
gamut_status material_new(const struct material *, struct registry *, struct arena *,
                          struct fields *, size_t chunk, int threads, struct trace *,
                          struct bound_material **);
void material_free(struct bound_material *);
/* What the material's task reads and writes; for the scheduler. */
const struct gamut_use *material_uses(const struct bound_material *, size_t *count);
/* State at the end from the state at the beginning. Any thread. Merges statuses. */
gamut_status material_update(struct bound_material *, const struct gamut_chunk *);
/* Fills the initial state of all points of a set; energy from pressure where the body asks. */
gamut_status material_start(struct bound_material *, struct point_set *, const struct gamut_body *,
                            struct trace *);
const struct kernel *material_kernel(const struct bound_material *, enum gamut_kind);

/* An effect's kernels bound the same way: one call a task. */
struct bound_kernel;
gamut_status bound_new(const struct kernel *const *by_material, size_t materials, struct arena *,
                       struct fields *, int threads, struct trace *, struct bound_kernel **);
void bound_free(struct bound_kernel *);
gamut_status bound_call(struct bound_kernel *, size_t material, const char *task,
                        const struct gamut_chunk *);

/* ---- messages of points ------------------------------------------------------------------------ */

/* Counts of what kernels flagged, kept per thread and summed in order. The first stop of a step (by
 * set, then point id) is kept with its point. */
struct flags;
struct flag_report {
  const struct descriptor *plugin; const struct message *message;
  uint64_t count; const char *material;
};
struct flag_stop { const struct descriptor *plugin; const struct message *message;
                   size_t set; int64_t id; size_t slot; };
size_t material_flags(const struct bound_material *, struct flag_report *, size_t capacity);
/* Whether some point demanded a stop since the last call; fills the worst (lowest set, id). */
bool material_stopped(struct bound_material *, struct flag_stop *);

#endif
