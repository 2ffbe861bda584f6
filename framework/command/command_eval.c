#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/evaluation.h"
#include "command/find_plugin.h"

struct parameter_reader {
  const struct descriptor *descriptor;
  struct settings *settings;
  struct command *command;
};

static gamut_status take_parameter(void *self, const char *name, const char *value)
{
  struct parameter_reader *reader = self;
  const size_t before = reader->settings->count;
  gamut_status status = settings_read(reader->settings, reader->descriptor, name, value, "--param",
                                      reader->command->units, reader->command->trace);
  if (status == GAMUT_OK && reader->settings->count == before)
    status = usage_fail(reader->command, "--param: '%s' is given twice", name);
  return status;
}

static gamut_status check_kind(struct command *command, const struct descriptor *descriptor)
{
  if (descriptor->kind == GAMUT_KIND_EOS || descriptor->kind == GAMUT_KIND_STRENGTH)
    return GAMUT_OK;
  if (descriptor->kind == GAMUT_KIND_ELASTICITY)
    return usage_fail(command,
                      "eval works on eos and strength; for %s, which follows a path, write a scene "
                      "for solver material_driver (one point along a strain or stress path)",
                      descriptor->id);
  return usage_fail(command, "eval works on eos and strength, not on %s", descriptor->id);
}

/* A law that refuses a point has not given what was asked for. */
static gamut_status judge(struct command *command, struct evaluation *evaluation)
{
  size_t point = 0;
  const char *name = "", *text = NULL;
  if (evaluation_worst(evaluation, &point, &name, &text) != GAMUT_STOP)
    return GAMUT_OK;
  return trace_fail(command->trace, GAMUT_NUMERICS, "%s at point %zu: %s%s%s",
                    evaluation->descriptor->id, point, name, text ? ": " : "", text ? text : "");
}

gamut_status command_eval(struct command *command)
{
  gamut_status status = GAMUT_OK;
  struct option_texts param = {0}, at = {0};
  struct settings settings = {0};
  struct evaluation evaluation = {0};
  const char *plugin = NULL;
  const struct descriptor *descriptor = NULL;
  bool json = false;
  const struct option option[] = {{"--param", 0, OPTION_PAIRS, &param},
                                  {"--at", 0, OPTION_PAIRS, &at},
                                  {"--derivatives", 0, OPTION_FLAG, &evaluation.derivatives},
                                  {"--json", 0, OPTION_FLAG, &json}};
  TRY(options_read(command, option, 4, &plugin, 1, 1, NULL));
  bool derivatives = evaluation.derivatives;
  TRY(find_plugin(command, plugin, &descriptor));
  TRY(check_kind(command, descriptor));
  TRY(evaluation_new(&evaluation, descriptor, command));
  evaluation.derivatives = derivatives;
  struct parameter_reader reader = {descriptor, &settings, command};
  for (size_t i = 0; i < param.count; i++)
    TRY(split_pairs(command, "--param", param.text[i], take_parameter, &reader));
  for (size_t i = 0; i < at.count; i++)
    TRY(evaluation_at(&evaluation, command, at.text[i]));
  TRY(evaluation_run(&evaluation, &settings, command));
  if (json)
    TRY(evaluation_json(&evaluation, stdout, command->trace));
  else
    evaluation_text(&evaluation, stdout);
  status = judge(command, &evaluation);
done:
  evaluation_free(&evaluation);
  settings_free(&settings);
  free(param.text);
  free(at.text);
  return status;
}
