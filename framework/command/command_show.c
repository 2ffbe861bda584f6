#include <stdio.h>

#include "command/find_plugin.h"
#include "command/options.h"

gamut_status command_show(struct command *command)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *descriptor = NULL;
  const char *plugin = NULL;
  bool json = false;
  const struct option option[] = {{"--json", 0, OPTION_FLAG, &json}};
  TRY(options_read(command, option, 1, &plugin, 1, 1, NULL));
  TRY(find_plugin(command, plugin, &descriptor));
  if (json)
    descriptor_show_json(descriptor, stdout);
  else
    descriptor_show(descriptor, stdout);
done:
  return status;
}
