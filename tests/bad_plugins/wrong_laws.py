"""Laws that compute something wrong or do what no law may: `gamut verify` refuses each, says why,
and passes the same law without the fault. Prints TAP."""
import os
import shutil
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

S, E = kernels.STRENGTH, kernels.EOS
HOT = kernels.STRENGTH_YAML.replace("[plastic_strain]", "[plastic_strain, temperature]")
FAST = kernels.STRENGTH_YAML.replace("[plastic_strain]", "[plastic_strain, plastic_strain_rate]")
WARM = kernels.EOS_YAML.replace("[compression,", "[compression, energy,")
SPARE = kernels.STRENGTH_YAML.replace(
    "inputs:", '  s: {{unit: Pa, default: 1 Pa, physical: "[0, inf)", doc: spare}}\ninputs:')
SPARE_EOS = kernels.EOS_YAML.replace(
    "inputs:", '  s: {{unit: Pa, default: 1 Pa, physical: "[0, inf)", doc: spare}}\ninputs:')
OUTLIVE, CALLS = "variables that outlive a call: ", "functions called that a law may not call: "
LAWS = {
    # kind, what stands before the kernel, its body, YAML, NAME.test.yaml, what verify says
    "counts": ("strength", "static double calls;\n", "    calls += 1;\n" + S +
               "    b->flow_stress[i] += 1e6 * (calls > 1e9);\n", None, None, OUTLIVE + "calls"),
    "scratch": ("strength", "static volatile double work[2048];\n",
                "    work[i] = b->h[i];\n" + S, None, None, OUTLIVE + "work"),
    "of_thread": ("strength", "static _Thread_local volatile double last;\n",
                  S + "    last = b->h[i];\n", None, None, OUTLIVE + "last"),
    "small_flag": ("eos", "static volatile char seen;\n", E + "    seen = 1;\n", None, None,
                   OUTLIVE + "seen"),
    "allocates": ("strength", "#include <stdlib.h>\n",
                  "    double *volatile w = malloc(80);\n    w[3] = 0;\n" + S + "    free(w);\n",
                  None, None, CALLS),
    "prints": ("strength", "#include <stdio.h>\n", S + '    if (b->h[i] < 0) puts("oh");\n', None,
               None, CALLS + "puts"),
    "environment": ("strength", "#include <stdlib.h>\n",
                    S + '    if (getenv("ROGUE")) b->flow_stress[i] *= 3;\n', None, None,
                    CALLS + "getenv"),
    "clock": ("eos", "#include <time.h>\n", E + "    b->pressure[i] += time(0) < 0;\n", None, None,
              CALLS + "time"),
    "chance": ("eos", "#include <stdlib.h>\n", E + "    b->pressure[i] += rand() < 0;\n", None,
               None, CALLS + "rand"),
    "rounding": ("strength", "#include <fenv.h>\n", S + "    fesetround(FE_UPWARD);\n", None, None,
                 "calls that change rounding, flushing or traps: 3"),
    "flushing": ("eos", "#include <xmmintrin.h>\n", E + "    _MM_SET_FLUSH_ZERO_MODE(0x8000);\n",
                 None, None, "calls that change rounding, flushing or traps: 3"),
    "rounds_down": ("eos", "", E + "    __builtin_ia32_ldmxcsr(0x3f80);\n", None, None,
                    "calls that change rounding, flushing or traps: 3"),
    "jump": ("strength", "",
             S + "    b->flow_stress[i] += b->plastic_strain[i] > 0.123 ? 5e6 : 0;\n",
             None, None, "(at plastic_strain = 0.123)"),
    "jump_of_pressure": ("eos", "",
                         E + "    b->pressure[i] += b->compression[i] > 0.21 ? 1e6 : 0;\n",
                         None, None, "(at compression = 0.21)"),
    "clamp": ("strength", "", S + "    b->flow_stress[i] = b->plastic_strain[i] > 0.5 ? b->y0[i] : "
              "b->flow_stress[i];\n", None, None, "(at plastic_strain = 0.5)"),
    "hot": ("strength", "", S + "    b->flow_stress[i] *= 1 - b->temperature[i] / 1e4;\n"
            "    b->flow_stress_slope_plastic_strain[i] *= 1 - b->temperature[i] / 1e4;\n", HOT,
            None, "flow_stress that changes with temperature gives its slope"),
    "fast": ("strength", "", S + "    b->flow_stress[i] += b->plastic_strain_rate[i];\n", FAST,
             None, "flow_stress that changes with plastic_strain_rate gives its slope"),
    "warm": ("eos", "", E + "    b->pressure[i] += 0.1 * b->energy[i];\n", WARM, None,
             "pressure that changes with energy gives its slope"),
    "spare": ("strength", "", S, SPARE, None, "not ok"),
    "spare_eos": ("eos", "", E, SPARE_EOS, None, "the parameter s moves a result"),
    "slow_waves": ("eos", "", E + "    b->sound_speed[i] *= 0.5;\n", None, None,
                   "sound speed over that of the slopes, 256 points: 0.5 (at least 1)"),
    "unproven": ("strength", "", S, None, "tests: []\n", "no known answer: formula unproven"),
    "unproven_eos": ("eos", "", E, None, "tests: []\n", "no known answer: formula unproven"),
    "no_tests_at_all": ("strength", "", S, None, "", "no known answer: formula unproven"),
    "wrong_formula": ("strength", "", S + "    b->flow_stress[i] += b->y0[i];\n", None, None,
                      "not ok"),
    "overflows": ("eos", "", E + "    b->pressure[i + 1] = 0;\n", None, None, "written beyond"),
}
NOTED = {
    "fast_waves": ("eos", E + "    b->sound_speed[i] *= 3;\n", kernels.EOS_YAML,
                   "note: the sound speed is up to 3 times that of the slopes"),
    "reads_too_much": ("strength", S, HOT, "note: the input temperature moves no result"),
    "good": ("strength", S, kernels.STRENGTH_YAML, "1.."),
    "good_eos": ("eos", E, kernels.EOS_YAML, "1.."),
}
def make(root, kind, name, body, top="", yaml=None, test=None):
    law = kernels.strength if kind == "strength" else kernels.eos
    standard = {"strength": (kernels.STRENGTH_YAML, kernels.STRENGTH_TEST),
                "eos": (kernels.EOS_YAML, kernels.EOS_TEST)}[kind]
    law(root, name, body, top, yaml or standard[0], standard[1] if test is None else test or None)
    return f"./{kind}/{name}"


