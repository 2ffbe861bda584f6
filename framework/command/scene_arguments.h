/* What run, check and explain share: a scene with its overrides. */
#ifndef GAMUT_SCENE_ARGUMENTS_H
#define GAMUT_SCENE_ARGUMENTS_H

#include "command/options.h"
#include "scene/scene.h"

/* Reads `file` with the overrides given as "path=value". */
gamut_status scene_from_arguments(struct command *, const char *file, const struct option_texts *,
                                  struct scene **);

#endif
