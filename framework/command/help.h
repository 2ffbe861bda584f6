/* Help texts. */
#ifndef GAMUT_HELP_H
#define GAMUT_HELP_H

#include <stdbool.h>
#include <stdio.h>

/* All commands, common options, exit codes. */
void help_all(FILE *);
/* One command; false if there is none of that name. */
bool help_command(const char *name, FILE *);

#endif
