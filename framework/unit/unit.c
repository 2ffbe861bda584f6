#include "unit/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <udunits2.h>

#include "base/exclusive.h"
#include "unit/number.h"

/* UDUNITS parses with static variables and reads numbers by the locale of the thread: `enter` and
 * `leave` stand around every call. */
struct units {
  ut_system *system;
  locale_t c;
};

static locale_t enter(const struct units *units)
{
  exclusive_begin();
  return uselocale(units->c);
}

static void leave(locale_t before)
{
  uselocale(before);
  exclusive_end(NULL);
}

struct units *units_new(char *why, size_t size)
{
  EXCLUSIVE;
  struct units *units = calloc(1, sizeof *units);
  if (units == NULL) {
    snprintf(why, size, "no memory left for the unit database");
    return NULL;
  }
  ut_set_error_message_handler(ut_ignore);
  units->c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  if (units->c != (locale_t)0) {
    locale_t before = enter(units);
    units->system = ut_read_xml(NULL);
    leave(before);
  }
  if (units->system == NULL) {
    snprintf(why, size,
             "the unit database of UDUNITS-2 cannot be read (is its XML file installed, or "
             "does UDUNITS2_XML_PATH point elsewhere?)");
    units_free(units);
    return NULL;
  }
  return units;
}

void units_free(struct units *units)
{
  if (units == NULL)
    return;
  EXCLUSIVE;
  ut_free_system(units->system);
  if (units->c != (locale_t)0)
    freelocale(units->c);
  free(units);
}

/* Walks through a unit to the product of base units below it: its dimension, and the unit of SI. */

static ut_status fold_power(ut_unit **product, const ut_unit *basic, int power)
{
  if (ut_is_dimensionless(basic)) /* radians have no dimension here */
    return UT_SUCCESS;
  ut_unit *raised = ut_raise(basic, power);
  ut_unit *next = raised != NULL ? ut_multiply(*product, raised) : NULL;
  ut_free(raised);
  if (next == NULL)
    return UT_BAD_ARG;
  ut_free(*product);
  *product = next;
  return UT_SUCCESS;
}

static ut_status visit_basic(const ut_unit *unit, void *product)
{
  return fold_power(product, unit, 1);
}

static ut_status visit_product(const ut_unit *unit, int count, const ut_unit *const *basic,
                               const int *power, void *product)
{
  (void)unit;
  ut_status status = UT_SUCCESS;
  for (int k = 0; k < count && status == UT_SUCCESS; k++)
    status = fold_power(product, basic[k], power[k]);
  return status;
}

static const ut_visitor visitor;

static ut_status visit_galilean(const ut_unit *unit, double scale, const ut_unit *below,
                                double offset, void *product)
{
  (void)unit, (void)scale, (void)offset;
  return ut_accept_visitor(below, &visitor, product);
}

static ut_status refuse_timestamp(const ut_unit *unit, const ut_unit *below, double origin,
                                  void *product)
{
  (void)unit, (void)below, (void)origin, (void)product;
  return UT_BAD_ARG;
}

static ut_status refuse_logarithm(const ut_unit *unit, double base, const ut_unit *reference,
                                  void *product)
{
  (void)unit, (void)base, (void)reference, (void)product;
  return UT_BAD_ARG;
}

static const ut_visitor visitor = {visit_basic, visit_product, visit_galilean, refuse_timestamp,
                                   refuse_logarithm};

/* How much of SI one step of a unit with a zero of its own is: 5/9 for degF. Scales stack, offsets
 * do not count; of what is no such unit the step is that of its dimension, 1. */

static ut_status step_of_basic(const ut_unit *unit, void *step)
{
  (void)unit, (void)step;
  return UT_SUCCESS;
}

static ut_status step_of_product(const ut_unit *unit, int count, const ut_unit *const *basic,
                                 const int *power, void *step)
{
  (void)unit, (void)count, (void)basic, (void)power, (void)step;
  return UT_SUCCESS;
}

static const ut_visitor step_visitor;

