"""Laws that write where they may not, look at a point's neighbours or give wrong slopes: `run` and
`check` refuse each before the first step, and run the same law without the fault. Prints TAP."""
import os
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

S, E = kernels.STRENGTH, kernels.EOS
HOT = kernels.STRENGTH_YAML.replace("[plastic_strain]", "[plastic_strain, temperature]").replace(
    "flow_stress_slope_plastic_strain]",
    "flow_stress_slope_plastic_strain, flow_stress_slope_temperature]")
INPUT, PARAMETER = "writes to its input ", "writes to its parameter "
BEYOND = "writes beyond the points that it was given, in "
COMPANY = "gives a point alone another value than beside others: "
SLOPE = " where differences give "
LAWS = {
    # kind, body, YAML, what is said
    "writes_input": ("strength", S + "    ((double *)b->plastic_strain)[i] += 1e-3;\n", None,
                     INPUT + "plastic_strain"),
    "writes_next_input": ("strength", S + "    ((double *)b->plastic_strain)[b->count] = 0.1;\n",
                          None, INPUT + "plastic_strain"),
    "writes_compression": ("eos", E + "    ((double *)b->compression)[i] = 0;\n", None,
                           INPUT + "compression"),
    "writes_density": ("eos", E + "    ((double *)b->reference_density)[i] *= 1.01;\n", None,
                       INPUT + "reference_density"),
    "writes_param": ("strength", S + "    ((double *)b->y0)[i] *= 1.5;\n", None, PARAMETER + "y0"),
    "writes_modulus": ("eos", E + "    ((double *)b->K)[i] *= 1.5;\n", None, PARAMETER + "K"),
    "neighbour": ("strength", S + "    b->flow_stress[i] += i > 0 ? 1e-3 * b->y0[i - 1] : 0;\n",
                  None, COMPANY + "flow_stress"),
    "next_neighbour": ("eos", E + "    b->pressure[i] += 1e-9 * b->compression[i + 1];\n", None,
                       COMPANY + "pressure"),
    "counts_points": ("strength", S + "    b->flow_stress[i] += b->count > 3;\n", None,
                      COMPANY + "flow_stress"),
    "beyond": ("strength", S + "    b->flow_stress[i + 1] = 1e8;\n", None, BEYOND + "flow_stress"),
    "beyond_eos": ("eos", E + "    b->sound_speed[b->count] = 1e3;\n", None,
                   BEYOND + "sound_speed"),
    "before": ("eos", E + "    b->pressure[-1] = 0;\n", None, BEYOND + "pressure"),
    "flags_beyond": ("eos", E + "    b->status[b->count] = 1;\n", None, BEYOND + "status"),
    "unwritten": ("strength", S.splitlines()[0] + "\n", None,
                  "leaves points unwritten of flow_stress_slope_plastic_strain"),
    "slope_wrong": ("strength", S + "    b->flow_stress_slope_plastic_strain[i] *= 1.01;\n", None,
                    SLOPE),
    "slope_of_eos": ("eos", E + "    b->pressure_slope_compression[i] *= 0.99;\n", None, SLOPE),
    "slope_of_heat": ("strength", S + "    b->flow_stress[i] *= 1 - b->temperature[i] / 1e4;\n"
                      "    b->flow_stress_slope_plastic_strain[i] *= 1 - b->temperature[i] / 1e4;\n"
                      "    b->flow_stress_slope_temperature[i] = 0;\n", HOT, SLOPE),
    "good": ("strength", S, None, None),
    "good_eos": ("eos", E, None, None),
    "kink": ("strength", S + "    if (b->plastic_strain[i] > 0.0131) {\n"
             "      b->flow_stress[i] = b->y0[i] + b->h[i] * 0.0131;\n"
             "      b->flow_stress_slope_plastic_strain[i] = 0;\n    }\n", None, None),
}
def try_law(root, name, kind, body, yaml, due):
    if kind == "strength":
        kernels.strength(root, name, body, yaml=yaml or kernels.STRENGTH_YAML)
        text = kernels.scene(strength_model=name)
    else:
        kernels.eos(root, name, body, yaml=yaml or kernels.EOS_YAML)
        text = kernels.scene(eos_model=name)
    with open(os.path.join(root, name + ".yaml"), "w", encoding="utf-8") as file:
        file.write(text)
    for command in ("check", "run"):
        code, said = kernels.gamut(["--plugin-path", root, command, name + ".yaml"], root)
        if due:
            named = f"plugin {kind}/{name} " in said and due in said
            report(code == 4 and named,
                   f"{command}, {name}: exit {code}, said: {due.strip()}", said)
        else:
            report(code == 0, f"{command}, {name}: exit {code}", said)


def main():
    with tempfile.TemporaryDirectory() as root:
        for name, (kind, body, yaml, due) in LAWS.items():
            try_law(root, name, kind, body, yaml, due)
    done()


if __name__ == "__main__":
    main()
