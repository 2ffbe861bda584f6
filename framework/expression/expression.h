/* Arithmetic in YAML: constraints, given sets, measures, velocities. muParser behind a small face.
 */
#ifndef GAMUT_EXPRESSION_H
#define GAMUT_EXPRESSION_H

#include <stdbool.h>
#include <stddef.h>

struct expression;

/* Reads `text` over the named variables (borrowed array, names copied). Functions: sqrt exp log
 * log10 sin cos tan asin acos atan sinh cosh tanh abs min max pow; `^` is power; comparisons give 1
 * or 0;
 * `&&`, `||`, `c ? a : b`; the constant pi. On failure null with the reason in `why` (unknown names
 * are named). A variable hides a function of its name; min and max pass over NaN. A formula has one
 * value, at most 1000 ASCII characters and no assignments. Any thread. */
struct expression *expression_new(const char *text, const char *const *names, size_t count,
                                  char *why, size_t size);
void expression_free(struct expression *); /* accepts null */

/* The value where variable k is value[k]; NaN or infinite where the formula has none. One
 * expression is not for two threads at once. */
double expression_value(struct expression *, const double *value);

/* Whether the text uses the variable. */
bool expression_uses(const struct expression *, size_t variable);

#endif