static ut_status step_of_galilean(const ut_unit *unit, double scale, const ut_unit *below,
                                  double offset, void *step)
{
  (void)unit, (void)offset;
  *(double *)step *= scale;
  return ut_accept_visitor(below, &step_visitor, step);
}

static const ut_visitor step_visitor = {step_of_basic, step_of_product, step_of_galilean,
                                        refuse_timestamp, refuse_logarithm};

/* A difference in SI: of a unit without a zero of its own it is what the number itself is. */
static double difference_of(const ut_unit *unit, const cv_converter *converter, double number)
{
  double step = 1;
  if (cv_convert_double(converter, 0) == 0 ||
      ut_accept_visitor(unit, &step_visitor, &step) != UT_SUCCESS)
    return cv_convert_double(converter, number);
  return step * number;
}

/* Reads a unit and the unit of SI of its dimension; both are the caller's to free, also on failure.
 */
static bool parse(const struct units *units, const char *text, ut_unit **unit, ut_unit **si)
{
  char copy[UNIT_TEXT_MAX];
  *unit = *si = NULL;
  if (!unit_text(text, copy))
    return false;
  *unit = ut_parse(units->system, copy[0] == '\0' ? "1" : copy, UT_UTF8);
  *si = *unit != NULL ? ut_get_dimensionless_unit_one(units->system) : NULL;
  return *si != NULL && ut_accept_visitor(*unit, &visitor, si) == UT_SUCCESS;
}

/* UDUNITS calls reciprocal units convertible ("5 s" for "1/s"), so dimensions are compared. */
static enum unit_result convert(const struct units *units, const char *given, const char *wanted,
                                bool difference, double *value)
{
  ut_unit *from, *from_si, *to, *to_si;
  cv_converter *converter = NULL;
  enum unit_result result = UNIT_UNKNOWN;
  bool readable = parse(units, given, &from, &from_si);
  readable = parse(units, wanted, &to, &to_si) && readable;
  if (readable && ut_compare(from_si, to_si) != 0)
    result = ut_is_dimensionless(to_si) ? UNIT_UNWANTED : UNIT_DIMENSION;
  else if (readable)
    converter = ut_get_converter(from, to_si);
  if (converter != NULL) {
    *value =
        difference ? difference_of(from, converter, *value) : cv_convert_double(converter, *value);
    result = isfinite(*value) ? UNIT_OK : UNIT_NAN;
  }
  cv_free(converter);
  ut_free(from);
  ut_free(from_si);
  ut_free(to);
  ut_free(to_si);
  return result;
}

enum reading_as { AS_STATED, BARE_IS_SI, AS_DIFFERENCE };

static enum unit_result read_quantity(const struct units *units, const char *text, const char *unit,
                                      enum reading_as as, double *value)
{
  const char *rest;
  double number;
  enum unit_result result = number_read(text, units->c, &number, &rest);
  if (result != UNIT_OK)
    return result;
  bool pure = unit[0] == '\0' || (unit[0] == '1' && unit[1] == '\0');
  if (*rest == '\0' && !pure && as != BARE_IS_SI)
    return UNIT_MISSING;
  if (*rest != '\0') {
    locale_t before = enter(units);
    result = convert(units, rest, unit, as == AS_DIFFERENCE, &number);
    leave(before);
  }
  if (result == UNIT_OK)
    *value = number;
  return result;
}

enum unit_result unit_read(const struct units *units, const char *text, const char *unit,
                           double *value)
{
  return read_quantity(units, text, unit, AS_STATED, value);
}

enum unit_result unit_read_bare(const struct units *units, const char *text, const char *unit,
                                double *value)
{
  return read_quantity(units, text, unit, BARE_IS_SI, value);
}

enum unit_result unit_read_difference(const struct units *units, const char *text, const char *unit,
                                      double *value)
{
  return read_quantity(units, text, unit, AS_DIFFERENCE, value);
}

bool unit_alike(const struct units *units, const char *one, const char *other)
{
  double value = 1;
  locale_t before = enter(units);
  enum unit_result result = convert(units, one, other, false, &value);
  leave(before);
  return result == UNIT_OK;
}
