#include "report/readable.h"
#include "base/array.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Units that take a prefix, and the powers of ten between which they are used. Others stay as they
 * are: nobody reads km2 for 1e6 m2 with ease. */
static const struct prefixable {
  const char *unit, *stem;
  int lowest, highest; /* multiples of 3 */
  int own;             /* power of ten of the unit itself: kg is 3 of g */
} prefixables[] = {
    {"m", "m", -9, 3, 0},       {"s", "s", -12, 0, 0},      {"kg", "g", -9, 3, 3},
    {"Pa", "Pa", 0, 12, 0},     {"N", "N", -3, 9, 0},       {"J", "J", -6, 12, 0},
    {"W", "W", -3, 12, 0},      {"Hz", "Hz", 0, 12, 0},     {"J/m3", "J/m3", 0, 12, 0},
    {"N/m", "N/m", 0, 12, 0},   {"N m", "N m", -3, 9, 0},   {"N s", "N s", -6, 6, 0},
    {"Pa s", "Pa s", -6, 9, 0}, {"Pa/s", "Pa/s", 0, 18, 0}, {"m/s", "m/s", -3, 3, 0},
};

static const char *prefix(int power)
{
  static const char *const names[] = {"p", "n", "u", "m", "", "k", "M", "G", "T", "P", "E"};
  return names[power / 3 + 4];
}

double readable_unit(double size, const char *unit, char *name, size_t name_size)
{
  size = fabs(size);
  snprintf(name, name_size, "%s", strcmp(unit, "1") == 0 ? "" : unit);
  if (!isfinite(size) || size == 0)
    return 1;
  for (size_t i = 0; i < ARRAY_SIZE(prefixables); ++i) {
    const struct prefixable *p = &prefixables[i];
    if (strcmp(p->unit, unit) != 0)
      continue;
    /* 1e-12 of room, so that 1000 times a rounded 1e-3 is still 1 */
    int power = 3 * (int)floor((log10(size) + p->own + 1e-12) / 3);
    power = power < p->lowest ? p->lowest : power > p->highest ? p->highest : power;
    if (strcmp(unit, "m/s") == 0 && size >= 1 && size < 1e4)
      power = 0; /* speeds of impact are m/s */
    snprintf(name, name_size, "%s%s", prefix(power), p->stem);
    return pow(10, p->own - power);
  }
  return 1;
}

char *readable_like(double value, double like, const char *unit, char *text, size_t size)
{
  char name[40];
  double factor = readable_unit(like, unit, name, sizeof name);
  snprintf(text, size, "%.4g%s%s", value * factor, *name ? " " : "", name);
  return text;
}

char *readable(double value, const char *unit, char *text, size_t size)
{
  return readable_like(value, value, unit, text, size);
}

char *readable_rate(double rate, char *text, size_t size)
{
  if (rate >= 1e6)
    snprintf(text, size, "%.3g million point-steps/s", rate / 1e6);
  else
    snprintf(text, size, "%.0f point-steps/s", rate);
  return text;
}
