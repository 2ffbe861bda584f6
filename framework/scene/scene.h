/* A scene checked against the descriptors it names. What a scene may say:
 *
 *   gamut: 1                          format, required
 *   title: text
 *   include: [materials/copper.yaml]  merged below this file; relative to the including file, then
 *                                     to the folder of inputs beside it and the installed one
 *   solver: {model: NAME, ...}        the solver's parameters
 *   materials: {NAME: {density:, eos: {model:, ...}, strength:, elasticity:, source: text, ...}}
 *                                     elasticity, or its model, defaults to hypoelastic; strength
 *                                     may be absent, and needs a shear modulus. scaled: true for
 *                                     numbers without a scale: unusual ones are not warned of.
 *                                     Further keys: material_parameters of any installed plugin
 *   bodies: {NAME: {material:, shape:, velocity:, temperature:, pressure: | energy:, ...}}
 *                                     velocity: vector with units, or [expression strings of x, y,
 *                                     z in SI metres]; further keys: body_parameters of the solver
 *   effects: {NAME: {model:, enabled: auto|on|off, bodies: [..], materials: [..], ...}}
 *   quantities: {NAME: {measure:, ARGUMENTS, effect:, body:, at:, reduce:, every:}}
 *                                     at: {body:, point: | points: | line:, follow:}
 *   outputs: {every: 5 us, fields: [..], checkpoint: 10 min}
 *                                     or {frames: 20}; checkpoint: wall time, or {every: 10 us}
 *   uncertainty: {estimator: {model:, ...}, seed:, correlation: [[path, path, number], ..],
 *                 failures: share,    see study/study.h
 *                 step_margin: share}
 *
 * A real parameter may be random: {mean: 90 MPa, cv: 0.1} or {mean:, sd:, distribution:,
 * truncate:}; or {distribution: uniform, lower:, upper:}. A run without a study takes the mean and
 * says so. Units are required where a dimension is due. A card is a scene with only gamut and
 * materials (title and include may be there); it reads well, with solver.descriptor null and no
 * bodies. */
#ifndef GAMUT_SCENE_ROOM_H
#define GAMUT_SCENE_ROOM_H

#include "base/error.h"
#include "descriptor/descriptor.h"
#include "expression/expression.h"
#include "random/distribution.h"
#include "registry/registry.h"
#include "tree/tree.h"
#include "unit/unit.h"

/* A random parameter of a kernel may vary in space: {mean:, cv:, field: {model: karhunen_loeve,
 * ...}} with a plugin of kind random_field. Every point then has a value of its own, whose
 * distribution is the stated one; it is no parameter of a study, which sees another realisation of
 * the field in each run. A run without a study takes realisation 0.
 */

/* A file that a value comes from. */
struct value_file {
  char *path;
  char *content; /* of a FILE: all of it, with a zero byte behind its end; of a TABLE null */
  size_t length;
  size_t *line; /* of a TABLE: the line of each row; else null */
};

/* One checked value. Which members count depends on parameter->type. */
struct value {
  const struct parameter *parameter;
  const struct tree *node;     /* where it was given; null: default, derived or absent */
  bool given, present;         /* in the scene; has a value at all */
  double real;                 /* VALUE_REAL, INTEGER, BOOLEAN, number of a CHOICE; SI; the mean */
  struct distribution *random; /* null: certain */
  const char *text;            /* CHOICE, TEXT, BODY; of a FILE its path */
  struct value_file *file;     /* FILE, or TABLE that comes from one; else null */
  double *number;
  size_t numbers;                /* VECTOR, or TABLE row by row (numbers = rows x columns) */
  struct expression *expression; /* EXPRESSION */
  struct expression **each;      /* copies of it, one a thread, for who asked for them */
  size_t copies;
  struct gamut_values *group;     /* GROUP, LIST, MAP, ONE_OF, never null for one: of the members,
                                     the entries by name or number, the forms; and of `model` */
  const struct descriptor *model; /* PLUGIN, or the field of a random REAL; else null */
  const struct tree *levels;      /* LEVELS: the mapping of paths to lists */
};

/* The values of one plugin instance, in the order of the descriptor's parameters. Plugins see it as
 * the opaque struct gamut_values, through the host. */
struct gamut_values {
  const struct gamut_host *host; /* first, see <gamut/host.h>; set by whoever makes the run */
  const struct parameter *parameter;
  struct value *value;
  size_t count;
  char *path;              /* scene path: "materials.copper.strength" */
  const struct tree *node; /* the mapping, or null */
  struct parameter *own;   /* of a list or map: those that `parameter` points to; else null */
  bool preparing;          /* seen by a `prepare`, which takes no numbers that kernels see */
};
#define values gamut_values

/* By dotted path; null if not declared. */
const struct value *values_find(const struct values *, const char *path);
/* The kind of space of these values of a solver; null where it has no such parameter. */
const struct geometry *values_geometry(const struct values *);

