/* NAME.gamut.h: what a plugin's C code includes. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "catalogue/catalogue.h"
#include "descriptor/descriptor_private.h"

/* Writes a name as part of a constant's. */
static void put_upper(FILE *file, const char *name)
{
  for (; *name; name++)
    fputc(isalnum((unsigned char)*name) ? toupper((unsigned char)*name) : '_', file);
}

/* Prose inside a comment: one line, and it does not end the comment. */
static void put_comment(FILE *file, const char *text)
{
  char before = 0;
  for (; *text; text++) {
    char c = isspace((unsigned char)*text) ? ' ' : *text;
    if (c == ' ' && (before == ' ' || text[1] == 0))
      continue;
    if ((before == '*' && c == '/') || (before == '/' && c == '*'))
      fputc(' ', file);
    fputc(c, file);
    before = c;
  }
}

static const char *slot_meaning(const struct descriptor *d, const struct slot *slot)
{
  switch (slot->kind) {
  case SLOT_PARAMETER:
    return d->parameter[slot->index].doc;
  case SLOT_MATERIAL_PARAMETER:
    return d->material_parameter[slot->index].doc;
  case SLOT_INPUT:
  case SLOT_OUTPUT:
    return catalogue_find(slot->name) ? catalogue_find(slot->name)->meaning : NULL;
  case SLOT_STATE_BEGIN:
    return "at the beginning of the step";
  case SLOT_STATE_END:
    return d->state[slot->index].doc;
  case SLOT_LAW:
    return d->law[slot->index].optional ? "null if absent" : "never null";
  case SLOT_SCRATCH:
    return "for the kernel's own use";
  case SLOT_INVERSE_INPUT:
    return "what `inverse` reads";
  case SLOT_INVERSE_OUTPUT:
    return "what `inverse` writes";
  case SLOT_DERIVATIVE:
  case SLOT_SECOND_DERIVATIVE:
    return "null if not wanted";
  case SLOT_DATA:
    return "what `prepare` made";
  }
  return NULL;
}

/* "  const double *stress_begin[6];" */
static int declare(const struct descriptor *d, const struct slot *slot, char *text, size_t size)
{
  const char *type = slot->kind == SLOT_PARAMETER || slot->kind == SLOT_MATERIAL_PARAMETER ||
                             slot->kind == SLOT_INPUT || slot->kind == SLOT_STATE_BEGIN ||
                             slot->kind == SLOT_INVERSE_INPUT
                         ? "const double"
                         : "double";
  char other[160], extent[16] = "";
  if (slot->kind == SLOT_LAW)
    snprintf(other, sizeof other, "const struct gamut_%s_law", slot->name);
  else if (slot->kind == SLOT_DATA)
    snprintf(other, sizeof other, "const struct %s_data", d->name);
  if (slot->kind == SLOT_LAW || slot->kind == SLOT_DATA)
    type = other;
  if (slot->components > 1 || slot->kind == SLOT_SCRATCH)
    snprintf(extent, sizeof extent, "[%u]", slot->components);
  return snprintf(text, size, "  %s *%s%s;", type, slot->name, extent);
}

static void put_member(FILE *file, const struct descriptor *d, const struct slot *slot, int width)
{
  char text[256];
  declare(d, slot, text, sizeof text);
  fprintf(file, "%-*s /* ", width, text);
  const char *meaning = slot_meaning(d, slot);
  bool unit = slot->kind != SLOT_LAW && slot->kind != SLOT_SCRATCH && slot->kind != SLOT_DATA;
  if (unit)
    put_comment(file, slot->unit);
  if (meaning) {
    fputs(unit ? ": " : "", file);
    put_comment(file, meaning);
  }
  if (slot->kind == SLOT_INPUT && d->input[slot->index].optional)
    fprintf(file, "; %g where absent", d->input[slot->index].absent);
  fputs(" */\n", file);
}

static void put_constants(FILE *file, const struct descriptor *d)
{
  static const char *const severity[] = {"GAMUT_FINE", "GAMUT_NOTE", "GAMUT_WARN", "GAMUT_STOP"};
  fprintf(file, "#define %s_digest \"%s\"\n", d->name, d->digest);
  fputs("#define ", file);
  put_upper(file, d->name);
  fprintf(file, "_SCRATCH %zu\n", d->scratch);
  for (size_t i = 0; i < d->messages; i++) {
    fputs("#define ", file);
    put_upper(file, d->name);
    fputc('_', file);
    put_upper(file, d->message[i].name);
    fprintf(file, " GAMUT_MESSAGE(%s, %zu)\n", severity[d->message[i].severity], i);
  }
}

