/* What a solver, effect, estimator or random field may ask of the core.
 *
 * Every function here is an inline call through the table `gamut_host` that the core hands over, so
 * a plugin has no symbol to resolve. All are called from one thread, before the first step or
 * between steps, unless a comment says otherwise. Objects belong to the run; a plugin frees none of
 * them.
 */
#ifndef GAMUT_HOST_H
#define GAMUT_HOST_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/block.h>
#include <gamut/status.h>

struct gamut_run; /* one run of one scene */
/* The checked values of one plugin's parameters, or of a measure's arguments. */
struct gamut_values;
struct gamut_body; /* a body of the scene */

/* The points of one body and material. Read-only for plugins; the core keeps it current. Points are
 * cut into blocks: block b holds slots first[b] to first[b+1]-1, a multiple of GAMUT_LANES. Slots
 * at the end of a block that hold no point are padding: copies of the block's last point with zero
 * mass and id -1. Points may leave (see removal); a set may come to hold none. */
struct gamut_set {
  const char *body;    /* name of its body, borrowed from the scene */
  size_t index;        /* number of the set, in the order of the scene's bodies */
  size_t points;       /* real points */
  size_t slots;        /* points and padding */
  size_t blocks;       /* blocks; 0 until gamut_arrange */
  const size_t *first; /* blocks + 1 entries */
  const int64_t *id;   /* one a slot: the point's id for its whole life; -1 for padding */
};

/* Where a field lives. */
enum gamut_where {
  GAMUT_AT_POINT,    /* one value a point of every set */
  GAMUT_AT_MATERIAL, /* one value a material, seen by kernels as an array */
  GAMUT_AT_RUN,      /* one value a run (time_step), seen by kernels as an array */
  GAMUT_AT_SOLVER    /* kept by the solver (nodes, bonds, pairs); the core knows its name only */
};

/* A handle to a field: components first to first + components - 1 of a chunk's tables. */
struct gamut_field {
  uint32_t first;
  uint32_t components;
};

/* A run of points of one block, as a point task gets it. The pointers in `begin` and `end` lead to
 * `count` values of a field's component at the beginning and at the end of the step. For a field
 * without history they are the same. Padding points are part of the chunk. A task may use them only
 * during its call. */
struct gamut_chunk {
  const struct gamut_set *set;
  size_t block;         /* number of the block within its set */
  size_t serial;        /* number of the block over all sets; no order of summation: see `sum` */
  size_t slot;          /* first slot of the chunk */
  size_t count;         /* points, a multiple of GAMUT_LANES */
  int thread;           /* 0 to threads - 1 */
  double *const *begin; /* one pointer a component, by gamut_field.first */
  double *const *end;
};

static inline double *gamut_begin(const struct gamut_chunk *c, struct gamut_field f, unsigned k)
{
  return c->begin[f.first + k];
}
static inline double *gamut_end(const struct gamut_chunk *c, struct gamut_field f, unsigned k)
{
  return c->end[f.first + k];
}

enum gamut_access {
  GAMUT_READ_BEGIN, /* the value at the beginning of the step (or the only one); refused where it
                       is overwritten before the task runs: of a state from the sweep on that comes
                       after its writer's */
  GAMUT_READ,       /* the value at the end, after every task of this step that writes it; where all
                       of these come in later phases, what the step before left */
  GAMUT_READ_IF,    /* as GAMUT_READ, if somebody writes it; else the chunk's pointer is null */
  GAMUT_WRITE,      /* sets it */
  GAMUT_ADD,        /* adds to it; the core clears it before the first task that adds */
  GAMUT_READ_LAST,  /* the value that the step before left (a stored field without history) */
  GAMUT_SCALE,      /* multiplies it; the core sets it to 1 before the first task that scales */
  GAMUT_LEAST       /* lowers it to the lesser of two numbers; the core sets it to infinity before
                       the first task that lowers */
};
/* GAMUT_ADD, GAMUT_SCALE and GAMUT_LEAST are shared: several tasks may change one field in a step,
 * all by the same access, and only tasks GAMUT_PER_CHUNK. They work in the order of the phases, in
 * one phase in the order of the scene's effects. So a product or sum of two has the same bits in
 * either order, of three or more those of the scene's order; the least has them in any. */
