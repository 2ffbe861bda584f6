/* One plugin with values, made ready to be called alone: what `gamut eval` and the checks stand on.
 */
#ifndef GAMUT_SPECIMEN_H
#define GAMUT_SPECIMEN_H

#include <stdbool.h>
#include <stddef.h>

#include "bench/lone_run.h"
#include "material/material.h"

/* A parameter's value as it would stand in a scene, with its unit. */
struct setting {
  const char *name;
  char *text; /* owned */
};
struct settings {
  struct setting *item;
  size_t count, capacity;
  const char *folder; /* that files are named from; null: the current one */
};
void settings_free(struct settings *);
/* Puts a value in YAML words; an earlier one of that name is replaced. */
void settings_put(struct settings *, const char *name, const char *text);
/* Puts a number in the SI unit of the parameter. */
void settings_number(struct settings *, const struct parameter *, double si);
/* Reads what a person wrote: with a unit, or bare and then SI. The parameter is named by its name
 * or its symbol. `what` stands for the source in messages ("--param"). */
gamut_status settings_read(struct settings *, const struct descriptor *, const char *name,
                           const char *text, const char *what, const struct units *,
                           struct trace *);
/* Puts what a test says of the parameter that the node is called like: a value of any type. */
gamut_status settings_node(struct settings *, const struct descriptor *, const struct tree *node,
                           const char *what, const struct units *, struct trace *);
void settings_copy(struct settings *, const struct settings *from);

/* A declared parameter or material parameter by name or symbol; null if there is none. */
const struct parameter *specimen_parameter(const struct descriptor *, const char *name);

struct specimen {
  const struct descriptor *descriptor;
  struct tree *tree;        /* what the values were read from */
  struct values *values;    /* of its parameters */
  struct values *extra;     /* of its material parameters; null if it has none */
  struct instance instance; /* the kernel keeps it: a specimen that was opened stays where it is */
  struct arena *arena;
  struct lone_run lone;  /* for the kernel's `prepare` */
  struct kernel *kernel; /* null until specimen_open */
};

/* Checks the settings as a scene's would be. `source` stands for the file in messages. */
gamut_status specimen_values(struct specimen *, const struct descriptor *, const struct settings *,
                             const char *source, const struct units *, struct trace *);
/* Opens the shared object and makes the kernel with room for `count` points. */
gamut_status specimen_open(struct specimen *, struct registry *, size_t count, double density,
                           struct trace *);
void specimen_close(struct specimen *);

/* Name of a slot's array as bench_array knows it ("stress_xx"). Returns buffer. */
char *slot_label(const struct slot *, char *buffer, size_t size);
/* Whether a kernel may read it but not write it. */
bool slot_is_input(const struct slot *);
/* Whether a kernel must write it. */
bool slot_is_output(const struct slot *);

#endif