def main():
    x86 = os.uname().machine == "x86_64"
    with tempfile.TemporaryDirectory() as root:
        for name, (kind, top, body, yaml, test, line) in LAWS.items():
            if not x86 and name in ("flushing", "rounds_down"):
                continue
            code, said = kernels.gamut(["verify", make(root, kind, name, body, top, yaml, test)],
                                       root)
            wrong = [text for text in said.splitlines() if text.startswith("not ok")]
            found = any(line in text for text in wrong)
            report(code == 4 and found, f"{name}: exit {code}, said: {line}", said)
        for name, (kind, body, yaml, line) in NOTED.items():
            code, said = kernels.gamut(["verify", make(root, kind, name, body, "", yaml)], root)
            report(code == 0 and line in said, f"{name}: exit {code}, passes; said: {line}", said)
        prepared = os.path.join(os.path.dirname(os.path.abspath(__file__)), "double_work")
        if os.path.isdir(prepared):
            energy(root, prepared)
    done()


def energy(root, prepared):
    """An elasticity that counts plastic work again: twice, five times, or the half of it."""
    with open(os.path.join(prepared, "neo_hookean.c.txt"), encoding="utf-8") as file:
        source = file.read()
    with open(os.path.join(prepared, "neo_hookean.yaml.txt"), encoding="utf-8") as file:
        yaml = file.read()
    with open(os.path.join(prepared, "neo_hookean.test.yaml.txt"), encoding="utf-8") as file:
        test = file.read()
    again = "0.5 * g * (trace - 3 - before) + dissipated - q"
    for factor, due in (("dissipated", 4), ("5 * dissipated", 4), ("0.5 * dissipated", 4),
                        ("0.1 * dissipated", 4)):
        shutil.rmtree(os.path.join(root, "elasticity"), ignore_errors=True)
        changed = source.replace(again, f"0.5 * g * (trace - 3 - before) + {factor} - q")
        kernels.write(root, "elasticity", "neo_hookean", yaml, changed, test)
        code, said = kernels.gamut(["verify", "./elasticity/neo_hookean"], root)
        lines = [text for text in said.splitlines() if "energy less the work" in text]
        report(code == due, f"plastic work counted again as {factor}: exit {code} (due {due}); "
               + lines[-1].split(" - ")[-1], said)


if __name__ == "__main__":
    main()
