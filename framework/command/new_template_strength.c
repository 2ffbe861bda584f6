/* The skeleton of a strength plugin. @NAME@ and its like are filled in. */
#include "command/new_template.h"

static const char descriptor[] =
    "plugin: strength/@NAME@\n"
    "version: \"0.1\"\n"
    "summary: flow stress that grows linearly with plastic strain\n"
    "formula: |\n"
    "  flow_stress = yield_stress + hardening_modulus plastic_strain\n"
    "source: [textbook]\n"
    "parameters:\n"
    "  yield_stress: {symbol: Y, unit: Pa, physical: \"(0, inf)\", random: true,\n"
    "                 doc: flow stress at zero plastic strain}\n"
    "  hardening_modulus: {symbol: H, unit: Pa, default: 0 Pa, physical: \"[0, inf)\", "
    "random: true,\n"
    "                      doc: growth of the flow stress with plastic strain}\n"
    "inputs: [plastic_strain]\n"
    "outputs: [flow_stress, flow_stress_slope_plastic_strain]\n";

static const char source[] =
    "#include \"@NAME@.gamut.h\"\n"
    "\n"
    "static void flow_stress(const struct @NAME@ *b)\n"
    "{\n"
    "  GAMUT_EACH (i, b) {\n"
    "    b->flow_stress[i] = b->yield_stress[i] + b->hardening_modulus[i] * "
    "b->plastic_strain[i];\n"
    "    b->flow_stress_slope_plastic_strain[i] = b->hardening_modulus[i];\n"
    "  }\n"
    "}\n"
    "\n"
    "GAMUT_STRENGTH(@NAME@, .flow_stress = flow_stress)\n";

static const char known[] =
    "tests:\n"
    "  - name: hardened by twenty percent of plastic strain\n"
    "    source: by hand\n"
    "    parameters: {yield_stress: 90 MPa, hardening_modulus: 300 MPa}\n"
    "    at: {plastic_strain: 0.2}\n"
    "    expect: {flow_stress: 150e6, flow_stress_slope_plastic_strain: 300e6}\n";

const struct new_file new_template_strength[] = {
    {"@NAME@.yaml", {descriptor}},
    {"@NAME@.c", {source}},
    {"@NAME@.test.yaml", {known}},
    {NULL, {NULL}},
};