struct gamut_use {
  const char *field;
  enum gamut_access access;
};

enum gamut_extent {
  GAMUT_PER_CHUNK,   /* called for every chunk of points, by any thread, in any order of blocks */
  GAMUT_OPEN_BLOCK,  /* called once a block before its first chunk (chunk.count is 0) */
  GAMUT_CLOSE_BLOCK, /* called once a block after its last chunk (chunk.count is 0) */
  GAMUT_ONCE /* called once a step by one thread, with a null chunk; may use OpenMP itself */
};

/* One pass over the grid: a service of solvers that have one and provide `grid`. Each node takes
 * the mean of the points around it, x_i = sum w (a N_i + q . grad N_i) / sum w N_i, and each point
 * takes back the value sum x_i N_i and the gradient sum x_i grad N_i at its place. So heat
 * conduction is two passes: one gives the gradient of the temperature (w the heat capacity, a the
 * temperature), one takes the flux over capacity as q and gives the rate of the temperature.
 *
 * One struct a set, in the order of the scene's bodies; arrays have a number a slot, as stored
 * fields do, and may be those of a state. A set without weight takes no part. */
struct gamut_grid_pass {
  const double *weight;  /* w, not negative; null: no points of this set */
  const double *value;   /* a; null: 0 */
  const double *flux[3]; /* q by component, those that the geometry lacks are not read; null: 0 */
  double *result;        /* value at the points; null: not wanted */
  double *gradient[3];   /* by component, 0 along axes that the geometry lacks; null: not wanted */
};

/* One piece of work of a step. The struct and what it points to is copied.
 * `run` returns GAMUT_OK or a status after gamut_fail; several threads may be in it at once. */
struct gamut_task {
  const char *name;  /* for people: "gather" */
  const char *phase; /* one of the phases that the solver's descriptor lists, in order */
  enum gamut_extent extent;
  const struct gamut_use *uses;
  size_t use_count;
  bool essential; /* true: always live. false: live if a live task reads what it writes */
  bool material; /* calls gamut update_material: the core adds what the material reads and writes */
  gamut_status (*run)(void *self, const struct gamut_chunk *chunk);
  void *self; /* borrowed */
  const struct gamut_use *offers; /* not copied: further uses, all of them taken if a live task
                                     writes the field of the first, which says READ_IF */
  size_t offer_count;
};

/* Planes: a service of solvers that effects ask for. */

/* What a plane does with one component of the velocity (component 0 is along the normal, 1 and 2
 * are tangential). */
enum gamut_plane_rule { GAMUT_PLANE_FREE, GAMUT_PLANE_MIRROR, GAMUT_PLANE_PRESCRIBED };

struct gamut_plane {
  double point[3];
  double normal[3]; /* unit, pointing to where material may be */
  enum gamut_plane_rule normal_rule;
  enum gamut_plane_rule tangential_rule;
  double velocity[3]; /* of the plane, in space; the prescribed one */
  bool unilateral;    /* true: material may leave the plane (a wall) */
  double friction;    /* Coulomb's coefficient, where unilateral */
};

/* What a plane did, summed over the step just taken. Written by the solver, in a fixed order. */
struct gamut_reaction {
  double force[3];   /* on the plane by the material, averaged over the step, N (per metre or
                        radian as the geometry has it) */
  double work;       /* done by the plane on the material since the start, J */
  double area;       /* in contact, m2 */
  double impulse[3]; /* on the plane by the material since the start, N s */
};

/* Removal: a service of solvers that let points leave the run. */

/* What may go. An effect that asks for removal gets a mark. It takes a point out by writing the
 * mark into the field `removal` (GAMUT_ADD, and only where that is still 0) in a phase before the
 * solver puts points on its grid. The point is gone at the end of that step: nothing of it stays,
 * and what it had is booked in the ledger under the effect's name. */
