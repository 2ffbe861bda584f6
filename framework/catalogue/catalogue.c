#include "catalogue/catalogue.h"
#include "base/array.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const struct field_info catalogue[] = {
#define CATALOGUE_ENTRY(name, where, components, unit, meaning)                                    \
  {#name, where, components, unit, meaning, GAMUT_WRITE},
    FIELD_CATALOGUE(CATALOGUE_ENTRY)
#undef CATALOGUE_ENTRY
#define CATALOGUE_ENTRY(name, access, unit, meaning)                                               \
  {#name, GAMUT_AT_POINT, 1, unit, meaning, access},
        FIELD_CATALOGUE_SHARED(CATALOGUE_ENTRY)
#undef CATALOGUE_ENTRY
};

double access_neutral(enum gamut_access access)
{
  return access == GAMUT_SCALE ? 1.0 : access == GAMUT_LEAST ? (double)INFINITY : 0.0;
}

enum { CATALOGUE_SIZE = ARRAY_SIZE(catalogue) };

const struct field_info *catalogue_find(const char *name)
{
  for (size_t i = 0; i < CATALOGUE_SIZE; i++)
    if (strcmp(catalogue[i].name, name) == 0)
      return &catalogue[i];
  return NULL;
}

const struct field_info *catalogue_at(size_t index)
{
  return index < CATALOGUE_SIZE ? &catalogue[index] : NULL;
}

const char *component_name(unsigned components, unsigned k)
{
  static const char *const vector[] = {"x", "y", "z"};
  static const char *const symmetric[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  static const char *const full[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  static const char *const number[] = {"0",  "1",  "2",  "3",  "4",  "5",  "6",  "7",
                                       "8",  "9",  "10", "11", "12", "13", "14", "15",
                                       "16", "17", "18", "19", "20", "21", "22", "23",
                                       "24", "25", "26", "27", "28", "29", "30", "31"};
  assert(k < components && components <= CATALOGUE_COMPONENTS_MAX);
  switch (components) {
  case 1:
    return "";
  case 2:
  case 3:
    return vector[k];
  case 6:
    return symmetric[k];
  case 9:
    return full[k];
  default:
    return number[k];
  }
}