struct instance {   /* a plugin named by the scene with its values */
  const char *name; /* effects: their key; others: kind */
  const struct descriptor *descriptor;
  struct values *values;
  const struct tree *node;
  const char **state_field; /* effects that are not off: one a state, the name of its field */
};

/* The field of a plugin's state, or of one that is no effect's: the state's own name. */
const char *instance_state_field(const struct instance *, size_t state);
/* The field that `name` means to this plugin: that of its state of that name, else `name`. */
const char *instance_field(const struct instance *, const char *name);

struct material {
  const char *name;
  double density; /* kg/m3 */
  struct distribution *density_random;
  struct instance eos, strength, elasticity; /* descriptor null: absent */
  /* material parameters of plugins, by name; value.present false where not given */
  struct values *extra; /* parameter array = the union over installed plugins */
  const struct tree *node;
};

enum shape_kind {
  SHAPE_NONE,
  SHAPE_BOX,
  SHAPE_CYLINDER,
  SHAPE_SPHERE,
  SHAPE_TUBE,
  SHAPE_CONE,
  SHAPE_UNION,
  SHAPE_DIFFERENCE,
  SHAPE_POINTS
};
/* Points from a file, each a cube (square, length) of its volume around its place. */
struct shape_points {
  size_t count;
  double *place;  /* x, y, z of one after the other */
  double *volume; /* of the full circle where axisymmetric; area or length where axes lack */
  double *half;   /* half the edge */
};
struct shape {
  enum shape_kind kind;
  bool revolved;             /* of an axisymmetric scene: no negative radius */
  double lower[3], upper[3]; /* box; unbounded (-inf, inf) in directions a geometry lacks */
  double centre[3];          /* sphere; centre of the base of a cylinder, tube or cone */
  double radius, length;     /* cylinder: from the base along +axis; an axisymmetric scene has
                                axis y and radius along x; in plane strain axis z, length inf */
  double inner_radius;       /* tube */
  double top_radius;         /* cone */
  int axis;
  struct shape *part; /* union: all of them; difference: the first without the others */
  size_t parts;
  struct shape_points points;
  const struct shape_index *index; /* of many parts or points; null: they are asked one by one */
};
/* Distance from the surface, positive inside; where shapes are joined a lower bound of it. */
double shape_depth(const struct shape *, const double x[3]);
/* Exact volume in a space of so many axes, or revolved; 0 where there is no formula for it. */
double shape_volume(const struct shape *, unsigned dimension, bool revolved);
bool shape_contains(const struct shape *, const double x[3]); /* closed set */
void shape_bounds(const struct shape *, double lower[3], double upper[3]);

struct gamut_body {
  const struct gamut_host *host; /* first */
  const char *name;
  size_t index, material; /* numbers in scene->body, scene->material */
  struct shape shape;
  double velocity[3];
  struct expression *velocity_expression[3]; /* of x y z in metres, giving m/s; null: uniform */
  double temperature;                        /* K; default 298 */
  bool has_pressure, has_energy;
  double pressure, energy;      /* initial, Pa or J/m3 */
  struct values *solver_values; /* body_parameters of the solver */
  const struct tree *node;
};

struct effect {
  struct instance instance;
  enum { EFFECT_AUTO, EFFECT_ON, EFFECT_OFF } enabled;
  bool *on_body; /* one a body: whether the effect touches it (bodies:, materials:) */
};

enum reduction_kind {
  REDUCE_NONE,
  REDUCE_AT,
  REDUCE_MAX,
  REDUCE_MIN,
  REDUCE_MEAN,
  REDUCE_TIME_OF,
  REDUCE_SLOPE
};
/* `reduce:` forms: `at end`, `at 12 us`, `max`, `min`, {mean: [t0, t1]}, {max: [t0, t1]}, {min:
 * ..}, {slope: [t0, t1]} (least-squares slope by time; unit /s), {time_of: VALUE} (first crossing
 * of VALUE, interpolated; in s), {time_of_max: [t0, t1]} is time of the largest. Absent: a history.
 */
struct reduction {
  enum reduction_kind kind;
  bool at_end;
  double from, to; /* window, axis units (s); whole run by default */
  double level;    /* TIME_OF, in the measure's unit */
  bool time_of_max;
};

struct quantity {
  const char *name;
  const char *family; /* of one of several points: the name in the scene, "speed" of "speed.07" */
  const struct measure *measure;
  const struct descriptor *provider; /* whose measure it is; null: a plain field of the catalogue */
  const char *effect;                /* key of the effect that provides it, or null */
  const char *field;                 /* plain field component, e.g. "velocity_y", or null */
  struct values *arguments;          /* may be null */
  int body;                          /* index, or -1 */
  bool has_point, follow_space;
  double point[3];
  double every; /* 0: about 500 samples */
  struct reduction reduction;
  const struct tree *node;
};

/* A random parameter: where it stands, its law, and the number that a draw sets. */
struct random_parameter {
  const char *path; /* "materials.copper.strength.A" */
  const struct parameter *parameter;
  const struct tree *node;
  const struct distribution *distribution;
  double *number;                      /* its mean until scene_draw */
  struct values *values;               /* of its plugin; null: density */
  const struct descriptor *descriptor; /* of what holds between them; null: nothing */
};