struct gamut_removal {
  bool flagged;  /* points at which a kernel says "stop" go as well; the run does not stop */
  bool lost;     /* so do points that the solver cannot place, or whose state is no number */
  bool expected; /* that material leaves is what the scene is made for: no warning */
  double most;   /* largest share of a body's mass at the start; beyond it the run stops. 0: all */
};

/* What one effect took since the start. Written by the solver after every step, in fixed order. */
struct gamut_removed {
  double points, mass, momentum[3], kinetic, internal;
};

/* An account balances: sum(stored now) - sum(stored at start) = sum(supplied) - sum(lost). The core
 * reports each entry and the residual; a residual beyond 1e-10 of the account's scale is a fault of
 * the bookkeeping, stored energy grown beyond what was supplied is an instability (exit 5). */
enum gamut_ledger_role { GAMUT_STORED, GAMUT_SUPPLIED, GAMUT_LOST };

/* Random numbers. */

/* Counter-based stream of random numbers (Philox): the same (seed, realisation, name, index) gives
 * the same number on any machine and thread, in any order. Copy it freely; change realisation at
 * will. */
struct gamut_stream {
  uint64_t seed, realisation;
  uint64_t name; /* hash of what it is for: a parameter's scene path */
  double (*normal)(const struct gamut_stream *, uint64_t index);  /* mean 0, variance 1 */
  double (*uniform)(const struct gamut_stream *, uint64_t index); /* between 0 and 1, neither */
};

/* A strength or eos of a body's material with arrays of the solver's own: its parameters, inputs
 * and outputs by name, each `count` values (see the law's descriptor). For solvers that do not
 * update materials by an elasticity. */
struct gamut_law;

/* Arithmetic that a scene gives for a parameter. */
struct gamut_formula;

struct gamut_host {
  size_t size; /* sizeof(struct gamut_host) of the core; members are only ever added at the end */

  /* Records an error for people and returns `status`. Thread-safe. */
  gamut_status (*fail)(struct gamut_run *, gamut_status status, const char *format, ...);
  /* As fail, naming the place in the scene of the value at `path` (dotted), or of another key that
   * stands there, such as a body's `material`; "" is the whole, "curve.3" the fourth row of a
   * table. `fail` names the effect, the quantity, the random field or the solver that is at work.
   */
  gamut_status (*fail_at)(struct gamut_run *, const struct gamut_values *, const char *path,
                          const char *expected, const char *format, ...);
  /* Records a warning: printed, and kept in the results. */
  void (*warn)(struct gamut_run *, const char *format, ...);

  /* Values by dotted path ("transfer.pic"), SI. The path must be declared in the descriptor with
   * that type; asking for another is a fault of the plugin and ends the program. Borrowed. */
  bool (*given)(const struct gamut_values *, const char *path); /* in the scene, not by default */
  double (*real)(const struct gamut_values *, const char *path);
  /* Also of a choice: its number in the descriptor, -1 where there is none; of an entry of a map,
   * which an argument of a measure names: its number. */
  long (*integer)(const struct gamut_values *, const char *path);
  bool (*boolean)(const struct gamut_values *, const char *path);
  const char *(*text)(const struct gamut_values *, const char *path); /* also choice, body, file */
  const double *(*vector)(const struct gamut_values *, const char *path, size_t *count);
  /* A table parameter: `rows` rows of as many columns as were declared, row by row. */
  const double *(*table)(const struct gamut_values *, const char *path, size_t *rows);

  /* Bodies, in the order of the scene. */
  size_t (*bodies)(const struct gamut_run *);
  const struct gamut_body *(*body)(const struct gamut_run *, size_t index);
  const char *(*body_name)(const struct gamut_body *);
  /* The solver's own parameters of a body (`body_parameters` in its descriptor). */
  const struct gamut_values *(*body_values)(const struct gamut_body *);
  /* Box around the body's shape; false if the body has no shape. */
  bool (*body_bounds)(const struct gamut_body *, double lower[3], double upper[3]);
  bool (*body_contains)(const struct gamut_body *, const double x[3]);
  /* Initial velocity at x, m/s. */
  void (*body_velocity)(const struct gamut_body *, const double x[3], double v[3]);
  /* Reference density, kg/m3. */
  double (*body_density)(const struct gamut_run *, const struct gamut_body *);

