#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command/new_template.h"
#include "command/options.h"
#include "error/memory.h"

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

static void fill_in(const char *text, const struct names *names, FILE *file)
{
  while (*text) {
    size_t length;
    const char *value = *text == '@' ? value_of(names, text, &length) : NULL;
    if (value) {
      fputs(value, file);
      text += length;
    } else {
      fputc(*text++, file);
    }
  }
}

static char *path_of(const char *folder, const char *name, const struct names *names)
{
  char *path = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&path, &size);
  if (!file)
    return NULL;
  fprintf(file, "%s/", folder);
  fill_in(name, names, file);
  return memory_close(file, &path);
}

static gamut_status write_files(struct command *command, const char *folder,
                                const struct new_file *files, const struct names *names)
{
  gamut_status status = GAMUT_OK;
  for (; files->name && status == GAMUT_OK; files++) {
    char *path = path_of(folder, files->name, names);
    FILE *file = path ? fopen(path, "wx") : NULL;
    if (file)
      for (size_t i = 0; i < 3 && files->text[i]; i++)
        fill_in(files->text[i], names, file);
    if (!file || fclose(file) != 0)
      status = trace_fail(command->trace, GAMUT_OUTPUT, "cannot write %s: %s", path ? path : folder,
                          strerror(errno));
    free(path);
  }
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
  for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++)
    if (strcmp(taken[i], name) == 0)
      return false;
  return true;
}

static gamut_status read_names(struct command *command, const char *text, struct names *names,
                               enum gamut_kind *kind)
{
  const char *kinds[GAMUT_KINDS], *slash = strchr(text, '/');
  char word[32];
  for (int k = 0; k < GAMUT_KINDS; k++)
    kinds[k] = kind_name((enum gamut_kind)k);
  if (!slash || (size_t)(slash - text) >= sizeof word)
    return usage_fail(command, "a plugin is named KIND/NAME, e.g. strength/mine, not '%s'", text);
  snprintf(word, sizeof word, "%.*s", (int)(slash - text), text);
  if (!kind_from_name(word, kind)) {
    const char *near = nearest(word, kinds, GAMUT_KINDS);
    return near ? usage_fail(command, "there is no kind '%s'; did you mean '%s'?", word, near)
                : usage_fail(command, "there is no kind '%s'", word);
  }
  names->kind = kind_name(*kind);
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
  static const struct new_file *const template_of[GAMUT_KINDS] = {
      [GAMUT_KIND_EOS] = new_template_eos,
      [GAMUT_KIND_STRENGTH] = new_template_strength,
      [GAMUT_KIND_ELASTICITY] = new_template_elasticity,
      [GAMUT_KIND_EFFECT] = new_template_effect,
      [GAMUT_KIND_RANDOM_FIELD] = new_template_random_field,
      [GAMUT_KIND_ESTIMATOR] = new_template_estimator,
      [GAMUT_KIND_SOLVER] = new_template_solver,
  };
  gamut_status status = GAMUT_OK;
  const char *text = NULL, *folder = NULL;
  enum gamut_kind kind;
  struct names names = {0};
  const struct option option[] = {{"--output", 'o', OPTION_TEXT, &folder}};
  TRY(options_read(command, option, 1, &text, 1, 1, NULL));
  TRY(read_names(command, text, &names, &kind));
  if (!folder)
    folder = names.name;
  if (mkdir(folder, 0755) != 0) {
    status = errno == EEXIST
                 ? trace_fail(command->trace, GAMUT_OUTPUT, "%s is there already", folder)
                 : trace_fail(command->trace, GAMUT_OUTPUT, "cannot make the folder %s: %s", folder,
                              strerror(errno));
    goto done;
  }
  TRY(write_files(command, folder, template_of[kind], &names));
  TRY(write_files(command, folder, new_template_common, &names));
  printf("%s: the skeleton of %s/%s; next: cd %s && make check\n", folder, names.kind, names.name,
         folder);
done:
  return status;
}
