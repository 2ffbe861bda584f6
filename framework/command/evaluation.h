/* One kernel at given states: the points of `gamut eval` and what came out. */
#ifndef GAMUT_EVALUATION_H
#define GAMUT_EVALUATION_H

#include <stdio.h>

#include "bench/specimen.h"
#include "command/options.h"

/* An input of the kernel: one value, or a range of `count` values. */
struct eval_input {
  char name[64];
  const char *unit;
  bool read; /* the kernel reads it */
  bool given;
  double from, to;
  size_t count;
};

/* A parameter (or input) that derivatives are taken by. */
struct eval_by {
  const char *name;
  int own;       /* its number in the descriptor's `derivatives: by`, or -1: by differences */
  int parameter; /* its number in the descriptor, or -1: an input */
};

struct evaluation {
  const struct descriptor *descriptor;
  struct specimen specimen;
  struct bench *bench, *probe; /* all points; one point for differences */
  struct eval_input *input;
  size_t inputs;
  struct slot *slot;
  size_t slots;
  struct eval_by *by;
  size_t bys;
  const char *of; /* what derivatives are taken of */
  size_t points;
  bool derivatives;
  double *first, *second; /* [point * bys + k], [(point * bys + k) * bys + l] */
};

enum { EVAL_POINTS_MAX = 1000000 };

/* Reads "name=value" or "name=from:to:count" (several separated by commas) into the inputs. */
gamut_status evaluation_at(struct evaluation *, struct command *, const char *text);
/* The inputs of the kind and of the descriptor, at their defaults. */
gamut_status evaluation_new(struct evaluation *, const struct descriptor *, struct command *);
/* Makes the kernel from the parameters, fills the points, calls. */
gamut_status evaluation_run(struct evaluation *, const struct settings *, struct command *);
void evaluation_free(struct evaluation *);
/* Value of an input at a point. */
double evaluation_input(const struct evaluation *, size_t input, size_t point);

/* The object of the contract, all in SI. */
gamut_status evaluation_json(struct evaluation *, FILE *, struct trace *);
/* A table for people. */
void evaluation_text(struct evaluation *, FILE *);

/* The worst status of all points, with the first point that has it. */
enum gamut_severity evaluation_worst(struct evaluation *, size_t *point, const char **name,
                                     const char **text);

/* Calls `take` for each "name=value" of a text with several, separated by commas. */
gamut_status split_pairs(struct command *, const char *option, const char *text,
                         gamut_status (*take)(void *, const char *name, const char *value),
                         void *self);

#endif