  /* Makes the set of a body with room for `points` points (padding is added by gamut_arrange).
   * Called in create, once a body; the arrays exist after the core has planned the run. */
  gamut_status (*points)(struct gamut_run *, const struct gamut_body *, size_t points,
                         struct gamut_set **set);
  /* Handle of a field by its name in the catalogue or in a loaded descriptor. */
  gamut_status (*field)(struct gamut_run *, const char *name, struct gamut_field *field);
  /* A field's stored array of a set, by component; null where this scene does not store it. */
  double *(*stored)(const struct gamut_set *, struct gamut_field, unsigned component);
  /* Rearranges all stored fields: new slot s takes what was in slot source[s]; a source with its
   * top bit set is padding (a copy with zero mass). `first` holds blocks + 1 slot numbers. Both
   * copied. */
  gamut_status (*arrange)(struct gamut_run *, struct gamut_set *, const uint32_t *source,
                          size_t slots, const size_t *first, size_t blocks);
  /* Fills the state of the set's points at t = 0: material parameters, temperature, energy, and the
   * stress that belongs to them. After the solver has set positions and masses. */
  gamut_status (*start_material)(struct gamut_run *, struct gamut_set *);
  /* Updates the material of a chunk: state at the end from the state at the beginning and the
   * fields written so far. Repeatable. Any thread. For solvers that iterate on it (their task says
   * `material`). For a solver whose phases include "material" the core's own task in that phase
   * does it. */
  gamut_status (*update_material)(struct gamut_run *, const struct gamut_chunk *);
  /* Registers a task. In create only. */
  gamut_status (*task)(struct gamut_run *, const struct gamut_task *);
  /* Sets a GAMUT_AT_RUN field (cell_size, or time_step by the core itself). */
  void (*set_uniform)(struct gamut_run *, struct gamut_field, double value);

  /* Memory that counts: 64-byte aligned, zeroed, shown by `explain` under `label`; null and an
   * error recorded when there is none. Never in a step, but where a grid must grow. */
  void *(*allocate)(struct gamut_run *, const char *label, size_t bytes);
  void (*release)(struct gamut_run *, void *memory);

  /* Asks the run's solver for a plane. The reaction is owned by the solver, current after each
   * step. */
  gamut_status (*plane)(struct gamut_run *, const struct gamut_plane *,
                        const struct gamut_reaction **reaction);

  /* Opens a line of the ledger ("energy", "kinetic", "J"); *value is then kept current by the
   * plugin, after every step. Stored lines are compared with their value after start. */
  gamut_status (*ledger)(struct gamut_run *, const char *account, const char *name,
                         const char *unit, enum gamut_ledger_role role, double **value);

  double (*time)(const struct gamut_run *);      /* at the beginning of the step */
  double (*time_step)(const struct gamut_run *); /* of the step under way */
  uint64_t (*step)(const struct gamut_run *);
  int (*threads)(const struct gamut_run *);
  size_t (*chunk)(const struct gamut_run *); /* points a chunk, a multiple of GAMUT_LANES */

  /* Exact volume of the body's shape in a space of so many axes (per unit of those it lacks), or of
   * the shape revolved about y. 0 where there is no shape or no formula for it. */
  double (*body_volume)(const struct gamut_body *, unsigned dimension, bool revolved);

