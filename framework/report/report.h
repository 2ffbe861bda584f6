/* For people: progress lines, tables, pictures. */
#ifndef GAMUT_REPORT_H
#define GAMUT_REPORT_H

#include <stdio.h>

#include "error/error.h"

/* Progress on a terminal: one line rewritten, with share, time, steps, rate (point-steps/s) and ETA;
 * elsewhere one line a tenth. */
struct progress;
struct progress *progress_new(FILE *, double end, const char *axis_unit);
void progress_free(struct progress *); /* ends the line */
void progress_tell(void *progress, double done, double time, uint64_t step, double rate);

/* The quantities of a summary as a table with units that read well ("16.2 mm"). */
void report_summary(const char *summary_json, FILE *);

/* Pictures of a result folder with gnuplot: one PNG a history (history.png has them all), the body
 * coloured by a field at the last (or given) frame. Writes data and .gp scripts beside the pictures so
 * that they can be made again. Without gnuplot the scripts are written and that is said. */
struct plot_options { const char *field; long frame; const char *folder; }; /* frame -1: last */
gamut_status report_plot(const char *result, const struct plot_options *, struct trace *);

#endif
