/* The skeleton of an eos plugin. @NAME@ and its like are filled in. */
#include "command/new_template.h"

static const char descriptor[] =
    "plugin: eos/@NAME@\n"
    "version: \"0.1\"\n"
    "summary: pressure proportional to compression\n"
    "formula: |\n"
    "  pressure = bulk_modulus compression\n"
    "  sound_speed = sqrt(bulk_modulus / reference_density)\n"
    "source: [textbook]\n"
    "parameters:\n"
    "  bulk_modulus: {symbol: K, unit: Pa, physical: \"(0, inf)\", random: true,\n"
    "                 doc: pressure over compression}\n"
    "inputs: [compression, reference_density]\n"
    "outputs: [pressure, pressure_slope_compression, sound_speed]\n"
    "messages:\n"
    "  vacuum: {severity: stop, text: \"density is zero or negative\"}\n";

static const char source[] =
    "#include \"@NAME@.gamut.h\"\n"
    "\n"
    "static void pressure(const struct @NAME@ *b)\n"
    "{\n"
    "  GAMUT_EACH (i, b) {\n"
    "    b->pressure[i] = b->bulk_modulus[i] * b->compression[i];\n"
    "    b->pressure_slope_compression[i] = b->bulk_modulus[i];\n"
    "    b->sound_speed[i] = sqrt(b->bulk_modulus[i] / b->reference_density[i]);\n"
    "    GAMUT_FLAG(b, i, b->compression[i] <= -1, @UPPER@_VACUUM);\n"
    "  }\n"
    "}\n"
    "\n"
    "GAMUT_EOS(@NAME@, .pressure = pressure)\n";

static const char known[] =
    "tests:\n"
    "  - name: ten percent of compression\n"
    "    source: by hand\n"
    "    parameters: {bulk_modulus: 10 GPa}\n"
    "    at: {compression: 0.1, reference_density: 2500}\n"
    "    expect: {pressure: 1e9, pressure_slope_compression: 10e9, sound_speed: 2000}\n";

const struct new_file new_template_eos[] = {
    {"@NAME@.yaml", {descriptor}},
    {"@NAME@.c", {source}},
    {"@NAME@.test.yaml", {known}},
    {NULL, {NULL}},
};