/* A file whose contents are part of the scene. */
struct input_file {
  const char *key; /* where the scene names it: "materials.metal.eos.curve.file" */
  const char *path;
  char digest[17]; /* of its bytes when the scene was read */
};

struct scene {
  const char *file; /* as given */
  const char *title;
  struct tree *tree; /* merged, with overrides; owned */
  struct instance solver;
  struct material *material;
  size_t materials;
  const struct tree *materials_node; /* where their names are looked up */
  struct gamut_body *body;
  size_t bodies;
  struct effect *effect;
  size_t effects;
  const struct tree *effects_node; /* where their names are looked up */
  struct quantity *quantity;
  size_t quantities;
  struct input_file *input_file; /* in the order in which they were read; owned */
  size_t input_files;
  double output_every;                      /* 0: none; <0: -frames */
  double checkpoint_wall, checkpoint_every; /* s of wall time, axis; 0: at signals only */
  const char **output_field;
  size_t output_fields;
  bool random;                               /* some parameter is random */
  struct random_parameter *random_parameter; /* in the order of the file */
  size_t random_parameters;
  /* of `uncertainty`; see study/study.h */
  struct instance estimator; /* descriptor null: no study */
  uint64_t seed;
  double failures;     /* share of the runs of a study that may fail */
  double step_margin;  /* share by which steps of a study's runs are shorter than at the means; NaN:
                          each run takes its own */
  double *correlation; /* of the normal variables behind the random parameters, row by row, no
                          eigenvalue below 0; null: independent */
};

/* From --set path=value, or a node of some scene, which is copied: faults then have its place. */
struct scene_override {
  const char *path, *value;
  const struct tree *node; /* null: `value` is read */
};

/* Overrides from texts "path=value" of a command line. */
struct override_list {
  struct scene_override *override;
  size_t count;
  char **path; /* owned; the values are borrowed from the texts */
};
/* GAMUT_USAGE where a text has no path or no '='. Free the list whatever the status. */
gamut_status overrides_read(const char *const *text, size_t count, struct trace *,
                            struct override_list *);
void overrides_free(struct override_list *);

/* Reads, merges, overrides and checks. All errors are collected. Blamed as GAMUT_SCENE; a plugin
 * that the scene names but that is broken as GAMUT_PLUGIN. Nothing is opened or run. */
gamut_status scene_read(const char *file, const struct scene_override *, size_t overrides,
                        struct registry *, const struct units *, struct trace *, struct scene **);
/* The same scene with some of it overridden, checked anew. No file is read again but those of
 * tables. The two share texts: not for two threads at once, nor is scene_free of either. */
gamut_status scene_vary(const struct scene *, const struct scene_override *, size_t overrides,
                        struct registry *, const struct units *, struct trace *, struct scene **);
void scene_free(struct scene *);

/* Checks values of `node` (a mapping, or null for none) against parameters: unknown and duplicate
 * keys, types, units, ranges, required ones; then given sets and constraints. Keys in `also` (count
 * others) are allowed and left alone. Used by scene, eval, conformance. */
gamut_status values_read(const struct descriptor *, const struct parameter *, size_t count,
                         const struct tree *node, const char *path, const char *const *also,
                         size_t others, const struct units *, struct trace *, struct values **);
void values_free(struct values *);
/* Sets a real parameter (eval, studies), then derives given sets and checks ranges and constraints.
 */
gamut_status values_set(struct values *, const struct descriptor *, size_t parameter, double real,
                        struct trace *);

/* Parameters of one plugin that differ from point to point: those with a random field, and those
 * that follow from them. Null where there is none. `descriptor` of given sets and constraints, or
 * null. */
struct pointwise;
struct pointwise *pointwise_new(const struct values *, const struct descriptor *);
void pointwise_free(struct pointwise *);                       /* accepts null */
bool pointwise_varies(const struct pointwise *, size_t index); /* accepts null */
/* number[i] holds parameter i at one point, drawn where it has a field: derives the rest, checks
 * ranges and constraints. False with the parameter to blame and the reason. */
bool pointwise_work_out(const struct pointwise *, double *number, size_t *index, char *why,
                        size_t size);

/* Gives every random parameter a value (one each, in order), derives what follows from them, checks
 * ranges and constraints. GAMUT_SCENE where such a scene could not be. */
gamut_status scene_draw(struct scene *, const double *value, struct trace *);

/* A draw (as scene_draw) against a constraint of a plugin, or the range of what is derived there,
 * where some parameter of that plugin has `truncate: true`: that parameter; `conflict` gets the
 * constraint. Null: there is nothing to draw again for. Sets the parameters. */
const struct random_parameter *scene_conflict(struct scene *, const double *value, char *conflict,
                                              size_t size);

/* JSON Schema of scenes, for editors, from the registry. */
void schema_write(const struct registry *, FILE *);

#endif
