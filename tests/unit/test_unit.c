#include "unit/unit.h"

#include <locale.h>
#include <pthread.h>
#include <stdlib.h>

#include "tests/tap.h"

static void check(const struct units *units, const char *text, const char *unit, double expected)
{
  double value = NAN;
  char name[100];
  enum unit_result result = unit_read(units, text, unit, &value);
  snprintf(name, sizeof name, "'%s' in '%s' (result %d)", text, unit, (int)result);
  tap_relative(name, value, expected, 1e-14);
}

static void refuse(const struct units *units, const char *text, const char *unit,
                   enum unit_result expected)
{
  double value = 7;
  enum unit_result result = unit_read(units, text, unit, &value);
  tap_ok(result == expected && value == 7, "'%.40s' in '%s': result %d (%d), value untouched", text,
         unit, (int)result, (int)expected);
}

static void test_values(const struct units *units)
{
  check(units, "8960 kg/m3", "kg/m3", 8960);
  check(units, "8.96 g/cm3", "kg/m^3", 8960);
  check(units, "190 m/s", "m/s", 190);
  check(units, "383 J/(kg K)", "J/(kg K)", 383);
  check(units, "124 GPa", "Pa", 124e9);
  check(units, "1 Mbar", "Pa", 1e11);
  check(units, "80 us", "s", 80e-6);
  check(units, "80 \xC2\xB5s", "s", 80e-6);
  check(units, "25.4 mm", "m", 0.0254);
  check(units, "1e3 1/s", "1/s", 1000);
  check(units, "2 1/ms", "1/s", 2000);
  check(units, "3 J/m^3", "Pa", 3);
  check(units, "2 cm3", "m3", 2e-6);
  check(units, "25 degC", "K", 298.15);
  check(units, "-273.15 degC", "K", 0);
  check(units, "2 J/(kg degC)", "J/(kg K)", 2);
  check(units, "60 rpm", "1/s", 6.283185307179586);
  check(units, "180 degree", "1", 3.141592653589793);
  check(units, "12 %", "1", 0.12);
  check(units, "12 %", "", 0.12);
  check(units, "-.5e-1", "1", -0.05);
  check(units, "+3", "", 3);
  check(units, "  4   mm  ", "m", 0.004);
  check(units, "4\tmm", "m", 0.004);
  check(units, "1e-400 m", "m", 0);
  check(units, "5 mm", "mm", 0.005);
  check(units, "1 GPa", "MPa", 1e9);
}

static void check_difference(const struct units *units, const char *text, const char *unit,
                             double expected)
{
  double value = NAN;
  char name[100];
  enum unit_result result = unit_read_difference(units, text, unit, &value);
  snprintf(name, sizeof name, "the difference '%s' in '%s' (result %d)", text, unit, (int)result);
  tap_relative(name, value, expected, 1e-14);
}

static void test_differences(const struct units *units)
{
  check_difference(units, "20 degC", "K", 20);
  check_difference(units, "36 degF", "K", 20);
  check_difference(units, "20 K", "K", 20);
  check_difference(units, "9 degR", "K", 5);
  check_difference(units, "5 MPa", "Pa", 5e6);
  check_difference(units, "2 J/(kg degC)", "J/(kg K)", 2);
  check_difference(units, "12 %", "1", 0.12);
  check_difference(units, "3", "1", 3);
}

