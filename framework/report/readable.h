/* Numbers with units as people write them: 0.0162 m is "16.2 mm". */
#ifndef GAMUT_READABLE_H
#define GAMUT_READABLE_H

#include <stddef.h>

/* The unit in which a value of that size reads well: writes its name to `name` and returns the
 * factor that leads to it (1000 and "mm" for 0.0162 m). The name of a pure number is empty. */
double readable_unit(double size, const char *unit, char *name, size_t name_size);

/* "16.2 mm". Returns text. */
char *readable(double value, const char *unit, char *text, size_t size);
/* The same in the unit that suits `like`. */
char *readable_like(double value, double like, const char *unit, char *text, size_t size);
/* "12.3 million point-steps/s" */
char *readable_rate(double rate, char *text, size_t size);

#endif