  /* A law of the body's material ("strength" or "eos") with arrays for `count` points. For solvers
   * whose descriptor lists `laws`. In create or start; owned by the run. */
  gamut_status (*law)(struct gamut_run *, const struct gamut_body *, const char *kind, size_t count,
                      struct gamut_law **law);
  /* Array of a parameter, input or output by name ("flow_stress_given"); null where the law has
   * none. Parameters hold the scene's values, and may be written point by point. */
  double *(*law_array)(struct gamut_law *, const char *name);
  /* Calls an operation ("flow_stress", "inverse", "pressure") on the first `count` points; false
   * where the law does not offer it. *worst (may be null) is the worst status word of these points.
   * Any thread, but one at a time for the same law. */
  bool (*law_call)(struct gamut_law *, const char *operation, size_t count, int64_t *worst);
  /* The text of a status word of the law. */
  const char *(*law_message)(const struct gamut_law *, int64_t word);

  /* The run's stream for a name, of the study's seed and this realisation. */
  struct gamut_stream (*stream)(const struct gamut_run *, const char *name);
  uint64_t (*realisation)(const struct gamut_run *);
  /* Values of the random field that the parameter `path` (type plugin, kind random_field) names, in
   * this realisation, at `count` points with position[3][count] and id; `name` names its stream.
   * *given is false, and nothing is written, where the scene names no field there. */
  gamut_status (*sample)(struct gamut_run *, const struct gamut_values *, const char *path,
                         const char *name, size_t count, const double *const position[3],
                         const int64_t *id, double *value, bool *given);
  /* Box around the bodies of the scene, in the axes of its geometry (0 in the others); false where
   * no body has a shape. */
  bool (*domain)(const struct gamut_run *, double lower[3], double upper[3]);
  /* Prints something that is as it should be. */
  void (*note)(struct gamut_run *, const char *format, ...);
  /* Says where the points of a law are: parameters with a random field get their values there. A
   * scene with such a field is refused if the solver has not said it by the end of its start. */
  gamut_status (*law_places)(struct gamut_run *, struct gamut_law *,
                             const double *const position[3], const int64_t *id);
  /* Points that the scene lists for the body, x y z of one after the other, and their volumes; 0
   * and null where its shape is no list. */
  size_t (*body_points)(const struct gamut_body *, const double **place, const double **volume);
  /* A parameter of type expression, made ready for all threads of the run; null where the scene
   * does not give it. In create; owned by the run. */
  gamut_status (*formula)(struct gamut_run *, const struct gamut_values *, const char *path,
                          struct gamut_formula **);
  /* Its value where its variables, in the descriptor's order, are `variable`. A thread may use its
   * own number only. */
  double (*formula_value)(const struct gamut_formula *, int thread, const double *variable);
  bool (*formula_uses)(const struct gamut_formula *, size_t variable);

  /* Asks the run's solver to let points leave, for the bodies that the effect works on. The sums
   * are owned by the solver. In an effect's create. */
  gamut_status (*removal)(struct gamut_run *, const struct gamut_removal *,
                          const struct gamut_removed **, double *mark);
  /* Takes the points in these slots (ascending) out of a set. In each block its last points take
   * the free slots, so that padding stays at the end. Between steps; for solvers. */
  void (*drop)(struct gamut_run *, struct gamut_set *, const uint32_t *slot, size_t count);

  /* As fail, naming the effect that asked for the plane with this reaction, and its place in the
   * scene. */
  gamut_status (*fail_plane)(struct gamut_run *, const struct gamut_reaction *, gamut_status status,
                             const char *format, ...);

  /* Opens a count of work ("sorts") for `cost.work` of the summary, which the plugin adds to; null
   * when there is no memory. Counts must not depend on threads. In create; the name is borrowed. */
  uint64_t *(*count)(struct gamut_run *, const char *name);

  /* Name of the strength of the body's material ("von_mises"); null where it has none. */
  const char *(*body_strength)(const struct gamut_run *, const struct gamut_body *);

  /* Says that the steps of this run are stated and hang on no state, so that a study need not give
   * any. For solvers, in create. */
  void (*fixed_steps)(struct gamut_run *);
  /* Whether the steps of this run are given: all runs of a study take the same. `next` then gets
   * the given one as the longest, and where it answers by a shorter one the run fails: so it asks
   * for that only where the state needs it, not to let steps grow slowly. */
  bool (*given_steps)(const struct gamut_run *);