static bool has_kernels(const struct descriptor *d)
{
  return d->kind == GAMUT_KIND_EOS || d->kind == GAMUT_KIND_STRENGTH ||
         d->kind == GAMUT_KIND_ELASTICITY || d->kind == GAMUT_KIND_EFFECT;
}

/* Plugins that are kernels and nothing else: what asks the core is left out. */
static bool only_kernels(const struct descriptor *d)
{
  return has_kernels(d) && d->kind != GAMUT_KIND_EFFECT && !d->prepare;
}

static void host_begin(FILE *file, const struct descriptor *d)
{
  if (has_kernels(d))
    fputs("#ifndef GAMUT_KERNEL\n", file);
}

static void host_end(FILE *file, const struct descriptor *d)
{
  if (has_kernels(d))
    fputs("#endif\n", file);
}

/* Where a parameter stands: below what, and the path by which values are asked for it. */
struct stand {
  const char *prefix, *path; /* of names in C, "diameter_"; of values, "transfer." */
};

static void put_choice(FILE *file, const struct descriptor *d, const struct stand *stand,
                       const struct parameter *p)
{
  fputs("\n#define ", file);
  put_upper(file, d->name);
  fputc('_', file);
  put_upper(file, stand->prefix);
  put_upper(file, p->name);
  fprintf(file, "_CHOICES %zu\nenum %s_%s%s {\n", p->choices, d->name, stand->prefix, p->name);
  for (size_t k = 0; k < p->choices; k++) {
    const char *part[] = {d->name, "_", stand->prefix, p->name, "_", p->choice[k]};
    fputs("  ", file);
    for (size_t i = 0; i < ARRAY_SIZE(part); i++)
      put_upper(file, part[i]);
    fputs(k + 1 < p->choices ? ",\n" : "\n", file);
  }
  fputs("};\n", file);
  if (only_kernels(d))
    return;
  host_begin(file, d);
  fprintf(file,
          "static inline enum %s_%s%s\n%s_%s%s_of(const struct gamut_values *values)\n{\n"
          "  return (enum %s_%s%s)gamut_choice(values, \"%s%s\");\n}\n",
          d->name, stand->prefix, p->name, d->name, stand->prefix, p->name, d->name, stand->prefix,
          p->name, stand->path, p->name);
  host_end(file, d);
}

/* An enum of each choice and what turns the scene's values into it, so that a `switch` without a
 * `default` lets the compiler find a choice that the code does not know. */
static void put_choices(FILE *file, const struct descriptor *d, const struct stand *stand,
                        const struct parameter *parameter, size_t count)
{
  for (size_t i = 0; i < count; i++) {
    const struct parameter *p = &parameter[i];
    char prefix[256], path[256];
    if (p->type == VALUE_CHOICE)
      put_choice(file, d, stand, p);
    snprintf(prefix, sizeof prefix, "%s%s_", stand->prefix, p->name);
    snprintf(path, sizeof path, "%s%s.", stand->path, p->name);
    put_choices(file, d, &(struct stand){prefix, path}, p->member, p->members);
    if (p->of) /* asked for in the values of an entry */
      put_choices(file, d, &(struct stand){prefix, ""}, p->of->member, p->of->members);
  }
}

