/* A plugin's YAML, checked. Nothing about a plugin that can be known without running it comes from
 * anywhere else.
 *
 *   plugin: strength/johnson_cook      kind/name; the folder and files are called name
 *   version: "1.0"
 *   summary: one line
 *   formula: |                         the formula that runs, as `gamut show` prints it
 *   notes: |                           what a user must know (limits, what is left out)
 *   source: [literature, ...]
 *   parameters:                        in order
 *     A: {symbol: A, unit: Pa, type: real, default: 90 MPa, fit: "[10, 1000] MPa",
 *         physical: "(0, inf)", random: true, optional: false, doc: ..., source: ...}
 *     types: real (default), integer, boolean, choice (choices: [..]), text, vector (size: 2 or
 *     "1..3"), body (name of a body), expression (variables: [x, y, z]), table (columns: {time: s,
 *     strain: 1}; a sequence of rows or {file: NAME.csv}; of two columns also one number, which is
 *     the row [0, number]; size: "4..1000" rows), file (a path from the folder of what names it),
 *     group (members: like parameters), list (of: a parameter's declaration; size: "0..8";
 *     entries in brackets, those that are texts may be one without), map (of:, size:; entries by
 *     names that the scene gives), entry (of: name of a map among the plugin's parameters; an entry
 *     of it by name; arguments of measures only), one of (forms: like parameters; a value written
 *     in one of these ways, told apart by its form: words of choices and booleans first, else a
 *     plain value, a list or a mapping, at most one form of each), levels (of an estimator: a
 *     mapping of scene paths to lists of values, what a study varies; the choice `combine` beside
 *     it says how: grid, every value with every other, or zip, side by side), plugin (kind:
 *     random_field; a plugin of that kind with its parameters, {model: NAME, ...}).
 *     Without default and not optional: required. unit "1" is a pure number. Ranges are in SI
 *     unless they carry a unit: "[a, b)", "(0, inf)". Outside `physical` a scene is refused,
 *     outside `fit`, where the law holds, warned. `usual` is the spread of published values: beyond
 *     it most often a unit is wrong, and the warning says which would be right. It is of the
 *     magnitude where numbers may be negative and its lower end is positive; zero is never unusual.
 *     Beside the members of a group `one_of: [factor, [slope, start]]` lists alternatives: a scene
 *     gives the members of one. It need not where they are optional in all of the alternatives.
 *   one_of: [limit, [lower, upper]]    the same of the parameters
 *   constraints: ["T_melt > T_room"]   comparisons over real parameters
 *   needs: {shear_modulus: "(0, inf)"} strength, eos: ranges in SI of what its caller has of that
 *                                      name. A strength needs this one unless it says other ones,
 *                                      or {}: without shear it limits nothing
 *   usual: {density: "[50, 30000]"}    eos: usual ranges in SI of keys of the material
 *   given:                             alternative sets; a scene gives one. What is given leads to
 *     - {set: [youngs_modulus, poissons_ratio], then: {shear_modulus: "youngs_modulus / (2 * ..)"}}
 *     - {set: [shear_modulus]}         what is in `then`; all names are declared parameters. Those
 *                                      of other sets must not be given. Derived ones need no value.
 *   inputs: [velocity_gradient, viscous_pressure?]   fields read; `?`: may be absent. It then reads
 *                                      as `absent` says, "burn_fraction?: {unit: 1, absent: 1}"
 *                                      (`inf` is infinite); unless stated as the catalogue has it
 *   outputs: [pressure, sound_speed]   fields written. A field outside the catalogue (another
 *                                      plugin's state) is an item "burn: {unit: 1, components: 1}"
 *   state:                             history: fields of their own, a begin and an end value. Unit
 *     plastic_strain: {unit: 1, components: 1, initial: 0, doc: ...}   and components of a field of
 *                                      the catalogue need not be stated, and agree if they are
 *   scratch: 24                        scratch arrays for the kernel
 *   laws: [eos, strength?]             elasticity: callees; `?`: may be absent (null pointer).
 *                                      solver: laws that it calls itself; it then updates
 *                                      materials by no elasticity, and materials need none
 *   prepare: true                      its kernels carry data of the plugin's own, made once of the
 *                                      values by its operation `prepare`. Without it a law has only
 *                                      parameters that a kernel sees. A number that `prepare` reads
 *                                      says `prepared: true`; no kernel sees it then, and it can be
 *                                      random, but not differ from point to point
 *   inverse: true                      strength: offers the inverse
 *   derivatives: {of: pressure, by: [C0, S1, reference_density]}
 *   variants: [{when: "C == 0", kernel: name, drops: [plastic_strain_rate]}]   `when` over real,
 *                                      integer and boolean parameters; `drops`: inputs not needed
 *   messages: {beyond_pole: {severity: stop, text: "..."}}
 *   tasks: [{kernel: heat, phase: after material, reads: [..], writes: [..], adds: [..]}]   effects
 *                                      scales: [..] multiplies an output, lowers: [..] takes the
 *                                      lesser of two: several effects may, see GAMUT_SCALE
 *   body_parameters:, material_parameters:   like parameters: keys that this plugin adds to every
 *                                      body (solver) or material (effects, elasticity)
 *   requires: [plane]                  names in somebody's `provides`
 *   provides: [plane, points]          an elasticity: imposed_stress, where its step begins with
 *                                      the deviator of `stress`, so that effects may set it; an
 *                                      effect: opened_material, where the eos will be asked for
 *                                      material that is pulled apart
 *   phases: [..]                       solver
 *   axis: {name: time, unit: s}        solver
 *   yields: moments                    estimator: what its runs are for. moments (unless stated):
 *                                      they are a sample, and `report` gives mean and variance;
 *                                      table: each stands for itself
 *   adaptive: false                    estimator: whether what it asks for hangs on what it was
 *                                      told; where not, all rows are known beforehand
 *   omits_failed_runs: true            estimator: whether it can leave out runs that failed; where
 *                                      not (the weights of a quadrature), the first one ends the
 *                                      study
 *   measures:                          what a quantity can be
 *     pressure: {unit: Pa, at: point, formula: "-(stress_xx + stress_yy + stress_zz) / 3", doc: ..}
 *     extent: {unit: m, at: body, arguments: {axis: {type: choice, choices: [x, y, z]}}, doc: ..}
 *     stress_strain: {unit: Pa, at: run, against: strain, doc: ..}   a curve over another measure
 *     of the plugin with the same `at` and no arguments, recorded at every step
 *     `unit_of: field`, of a measure or of an argument in place of its unit, says that it has the
 *     unit of the field that the argument `field` (type text) names in the scene.
 *     `at: point` measures are per point (a formula over components of fields such as stress_xx, or
 *     the name of a field); `at: body` and `at: run` are scalars from the plugin's measure
 *     operation.
 */