  /* Sums over blocks. A plugin adds serially over the points of a chunk or a block only; what
   * blocks have it puts into a table, a row a block, and `sum` adds up each of its columns: exactly
   * and rounded once to the nearest double, so that no bit of total[0] to total[columns - 1]
   * depends on the order of the rows, on how points are numbered or who did the work. No rows sum
   * to 0; an infinity or no number in a column makes its sum no number; a sum too large for a
   * double is an infinity. About 50 instructions a value; nothing is allocated. One thread calls it
   * at a time, in a task GAMUT_ONCE or outside a step, never in a chunk's task. */
  void (*sum)(struct gamut_run *, const double *value, size_t rows, size_t columns, double *total);
  /* The largest of `count` values, under the same rules: minus infinity of none, no number if there
   * is one. For the least, turn the signs. */
  double (*most)(struct gamut_run *, const double *value, size_t count);

  /* A list or a map of the values, in the order of the scene: how many entries it has (0 where it
   * is absent); the name that the scene gives to one, of a list its number from 0, as in the path
   * "steps.0"; the values of one that is a group, which are asked like any. Entries that are no
   * groups are asked for by their path. Borrowed. An index beyond the last is the plugin's fault
   * and ends the program. */
  size_t (*entries)(const struct gamut_values *, const char *path);
  const char *(*entry_name)(const struct gamut_values *, const char *path, size_t index);
  const struct gamut_values *(*entry)(const struct gamut_values *, const char *path, size_t index);

  /* The bytes of a file that a parameter of type file names, as they were when the scene was read,
   * with a zero byte behind the last; null where it is absent. `text` gives its path. Borrowed. */
  const char *(*file)(const struct gamut_values *, const char *path, size_t *size);
  /* As fail_at, at a line (from 1) of that file. */
  gamut_status (*fail_in_file)(struct gamut_run *, const struct gamut_values *, const char *path,
                               size_t line, const char *expected, const char *format, ...);

  /* The set of body `index`, for tasks GAMUT_ONCE; null until the solver has made it. */
  const struct gamut_set *(*set)(const struct gamut_run *, size_t index);
  /* A pass over the grid with the points where they are now; see struct gamut_grid_pass. In a task
   * GAMUT_ONCE of the solver's phase `grid`. The same bits with any number of threads. */
  gamut_status (*grid_pass)(struct gamut_run *, const struct gamut_grid_pass *pass);
};

/* Every run begins with its host; the rest is the core's. */
struct gamut_run_head {
  const struct gamut_host *host;
};
#define GAMUT_HOST(run) (((const struct gamut_run_head *)(const void *)(run))->host)
/* Values and bodies begin with their host as well. */

#define gamut_fail(run, ...) (GAMUT_HOST(run)->fail((run), __VA_ARGS__))
#define gamut_fail_at(run, ...) (GAMUT_HOST(run)->fail_at((run), __VA_ARGS__))
#define gamut_fail_in_file(run, ...) (GAMUT_HOST(run)->fail_in_file((run), __VA_ARGS__))
#define gamut_warn(run, ...) (GAMUT_HOST(run)->warn((run), __VA_ARGS__))

