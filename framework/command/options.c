#include "command/options.h"
#include "base/array.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct usage {
  const char *name, *arguments;
} usages[] = {
#define USAGE_ENTRY(name, function, arguments, line) {name, arguments},
    COMMAND_LIST(USAGE_ENTRY)
#undef USAGE_ENTRY
};
enum { USAGES = ARRAY_SIZE(usages) };

const char *usage_arguments(const char *command)
{
  for (size_t i = 0; i < USAGES; i++)
    if (strcmp(usages[i].name, command) == 0)
      return usages[i].arguments;
  return NULL;
}

const char *usage_nearest(const char *command)
{
  const char *name[USAGES];
  for (size_t i = 0; i < USAGES; i++)
    name[i] = usages[i].name;
  return nearest(command, name, USAGES);
}

void usage_note(struct command *command)
{
  const char *arguments = usage_arguments(command->argv[0]);
  trace_note(command->trace, "usage: gamut %s %s", command->argv[0], arguments ? arguments : "");
}

gamut_status usage_fail(struct command *command, const char *format, ...)
{
  char text[512];
  va_list list;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  trace_fail(command->trace, GAMUT_USAGE, "%s", text);
  usage_note(command);
  return GAMUT_USAGE;
}

static const struct option *option_named(const struct option *option, size_t options,
                                         const char *word, size_t length)
{
  for (size_t i = 0; i < options; i++) {
    if (strlen(option[i].name) == length && strncmp(option[i].name, word, length) == 0)
      return &option[i];
    if (option[i].letter && length == 2 && word[0] == '-' && word[1] == option[i].letter)
      return &option[i];
  }
  return NULL;
}

static gamut_status unknown_option(struct command *command, const struct option *option,
                                   size_t options, const char *word)
{
  const char *name[16];
  size_t names = 0;
  for (size_t i = 0; i < options && names < 16; i++)
    name[names++] = option[i].name;
  const char *near = nearest(word, name, names);
  if (near)
    return usage_fail(command, "unknown option '%s'; did you mean '%s'?", word, near);
  return usage_fail(command, "unknown option '%s'", word);
}

static gamut_status option_set(struct command *command, const struct option *option,
                               const char *value)
{
  switch (option->kind) {
  case OPTION_FLAG:
    *(bool *)option->target = true;
    break;
  case OPTION_TEXT:
    *(const char **)option->target = value;
    break;
  case OPTION_TEXTS:
  case OPTION_PAIRS: {
    struct option_texts *texts = option->target;
    texts->text[texts->count++] = value;
    break;
  }
  case OPTION_WHOLE: {
    char *end;
    errno = 0;
    long number = strtol(value, &end, 10);
    if (end == value || *end || errno || number < 1 || number > INT_MAX)
      return usage_fail(command, "%s wants a positive whole number, not '%s'", option->name, value);
    *(int *)option->target = (int)number;
    break;
  }
  }
  return GAMUT_OK;
}

static gamut_status make_room(struct command *command, const struct option *option, size_t options)
{
  for (size_t i = 0; i < options; i++) {
    if (option[i].kind != OPTION_TEXTS && option[i].kind != OPTION_PAIRS)
      continue;
    struct option_texts *texts = option[i].target;
    texts->text = calloc((size_t)command->argc, sizeof *texts->text);
    if (!texts->text)
      return trace_fail(command->trace, GAMUT_INTERNAL, "out of memory");
  }
  return GAMUT_OK;
}

gamut_status options_read(struct command *command, const struct option *option, size_t options,
                          const char **operand, size_t least, size_t most, size_t *operands)
{
  gamut_status status = GAMUT_OK;
  bool ended = false;
  size_t count = 0;
  const struct option *pairs = NULL; /* the option that takes further words with '=' */
  TRY(make_room(command, option, options));
  for (int i = 1; i < command->argc; i++) {
    const char *word = command->argv[i];
    if (ended || word[0] != '-' || word[1] == 0) {
      if (pairs && !ended && strchr(word, '=')) {
        TRY(option_set(command, pairs, word));
        continue;
      }
      pairs = NULL;
      if (count == most) {
        status = usage_fail(command, "one argument too many: '%s'", word);
        goto done;
      }
      operand[count++] = word;
      continue;
    }
    if (strcmp(word, "--") == 0) {
      ended = true;
      continue;
    }
    const char *equals = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
    size_t length = equals ? (size_t)(equals - word) : strlen(word);
    const struct option *found = option_named(option, options, word, length);
    const char *value = equals ? equals + 1 : NULL;
    if (!found)
      status = unknown_option(command, option, options, word);
    else if (found->kind == OPTION_FLAG && value)
      status = usage_fail(command, "%s takes no value", found->name);
    else if (found->kind != OPTION_FLAG && !value && i + 1 == command->argc)
      status = usage_fail(command, "%s wants a value after it", found->name);
    else
      status = option_set(command, found,
                          value || found->kind == OPTION_FLAG ? value : command->argv[++i]);
    if (status != GAMUT_OK)
      goto done;
    pairs = found->kind == OPTION_PAIRS ? found : NULL;
  }
  if (count < least)
    status = usage_fail(command, "something is missing after 'gamut %s'", command->argv[0]);
done:
  if (operands)
    *operands = count;
  return status;
}
