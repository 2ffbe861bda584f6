/* The texts of a quantity: "NUMBER UNIT". */
#ifndef GAMUT_UNIT_NUMBER_H
#define GAMUT_UNIT_NUMBER_H

#include <locale.h>
#include <stddef.h>

#include "unit/unit.h"

enum { UNIT_TEXT_MAX = 64 };

/* Reads the number in front: UNIT_OK, UNIT_NOT_A_NUMBER or UNIT_NAN. *rest points behind the blanks
 * that follow it. `c` is the C locale. */
enum unit_result number_read(const char *text, locale_t c, double *value, const char **rest);

/* Copies a unit's text without blanks around it. False if it is no unit whatever the database says:
 * too long, or with numbers in it other than whole exponents and a leading "1/". UDUNITS would take
 * those for factors, and "m^0.5" for 5. */
bool unit_text(const char *text, char copy[UNIT_TEXT_MAX]);

#endif
