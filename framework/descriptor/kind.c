#include <assert.h>
#include <string.h>

#include <gamut/estimator.h>
#include <gamut/random_field.h>
#include <gamut/solver.h>

#include "descriptor/descriptor_private.h"

const char *kind_name(enum gamut_kind kind)
{
  static const char *const name[] = {
#define KIND_NAME(kind, name) [kind] = name,
      GAMUT_KIND_LIST(KIND_NAME)
#undef KIND_NAME
  };
  assert((size_t)kind < ARRAY_SIZE(name));
  return name[kind];
}

bool kind_from_name(const char *name, enum gamut_kind *kind)
{
  for (int k = 0; k < GAMUT_KINDS; k++)
    if (strcmp(kind_name((enum gamut_kind)k), name) == 0) {
      *kind = (enum gamut_kind)k;
      return true;
    }
  return false;
}

const char *kind_operation(enum gamut_kind kind, size_t index)
{
  static const char *const operation[GAMUT_KINDS][16] = {
#define OPERATION_NAME(type, name, arguments) #name,
      [GAMUT_KIND_EOS] = {GAMUT_EOS_OPERATIONS(OPERATION_NAME, void)},
      [GAMUT_KIND_STRENGTH] = {GAMUT_STRENGTH_OPERATIONS(OPERATION_NAME, void)},
      [GAMUT_KIND_ELASTICITY] = {GAMUT_ELASTICITY_OPERATIONS(OPERATION_NAME, void)},
      [GAMUT_KIND_EFFECT] = {GAMUT_EFFECT_OPERATIONS(OPERATION_NAME, void)},
      [GAMUT_KIND_RANDOM_FIELD] = {GAMUT_RANDOM_FIELD_OPERATIONS(OPERATION_NAME, void)},
      [GAMUT_KIND_ESTIMATOR] = {GAMUT_ESTIMATOR_OPERATIONS(OPERATION_NAME, void)},
      [GAMUT_KIND_SOLVER] = {GAMUT_SOLVER_OPERATIONS(OPERATION_NAME, void)},
#undef OPERATION_NAME
  };
  return index < ARRAY_SIZE(operation[kind]) ? operation[kind][index] : NULL;
}

const char *descriptor_operation(const struct descriptor *d, size_t index)
{
  static const char *const prepare[] = {"prepare", "release"};
  size_t own = 0;
  while (kind_operation(d->kind, own))
    own++;
  if (index < own)
    return kind_operation(d->kind, index);
  index -= own;
  if (d->prepare && index < ARRAY_SIZE(prepare))
    return prepare[index];
  index -= d->prepare ? ARRAY_SIZE(prepare) : 0;
  if (index < d->variants)
    return d->variant[index].kernel;
  index -= d->variants;
  return index < d->tasks ? d->task[index].kernel : NULL;
}

const char *value_type_name(enum value_type type)
{
  static const char *const name[] = {
      [VALUE_REAL] = "real",       [VALUE_INTEGER] = "integer",
      [VALUE_BOOLEAN] = "boolean", [VALUE_CHOICE] = "choice",
      [VALUE_TEXT] = "text",       [VALUE_VECTOR] = "vector",
      [VALUE_BODY] = "body",       [VALUE_EXPRESSION] = "expression",
      [VALUE_TABLE] = "table",     [VALUE_FILE] = "file",
      [VALUE_LEVELS] = "levels",   [VALUE_PLUGIN] = "plugin",
      [VALUE_LIST] = "list",       [VALUE_MAP] = "map",
      [VALUE_ENTRY] = "entry",     [VALUE_ONE_OF] = "one of",
      [VALUE_GROUP] = "group",
  };
  return (size_t)type < ARRAY_SIZE(name) ? name[type] : NULL;
}

bool kernel_sees(const struct parameter *parameter)
{
  return !parameter->prepared &&
         (parameter->type == VALUE_REAL || parameter->type == VALUE_INTEGER ||
          parameter->type == VALUE_BOOLEAN || parameter->type == VALUE_CHOICE);
}

const struct parameter *parameter_named(const struct parameter *parameter, size_t count,
                                        const char *name)
{
  for (size_t i = 0; i < count; i++)
    if (strcmp(parameter[i].name, name) == 0)
      return &parameter[i];
  return NULL;
}

int descriptor_parameter(const struct descriptor *descriptor, const char *name)
{
  const struct parameter *found =
      parameter_named(descriptor->parameter, descriptor->parameters, name);
  return found ? (int)(found - descriptor->parameter) : -1;
}

bool descriptor_provides(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->provisions; i++)
    if (strcmp(d->provide[i], name) == 0)
      return true;
  return false;
}
