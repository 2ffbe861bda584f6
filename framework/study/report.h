/* What an estimator has reported beside moments; for report.c, which takes it, and report_write.c.
 */
#ifndef GAMUT_STUDY_REPORT_H
#define GAMUT_STUDY_REPORT_H

#include "study/study_private.h"

/* A number of a quantity: one a place where it is a curve. */
struct estimate {
  char *name, *unit, *meaning;
  size_t quantity;
  double *value;
};

/* Either numbers or texts, one a row. */
struct reported_column {
  char *name, *unit, *meaning;
  double *number;
  char **text;
};
struct reported_table {
  char *name, *meaning;
  struct reported_column *column;
  size_t columns, rows;
};

struct study_report {
  struct gamut_report open; /* first: what the estimator sees */
  struct study *study;
  gamut_status status; /* of what was reported so far */
  struct estimate *estimate;
  size_t estimates;
  struct reported_table *table;
  size_t tables;
};

#endif
