/* Solvers: they advance bodies in time or load.
 *
 * The core drives. It calls create (the solver lays out points and registers fields and tasks),
 * plans the run (which tasks are live, in which order, which fields are stored), allocates, calls
 * start, then for each step: next (how long may it be), every live task in order, after (sums,
 * ledger). */
#ifndef GAMUT_SOLVER_H
#define GAMUT_SOLVER_H

#include <gamut/host.h>

#define GAMUT_SOLVER_OPERATIONS(OP, B)                                                             \
  /* required. Reads its values and the bodies, makes sets, registers fields, tasks, ledger lines. \
   * On failure returns a status after gamut_fail and leaves nothing behind. */                    \
  OP(gamut_status, create, (struct gamut_run *, const struct gamut_values *, void **self))         \
  /* required. Accepts null. */                                                                    \
  OP(void, destroy, (void *self))                                                                  \
  /* required. Fields exist: set positions, masses, velocities; arrange; gamut start_material. */  \
  OP(gamut_status, start, (void *self))                                                            \
  /* required. The step to take from here: in, `*step` is the longest that the end of the run      \
   * allows; out, the one to take (smaller or equal); 0 ends the run here. */                      \
  OP(gamut_status, next, (void *self, double *step))                                               \
  /* optional. After the last task of a step: check what can go wrong, keep the ledger. */         \
  OP(gamut_status, after, (void *self))                                                            \
  /* optional: required by effects that ask for planes. Called while effects are created. */       \
  OP(gamut_status, plane,                                                                          \
     (void *self, const struct gamut_plane *, const struct gamut_reaction **reaction))             \
  /* optional, required if the descriptor declares measures without a formula. `body` is null for  \
   * measures `at: run`; `arguments` are those the descriptor declares. Called between steps. */   \
  OP(gamut_status, measure,                                                                        \
     (void *self, const char *name, const struct gamut_body *body,                                 \
      const struct gamut_values *arguments, double *value))                                        \
  /* optional. Writes the longest step the present state allows and what limits it, for explain.   \
   */                                                                                              \
  OP(gamut_status, describe, (void *self, double *step, char *text, size_t size))                  \
  /* optional: without it a run cannot be stopped and gone on with. The private state between two  \
   * steps as bytes; called with null bytes to learn the size. The core keeps the stored fields,   \
   * slots, blocks, ids, ledger lines and histories: only what `start` would not make again from   \
   * these is due here. No pointers. */                                                            \
  OP(size_t, save, (const void *self, void *bytes))                                                \
  /* optional, with save. Makes a solver that has just started from the same scene, whose sets and \
   * stored fields already stand as they were, go on where the saved one stood: to the same bits,  \
   * with any number of threads. On failure returns a status after gamut_fail. */                  \
  OP(gamut_status, restore, (void *self, const void *bytes, size_t size))                          \
  /* optional: required by effects that ask for removal. `name` is for the ledger; on_body[i] says \
   * whether points of body i may go. Both outlive the solver. Called while effects are created.   \
   */                                                                                              \
  OP(gamut_status, removal,                                                                        \
     (void *self, const char *name, const bool *on_body, const struct gamut_removal *,             \
      const struct gamut_removed **, double *mark))                                                \
  /* optional: required by effects that take a pass over the grid; see struct gamut_grid_pass. */  \
  OP(gamut_status, grid_pass, (void *self, const struct gamut_grid_pass *pass))
#define GAMUT_SOLVER_OPS(B) GAMUT_SOLVER_OPERATIONS(GAMUT_OPERATION, B)

#endif
