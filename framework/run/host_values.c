#include <stdlib.h>

#include "run/host.h"

/* Asking for a value that the descriptor does not declare, or not with that type, is a fault of the
 * plugin that no scene can mend. */
static const struct value *demand(const struct gamut_values *values, const char *path,
                                  unsigned types)
{
  const struct value *value = values_find(values, path);
  if (value && (types >> value->parameter->type & 1u))
    return value;
  fprintf(stderr, "gamut: the plugin with the values '%s' asks for '%s', which its descriptor %s\n",
          values->path ? values->path : "", path,
          value ? "declares with another type" : "does not declare");
  exit(GAMUT_PLUGIN);
}

bool host_given(const struct gamut_values *values, const char *path)
{
  const struct value *value = values_find(values, path);
  return value && value->given;
}

double host_real(const struct gamut_values *values, const char *path)
{
  return demand(values, path, 1u << VALUE_REAL | 1u << VALUE_INTEGER)->real;
}

long host_integer(const struct gamut_values *values, const char *path)
{
  return (long)demand(values, path, 1u << VALUE_INTEGER)->real;
}

bool host_boolean(const struct gamut_values *values, const char *path)
{
  return demand(values, path, 1u << VALUE_BOOLEAN)->real != 0.0;
}

const char *host_text(const struct gamut_values *values, const char *path)
{
  return demand(values, path, 1u << VALUE_TEXT | 1u << VALUE_CHOICE | 1u << VALUE_BODY)->text;
}

const double *host_vector(const struct gamut_values *values, const char *path,
                                 size_t *count)
{
  const struct value *value = demand(values, path, 1u << VALUE_VECTOR);
  *count = value->present ? value->numbers : 0;
  return value->number;
}

const double *host_table(const struct gamut_values *values, const char *path, size_t *rows)
{
  const struct value *value = demand(values, path, 1u << VALUE_TABLE);
  *rows = value->present && value->parameter->choices ? value->numbers / value->parameter->choices
                                                      : 0;
  return value->number;
}
