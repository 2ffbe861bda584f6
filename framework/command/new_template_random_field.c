/* The skeleton of a random field plugin. @NAME@ and its like are filled in. */
#include "command/new_template.h"

static const char descriptor[] =
    "plugin: random_field/@NAME@\n"
    "version: \"0.1\"\n"
    "summary: white noise, every point independent of every other\n"
    "formula: |\n"
    "  value = standard normal number of the point's id\n"
    "source: [textbook]\n";

static const char source[] =
    "#include \"@NAME@.gamut.h\"\n"
    "\n"
    "static gamut_status create(struct gamut_run *run, const struct gamut_values "
    "*values, void **self)\n"
    "{\n"
    "  (void)run;\n"
    "  (void)values;\n"
    "  *self = NULL; /* white noise has nothing to keep */\n"
    "  return GAMUT_OK;\n"
    "}\n"
    "\n"
    "static void destroy(void *self)\n"
    "{\n"
    "  (void)self;\n"
    "}\n"
    "\n"
    "static gamut_status sample(const void *self, const struct gamut_stream *stream, "
    "size_t count,\n"
    "                           const double *const position[3], const int64_t *id, "
    "double *value)\n"
    "{\n"
    "  (void)self;\n"
    "  (void)position;\n"
    "  for (size_t i = 0; i < count; i++)\n"
    "    value[i] = stream->normal(stream, (uint64_t)id[i]);\n"
    "  return GAMUT_OK;\n"
    "}\n"
    "\n"
    "GAMUT_RANDOM_FIELD(@NAME@, .create = create, .destroy = destroy, .sample = sample)\n";

static const char known[] =
    "# Random fields are checked by their moments and by what they give for the same points.\n"
    "tests: []\n";

const struct new_file new_template_random_field[] = {
    {"@NAME@.yaml", {descriptor}},
    {"@NAME@.c", {source}},
    {"@NAME@.test.yaml", {known}},
    {NULL, {NULL}},
};
