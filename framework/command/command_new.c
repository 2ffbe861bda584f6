#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/memory.h"
#include "command/options.h"
#include "registry/registry.h"

/* What goes into the templates. */
struct names {
  const char *kind, *name;
  char upper[64];
};

static const char *value_of(const struct names *names, const char *word, size_t *length)
{
  const char *const word_of[] = {"@NAME@", "@KIND@", "@UPPER@"};
  const char *const value[] = {names->name, names->kind, names->upper};
  for (size_t i = 0; i < 3; i++) {
    *length = strlen(word_of[i]);
    if (strncmp(word, word_of[i], *length) == 0)
      return value[i];
  }
  return NULL;
}

static void fill_in(const char *line, const struct names *names, FILE *file)
{
  while (*line) {
    size_t length;
    const char *value = *line == '@' ? value_of(names, line, &length) : NULL;
    if (value) {
      fputs(value, file);
      line += length;
    } else {
      fputc(*line++, file);
    }
  }
}

/* One file of a skeleton; NAME in its own name is the plugin's. */
static gamut_status write_file(struct command *command, const char *from, const char *item,
                               const char *folder, const struct names *names)
{
  gamut_status status = GAMUT_OK;
  char path[PATH_MAX], line[512];
  const bool named = strncmp(item, "NAME", 4) == 0;
  snprintf(path, sizeof path, "%s/%s", from, item);
  FILE *skeleton = fopen(path, "r");
  if (!skeleton)
    return trace_fail(command->trace, GAMUT_OUTPUT, "cannot read the skeleton %s: %s", path,
                      strerror(errno));
  snprintf(path, sizeof path, "%s/%s%s", folder, named ? names->name : "", named ? item + 4 : item);
  FILE *file = fopen(path, "wx");
  while (file && fgets(line, sizeof line, skeleton))
    fill_in(line, names, file);
  const bool read = !ferror(skeleton), closed = file && fclose(file) == 0;
  if (!read || !closed)
    status = trace_fail(command->trace, GAMUT_OUTPUT, "cannot %s %s: %s",
                        read ? "write" : "read the skeleton of", path, strerror(errno));
  fclose(skeleton);
  return status;
}

/* The folder share/templates/PART. */
static gamut_status find_skeleton(struct command *command, const char *part, char *folder,
                                  size_t size)
{
  char place[64];
  snprintf(place, sizeof place, "share/templates/%s", part);
  return installed_data(place, folder, size)
             ? GAMUT_OK
             : trace_fail(command->trace, GAMUT_OUTPUT,
                          "no folder %s, neither in the tree that gamut was built in nor where it "
                          "is installed",
                          place);
}

static gamut_status write_files(struct command *command, const char *from, const char *folder,
                                const struct names *names)
{
  gamut_status status = GAMUT_OK;
  DIR *listed = opendir(from);
  const struct dirent *item;
  if (!listed)
    return trace_fail(command->trace, GAMUT_OUTPUT, "cannot read the folder %s: %s", from,
                      strerror(errno));
  while (status == GAMUT_OK && (item = readdir(listed)) != NULL)
    if (item->d_name[0] != '.')
      status = write_file(command, from, item->d_name, folder, names);
  closedir(listed);
  return status;
}

/* Names become names in C and of files. */
static bool name_is_good(const char *name)
{
  /* Words of C, and structs of the skeletons. */
  static const char *const taken[] = {
      "auto",   "break",    "case",   "char",   "const",    "continue", "default", "do",
      "double", "else",     "enum",   "extern", "float",    "for",      "goto",    "if",
      "inline", "int",      "long",   "main",   "register", "restrict", "return",  "short",
      "signed", "sizeof",   "static", "struct", "switch",   "typedef",  "union",   "unsigned",
      "void",   "volatile", "while",  "state",  "sums"};
  size_t length = strlen(name);
  if (length == 0 || length > 40 || !islower((unsigned char)name[0]))
    return false;
  for (size_t i = 0; i < length; i++)
    if (!islower((unsigned char)name[i]) && !isdigit((unsigned char)name[i]) && name[i] != '_')
      return false;
  for (size_t i = 0; i < ARRAY_SIZE(taken); i++)
    if (strcmp(taken[i], name) == 0)
      return false;
  return true;
}

static gamut_status read_names(struct command *command, const char *text, struct names *names)
{
  enum gamut_kind kind;
  const char *kinds[GAMUT_KINDS], *slash = strchr(text, '/');
  char word[32];
  for (int k = 0; k < GAMUT_KINDS; k++)
    kinds[k] = kind_name((enum gamut_kind)k);
  if (!slash || (size_t)(slash - text) >= sizeof word)
    return usage_fail(command, "a plugin is named KIND/NAME, e.g. strength/mine, not '%s'", text);
  snprintf(word, sizeof word, "%.*s", (int)(slash - text), text);
  if (!kind_from_name(word, &kind)) {
    const char *near = nearest(word, kinds, GAMUT_KINDS);
    return near ? usage_fail(command, "there is no kind '%s'; did you mean '%s'?", word, near)
                : usage_fail(command, "there is no kind '%s'", word);
  }
  names->kind = kind_name(kind);
  names->name = slash + 1;
  if (!name_is_good(names->name))
    return usage_fail(command,
                      "'%s' cannot be a plugin's name: small letters, digits and '_', a letter "
                      "first, at most 40, and no word that C or gamut needs",
                      names->name);
  for (size_t i = 0; i <= strlen(names->name); i++)
    names->upper[i] = (char)toupper((unsigned char)names->name[i]);
  return GAMUT_OK;
}

gamut_status command_new(struct command *command)
{
  gamut_status status = GAMUT_OK;
  const char *text = NULL, *folder = NULL;
  char own[PATH_MAX], common[PATH_MAX];
  struct names names = {0};
  const struct option option[] = {{"--output", 'o', OPTION_TEXT, &folder}};
  TRY(options_read(command, option, 1, &text, 1, 1, NULL));
  TRY(read_names(command, text, &names));
  TRY(find_skeleton(command, names.kind, own, sizeof own));
  TRY(find_skeleton(command, "common", common, sizeof common));
  if (!folder)
    folder = names.name;
  if (mkdir(folder, 0755) != 0) {
    status = errno == EEXIST
                 ? trace_fail(command->trace, GAMUT_OUTPUT, "%s is there already", folder)
                 : trace_fail(command->trace, GAMUT_OUTPUT, "cannot make the folder %s: %s", folder,
                              strerror(errno));
    goto done;
  }
  TRY(write_files(command, own, folder, &names));
  TRY(write_files(command, common, folder, &names));
  printf("%s: the skeleton of %s/%s; next: cd %s && make check\n", folder, names.kind, names.name,
         folder);
done:
  return status;
}