#ifndef GAMUT_DESCRIPTOR_H
#define GAMUT_DESCRIPTOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gamut/plugin.h>

#include "base/error.h"
#include "tree/tree.h"
#include "unit/unit.h"

enum value_type {
  VALUE_REAL,
  VALUE_INTEGER,
  VALUE_BOOLEAN,
  VALUE_CHOICE,
  VALUE_TEXT,
  VALUE_VECTOR,
  VALUE_BODY,
  VALUE_EXPRESSION,
  VALUE_TABLE,
  VALUE_FILE,
  VALUE_LEVELS,
  VALUE_PLUGIN,
  VALUE_LIST,
  VALUE_MAP,
  VALUE_ENTRY,
  VALUE_ONE_OF,
  VALUE_GROUP /* the last */
};

/* A range with open or closed ends, SI. */
struct range {
  bool stated;
  double lower, upper;
  bool lower_open, upper_open;
};
bool range_holds(const struct range *, double value);
/* "greater than 0 and at most 0.5" with the unit, for messages. Returns buffer. */
char *range_text(const struct range *, const char *unit, char *buffer, size_t size);

/* Members of which a scene gives those of one set; `needed`: it must. 0 sets: no such thing. */
struct alternatives { size_t sets; bool needed; };

struct parameter {
  const char *name, *symbol, *unit, *doc, *source;
  enum value_type type;
  const char *unit_of; /* null, or the argument that names the field whose unit this one has */
  const struct tree *standard; /* the default as written, or null */
  bool optional, random;
  bool elsewhere; /* not for the law's kernels: a solver reads it */
  bool prepared;  /* not for kernels: `prepare` reads it */
  struct range fit, physical, usual;
  size_t size_min, size_max;   /* of a vector; entries of a list or map; rows of a table */
  const char **choice;         /* names of a choice, variables of an expression, table columns */
  const char **choice_unit;    /* units of table columns */
  size_t choices;
  struct parameter *member;    /* of a group; forms of a `one of` */
  size_t members;
  struct alternatives one_of;  /* of a group */
  unsigned set;                /* the alternative, from 1, of its group that it is in; 0: none */
  struct parameter *of;        /* what each entry of a list or map is */
  const char *entry_of;        /* of an entry: the map */
  enum gamut_kind kind;        /* of a plugin */
};

