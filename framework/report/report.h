/* For people: progress lines, tables, pictures. */
#ifndef GAMUT_REPORT_H
#define GAMUT_REPORT_H

#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

/* Progress on a terminal: one line rewritten, with share, time, steps, rate (point-steps/s) and
 * ETA; elsewhere one line a tenth. */
struct progress;
/* Null when out of memory; the others accept null. */
struct progress *progress_new(FILE *, double end, const char *axis_unit);
void progress_free(struct progress *); /* ends the line */
void progress_tell(void *progress, double done, double time, uint64_t step, double rate);

/* The same for a study: runs done. */
struct runs_progress;
struct runs_progress *runs_progress_new(FILE *);
void runs_progress_free(struct runs_progress *);
void runs_progress_tell(void *progress, size_t done, size_t asked, size_t failed);

/* The quantities of a summary as a table with units that read well ("16.2 mm"). */
void report_summary(const char *summary_json, FILE *);

/* Pictures of a result folder with gnuplot: one PNG a history (history_NAME.png; history.png has
 * them all; of a study the mean with a band of one standard deviation), and the body coloured by a
 * field at the last (or given) frame
 * (body_FIELD_NNNNNNNN.png): the plane of a 2d scene, mirrored where it is axisymmetric; a slice
 * through the axis in 3d; the field over x in 1d. Data (SI) and .gp scripts stand beside the
 * pictures, so that they can be made again with `gnuplot FILE.gp`. Made in `folder`, or
 * RESULT/pictures. Prints the names of the pictures. Without gnuplot data and scripts are written,
 * and GAMUT_OUTPUT says which package is missing. */
struct plot_options {
  const char *field;
  long frame;
  const char *folder;
}; /* frame -1: last */
gamut_status report_plot(const char *result, const struct plot_options *, struct trace *);

#endif