static void put_measures(FILE *file, const struct descriptor *d)
{
  char prefix[256];
  if (d->measures == 0 || only_kernels(d)) /* the core takes them from the descriptor */
    return;
  fprintf(file, "\nenum %s_measure {\n", d->name);
  for (size_t i = 0; i < d->measures; i++) {
    fputs("  ", file);
    put_upper(file, d->name);
    fputs("_MEASURE_", file);
    put_upper(file, d->measure[i].name);
    fputs(i + 1 < d->measures ? ",\n" : "\n", file);
  }
  fputs("};\n", file);
  host_begin(file, d);
  fprintf(file,
          "/* Of a name that is none of them: a number that is none of these. */\n"
          "static inline enum %s_measure %s_measure_of(const char *name)\n{\n"
          "  static const char *const names[] = {",
          d->name, d->name);
  for (size_t i = 0; i < d->measures; i++)
    fprintf(file, "%s\n      \"%s\"", i ? "," : "", d->measure[i].name);
  fprintf(file,
          "};\n  unsigned k = 0;\n  while (k < %zu && strcmp(name, names[k]) != 0)\n    k++;\n"
          "  return (enum %s_measure)k;\n}\n",
          d->measures, d->name);
  host_end(file, d);
  for (size_t i = 0; i < d->measures; i++) {
    snprintf(prefix, sizeof prefix, "%s_", d->measure[i].name);
    put_choices(file, d, &(struct stand){prefix, ""}, d->measure[i].argument,
                d->measure[i].arguments);
  }
}

static void put_block(FILE *file, const struct descriptor *d)
{
  struct slot *slots;
  size_t count = descriptor_layout(d, &slots);
  if (d->prepare)
    fprintf(file, "\nstruct %s_data; /* the plugin's own */\n", d->name);
  fputs("\n/* ", file);
  put_comment(file, d->summary);
  fprintf(file, " */\nstruct %s {\n", d->name);
  /* Comments stand in one column, but for members with very long names. */
  int width = 18;
  for (size_t i = 0; i < count; i++) {
    char text[256];
    int length = declare(d, &slots[i], text, sizeof text);
    width = length > width && length <= 44 ? length : width;
  }
  fprintf(file, "%-*s /* points in this block */\n", width, "  size_t count;");
  fprintf(file, "%-*s /* one word a point, see GAMUT_FLAG */\n", width, "  int64_t *status;");
  for (size_t i = 0; i < count; i++)
    if (slots[i].component == 0)
      put_member(file, d, &slots[i], width);
  fputs("};\n", file);
  free(slots);
}

static void put_operations(FILE *file, const struct descriptor *d)
{
  fprintf(file, "\nstruct %s_ops {\n  size_t size;\n  GAMUT_", d->name);
  put_upper(file, kind_name(d->kind));
  fprintf(file, "_OPS(struct %s)\n", d->name);
  if (d->prepare)
    fprintf(file,
            "  gamut_status (*prepare)(struct gamut_run *, const struct gamut_values *,\n"
            "                          struct %s_data **);\n"
            "  void (*release)(struct %s_data *);\n",
            d->name, d->name);
  for (size_t i = 0; i < d->variants; i++) {
    fprintf(file, "  void (*%s)(const struct %s *); /* in place of the first operation where ",
            d->variant[i].kernel, d->name);
    put_comment(file, d->variant[i].when);
    fputs(" */\n", file);
  }
  for (size_t i = 0; i < d->tasks; i++) {
    fprintf(file, "  void (*%s)(const struct %s *); /* phase: ", d->task[i].kernel, d->name);
    put_comment(file, d->task[i].phase);
    fputs(" */\n", file);
  }
  fputs("};\n", file);
}

static void put_includes(FILE *file, const struct descriptor *d)
{
  if (d->measures && !only_kernels(d))
    fputs("#include <string.h>\n\n", file);
  if (only_kernels(d))
    fputs("#include <gamut/kernel.h>\n\n", file);
  else if (has_kernels(d))
    fputs("#ifdef GAMUT_KERNEL\n#include <gamut/kernel.h>\n#else\n#include "
          "<gamut/plugin.h>\n#endif\n\n",
          file);
  else
    fputs("#include <gamut/plugin.h>\n\n", file);
}

void descriptor_header(const struct descriptor *d, FILE *file)
{
  fprintf(file, "/* Generated from %s.yaml by `gamut header`; edit that instead. */\n#ifndef ",
          d->name);
  put_upper(file, d->name);
  fputs("_GAMUT_H\n#define ", file);
  put_upper(file, d->name);
  fputs("_GAMUT_H\n\n", file);
  put_includes(file, d);
  put_constants(file, d);
  const struct stand top = {"", ""};
  put_choices(file, d, &top, d->parameter, d->parameters);
  put_choices(file, d, &top, d->material_parameter, d->material_parameters);
  put_choices(file, d, &top, d->body_parameter, d->body_parameters);
  put_measures(file, d);
  put_block(file, d);
  put_operations(file, d);
  fputs("\n#endif\n", file);
}
