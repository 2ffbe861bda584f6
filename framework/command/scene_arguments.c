#include "command/scene_arguments.h"

gamut_status scene_from_arguments(struct command *command, const char *file,
                                  const struct option_texts *texts, struct scene **scene)
{
  gamut_status status = GAMUT_OK;
  struct override_list list;
  status = overrides_read(texts->text, texts->count, command->trace, &list);
  if (status == GAMUT_USAGE)
    usage_note(command);
  if (status != GAMUT_OK)
    goto done;
  TRY(scene_read(file, list.override, list.count, command->registry, command->units, command->trace,
                 scene));
done:
  overrides_free(&list);
  return status;
}
