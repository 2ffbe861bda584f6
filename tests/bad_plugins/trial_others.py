"""Elasticities and kernels of effects that are wrong, and laws that a solver calls itself: `check`
and `run` refuse each before the first step, and run the same plugin without the fault. Prints TAP."""
import os
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

ELASTICITY_YAML = """plugin: elasticity/{name}
version: "1.0"
summary: a fluid for a test
source: [by hand]
parameters:
  bulk: {{unit: Pa, physical: "(0, inf)", doc: bulk modulus}}
inputs: [velocity_gradient, time_step, reference_density]
outputs: [sound_speed]
state:
  stress: {{}}
  volume_ratio: {{initial: 1}}
  energy: {{}}
"""
ELASTICITY = """    double *const *g = (double *const *)b->velocity_gradient;
    double grown = 1 + b->time_step[i] * (g[0][i] + g[4][i] + g[8][i]);
    b->volume_ratio[i] = b->volume_ratio_begin[i] * grown;
    for (int k = 0; k < 6; k++)
      b->stress[k][i] = k < 3 ? b->bulk[i] * (b->volume_ratio[i] - 1) : 0;
    b->energy[i] = b->energy_begin[i] + 0.5 * (b->stress[0][i] + b->stress_begin[0][i]) *
                   (b->volume_ratio[i] - b->volume_ratio_begin[i]);
    b->sound_speed[i] = sqrt(b->bulk[i] / b->reference_density[i]);
"""
EFFECT_YAML = """plugin: effect/{name}
version: "1.0"
summary: a push for a test
source: [by hand]
inputs: [mass]
outputs: [external_force]
tasks:
  - {{kernel: push, phase: forces, reads: [mass], adds: [external_force]}}
"""
EFFECT = "    b->external_force[0][i] += 10 * b->mass[i];\n"
INVERSE_YAML = kernels.STRENGTH_YAML + "inverse: true\n"
BEYOND = "writes beyond the points that it was given, in "
INPUT, PARAMETER = "writes to its input ", "writes to its parameter "
COMPANY = "gives a point alone another value than beside others: "
ARITHMETIC = "changes the processor's rounding"
ROUNDS = "    unsigned word;\n    __asm__ volatile(\"stmxcsr %0\" : \"=m\"(word));\n" \
         "    word |= 0x4000;\n    __asm__ volatile(\"ldmxcsr %0\" : : \"m\"(word));\n"
CRASH = "    *(volatile double *)8 = 1;\n"
E, F, S = ELASTICITY, EFFECT, kernels.STRENGTH
ELASTICITIES = {
    "e_beyond": (E + "    b->stress[0][b->count] = NAN;\n", BEYOND + "stress"),
    "e_before": (E + "    b->energy[-1] = NAN;\n", BEYOND + "energy"),
    "e_status": (E + "    b->status[b->count] = 1;\n", BEYOND + "status"),
    "e_gradient": (E + "    ((double *)b->velocity_gradient[0])[i] = 0;\n",
                   INPUT + "velocity_gradient"),
    "e_state": (E + "    ((double *)b->energy_begin)[i] = 1;\n", INPUT + "energy"),
    "e_parameter": (E + "    ((double *)b->bulk)[i] *= 2;\n", PARAMETER + "bulk"),
    "e_unwritten": (E.replace("    b->sound_speed[i] =", "    (void)"),
                    "leaves points unwritten of sound_speed"),
    "e_neighbour": (E + "    b->energy[i] += b->time_step[i + 1];\n", COMPANY + "energy"),
    "e_rounds": (E + ROUNDS, ARITHMETIC),
    "e_crashes": (E + CRASH, "crashed: invalid memory reference"),
    "e_good": (E, None),
}
EFFECTS = {
    "f_beyond": (F + "    b->external_force[1][b->count] = NAN;\n", BEYOND + "external_force"),
    "f_before": (F + "    b->external_force[2][-1] = NAN;\n", BEYOND + "external_force"),
    "f_mass": (F + "    ((double *)b->mass)[i] *= 2;\n", INPUT + "mass"),
    "f_neighbour": (F + "    b->external_force[0][i] += b->mass[i + 1];\n",
                    COMPANY + "external_force"),
    "f_rounds": (F + ROUNDS, ARITHMETIC),
    "f_crashes": (F + CRASH, "crashed: invalid memory reference"),
    "f_good": (F, None),
}
INVERSE = """static void inverse(const struct {name} *b)
{{
  for (size_t i = 0; i < b->count; i++) {{
    double p = (b->flow_stress_given[i] - b->y0[i]) / b->h[i];
    b->plastic_strain_inverse[i] = p > 0 ? p : 0;
{more}  }}
}}
"""
LAWS = {
    "h_beyond": (S + "    b->flow_stress[b->count] = 0;\n", "", BEYOND + "flow_stress"),
    "h_input": (S + "    ((double *)b->plastic_strain)[i] = 0;\n", "", INPUT + "plastic_strain"),
    "h_inverse": (S, "    b->plastic_strain_inverse[b->count] = 0;\n",
                  BEYOND + "plastic_strain_inverse"),
    "h_given": (S, "    ((double *)b->flow_stress_given)[i] = 0;\n", "flow_stress_given"),
    "h_rounds": (S + ROUNDS, "", ARITHMETIC),
    "h_good": (S, "", None),
}
BLOCK = """gamut: 1
solver: {{model: material_point_method, geometry: 1d, cell: 0.5 mm, end: 0.2 us}}
materials:
  metal: {{density: 8 g/cm3, {law}}}
bodies:
  block: {{material: metal, velocity: [-10 m/s], shape: {{box: {{min: [0 mm], max: [4 mm]}}}}}}
effects:
  wall: {{model: rigid_wall, plane: {{point: [0 mm], normal: [1]}}}}
{more}"""
BAR = """gamut: 1
solver: {{model: gamut_bar, bonds: 20, strain_limit: 0.01}}
materials:
  metal: {{density: 8 g/cm3, strength: {{model: {name}, y0: 90 MPa, h: 3 GPa}}}}
bodies:
  bar: {{material: metal, length: 10 mm, area: 1 mm2, youngs_modulus: 70 GPa}}
"""


