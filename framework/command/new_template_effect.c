/* The skeleton of an effect plugin. @NAME@ and its like are filled in. */
#include "command/new_template.h"

static const char descriptor[] =
    "plugin: effect/@NAME@\n"
    "version: \"0.1\"\n"
    "summary: a drag on every point, proportional to its momentum\n"
    "formula: |\n"
    "  external_force -= rate mass velocity\n"
    "source: [textbook]\n"
    "parameters:\n"
    "  rate: {symbol: c, unit: 1/s, physical: \"[0, inf)\", doc: how fast free motion dies out}\n"
    "inputs: [mass, velocity]\n"
    "outputs: [external_force]\n"
    "tasks:\n"
    "  - {kernel: drag, phase: forces, reads: [mass, velocity], adds: [external_force]}\n";

static const char source[] =
    "#include <stdio.h>\n"
    "\n"
    "#include \"@NAME@.gamut.h\"\n"
    "\n"
    "static void drag(const struct @NAME@ *b)\n"
    "{\n"
    "  for (int k = 0; k < 3; k++)\n"
    "    GAMUT_EACH (i, b)\n"
    "      b->external_force[k][i] -= b->rate[i] * b->mass[i] * b->velocity[k][i];\n"
    "}\n"
    "\n"
    "static bool decline(void *self, const struct gamut_values *values, char *why, size_t size)\n"
    "{\n"
    "  (void)self;\n"
    "  snprintf(why, size, \"rate = 0\");\n"
    "  return gamut_real(values, \"rate\") == 0;\n"
    "}\n"
    "\n"
    "GAMUT_EFFECT(@NAME@, .decline = decline, .drag = drag)\n";

static const char known[] =
    "# An effect has no known answers of its own: its kernels are checked on blocks "
    "of points. A scene\n"
    "# @NAME@.scene.yaml in this folder would be run in place of the usual scene.\n"
    "tests: []\n";

const struct new_file new_template_effect[] = {
    {"@NAME@.yaml", {descriptor}},
    {"@NAME@.c", {source}},
    {"@NAME@.test.yaml", {known}},
    {NULL, {NULL}},
};
