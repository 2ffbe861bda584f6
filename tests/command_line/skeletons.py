"""gamut new: the skeleton of every kind builds out of tree without a warning, and passes verify."""
import os
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tap import GAMUT, done, gamut, report  # noqa: E402

KINDS = ["eos", "strength", "elasticity", "effect", "random_field", "estimator", "solver"]
SCENE = """gamut: 1
solver: {model: material_driver, end: 1 ms, steps: 20, control: {xy: {velocity_gradient: 100 1/s}}}
materials:
  metal: {density: 8000 kg/m3, eos: {model: linear, bulk_modulus: 140 GPa},
          strength: {model: my_strength, yield_stress: 90 MPa, hardening_modulus: 300 MPa},
          elasticity: {model: hypoelastic, shear_modulus: 48 GPa}}
bodies:
  sample: {material: metal}
quantities:
  strain: {measure: plastic_strain, body: sample, reduce: at end}
"""


def make(folder):
    compiler = os.environ.get("CC", "cc")
    return subprocess.run(["make", f"GAMUT={GAMUT}", f"PKG_CONFIG_PATH={os.path.dirname(GAMUT)}",
                           f"CC={compiler}", "CFLAGS=-Werror"], cwd=folder, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def skeleton(kind, scratch):
    name = "my_" + kind
    folder = os.path.join(scratch, kind, name)
    os.mkdir(os.path.join(scratch, kind))
    answer = gamut("new", f"{kind}/{name}", "-o", folder, cwd=scratch)
    if not report(answer.code == 0 and name in answer.out, f"new {kind}/{name}", answer):
        return
    built = make(folder)
    if not report(built.returncode == 0, f"{name} builds without a warning"):
        print("# " + built.stdout.replace("\n", "\n# "))
        return
    answer = gamut("verify", folder)
    report(answer.code == 0 and answer.out.count("\nok ") >= 8, f"{name} passes verify", answer)
    again = gamut("new", f"{kind}/{name}", "-o", folder, cwd=scratch)
    report(again.code == 7 and "is there already" in again.said, f"{name} is not overwritten",
           again)


# A body that is pulled beyond what it bears, of an elasticity whose stress follows from a state of
# its own.
TORN = """gamut: 1
solver: {{model: material_point_method, geometry: 1d, cell: 0.2 mm, end: 1 us}}
materials:
  own: {{density: 8000 kg/m3, eos: {{model: linear, bulk_modulus: 140 GPa}},
        elasticity: {{model: my_elasticity, bulk_modulus: 140 GPa, shear_modulus: 48 GPa}}}}
  metal: {{density: 8000 kg/m3, eos: {{model: linear, bulk_modulus: 140 GPa}},
          elasticity: {{model: hypoelastic, shear_modulus: 48 GPa}}}}
bodies:
  left: {{material: own, shape: {{box: {{min: [-4 mm], max: [-1 mm]}}}}}}
  right: {{material: metal, velocity: ["100 * x"], shape: {{box: {{min: [0 mm], max: [4 mm]}}}}}}
effects: {{torn: {{{effect}}}}}
"""
IMPOSING = [("spall on every body", "model: spall, limit: 1 GPa", 3),
            ("spall on bodies: [left]", "model: spall, limit: 1 GPa, bodies: [left]", 3),
            ("cutoff on materials: [own]",
             "model: spall, limit: 1 GPa, mode: cutoff, materials: [own]", 3),
            ("spall on the other body", "model: spall, limit: 1 GPa, bodies: [right]", 0),
            ("spall that is off", "model: spall, limit: 1 GPa, enabled: off", 0)]


def imposed_stress(scratch):
    scene = os.path.join(scratch, "torn.yaml")
    for what, effect, due in IMPOSING:
        with open(scene, "w", encoding="utf-8") as file:
            file.write(TORN.format(effect=effect))
        for command in ("check", "run"):
            options = ["-o", os.path.join(scratch, "torn"), "--force"] if command == "run" else []
            answer = gamut("--plugin-path", scratch, command, scene, *options, cwd=scratch)
            told = "elasticity/my_elasticity" in answer.said and "'torn'" in answer.said
            report(answer.code == due and told == (due != 0),
                   f"{command}, an elasticity that takes no stress up: {what}: exit {due}", answer)


def false_promise(scratch):
    folder = os.path.join(scratch, "elasticity", "my_elasticity")
    file = os.path.join(folder, "my_elasticity.yaml")
    with open(file, encoding="utf-8") as text:
        honest = text.read()
    with open(file, "w", encoding="utf-8") as text:
        text.write(honest + "provides: [imposed_stress]\n")
    answer = gamut("verify", folder)
    report(answer.code == 4 and "an effect has halved" in answer.out,
           "verify finds an elasticity that promises to take a stress up and does not", answer)
    with open(file, "w", encoding="utf-8") as text:
        text.write(honest)


def main():
    with tempfile.TemporaryDirectory() as scratch:
        os.chmod(scratch, 0o755)
        for kind in KINDS:
            skeleton(kind, scratch)
        imposed_stress(scratch)
        false_promise(scratch)
        scene = os.path.join(scratch, "scene.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE)
        answer = gamut("--plugin-path", scratch, "run", scene, "--json", cwd=scratch)
        summary = answer.json() or {}
        report(answer.code == 0 and summary.get("quantities", {}).get("strain", {}).get("value", 0)
               > 0, "a new hardening law runs in the material driver", answer)
        answer = gamut("--plugin-path", scratch, "eval", "strength/my_strength", "--param",
                       "yield_stress=90 MPa", "--at", "plastic_strain=0.1", "--json")
        report(answer.code == 0 and answer.json() is not None, "and in eval", answer)
    done()


if __name__ == "__main__":
    main()
