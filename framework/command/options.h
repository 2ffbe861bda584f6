/* The options of a command, read by a table. */
#ifndef GAMUT_OPTIONS_H
#define GAMUT_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "command/command.h"

/* Texts that an option may give more than once, in order. Entries are borrowed from argv. */
struct option_texts {
  const char **text;
  size_t count;
};

enum option_kind {
  OPTION_FLAG,  /* target: bool *, set to true */
  OPTION_TEXT,  /* target: const char **, the last one given counts */
  OPTION_TEXTS, /* target: struct option_texts *; the array is allocated, freed by the caller */
  OPTION_PAIRS, /* as OPTION_TEXTS; takes the words with '=' that follow as well */
  OPTION_WHOLE  /* target: int *, a positive whole number */
};

struct option {
  const char *name; /* "--set" */
  char letter;      /* 'o' for -o, or 0 */
  enum option_kind kind;
  void *target;
};

/* Reads the command's arguments. What is no option goes to `operand` (at least `least`, at most
 * `most` of them); "--" ends the options. On a mistake records GAMUT_USAGE with the command's
 * usage. */
gamut_status options_read(struct command *, const struct option *, size_t options,
                          const char **operand, size_t least, size_t most, size_t *operands);

/* Notes the usage line of the command. */
void usage_note(struct command *);
/* Records GAMUT_USAGE in words, then the usage line of the command. */
gamut_status usage_fail(struct command *, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "gamut run SCENE ..." of a command by name; null if there is no such command. */
const char *usage_arguments(const char *command);
/* The name in COMMAND_LIST that is nearest, or null. */
const char *usage_nearest(const char *command);

#endif
