/* What a kernel sees: blocks, <gamut/math.h>, and the registration of a plugin. Nothing of the core
 * can be asked from here (that is <gamut/host.h>), so a source that includes no more can be
 * compiled for any processor. NAME.gamut.h of an eos, a strength or an elasticity includes this;
 * that of an effect, or of a law with `prepare`, does where GAMUT_KERNEL is defined before it, and
 * <gamut/plugin.h> elsewhere.
 *
 * Kernels are written so that a compiler for graphics processors can take them too, where a block
 * is one point: no calls but those of <gamut/math.h>, sqrt, fabs, copysign, memcpy and the laws in
 * the block; no variables that outlive a call; no recursion, no arrays whose length is not
 * constant, local ones of a few numbers or of GAMUT_CHUNK_MAX; names at file level that begin with
 * the plugin's; and what is C11 and C++20 both: no compound literals, initialisers in declared
 * order.
 */
#ifndef GAMUT_KERNEL_H
#define GAMUT_KERNEL_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/block.h>
#include <gamut/math.h>
#include <gamut/status.h>

struct gamut_run;
struct gamut_values;
struct gamut_body;

/* The number of the binary interface. It grows when a plugin built before must be rebuilt. */
#define GAMUT_ABI 2

/* X(kind in C, name in YAML) */
#define GAMUT_KIND_LIST(X)                                                                         \
  X(GAMUT_KIND_EOS, "eos")                                                                         \
  X(GAMUT_KIND_STRENGTH, "strength")                                                               \
  X(GAMUT_KIND_ELASTICITY, "elasticity")                                                           \
  X(GAMUT_KIND_EFFECT, "effect")                                                                   \
  X(GAMUT_KIND_RANDOM_FIELD, "random_field")                                                       \
  X(GAMUT_KIND_ESTIMATOR, "estimator")                                                             \
  X(GAMUT_KIND_SOLVER, "solver")

enum gamut_kind {
#define GAMUT_KIND_ENTRY(kind, name) kind,
  GAMUT_KIND_LIST(GAMUT_KIND_ENTRY)
#undef GAMUT_KIND_ENTRY
      GAMUT_KINDS
};

/* What a shared object exports. All members are constants of the plugin. */
struct gamut_plugin {
  size_t size;        /* sizeof(struct gamut_plugin) where the plugin was built */
  uint32_t abi;       /* GAMUT_ABI where it was built */
  uint32_t kind;      /* enum gamut_kind */
  const char *name;   /* "linear" */
  const char *digest; /* of the interface it was built with; a stale one is refused */
  size_t block_size;  /* sizeof(struct NAME) */
  const void *ops;    /* struct NAME_ops; its first member is its size */
};

/* Operations of each kind, as members of the generated struct NAME_ops (B is `struct NAME`). After
 * them the generated header adds prepare and release, where the descriptor says so, then one kernel
 * per entry of `variants` and of `tasks`, by name.
 * A null optional operation means the default in its comment.
 *
 * eos
 *   pressure     required. Reads compression, energy, reference_density; writes pressure,
 *                sound_speed and whatever slopes the descriptor declares.
 *   derivatives  optional. Fills NAME_by_P and NAME_by_P_Q by GAMUT_PUT (first and second
 *                derivatives of the output named under `derivatives`). Default: Richardson
 *                differences by the core.
 * strength
 *   flow_stress  required. Reads plastic_strain, plastic_strain_rate, temperature; writes
 *                flow_stress and the declared slopes.
 *   inverse      optional. The plastic strain at a given flow stress: reads the array
 *                flow_stress_given, writes plastic_strain_inverse (members added where the
 *                descriptor says `inverse: true`).
 *   derivatives  as for eos.
 * elasticity
 *   stress       required. From the state at the beginning of a step (NAME_begin, constant), the
 *                velocity gradient and the laws bound into the block to the state at its end.
 *   start        optional. The stress that belongs to the initial energy and compression; writes
 *                the end state. Default: the end state equals the beginning.
 * effect
 *   create       optional. Reads its values, asks the solver for planes. On failure returns a
 *                status after gamut_fail; *self then is not destroyed.
 *   destroy      optional. Accepts null.
 *   decline      optional. Returns true and writes the reason where the effect has nothing to do in
 *                this scene ("C = 0"); it then costs nothing.
 *   measure      optional, required if the descriptor declares measures.
 *   save, restore  optional, as of a solver: what the effect itself changes during a run. Default:
 *                nothing.
 *   Its kernels are the `tasks` of the descriptor.
 * random_field, estimator, solver: see their headers.
 *
 * Where the descriptor of an eos, strength, elasticity or effect with tasks says `prepare: true`:
 *   prepare      required. Makes what the kernels find as `data` in their blocks, of the checked
 *                values: called once whenever a material is bound (in a study in each run; of an
 *                effect for each material), on one thread. The values are borrowed for the call.
 *                Numbers that kernels see it may not ask for. May allocate. On failure returns a
 *                status after gamut_fail; what it has made then is its own to free.
 *   release      required. Frees it: once for each prepare that went well, when no kernel will be
 *                called again. Of the run nothing may be asked then.
 */