static void test_refusals(const struct units *units)
{
  static const char *const no_number[] = {
      "",      "39ab",  "39ab m",  "m",     "1,5 m",  "0x10 m", "5%",  "5m",        "1e m",
      "--1 m", "1.2.3", "1e5e5 m", "+ 5 m", "copper", "e m",    ". m", "5\xC2\xA0m"};
  for (size_t k = 0; k < sizeof no_number / sizeof *no_number; k++)
    refuse(units, no_number[k], "m", UNIT_NOT_A_NUMBER);
  static const char *const no_value[] = {"nan",  "NaN m",   "inf",    "-inf m",   "Infinity m",
                                         ".inf", "1e999 m", "-1e999", "1e308 Gm", "-.INF"};
  for (size_t k = 0; k < sizeof no_value / sizeof *no_value; k++)
    refuse(units, no_value[k], "m", UNIT_NAN);
  refuse(units, "5", "m", UNIT_MISSING);
  refuse(units, "5 ", "m/s", UNIT_MISSING);
  static const char *const unknown[] = {
      "5 mmm",     "5 foo", "5 10 m",  "5 m 3",         "5 m^0.5", "5 (m",
      "5 m^99999", "5 m/0", "5 K @ 2", "5 lg(re 1 mW)", "5 1e3 m", "5 s since 2000-01-01",
      "5 m\x01",   "5 ;",   "5 m*2"};
  for (size_t k = 0; k < sizeof unknown / sizeof *unknown; k++)
    refuse(units, unknown[k], "m", UNIT_UNKNOWN);
  refuse(units, "5 MPa m^0.5", "Pa", UNIT_UNKNOWN);
  refuse(units, "5 kg", "m", UNIT_DIMENSION);
  refuse(units, "5 %", "m", UNIT_DIMENSION);
  refuse(units, "5 s", "1/s", UNIT_DIMENSION);
  refuse(units, "5 m3/kg", "kg/m3", UNIT_DIMENSION);
  refuse(units, "5 m", "1", UNIT_UNWANTED);
  refuse(units, "5 m", "", UNIT_UNWANTED);
  refuse(units, "5 foo", "1", UNIT_UNKNOWN);
  size_t length = 1000000;
  char *text = malloc(length + 1);
  memset(text, '(', length);
  text[length] = '\0';
  memcpy(text, "5 ", 2);
  refuse(units, text, "m", UNIT_UNKNOWN);
  memset(text, '9', length);
  refuse(units, text, "m", UNIT_NAN);
  free(text);
}

static void *read_often(void *units)
{
  size_t wrong = 0;
  for (int k = 0; k < 2000; k++) {
    double value;
    wrong += unit_read(units, "25.4 mm", "m", &value) != UNIT_OK || value != 0.0254;
    wrong += unit_read(units, "1 furlongs/", "m", &value) != UNIT_UNKNOWN;
  }
  return (void *)wrong;
}

static void test_threads(struct units *units)
{
  pthread_t thread[4];
  size_t wrong = 0;
  for (int k = 0; k < 4; k++)
    pthread_create(&thread[k], NULL, read_often, units);
  for (int k = 0; k < 4; k++) {
    void *more;
    pthread_join(thread[k], &more);
    wrong += (size_t)more;
  }
  tap_ok(wrong == 0, "four threads: %zu of 16000 wrong (0)", wrong);
}

/* A locale with a decimal comma, if the machine has one. */
static void test_locale(const struct units *units)
{
  static const char *const comma[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR"};
  bool set = false;
  for (size_t k = 0; !set && k < sizeof comma / sizeof *comma; k++)
    set = setlocale(LC_ALL, comma[k]) != NULL;
  if (!set) {
    tap_skip("a locale with a decimal comma", "none is installed");
    return;
  }
  char why[200];
  struct units *other = units_new(why, sizeof why);
  check(units, "1.5 mm", "m", 0.0015);
  check(other, "10 psi", "Pa", 68947.5729316836);
  refuse(units, "1,5 mm", "m", UNIT_NOT_A_NUMBER);
  units_free(other);
  setlocale(LC_ALL, "C");
}

int main(void)
{
  char why[200] = "";
  struct units *units = units_new(why, sizeof why);
  if (!tap_ok(units != NULL, "the unit database %s", why))
    return tap_done();
  test_values(units);
  test_differences(units);
  test_refusals(units);
  test_threads(units);
  test_locale(units);
  double value = 0;
  tap_ok(unit_read_bare(units, "5", "m", &value) == UNIT_OK && value == 5, "a bare number is SI");
  tap_ok(unit_read_bare(units, "5 mm", "m", &value) == UNIT_OK && value == 0.005,
         "bare, with unit");
  tap_ok(unit_alike(units, "GPa", "J/m3"), "GPa and J/m3 are alike");
  tap_ok(!unit_alike(units, "s", "1/s"), "s and 1/s are not");
  tap_ok(!unit_alike(units, "foo", "foo") && unit_alike(units, "", "1"), "no unit is like nothing");
  tap_text("an example", unit_example("kg/m3"), "8960 kg/m3");
  tap_text("no example", unit_example("mol/s"), "mol/s");
  static const char *const si[] = {"m", "Pa", "J/(kg K)", "1/K", "W/(m K)", "1", "m/s^2", "rad"};
  for (size_t k = 0; k < sizeof si / sizeof *si; k++)
    tap_ok(unit_read(units, unit_example(si[k]), si[k], &value) == UNIT_OK, "the example of %s",
           si[k]);
  units_free(units);
  setenv("UDUNITS2_XML_PATH", "/nonexistent.xml", 1);
  tap_ok(units_new(why, sizeof why) == NULL && strlen(why) > 20, "no database: %s", why);
  return tap_done();
}
