/* Inside the scene room: what its readers share while one scene is read. */
#ifndef GAMUT_SCENE_PRIVATE_H
#define GAMUT_SCENE_PRIVATE_H

#include "base/array.h"
#include "scene/scene.h"

enum { PATH_SIZE = 512, WORDS_SIZE = 768 };
/* What is planned for each against each other: far above any use, and still planned in a moment. */
enum { MATERIALS_MAX = 1000, BODIES_MAX = 1000, EFFECTS_MAX = 1000 };

/* Memory that lives as long as the scene; freed in one go. */
struct scene_piece {
  struct scene_piece *next;
};
struct scene_store {
  struct scene shown; /* must stand first: the two pointers are one */
  struct scene_piece *piece;
};

/* Keys that stand one level up, down or aside: a key in the wrong place is sent there. */
struct neighbour {
  const char *where; /* "under 'strength:'" */
  const struct parameter *parameter;
  size_t parameters;
  const char *const *key;
  size_t keys;
};
enum { NEIGHBOURS_MAX = 8, GUESSES_MAX = 32 };

/* What a misspelt key of a mapping most likely stands for. */
struct guess {
  const struct tree *mapping;
  const char *name;
};

struct scene_reader {
  const struct units *units;
  struct trace *trace;
  const struct registry *registry; /* null outside scene_read; so is the scene */
  struct scene *scene;
  const struct tree *here; /* stands in where a value has no node */
  const char *const *body; /* names of the bodies; null: not checked */
  size_t bodies;
  const struct tree *bodies_node; /* their names as keys */
  unsigned axes;                  /* of the geometry; 0: the solver has none */
  bool axisymmetric;
  bool scaled;           /* of the material that is read */
  bool geometry_unknown; /* no solver or geometry was understood: axes are unknown */
  bool random;           /* some value is random */
  bool pointwise;        /* what is read now may differ from point to point */
  size_t faults;
  gamut_status first; /* status of the first fault */
  struct neighbour neighbour[NEIGHBOURS_MAX];
  size_t neighbours;
  struct guess guess[GUESSES_MAX];
  size_t guesses;
};