/* What a law asks of the parameter of that name of its caller, if it has one. */
struct need { const char *parameter; struct range range; };

struct given_set {
  const char **name;  size_t names;              /* given by the scene */
  const char **derived, **formula; size_t derivations; /* what follows: name = formula */
};

/* A field that a plugin reads or writes, or a law that it calls (no unit, no components). */
struct field_use {
  const char *name; bool optional; const char *unit; unsigned components;
  double absent; /* what an optional input reads where nobody gives it a value */
};
struct state_variable {
  const char *name, *unit, *doc; unsigned components; double initial;
};
struct variant { const char *when, *kernel; const char **drop; size_t drops; };
struct message { const char *name, *text; enum gamut_severity severity; };
struct kernel_task {
  const char *kernel, *phase;
  const char **read, **write, **add, **scale, **lower;
  size_t reads, writes, adds, scales, lowers;
};
enum measure_at { MEASURE_POINT, MEASURE_BODY, MEASURE_RUN };
struct measure {
  const char *name, *unit, *formula, *doc; enum measure_at at;
  const char *unit_of; /* as that of a parameter; `unit` is then that of the field in a scene */
  const struct measure *against; /* null, or the measure of the same plugin that is the axis */
  struct parameter *argument; size_t arguments;
};

struct descriptor {
  enum gamut_kind kind;
  const char *id, *name, *version, *summary, *formula, *notes;
  const char *file, *folder; /* absolute */
  const char **source;                 size_t sources;
  struct parameter *parameter;         size_t parameters;
  struct alternatives one_of;
  const char **constraint;             size_t constraints;
  struct need *need;                   size_t needs;
  struct need *usual;                  size_t usuals;  /* of the material's keys */
  struct given_set *given;             size_t givens;
  struct field_use *input;             size_t inputs;
  struct field_use *output;            size_t outputs;
  struct state_variable *state;        size_t states;
  size_t scratch;
  bool prepare;
  struct field_use *law;               size_t laws; /* "eos", "strength" */
  bool inverse;
  const char *derivative_of; const char **derivative_by; size_t derivatives;
  struct variant *variant;             size_t variants;
  struct message *message;             size_t messages;
  struct kernel_task *task;            size_t tasks;
  struct parameter *body_parameter;    size_t body_parameters;
  struct parameter *material_parameter; size_t material_parameters;
  const char **require;                size_t requirements;
  const char **provide;                size_t provisions;
  const char **phase;                  size_t phases;
  const char *axis, *axis_unit;
  bool yields_table;                   /* of an estimator: its runs are no sample */
  bool adaptive, omits_failed_runs;    /* of an estimator */
  struct measure *measure;             size_t measures;
  char digest[24];                     /* of the interface, see descriptor_digest */
  struct tree *tree;                   /* owns all strings */
};

