/* What run, check and explain share: a scene with its overrides. */
#ifndef GAMUT_SCENE_ARGUMENTS_H
#define GAMUT_SCENE_ARGUMENTS_H

#include "command/options.h"
#include "scene/scene.h"

/* Overrides given as "path=value". */
struct override_list {
  struct scene_override *override;
  size_t count;
  char **path; /* owned; the values are borrowed from argv */
};
gamut_status overrides_read(struct command *, const struct option_texts *, struct override_list *);
void overrides_free(struct override_list *);

/* Reads `file` with the overrides given as "path=value". */
gamut_status scene_from_arguments(struct command *, const char *file, const struct option_texts *,
                                  struct scene **);

#endif
