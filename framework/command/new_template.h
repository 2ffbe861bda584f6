/* The files of a plugin skeleton. In names and texts @NAME@, @KIND@ and @UPPER@ (the name in
 * capitals) are filled in. */
#ifndef GAMUT_NEW_TEMPLATE_H
#define GAMUT_NEW_TEMPLATE_H

#include <stddef.h>

struct new_file {
  const char *name;    /* null ends the list */
  const char *text[3]; /* parts, in order; null ends them */
};

/* One list a kind, and what all share. Each skeleton is the smallest whole plugin of its kind. */
extern const struct new_file new_template_common[], new_template_eos[], new_template_strength[],
    new_template_elasticity[], new_template_effect[], new_template_random_field[],
    new_template_estimator[], new_template_solver[];

#endif
