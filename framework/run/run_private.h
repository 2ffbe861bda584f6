/* The inside of a run, shared by the files of this room. */
#ifndef GAMUT_RUN_PRIVATE_H
#define GAMUT_RUN_PRIVATE_H

#include <jansson.h>

#include <gamut/plugin.h>

#include "material/material.h"
#include "run/run.h"

/* Operations of a solver and of an effect as the core sees them; see GAMUT_SOLVER_OPS. */
struct solver_operations {
  size_t size;
  GAMUT_SOLVER_OPS(void)
};
struct effect_operations {
  size_t size;
  GAMUT_EFFECT_OPS(void)
};

/* An effect that is on. */
struct running_effect {
  const struct effect *effect;
  const struct effect_operations *ops;
  void *self;
  bool created;
  struct kernel **kernel; /* one a material; null if it has no kernels */
  struct bound_effect *bound;
  struct effect_job { struct running_effect *owner; size_t task; } *job; /* one a task */
  char label[120]; /* "effect heat" */
};

/* A plane and the effect that asked for it. */
struct plane_owner {
  const struct gamut_reaction *reaction;
  const struct effect *effect;
};

/* A task that updates materials: the core's own, or a solver's that iterates on it. */
struct material_job {
  struct gamut_run *run;
  gamut_status (*inner)(void *self, const struct gamut_chunk *); /* null: the core's own */
  void *self;
};

/* An expression over the components of fields at one point. */
struct formula {
  struct expression *expression; /* null: the plain component `plain` */
  size_t plain;
  size_t *variable, variables;   /* components that the expression uses; SIZE_MAX: density */
  size_t *position;              /* their places in `value` */
  bool *zero;                    /* whether they are zero where nobody writes them */
  double *value;
};

/* A count of work that the solver keeps. */
struct work_count {
  const char *name;
  uint64_t value;
  struct work_count *next;
};

/* What a quantity is taken from. */
struct probe {
  const struct quantity *quantity;
  struct history *history;
  struct formula formula; /* for points */
  struct formula derived; /* the argument `field`, where it names a measure of points */
  struct running_effect *effect; /* provider, or null: the solver */
  int64_t id;             /* the point that is followed */
  size_t slot;            /* where it was last */
  double distance;        /* of the point from the place asked for */
  bool left;              /* the point is no longer there */
};

/* A field of the frames. One formula a material: materials may differ in elasticity. */
struct frame_column {
  const char *name, *unit, *meaning;
  unsigned components;
  const struct field *field;   /* plain; or */
  struct formula *formula;     /* one a material */
};

struct gamut_run {
  struct gamut_run_head head; /* first, see <gamut/host.h> */
  struct scene *scene;
  struct registry *registry;
  struct run_options options;
  struct trace *trace;
  struct arena *arena;
  struct fields *fields;
  struct schedule *schedule;
  struct store *store;
  int threads;
  size_t chunk;

  struct bound_material **material; /* one a scene material; null where no body uses it */
  struct point_set **set;           /* one a body */
  const struct solver_operations *solver;
  void *solver_self;
  struct running_effect *effect;
  size_t effects;
  struct running_effect *creating;  /* the effect whose create runs, for messages */
  struct plane_owner *plane;
  size_t planes;
  struct material_job **job;
  size_t jobs;
  struct gamut_law *law;            /* laws of the solver's own, a list */
  struct sampled_field *sampled_field; /* random fields that were asked for, a list */
  struct leaving *leaving;          /* effects that take points out, a list */
  struct spare spare;               /* where flagged points go in place of a stop */
  struct lane_scratch **scratch;
  double **uniform;                 /* one a component; null until somebody sets it */
  double **uniform_row;             /* the memory of each */
  unsigned char *start_source;      /* where a chunk's tables lead while a run starts */

  struct ledger_line *ledger;
  size_t lines, line_capacity;
  double **line_value;              /* what plugins write to */
  struct balance *balance;          /* of the account that a line is the first of */
  struct work_count *count;         /* of the solver, a list */

  struct probe *probe;
  size_t probes;
  struct history **history;
  struct probe **follower; /* those that follow a point, by body and id */
  size_t followers;
  const struct quantity *measuring; /* what a plugin measures now, for messages */
  struct probe *measured;           /* what it is for */
  const struct value *sampling;     /* what a random field is drawn for now, for messages */
  struct frame_column *column;
  size_t columns;

  double time, step, end;
  uint64_t steps;
  bool fixed_steps;       /* the solver says so */
  double *taken;          /* the steps so far, where they are kept */
  size_t taken_capacity;
  double next_frame;
  uint64_t frame;
  double wall, cpu;
  uint64_t checkpoint;    /* of `outputs.checkpoint.every`: how many have been due */
  double checkpoint_wall; /* when the last one was written */
  double work;            /* points updated by this process */
  bool started, resumed;
  bool too_large; /* memory was asked for that this machine has not */
  gamut_status start; /* what came of it */
};

extern const struct gamut_host run_host;



/* create.c */
gamut_status run_add_task(struct gamut_run *, const char *owner, const struct gamut_task *,
                          size_t only_set, const bool *on_set);

/* host_law.c */
void host_laws_free(struct gamut_run *);
/* After the solver's start: whether every random field of a law's parameters was asked for. */
gamut_status host_laws_check(struct gamut_run *);

