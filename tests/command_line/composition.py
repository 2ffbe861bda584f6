"""How pieces compose in a run: an elasticity that asks for a shorter step and flags its points,
variants, effects that are off, quantities at a place in space."""
import os
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tap import GAMUT, ROOT, done, gamut, report  # noqa: E402

SCENE = """gamut: 1
solver: {model: material_point_method, geometry: 1d, cell: 1 mm, step: 100 ns, end: 1 us}
materials:
  metal: {density: 8000 kg/m3, eos: {model: ideal_gas, gamma: 1.4},
          elasticity: {model: short_step, bulk_modulus: 140 GPa, shear_modulus: 48 GPa}}
bodies:
  bar: {material: metal, shape: {box: {min: [0 mm], max: [10 mm]}}, velocity: [1 m/s]}
quantities:
  of_matter: {measure: velocity_x, at: {body: bar, point: [5 mm]}, reduce: at end}
  in_space: {measure: velocity_x, at: {body: bar, point: [5 mm], follow: space}, reduce: at end}
  beside: {measure: velocity_x, at: {body: bar, point: [90 mm], follow: space}, reduce: at end}
"""
BAR = os.path.join(ROOT, "inputs", "taylor_bar.yaml")


def plugin(folder):
    """The skeleton of an elasticity, with a limit on the step and a warning at every point."""
    gamut("new", "elasticity/short_step", "-o", folder)
    for name, old, new in (
            ("short_step.yaml", "outputs: [sound_speed]", "outputs: [sound_speed, step_factor]"),
            ("short_step.yaml", "messages:\n",
             'messages:\n  soft: {severity: warn, text: "this material is soft"}\n'),
            ("short_step.c", "    b->volume_ratio[i] = j;",
             "    b->volume_ratio[i] = j;\n"
             "    b->step_factor[i] = b->time_step[i] > 30e-9 ? 0.5 : 1.0;\n"
             "    GAMUT_FLAG(b, i, 1, SHORT_STEP_SOFT);")):
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace(old, new))
    built = subprocess.run(["make", f"GAMUT={GAMUT}", f"PKG_CONFIG_PATH={os.path.dirname(GAMUT)}",
                            f"CC={os.environ.get('CC', 'cc')}"], cwd=folder, text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return report(built.returncode == 0, "an elasticity that asks for short steps builds")


def run_short_steps(scratch):
    scene = os.path.join(scratch, "scene.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(SCENE)
    answer = gamut("--plugin-path", scratch, "run", scene, "--json", cwd=scratch)
    summary = answer.json() or {}
    steps, points = (summary.get("cost", {}).get(k, 0) for k in ("steps", "points"))
    # 100, 50 and 25 ns, then no longer ones: 3 + (1000 - 175) / 25.
    report(answer.code == 0 and steps == 36, f"the step is cut to what the points allow: {steps}",
           answer)
    flags = summary.get("flags", [])
    report(len(flags) == 1 and flags[0].get("count") == steps * points,
           f"a warning is counted at every point and step: {flags}")
    report("ideal_gas" not in [p["id"].split("/")[1] for p in summary.get("plugins", [])] and
           "is not used" in answer.said, "an eos that the elasticity does not call is left aside",
           answer)
    report(answer.said.count("this material is soft") == 1, "and printed once", answer)
    value = {name: q.get("value") for name, q in summary.get("quantities", {}).items()}
    report(value.get("of_matter") == 1.0 and value.get("in_space") == 1.0,
           f"a quantity follows the material, or stays in space: {value}")
    report(value.get("beside", 0) is None, "where no material is there is no value")


def explained(*settings):
    changes = [word for setting in settings for word in ("--set", setting)]
    answer = gamut("explain", BAR, *changes)
    return answer.out if answer.code == 0 else ""


def main():
    with tempfile.TemporaryDirectory() as scratch:
        os.chmod(scratch, 0o755)
        folder = os.path.join(scratch, "elasticity", "short_step")
        os.mkdir(os.path.join(scratch, "elasticity"))
        if plugin(folder):
            run_short_steps(scratch)
    report("rate_independent: C == 0" in explained("materials.copper.strength.C=0"),
           "explain names the variant in force, and why")
    report("rate_independent" not in
           explained("materials.copper.strength.C={mean: 0.02, cv: 0.1}"),
           "a random parameter chooses no variant")
    told = explained("effects.heat.enabled=off")
    report("effect heat                enabled: off" in told and "  | heat " not in told,
           "an effect that is off is named, and has no task")
    report("linear = quadratic = 0" in explained("effects.viscosity.linear=0",
                                                 "effects.viscosity.quadratic=0"),
           "an effect that declines says why")
    done()


main()
