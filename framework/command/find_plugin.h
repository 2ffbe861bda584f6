/* A plugin as people name it on the command line. */
#ifndef GAMUT_FIND_PLUGIN_H
#define GAMUT_FIND_PLUGIN_H

#include "command/command.h"

/* "kind/name", a bare name that only one kind has, or the path of a folder or YAML file ("./mine").
 * Unknown ones are refused with GAMUT_PLUGIN and the nearest that is installed. */
gamut_status find_plugin(struct command *, const char *text, const struct descriptor **);

#endif
