/* The core's side of the table that plugins call, in two files: values, and the rest. */
#ifndef GAMUT_RUN_HOST_H
#define GAMUT_RUN_HOST_H

#include "run/inside.h"

bool host_given(const struct gamut_values *, const char *path);
double host_real(const struct gamut_values *, const char *path);
long host_integer(const struct gamut_values *, const char *path);
bool host_boolean(const struct gamut_values *, const char *path);
const char *host_text(const struct gamut_values *, const char *path);
const double *host_vector(const struct gamut_values *, const char *path, size_t *count);
const double *host_table(const struct gamut_values *, const char *path, size_t *rows);

#endif