/* Reads and checks. Every fault is reported with its place, blamed as GAMUT_PLUGIN. */
gamut_status descriptor_read(const char *file, const struct units *, struct trace *,
                             struct descriptor **);
void descriptor_free(struct descriptor *); /* accepts null */

const char *kind_name(enum gamut_kind);
bool kind_from_name(const char *name, enum gamut_kind *);
/* Names of the operations of a kind, as they stand in struct NAME_ops; null past the end. */
const char *kind_operation(enum gamut_kind, size_t index);
/* The same of all of a plugin's: those of its kind, prepare and release where it prepares, then the
 * kernels of variants and tasks. */
const char *descriptor_operation(const struct descriptor *, size_t index);
const struct parameter *parameter_named(const struct parameter *, size_t count, const char *name);
/* How its value may be written: bits 1 << enum tree_kind. */
unsigned parameter_forms(const struct parameter *);
/* Whether all texts are known that it may be: a choice or a boolean. */
bool parameter_is_word(const struct parameter *);
/* The sets of alternatives: "factor, or slope with start". Returns buffer. */
char *alternatives_text(const struct parameter *, size_t count, char *buffer, size_t size);
/* Index of a parameter of the descriptor, or -1. */
int descriptor_parameter(const struct descriptor *, const char *name);
/* A kind of space, which a solver offers as a choice of its parameter `geometry`; null: unknown. */
struct geometry { const char *name; unsigned axes; bool axisymmetric; };
const struct geometry *geometry_named(const char *name);
/* Whether `provides` lists it. */
bool descriptor_provides(const struct descriptor *, const char *name);

/* The block that a kernel of this plugin sees. */

/* What a pointer of the generated struct leads to, in declared order after count and status. */
enum slot_kind {
  SLOT_PARAMETER,          /* const double *: real parameter `index` (integers and booleans too) */
  SLOT_MATERIAL_PARAMETER, /* const double *: material_parameter `index` */
  SLOT_INPUT,              /* const double *[components] */
  SLOT_OUTPUT,             /* double *[components] */
  SLOT_STATE_BEGIN,
  SLOT_STATE_END,
  SLOT_LAW,     /* const struct gamut_eos_law * or gamut_strength_law * */
  SLOT_SCRATCH, /* double *scratch[n] */
  SLOT_INVERSE_INPUT,
  SLOT_INVERSE_OUTPUT,    /* flow_stress_given, plastic_strain_inverse */
  SLOT_DERIVATIVE,        /* double *: first by derivative_by[index] */
  SLOT_SECOND_DERIVATIVE, /* double *: by derivative_by[index] and [other] (index <= other) */
  SLOT_DATA               /* const struct NAME_data *: what `prepare` made */
};
struct slot {
  enum slot_kind kind;
  size_t index, other;
  unsigned component, components; /* this pointer is component `component` of `components` */
  const char *name, *unit;
};
/* Layout of the struct as pointers; *slots is allocated, freed by the caller. Kernels see
 * parameters of type real, integer, boolean (0 or 1) and choice (its number) that are not prepared.
 */
size_t descriptor_layout(const struct descriptor *, struct slot **slots);

/* Digest of kind, id, the ordered names, units and components of the layout, and the ordered names
 * of choices (in groups and in arguments of measures too), measures, messages and kernels (FNV-1a,
 * 64 bits): 16 hex digits. Not of the prose, nor of defaults. Computed by descriptor_read. */

/* Writes NAME.gamut.h: the struct with a comment a member, an enum of each choice and of the
 * measures with the function that gives it, constants of messages, number of scratch arrays,
 * digest, struct NAME_ops (kind operations, then the kernels of variants,
 * then those of tasks, in declared order). */
void descriptor_header(const struct descriptor *, FILE *);
/* For people: `gamut show`. */
void descriptor_show(const struct descriptor *, FILE *);
void descriptor_show_json(const struct descriptor *, FILE *);

#endif
