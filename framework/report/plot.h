/* Pieces of `gamut plot`. */
#ifndef GAMUT_PLOT_H
#define GAMUT_PLOT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "store/result.h"

/* A set of pictures in the making. */
struct plot {
  const char *folder;
  char *title;
  bool axisymmetric;
  struct trace *trace;
  char **name; /* of the pictures, without ".png"; each has a script NAME.gp */
  size_t count, room;
};

/* Adds a picture. */
gamut_status plot_add(struct plot *, const char *name);
/* Opens FOLDER/NAME + end for writing; null after recording why not. */
FILE *plot_file(const struct plot *, const char *name, const char *end);
gamut_status plot_file_close(const struct plot *, FILE *, const char *name);

/* Starts a script: terminal of that size, output NAME.png, what all pictures share. */
void plot_script(FILE *, const char *name, int width, int height);
/* 'text' for gnuplot. */
void plot_text(FILE *, const char *text);
/* "name [unit]"; the unit is left out of a pure number. Not quoted: for plot_text. */
char *plot_label(const char *name, const char *unit, char *label, size_t size);
/* A name as part of a file's name: what is no letter, digit, '_' or '-' becomes '_'. */
char *plot_file_name(const char *start, const char *name, char *made, size_t size);

gamut_status plot_histories(struct plot *, const struct result_history *, size_t count);
gamut_status plot_body(struct plot *, const struct result_frame *, size_t number);

/* Runs gnuplot over the scripts. */
gamut_status plot_run(const struct plot *);

#endif
