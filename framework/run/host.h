/* The core's side of the table that plugins call: values, laws of a solver's own, and the rest. */
#ifndef GAMUT_RUN_HOST_H
#define GAMUT_RUN_HOST_H

#include <stdarg.h>

#include "run/run_private.h"

/* Values: the same for every host. */
#define HOST_OF_VALUES                                                                             \
  .given = host_given, .real = host_real, .integer = host_integer, .boolean = host_boolean,        \
  .text = host_text, .vector = host_vector, .table = host_table, .entries = host_entries,          \
  .entry_name = host_entry_name, .entry = host_entry, .file = host_file
/* Gives values and the groups below them their host; accepts null. */
void host_of_values(struct gamut_values *, const struct gamut_host *);

/* host_messages.c: GAMUT_SCENE at the node, where there is one; at a value; what is no fault. */
gamut_status host_messages_fail(struct trace *, gamut_status, const struct tree *,
                                const char *format, va_list);
/* At a value; of a table that comes from a file also at a row of it, "curve.3", from 0. */
gamut_status host_messages_fail_at(struct trace *, const struct gamut_values *, const char *path,
                                   const char *expected, const char *format, va_list);
gamut_status host_messages_fail_in_file(struct trace *, const struct gamut_values *,
                                        const char *path, size_t line, const char *expected,
                                        const char *format, va_list);
void host_messages_warn(struct trace *, const char *format, va_list);
void host_messages_note(struct trace *, const char *format, va_list);

bool host_given(const struct gamut_values *, const char *path);
double host_real(const struct gamut_values *, const char *path);
long host_integer(const struct gamut_values *, const char *path);
bool host_boolean(const struct gamut_values *, const char *path);
const char *host_text(const struct gamut_values *, const char *path);
const double *host_vector(const struct gamut_values *, const char *path, size_t *count);
gamut_status host_formula(struct gamut_run *, const struct gamut_values *, const char *path,
                          struct gamut_formula **);
double host_formula_value(const struct gamut_formula *, int thread, const double *variable);
bool host_formula_uses(const struct gamut_formula *, size_t variable);
const double *host_table(const struct gamut_values *, const char *path, size_t *rows);
const char *host_file(const struct gamut_values *, const char *path, size_t *size);
size_t host_entries(const struct gamut_values *, const char *path);
const char *host_entry_name(const struct gamut_values *, const char *path, size_t index);
const struct gamut_values *host_entry(const struct gamut_values *, const char *path, size_t index);

gamut_status host_law(struct gamut_run *, const struct gamut_body *, const char *kind, size_t count,
                      struct gamut_law **);
double *host_law_array(struct gamut_law *, const char *name);
bool host_law_call(struct gamut_law *, const char *operation, size_t count, int64_t *worst);
gamut_status host_law_places(struct gamut_run *, struct gamut_law *,
                             const double *const position[3], const int64_t *id);
const char *host_law_message(const struct gamut_law *, int64_t word);

struct gamut_stream host_stream(const struct gamut_run *, const char *name);
uint64_t host_realisation(const struct gamut_run *);
gamut_status host_sample(struct gamut_run *, const struct gamut_values *, const char *path,
                         const char *name, size_t count, const double *const position[3],
                         const int64_t *id, double *value, bool *given);
gamut_status host_removal(struct gamut_run *, const struct gamut_removal *,
                          const struct gamut_removed **, double *mark);
void host_drop(struct gamut_run *, struct gamut_set *, const uint32_t *slot, size_t count);
/* host_sums.c: the same for every host. */
#define HOST_OF_SUMS .sum = host_sum, .most = host_most
void host_sum(struct gamut_run *, const double *value, size_t rows, size_t columns, double *total);
double host_most(struct gamut_run *, const double *value, size_t count);
bool host_domain(const struct gamut_run *, double lower[3], double upper[3]);

#endif