/* Each list once: members of the struct of operations, and their names. */
#define GAMUT_OPERATION(type, name, arguments) type(*name) arguments;
#define GAMUT_EOS_OPERATIONS(OP, B)                                                                \
  OP(void, pressure, (const B *))                                                                  \
  OP(void, derivatives, (const B *))
#define GAMUT_EOS_OPS(B) GAMUT_EOS_OPERATIONS(GAMUT_OPERATION, B)
#define GAMUT_STRENGTH_OPERATIONS(OP, B)                                                           \
  OP(void, flow_stress, (const B *))                                                               \
  OP(void, inverse, (const B *))                                                                   \
  OP(void, derivatives, (const B *))
#define GAMUT_STRENGTH_OPS(B) GAMUT_STRENGTH_OPERATIONS(GAMUT_OPERATION, B)
#define GAMUT_ELASTICITY_OPERATIONS(OP, B)                                                         \
  OP(void, stress, (const B *))                                                                    \
  OP(void, start, (const B *))
#define GAMUT_ELASTICITY_OPS(B) GAMUT_ELASTICITY_OPERATIONS(GAMUT_OPERATION, B)
#define GAMUT_EFFECT_OPERATIONS(OP, B)                                                             \
  OP(gamut_status, create, (struct gamut_run *, const struct gamut_values *, void **self))         \
  OP(void, destroy, (void *self))                                                                  \
  OP(bool, decline, (void *self, const struct gamut_values *, char *why, size_t size))             \
  OP(gamut_status, measure,                                                                        \
     (void *self, const char *name, const struct gamut_body *body,                                 \
      const struct gamut_values *arguments, double *value))                                        \
  OP(size_t, save, (const void *self, void *bytes))                                                \
  OP(gamut_status, restore, (void *self, const void *bytes, size_t size))
#define GAMUT_EFFECT_OPS(B) GAMUT_EFFECT_OPERATIONS(GAMUT_OPERATION, B)

/* Exports NAME_LTX_gamut_plugin. A build may put further shared objects beside NAME.so, made from
 * the same source for a richer instruction set (NAME.v3.so, NAME.v4.so); each exports the same
 * symbol and gamut opens the best one that the processor can run. */
#if defined(__GNUC__)
#define GAMUT_EXPORT __attribute__((visibility("default")))
#else
#define GAMUT_EXPORT
#endif
#define GAMUT_PLUGIN_(kind_, id, ...)                                                              \
  static const struct id##_ops id##_operations = {.size = sizeof(struct id##_ops), __VA_ARGS__};   \
  extern GAMUT_EXPORT const struct gamut_plugin id##_LTX_gamut_plugin;                             \
  GAMUT_EXPORT const struct gamut_plugin id##_LTX_gamut_plugin = {.size =                          \
                                                                      sizeof(struct gamut_plugin), \
                                                                  .abi = GAMUT_ABI,                \
                                                                  .kind = (kind_),                 \
                                                                  .name = #id,                     \
                                                                  .digest = id##_digest,           \
                                                                  .block_size = sizeof(struct id), \
                                                                  .ops = &id##_operations};

#define GAMUT_EOS(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_EOS, id, __VA_ARGS__)
#define GAMUT_STRENGTH(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_STRENGTH, id, __VA_ARGS__)
#define GAMUT_ELASTICITY(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_ELASTICITY, id, __VA_ARGS__)
#define GAMUT_EFFECT(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_EFFECT, id, __VA_ARGS__)
#define GAMUT_RANDOM_FIELD(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_RANDOM_FIELD, id, __VA_ARGS__)
#define GAMUT_ESTIMATOR(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_ESTIMATOR, id, __VA_ARGS__)
#define GAMUT_SOLVER(id, ...) GAMUT_PLUGIN_(GAMUT_KIND_SOLVER, id, __VA_ARGS__)

#endif