def tried(root, name, plugin, text, due):
    with open(os.path.join(root, name + ".yaml"), "w", encoding="utf-8") as file:
        file.write(text)
    for command in ("check", "run"):
        code, said = kernels.gamut(["--plugin-path", root, command, name + ".yaml"], root)
        if due:
            report(code == 4 and plugin in said and due in said,
                   f"{command}, {name}: exit {code} (4), said: {due.strip()}", said)
        else:
            report(code == 0, f"{command}, {name}: exit {code} (0)", said)


def elasticity(root, name, body):
    kernels.write(root, "elasticity", name, ELASTICITY_YAML.format(name=name),
                  kernels.kernel(name, "elasticity", "stress", body))
    return BLOCK.format(law=f"elasticity: {{model: {name}, bulk: 100 GPa}}", more="")


def effect(root, name, body):
    kernels.write(root, "effect", name, EFFECT_YAML.format(name=name),
                  kernels.kernel(name, "effect", "push", body))
    return BLOCK.format(law="eos: {model: linear, bulk_modulus: 100 GPa}",
                        more=f"  odd: {{model: {name}}}\n")


def law_of_a_solver(root, name, body, more):
    source = kernels.kernel(name, "strength", "flow_stress", body)
    start = source.index(f"GAMUT_STRENGTH({name}")
    source = (source[:start] + INVERSE.format(name=name, more=more) +
              source[start:].replace("= flow_stress)", "= flow_stress, .inverse = inverse)"))
    kernels.write(root, "strength", name, INVERSE_YAML.format(name=name), source)
    return BAR.format(name=name)


def hanging(root):
    text = elasticity(root, "e_hangs", E + "    for (volatile int on = 1; on;) {}\n")
    with open(os.path.join(root, "e_hangs.yaml"), "w", encoding="utf-8") as file:
        file.write(text)
    code, said, took = kernels.terminated(root, "e_hangs.yaml", "e_hangs-r")
    report(code == 4 and "elasticity/e_hangs" in said,
           f"SIGTERM, e_hangs: exit {code} (4) after {took:.1f} s", said)


def main():
    with tempfile.TemporaryDirectory() as root:
        for name, (body, due) in ELASTICITIES.items():
            tried(root, name, "elasticity/" + name, elasticity(root, name, body), due)
        for name, (body, due) in EFFECTS.items():
            tried(root, name, "effect/" + name, effect(root, name, body), due)
        for name, (body, more, due) in LAWS.items():
            tried(root, name, "strength/" + name, law_of_a_solver(root, name, body, more), due)
        if not kernels.sanitized():
            hanging(root)
    done()


if __name__ == "__main__":
    main()