/* host_random.c */
gamut_status random_open(struct gamut_run *);
void random_free(struct gamut_run *);
/* Draws the parameters that differ from point to point, at these points: number[k] is an array of
 * parameter k's numbers, null where it does not differ. */
gamut_status random_draw(struct gamut_run *, const struct pointwise *, const struct values *,
                         size_t count, const double *const position[3], const int64_t *id,
                         double *const *number);
/* Random field `index` that was made: what varies and its plugin; false past the end. */
bool random_field_at(const struct gamut_run *, size_t index, const char **path,
                     const char **plugin);
/* Fills the stored fields of such parameters of a set's material and of effects. */
gamut_status random_scatter(struct gamut_run *, const struct point_set *);

/* host_removal.c: from the first step on flagged points may leave. */
void removal_start(struct gamut_run *);
/* Says what left the run. */
void removal_warn(const struct gamut_run *, struct trace *);

/* effects.c */
gamut_status effects_create(struct gamut_run *);
void effects_free(struct gamut_run *);
gamut_status effects_resolve(struct gamut_run *);
/* effects_check.c; after the plan: an effect that sets the stress needs elasticities that take it
 * up; one that opens material is warned of where the eos stops there. */
gamut_status effects_check(struct gamut_run *);
/* Fields for the states of a solver or an effect, which its `create` may ask for. */
gamut_status declare_states(struct gamut_run *, const struct instance *);

/* formula.c */
/* Of a measure of points that has a formula. */
gamut_status formula_new(struct gamut_run *, const struct measure *, struct formula *);
gamut_status formula_plain(struct gamut_run *, const char *component, struct formula *);
double formula_value(struct formula *, const struct gamut_run *, const struct point_set *,
                     size_t slot);
void formula_free(struct formula *);
/* Names to the scheduler which fields it reads; see schedule_want. */
void formula_want(const struct formula *, struct gamut_run *, size_t set, const char *why,
                  const struct place *);
/* Declares what a text names of the catalogue. */
gamut_status formula_declare(struct gamut_run *, const char *text);

/* given.c: before the plan says which fields have values that no task writes; fills those of
 * bodies once there are arrays, and of a set those that its first positions give. */
gamut_status given_mark(struct gamut_run *);
void given_fill(struct gamut_run *);
void given_start(const struct point_set *);
/* After the solver's start: numbers of the run, such as cell_size, that are read and not set. */
gamut_status given_check(struct gamut_run *);

/* wants.c: names to the scheduler the fields that a quantity's argument `field` needs. Leaves in
 * `derived` the formula of the measure of points that it names. */
gamut_status wants_of_arguments(struct gamut_run *, const struct quantity *, const char *why,
                                struct formula *derived);
/* Works out that measure for all points of the body that is being measured, where it is `name`. */
gamut_status wants_derive(struct gamut_run *, const char *name, bool *derived);

/* observe.c */
gamut_status observe_create(struct gamut_run *);
gamut_status observe_start(struct gamut_run *); /* after the solver has started */
/* Whether a sample falls into the step from the present time; records values of its beginning. */
gamut_status observe_before(struct gamut_run *, double step, bool *due);
gamut_status observe_after(struct gamut_run *, bool due, bool final);
void observe_free(struct gamut_run *);

/* frames.c */
gamut_status frames_create(struct gamut_run *);
gamut_status frames_write(struct gamut_run *);
/* Writes a frame if one is due by the present time. */
gamut_status frames_due(struct gamut_run *);
void frames_go_on(struct gamut_run *); /* after a restart */
bool due_by_now(const struct gamut_run *, double every, uint64_t *count);
void frames_free(struct gamut_run *);

/* checkpoint.c */
gamut_status checkpoint_write(struct gamut_run *);
void checkpoint_start(struct gamut_run *); /* the clocks of `outputs.checkpoint` */
gamut_status checkpoint_due(struct gamut_run *);

/* ledger.c */
gamut_status ledger_open(struct gamut_run *, const char *account, const char *name,
                         const char *unit, enum gamut_ledger_role, double **value);
void ledger_start(struct gamut_run *);
gamut_status ledger_check(struct gamut_run *);
void ledger_free(struct gamut_run *);

/* counters.c: counts for summary.json; work_open is gamut_host.count. */
uint64_t *work_open(struct gamut_run *, const char *name);
json_t *work_json(const struct gamut_run *);

/* forecast.c: what a run would cost, from its start and a few steps of it. */
enum { TRIAL_STEPS = 5 };
struct forecast {
  double step, steps, seconds;
  char limit[200];
};
bool forecast_steps(struct gamut_run *, struct forecast *);

/* advance.c */
gamut_status advance_start(struct gamut_run *);
/* How long the first step would be, without taking it. */
gamut_status advance_first_step(struct gamut_run *, double *step);
/* One step; false in *more at the end of the run. */
gamut_status advance_step(struct gamut_run *, bool *more);

/* failures.c */
/* A body's velocity is arithmetic in space, which may have no value somewhere. */
gamut_status start_check(struct gamut_run *);
gamut_status stop_check(struct gamut_run *);
/* Names the fastest point with its state; "" where points have no velocity. */
void describe_fastest(const struct gamut_run *, char *text, size_t size);

#endif
