/* Inside the descriptor room: what its readers share while one YAML file is read. */
#ifndef GAMUT_DESCRIPTOR_PRIVATE_H
#define GAMUT_DESCRIPTOR_PRIVATE_H

#include "base/array.h"
#include "descriptor/descriptor.h"

/* Memory that lives as long as the descriptor; freed in one go. */
struct keep {
  struct keep *next;
};
struct descriptor_store {
  struct descriptor shown; /* must stand first: the two pointers are one */
  struct keep *kept;
};

struct reader {
  const struct units *units;
  struct trace *trace;
  struct descriptor *descriptor;
  size_t faults;
};

/* Zeroed memory of the descriptor. A descriptor takes some kilobytes: where there are none left,
 * the program ends. */
void *reader_keep(struct reader *, size_t count, size_t size);
char *reader_text(struct reader *, const char *text, size_t length);

/* Records a fault at a node's value or at its key. `expected` may be null. */
void reader_error_at_value(struct reader *, const struct tree *, const char *expected,
                           const char *format, ...) __attribute__((format(printf, 4, 5)));
void reader_error_at_key(struct reader *, const struct tree *, const char *expected,
                         const char *format, ...) __attribute__((format(printf, 4, 5)));
/* The same with "did you mean 'x'?" where one of the names is near, else the list of them. */
void reader_error_at_unknown(struct reader *, const struct tree *, bool at_key,
                             const char *const *known, size_t count, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

/* False with a fault if the node is no mapping. Each key that is not known is a fault. */
bool check_keys(struct reader *, const struct tree *, const char *const *known, size_t count,
                const char *what);
/* [A-Za-z][A-Za-z0-9_]*, not longer than 63 characters. */
bool is_name(const char *);
bool check_name(struct reader *, const struct tree *, bool at_key, const char *name);
/* Whether C has the word for itself, or a block or its arithmetic uses it. */
bool is_reserved(const char *name);

/* Scalars under a key of a mapping; null or `standard` if absent, with a fault if `required`. */
const char *read_text(struct reader *, const struct tree *, const char *key, bool required);
bool read_flag(struct reader *, const struct tree *, const char *key, bool standard);
long read_whole(struct reader *, const struct tree *, const char *key, long lower, long upper,
                long standard);
/* A sequence of scalars, each different; one scalar is a sequence of one. */
const char **read_texts(struct reader *, const struct tree *, const char *what, size_t *count);
/* A unit that the database knows; null if absent (a fault if `required`) or wrong. */
const char *read_unit(struct reader *, const struct tree *, const char *key, bool required);

/* Names of the parameters that expressions may use (real, integer, boolean). Returns their number.
 */
size_t arithmetic_names(struct reader *, const char ***names);
bool check_expression(struct reader *, const struct tree *, const char *text,
                      const char *const *names, size_t count);

/* What a declaration declares: only arguments of measures may take a unit from a field or name an
 * entry; arguments and entries need no `doc`. */
enum declared { DECLARED_PARAMETER, DECLARED_ARGUMENT, DECLARED_ENTRY };
void read_parameter(struct reader *, const struct tree *, enum declared, struct parameter *);
/* Parameters that hold others. */
void read_entries(struct reader *, const struct tree *, struct parameter *);
void read_forms(struct reader *, const struct tree *, struct parameter *);
void read_one_of(struct reader *, const struct tree *list, struct parameter *, size_t count,
                 struct alternatives *);
void check_entry_of(struct reader *, const struct tree *, const struct parameter *argument);

/* Each reads one section of the file. */
size_t read_parameters(struct reader *, const struct tree *, enum declared, struct parameter **);
void read_fields(struct reader *, const struct tree *root);   /* inputs, outputs, state, laws ... */
void read_rules(struct reader *, const struct tree *root);    /* constraints, given, variants */
void read_messages(struct reader *, const struct tree *root); /* messages, tasks */
void read_services(struct reader *, const struct tree *root); /* requires ... measures */

/* Text of a range to numbers; the reason in `why` on failure. */
bool range_read(const char *text, const char *unit, const struct units *, struct range *, char *why,
                size_t size);
bool range_within(const struct range *inner, const struct range *outer);

/* Faults of the struct that would be generated: names that C has, names that stand twice. */
void check_layout(struct reader *, const struct tree *root);
void check_geometry(struct reader *, const struct tree *root);
void descriptor_seal(struct descriptor *); /* computes the digest */

const char *value_type_name(enum value_type);
bool kernel_sees(const struct parameter *);

#endif
