/* "4569 m/s" to SI and back, by UDUNITS-2. */
#ifndef GAMUT_UNIT_H
#define GAMUT_UNIT_H

#include <stdbool.h>
#include <stddef.h>

/* The unit database; one a program, made in main and handed down. Any thread may read with it;
 * UDUNITS itself may not be called by two threads, so calls wait for each other: not for inner
 * loops. */
struct units;
struct units *units_new(char *why, size_t size); /* null with the reason in `why` */
void units_free(struct units *);                 /* accepts null */

enum unit_result {
  UNIT_OK,
  UNIT_NOT_A_NUMBER, /* the text does not start with a finite number that ends at a blank */
  UNIT_NAN,          /* nan, inf or a number too large for a double */
  UNIT_MISSING,      /* a bare number where a unit is due */
  UNIT_UNKNOWN,      /* the unit cannot be read */
  UNIT_DIMENSION,    /* the unit has another dimension */
  UNIT_UNWANTED      /* a unit where a pure number is due */
};

/* Reads "NUMBER UNIT" into SI of dimension `unit` ("Pa"; "1" or "" for pure numbers, where "%" is
 * understood as 0.01). Numbers by strtod in the C locale with nothing left over: "39ab" fails, "5%"
 * too ("5 %" is right). Units need no number in them but exponents: "1/s", "m-1", "kg/m^3". Angles
 * are pure numbers. *value is set only by UNIT_OK. */
enum unit_result unit_read(const struct units *, const char *text, const char *unit, double *value);

/* As unit_read, but a bare number is taken to be SI (for `gamut eval`). */
enum unit_result unit_read_bare(const struct units *, const char *text, const char *unit,
                                double *value);

/* As unit_read, for the difference of two such quantities: a spread, a width. 20 degC are 20 K and
 * 36 degF are 20 K, since a difference knows nothing of where a scale has its zero. */
enum unit_result unit_read_difference(const struct units *, const char *text, const char *unit,
                                      double *value);

/* Whether two units can be read and have the same dimension: unit_alike(u, x, x) is whether x is a
 * unit. */
bool unit_alike(const struct units *, const char *one, const char *other);

/* An example of a number with the unit as people write it, for messages ("8960 kg/m3"); the unit
 * itself if we know no example. */
const char *unit_example(const char *unit);

#endif