/* Zeroed memory. A scene takes little: where there is none left, the program ends. */
void *scene_take(size_t count, size_t size);                        /* freed by its owner */
void *scene_keep(struct scene_reader *, size_t count, size_t size); /* freed with the scene */
char *scene_text(struct scene_reader *, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* count.c: whether PART fits at most MOST times into WHOLE; else a fault at the node that says how
 * many WHAT ("frames") there would be. */
bool count_within(struct scene_reader *, const struct tree *, const char *what, double whole,
                  double part, double most);
/* The same for something that happens EVERY so long, up to the solver's end, or within one unit of
 * an axis that has none. */
bool every_within(struct scene_reader *, const struct tree *, const char *what, double every,
                  double most);
double axis_length(const struct scene_reader *); /* the solver's end; 0: it has none */

/* report_error.c: faults in words. `expected` may be null. */

void error_at_value(struct scene_reader *, const struct tree *, const char *expected,
                    const char *format, ...) __attribute__((format(printf, 4, 5)));
void error_at_key(struct scene_reader *, const struct tree *, const char *expected,
                  const char *format, ...) __attribute__((format(printf, 4, 5)));
/* The same with a path of its own, for what is not there. */
void error_at_missing(struct scene_reader *, const struct tree *, const char *path,
                      const char *expected, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
/* At a place in a file that is no tree, which `node` names. */
void error_at_place(struct scene_reader *, const struct place *, const struct tree *node,
                    const char *expected, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
void warn_value(struct scene_reader *, const struct tree *, const char *expected,
                const char *format, ...) __attribute__((format(printf, 4, 5)));
/* "did you mean 'x'?" where one is near, else "known are ..."; null if there is none, or if nobody
 * will see it. */
const char *suggest(const struct scene_reader *, const char *word, const char *const *known,
                    size_t count, char *buffer, size_t size);
/* The same of the keys of a mapping; null for none. */
const char *suggest_key(const struct scene_reader *, const char *word, const struct tree *mapping,
                        char *buffer, size_t size);
/* A list with commas: "a, b, c". Returns buffer. */
char *list_text(const char *const *name, size_t count, char *buffer, size_t size);
/* A key that nobody knows here; suggests the nearest, also of groups below and of neighbours. */
void error_at_unknown(struct scene_reader *, const struct tree *child, const struct parameter *,
                      size_t count, const char *const *also, size_t others, const char *what);
/* foreign.c: what gamut has for a name that other codes use; null if it is none of those. */
const char *foreign_name(const char *key);
/* Whether a key is what follows a decimal comma within braces: {A: 5,5 MPa} has the keys A and
 * "5 MPa". */
bool foreign_comma(const struct tree *);
/* renamed.c: the name that an old one was given up for; null if it is none. Of a key, by its path;
 * of a measure or a field, as each may stand where the other does. */
const char *renamed_key(const struct tree *);
const char *renamed_field(const char *name);
const char *renamed_words(const char *old, const char *now, char *buffer, size_t size);
/* Whether a key of the mapping that is a fault already was meant to be this one: it is not missed.
 */
bool is_typo_of(const struct scene_reader *, const struct tree *mapping, const char *name);
void neighbour_add(struct scene_reader *, const char *where, const struct parameter *,
                   size_t parameters, const char *const *key, size_t keys);
/* Whether a node is a mapping; else a fault that says what it should be. */
bool expect_mapping(struct scene_reader *, const struct tree *, const char *what);
/* The same of one that holds members by name, `member` written as one of them: not empty if one is
 * `needed`, and not beyond `most`. */
bool expect_members(struct scene_reader *, const struct tree *, const char *what,
                    const char *member, bool needed, size_t most);
/* Keys of a mapping against fixed ones; unknown ones are faults. */
void expect_keys(struct scene_reader *, const struct tree *, const char *const *known, size_t count,
                 const char *what);
/* Names of materials, bodies, effects and quantities are parts of paths. */
bool expect_name(struct scene_reader *, const struct tree *, const char *what);
bool has_name(const char *const *name, size_t count, const char *wanted);

/* One value. */

bool unit_is_pure(const char *unit);
/* A number in SI from a scalar; faults are reported at the node. */
bool amount_read(struct scene_reader *, const struct tree *, const char *name, const char *unit,
                 double *value);
/* The same for a difference of two such quantities: 20 degC are 20 K. */
bool interval_read(struct scene_reader *, const struct tree *, const char *name, const char *unit,
                   double *value);
/* A sequence of numbers; the array is the caller's to free, null with a fault. */
double *vector_read(struct scene_reader *, const struct tree *, const char *name, const char *unit,
                    size_t least, size_t most, size_t *count);
bool table_read(struct scene_reader *, const struct parameter *, const struct tree *,
                struct value *);
/* table_file.c: the rows of the CSV file that the node names, beside the file in which it does.
 * Null with a fault. */
struct table_file;
struct table_file *table_file_read(struct scene_reader *, const struct parameter *,
                                   const struct tree *name);
/* The numbers, row by row; the array is the caller's. */
double *table_file_numbers(struct table_file *, size_t *count);
/* A fault at the place of a row; and its line. */
void table_file_blame(struct table_file *, size_t row, const char *expected, const char *format,
                      ...) __attribute__((format(printf, 4, 5)));
size_t table_file_line(const struct table_file *, size_t row);
/* Whether it has as many rows as are declared; else a fault. */
bool table_file_fits(struct table_file *);
/* Where its numbers come from; the caller's. */
struct value_file *table_file_source(const struct table_file *);
/* Whether there are too few or too many rows, and how many there should be. */
bool rows_expected(const struct parameter *, size_t rows, char *expected, size_t size);
void table_file_free(struct table_file *); /* accepts null */
bool levels_read(struct scene_reader *, const struct parameter *, const struct tree *,
                 struct value *);
/* Whether the scene asks for a study whose runs stand for themselves: then what the first level
 * sets may be put in, where the scene below the levels, which is no member, cannot be read. */
bool levels_of_members(const struct scene_reader *, const struct tree *root);
void first_level_put(const struct scene_reader *, struct tree *root);
bool plugin_read(struct scene_reader *, enum gamut_kind, const struct tree *, struct value *);
bool random_read(struct scene_reader *, const struct parameter *, const struct tree *,
                 struct value *);
/* Physical range: a fault; range of the fit: a warning. `node` null: a derived value. */
bool range_check(struct scene_reader *, const struct parameter *, const struct tree *,
                 double value);
/* Warns of a given number outside a usual range, with the unit or the power of ten that would bring
 * it in. Numbers that are derived or drawn, and defaults, are not judged. */
void usual_check(struct scene_reader *, const struct parameter *, const struct range *,
                 const struct tree *, double value);
/* Warns of units that people read as another than they are. */
void unit_words_check(struct scene_reader *, const struct tree *);
/* A scalar's text; null with a fault. */
const char *text_read(struct scene_reader *, const struct tree *, const char *name);
/* A list of names, or one, each with its node; kept with the scene. */
struct names {
  const char **name;
  const struct tree **node;
  size_t count;
};
struct names names_read(struct scene_reader *, const struct tree *, const char *name, size_t most);

/* Values of a section. */

struct section {
  const struct descriptor *descriptor; /* of constraints and given sets; null: none */
  const struct parameter *parameter;
  size_t count;
  const struct tree *node; /* the mapping, or null */
  const char *path;
  const char *what; /* "strength 'johnson_cook'" */
  const char *const *also;
  size_t others;
  bool lenient;   /* what is required may be absent */
  bool pointwise; /* kernels see its numbers, so they may differ from point to point */
  bool open;      /* its other keys are looked at elsewhere */
  const struct alternatives *one_of; /* of its parameters; null: none */
};
/* Never null. */
struct values *section_read(struct scene_reader *, const struct section *);
/* Without values yet. */
struct values *values_new(const struct parameter *, size_t count, const struct tree *,
                          const char *path);
/* The path of a part, "solver.cell"; `buffer` of PATH_SIZE, which is returned. */
const char *path_below(const char *path, const char *name, char *buffer);
/* One value of any type, below the path. False with a fault. */
bool value_read(struct scene_reader *, const struct parameter *, const struct tree *,
                const char *path, struct value *);
/* Members of a group that is not given take their defaults; a lenient one asks for none. `what` it
 * is called in messages. */
bool group_read(struct scene_reader *, const struct parameter *, const struct tree *,
                const char *path, const char *what, bool lenient, struct value *);
/* input_files.c: the scene's record of a file that the node names. */
void input_file_record(struct scene_reader *, const struct tree *, const char *path,
                       const char *bytes, size_t size);
/* value_file.c: a file that the scene names; it is kept as it was then. */
bool file_value_read(struct scene_reader *, const struct parameter *, const struct tree *,
                     struct value *);
/* The path that a text in a file means: from that file's folder. False where it is too long. */
bool path_beside(const struct tree *name, char *path, size_t size);
struct value_file *value_file_new(const char *path);
void value_file_free(struct value_file *); /* accepts null */
/* value_nested.c; `node` null: no entries, no form. */
bool entries_read(struct scene_reader *, const struct parameter *, const struct tree *,
                  const char *path, struct value *);
bool one_of_read(struct scene_reader *, const struct parameter *, const struct tree *,
                 const char *path, struct value *);
/* The number of the word that a choice or boolean is; false where the node is none of them. */
bool word_known(const struct parameter *, const struct tree *, size_t *number);
/* The alternative, from 1, that the mapping gives first; 0: none of them. */
unsigned alternative_given(const struct section *);
/* Members of two alternatives, or of none where one is needed, are faults. */
void alternatives_check(struct scene_reader *, const struct section *, unsigned given);
/* Whether some given set speaks of the parameter: then it is not required by itself. */
bool given_set_names(const struct descriptor *, const char *name);
/* The given set that the values belong to; null if none or `descriptor` has no sets. */
const struct given_set *given_set_chosen(const struct values *, const struct descriptor *);
/* Chooses the given set, derives, checks ranges of what is derived, then the constraints. */
void values_check(struct scene_reader *, struct values *, const struct descriptor *,
                  const char *what);
/* Whether a constraint, or the range of what is derived, does not hold; `conflict` gets it. Silent.
 */
bool values_conflict(struct values *, const struct descriptor *, char *conflict, size_t size);

/* Parts of a scene. */

/* Reads the file with what it includes, puts overrides in. */
struct tree *include_read(struct scene_reader *, const char *file, const struct scene_override *,
                          size_t overrides);
void overrides_put(struct scene_reader *, struct tree *root, const struct scene_override *,
                   size_t overrides);
/* {model: NAME, ...} or NAME. `what` is the key: "strength". Descriptor null with a fault. */
void instance_read(struct scene_reader *, enum gamut_kind, const char *name, const struct tree *,
                   const char *const *also, size_t others, struct instance *);
/* The plugin of a kind where a scene names none; null where it must. */
const char *standard_model(enum gamut_kind);
/* Only the descriptor that `node` names; null (no fault) if it names none that is installed. */
const struct descriptor *instance_peek(const struct scene_reader *, enum gamut_kind,
                                       const struct tree *);
/* A card: materials for other scenes to include, nothing that could run. */
bool is_card(const struct tree *root);
void solver_read(struct scene_reader *, const struct tree *root);
void materials_read(struct scene_reader *, const struct tree *root);
void material_needs(
    struct scene_reader *); /* after effects: parameters that they ask of materials */
void bodies_read(struct scene_reader *, const struct tree *root);
bool shape_read(struct scene_reader *, const struct tree *, struct shape *);
void bodies_check(struct scene_reader *); /* overlaps, domain, cell */
void effects_read(struct scene_reader *, const struct tree *root);
/* effect_states.c: names the fields of effects' states, once all effects are read. */
void effect_states_name(struct scene_reader *);
/* The fields "one.damage, other.damage" where a name is that of a state which several effects keep
 * on one body; null where it is not. */
const char *effect_states_words(const struct scene_reader *, const char *name, char *buffer,
                                size_t size);
/* What to write in its place, as effect_states_words. */
const char *effect_states_expected(const struct scene_reader *, const char *name, char *buffer,
                                   size_t size);
void quantities_read(struct scene_reader *, const struct tree *root);
/* quantity_at.c: where it is taken. Where there are several points `places` gets them, x y z of one
 * after the other, to be freed; else its count is 0. */
struct places {
  double *place;
  size_t count;
};
void at_read(struct scene_reader *, const struct tree *, struct quantity *, struct places *);
bool reduction_read(struct scene_reader *, const struct tree *, const struct measure *,
                    struct reduction *);
void outputs_read(struct scene_reader *, const struct tree *root);
void uncertainty_read(struct scene_reader *,
                      const struct tree *root); /* last: lists what is random */
/* The parameter behind `density` of a material. */
const struct parameter *material_density(void);
/* A field or component of one by name ("velocity", "velocity_y", "plastic_strain") that this scene
 * can have: unit, or null. `component`: only what is one number a point. */
const char *field_unit(const struct scene_reader *, const char *name, bool component);
/* All such names, for suggestions; allocated. */
const char **field_names(struct scene_reader *, bool component, size_t *count);
const char *axis_unit(const struct scene_reader *); /* of the solver's axis: "s" */

/* {file:, spacing:}: points and their volumes. */
bool shape_points_read(struct scene_reader *, const struct tree *, struct shape *);
/* A length; it may be 0 where `least` is. */
bool length_read(struct scene_reader *, const struct tree *mapping, const char *key, bool required,
                 bool zero, double *length);

/* shape_index.c: for a union or points, once they are complete. */
void shape_index_make(struct scene_reader *, struct shape *);
double shape_index_depth(const struct shape *, const double x[3]);
/* Whether no two parts of a union have bounds with something in common. */
bool shape_parts_apart(const struct shape *, unsigned dimension);

/* True if x is in the shape and farther than `margin` from its surface. */
bool shape_inside(const struct shape *, const double x[3], double margin);
/* Bounds in a scene: an axisymmetric one has no negative radius. */
void shape_extent(const struct scene_reader *, const struct shape *, double lower[3],
                  double upper[3]);

#endif
