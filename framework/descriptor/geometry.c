/* The kinds of space that scenes know; what a solver's parameter `geometry` may offer. */
#include <string.h>

#include "descriptor/descriptor_private.h"

static const struct geometry known[] = {
    {"1d", 1, false}, {"plane_strain", 2, false}, {"axisymmetric", 2, true}, {"3d", 3, false}};

const struct geometry *geometry_named(const char *name)
{
  for (size_t i = 0; i < ARRAY_SIZE(known); i++)
    if (strcmp(known[i].name, name) == 0)
      return &known[i];
  return NULL;
}

void check_geometry(struct reader *reader, const struct tree *root)
{
  const struct descriptor *d = reader->descriptor;
  const struct parameter *p = parameter_named(d->parameter, d->parameters, "geometry");
  if (d->kind != GAMUT_KIND_SOLVER || !p || p->type != VALUE_CHOICE)
    return;
  for (size_t i = 0; i < p->choices; i++)
    if (!geometry_named(p->choice[i]))
      reader_error_at_value(reader, tree_at(root, "parameters.geometry.choices"),
                            "1d, plane_strain, axisymmetric or 3d",
                            "no scene knows the geometry '%s': nothing says how many axes it has",
                            p->choice[i]);
}
