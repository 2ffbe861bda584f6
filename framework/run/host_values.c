#include <stdlib.h>
#include <string.h>

#include "registry/guard.h"
#include "run/host.h"

static _Noreturn void end_of(const struct gamut_values *values, const char *path, const char *why)
{
  fprintf(stderr, "gamut: the plugin with the values '%s' asks for '%s', %s\n",
          values->path ? values->path : "", path, why);
  guard_finish();
  exit(GAMUT_PLUGIN);
}

/* Asking for a value that the descriptor does not declare, or not with that type, is a fault of the
 * plugin that no scene can mend. */
static const struct value *demand(const struct gamut_values *values, const char *path,
                                  unsigned types)
{
  const struct value *value = values_find(values, path);
  if (value && (types >> value->parameter->type & 1u))
    return value;
  end_of(values, path,
         value ? "which its descriptor declares with another type"
               : "which its descriptor does not declare");
}

void host_of_values(struct gamut_values *values, const struct gamut_host *host)
{
  if (!values)
    return;
  values->host = host;
  for (size_t i = 0; i < values->count; i++)
    host_of_values(values->value[i].group, host);
}

bool host_given(const struct gamut_values *values, const char *path)
{
  const struct value *value = values_find(values, path);
  return value && value->given;
}

/* Where `prepare` took a number that kernels see, what it makes of it would be wrong at points that
 * have another one. */
double host_real(const struct gamut_values *values, const char *path)
{
  const struct value *value = demand(values, path, 1u << VALUE_REAL | 1u << VALUE_INTEGER);
  if (values->preparing && value->parameter->type == VALUE_REAL && !strchr(path, '.') &&
      !value->parameter->prepared)
    end_of(values, path, "which its kernels see at each point; `prepared: true` is for `prepare`");
  return value->real;
}

long host_integer(const struct gamut_values *values, const char *path)
{
  const struct value *value = demand(values, path, 1u << VALUE_INTEGER | 1u << VALUE_CHOICE);
  const bool chosen = value->parameter->type != VALUE_CHOICE || value->text;
  return chosen ? (long)value->real : -1;
}

bool host_boolean(const struct gamut_values *values, const char *path)
{
  return demand(values, path, 1u << VALUE_BOOLEAN)->real != 0.0;
}

const char *host_text(const struct gamut_values *values, const char *path)
{
  return demand(values, path,
                1u << VALUE_TEXT | 1u << VALUE_CHOICE | 1u << VALUE_BODY | 1u << VALUE_FILE)
      ->text;
}

const char *host_file(const struct gamut_values *values, const char *path, size_t *size)
{
  const struct value *value = demand(values, path, 1u << VALUE_FILE);
  *size = value->file ? value->file->length : 0;
  return value->file ? value->file->content : NULL;
}

const double *host_vector(const struct gamut_values *values, const char *path, size_t *count)
{
  const struct value *value = demand(values, path, 1u << VALUE_VECTOR);
  *count = value->present ? value->numbers : 0;
  return value->number;
}

const double *host_table(const struct gamut_values *values, const char *path, size_t *rows)
{
  const struct value *value = demand(values, path, 1u << VALUE_TABLE);
  *rows =
      value->present && value->parameter->choices ? value->numbers / value->parameter->choices : 0;
  return value->number;
}

static const struct gamut_values *entries_of(const struct gamut_values *values, const char *path)
{
  return demand(values, path, 1u << VALUE_LIST | 1u << VALUE_MAP)->group;
}

static const struct value *entry_at(const struct gamut_values *values, const char *path,
                                    size_t index)
{
  const struct gamut_values *entries = entries_of(values, path);
  if (index >= entries->count)
    end_of(values, path, "an entry beyond the last");
  return &entries->value[index];
}

size_t host_entries(const struct gamut_values *values, const char *path)
{
  return entries_of(values, path)->count;
}

const char *host_entry_name(const struct gamut_values *values, const char *path, size_t index)
{
  return entry_at(values, path, index)->parameter->name;
}

const struct gamut_values *host_entry(const struct gamut_values *values, const char *path,
                                      size_t index)
{
  const struct value *entry = entry_at(values, path, index);
  if (entry->parameter->type != VALUE_GROUP)
    end_of(values, path, "entries of groups, which its descriptor declares as something else");
  return entry->group;
}

/* A formula is the value that holds it, with one copy a thread. */
static const struct value *value_of(const struct gamut_formula *formula)
{
  return (const struct value *)(const void *)formula;
}

static bool copy_formula(struct value *value, size_t threads, char *why, size_t size)
{
  const struct tree *text = value->node ? value->node : value->parameter->standard;
  struct expression **more = realloc(value->each, threads * sizeof(*more));
  if (!more)
    return false;
  value->each = more;
  while (value->copies < threads) {
    struct expression *copy =
        expression_new(text->text, value->parameter->choice, value->parameter->choices, why, size);
    if (!copy)
      return false;
    value->each[value->copies++] = copy;
  }
  return true;
}

gamut_status host_formula(struct gamut_run *run, const struct gamut_values *values,
                          const char *path, struct gamut_formula **formula)
{
  char why[256] = "out of memory";
  /* The values belong to the run: what is const to plugins is not to it. */
  struct value *value = (struct value *)(uintptr_t)demand(values, path, 1u << VALUE_EXPRESSION);
  *formula = NULL;
  if (!value->expression)
    return GAMUT_OK;
  if (!copy_formula(value, (size_t)run->threads, why, sizeof why))
    return trace_fail(run->trace, GAMUT_INTERNAL, "'%s': %s", path, why);
  *formula = (struct gamut_formula *)(void *)value;
  return GAMUT_OK;
}

double host_formula_value(const struct gamut_formula *formula, int thread, const double *variable)
{
  return expression_value(value_of(formula)->each[thread], variable);
}

bool host_formula_uses(const struct gamut_formula *formula, size_t variable)
{
  return expression_uses(value_of(formula)->expression, variable);
}