static inline bool gamut_given(const struct gamut_values *v, const char *path)
{
  return GAMUT_HOST(v)->given(v, path);
}
static inline double gamut_real(const struct gamut_values *v, const char *path)
{
  return GAMUT_HOST(v)->real(v, path);
}
static inline long gamut_integer(const struct gamut_values *v, const char *path)
{
  return GAMUT_HOST(v)->integer(v, path);
}
/* Number of a choice; code takes the functions of NAME.gamut.h, which make it an enum. */
static inline int gamut_choice(const struct gamut_values *v, const char *path)
{
  return (int)GAMUT_HOST(v)->integer(v, path);
}
/* Of the generated enum ID of a choice among x, y, z: its numbers are those of axes. */
#define GAMUT_CHOICE_IS_AXIS(ID)                                                                   \
  _Static_assert(ID##_X == 0 && ID##_Y == 1 && ID##_Z == 2 && ID##_CHOICES == 3, "x, y, z")
static inline bool gamut_boolean(const struct gamut_values *v, const char *path)
{
  return GAMUT_HOST(v)->boolean(v, path);
}
static inline const char *gamut_text(const struct gamut_values *v, const char *path)
{
  return GAMUT_HOST(v)->text(v, path);
}
static inline const double *gamut_vector(const struct gamut_values *v, const char *path,
                                         size_t *count)
{
  return GAMUT_HOST(v)->vector(v, path, count);
}
static inline const double *gamut_table(const struct gamut_values *v, const char *path,
                                        size_t *rows)
{
  return GAMUT_HOST(v)->table(v, path, rows);
}

static inline const char *gamut_file(const struct gamut_values *v, const char *path, size_t *size)
{
  return GAMUT_HOST(v)->file(v, path, size);
}
static inline size_t gamut_entries(const struct gamut_values *v, const char *path)
{
  return GAMUT_HOST(v)->entries(v, path);
}
static inline const char *gamut_entry_name(const struct gamut_values *v, const char *path, size_t i)
{
  return GAMUT_HOST(v)->entry_name(v, path, i);
}
static inline const struct gamut_values *gamut_entry(const struct gamut_values *v, const char *path,
                                                     size_t i)
{
  return GAMUT_HOST(v)->entry(v, path, i);
}

/* The vector at `path` with three components: those that the geometry lacks are 0. */
static inline void gamut_space_vector(const struct gamut_values *v, const char *path, double to[3])
{
  size_t count;
  const double *from = gamut_vector(v, path, &count);
  for (size_t k = 0; k < 3; k++)
    to[k] = k < count ? from[k] : 0.0;
}

/* Point and unit normal of a plane, from a group `plane` with vectors `point` and `normal`. It may
 * have any length but none; `expected` says in an error where it shall point. */
static inline gamut_status gamut_read_plane(struct gamut_run *run, const struct gamut_values *v,
                                            const char *expected, double point[3], double normal[3])
{
  double largest = 0.0, square = 0.0;
  gamut_space_vector(v, "plane.point", point);
  gamut_space_vector(v, "plane.normal", normal);
  for (int k = 0; k < 3; k++)
    largest = fmax(largest, fabs(normal[k]));
  if (!(largest > 0.0))
    return gamut_fail_at(run, v, "plane.normal", expected, "the normal has no length");
  /* by the largest component first: a square must not overflow or vanish */
  for (int k = 0; k < 3; k++) {
    normal[k] /= largest;
    square += normal[k] * normal[k];
  }
  for (int k = 0; k < 3; k++)
    normal[k] /= sqrt(square);
  return GAMUT_OK;
}

/* The rest is called as GAMUT_HOST(run)->NAME(run, ...); short names for what solvers use most: */
#define gamut_bodies(run) (GAMUT_HOST(run)->bodies(run))
#define gamut_body_at(run, i) (GAMUT_HOST(run)->body((run), (i)))
#define gamut_points(run, body, n, set) (GAMUT_HOST(run)->points((run), (body), (n), (set)))
#define gamut_field_named(run, name, handle) (GAMUT_HOST(run)->field((run), (name), (handle)))
#define gamut_add_task(run, described) (GAMUT_HOST(run)->task((run), (described)))
#define gamut_allocate(run, label, bytes) (GAMUT_HOST(run)->allocate((run), (label), (bytes)))
#define gamut_release(run, memory) (GAMUT_HOST(run)->release((run), (memory)))
#define gamut_time(run) (GAMUT_HOST(run)->time(run))
#define gamut_time_step(run) (GAMUT_HOST(run)->time_step(run))
#define gamut_threads(run) (GAMUT_HOST(run)->threads(run))
#define gamut_sum(run, value, rows, columns, total)                                                \
  (GAMUT_HOST(run)->sum((run), (value), (rows), (columns), (total)))
#define gamut_most(run, value, count) (GAMUT_HOST(run)->most((run), (value), (count)))

#endif
