"""An effect that opens material is warned of where the eos of that material stops a run; once a
material, at check, explain and run alike, and not in the exit code."""
import os
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tap import gamut, done, report  # noqa: E402

PLATE = """gamut: 1
solver: {{model: material_point_method, geometry: 1d, cell: 0.2 mm, end: 0.2 us}}
materials:
  cu: {{density: 8960 kg/m3, eos: {{model: mie_gruneisen, C0: 3940 m/s, S1: 1.489,
       gamma0: 2.02{limit}}}}}
  st: {{density: 7830 kg/m3, eos: {{model: mie_gruneisen, C0: 4569 m/s, S1: 1.49, gamma0: 2.17}}}}
  al: {{density: 2785 kg/m3, eos: {{model: linear, bulk_modulus: 79 GPa}}}}
bodies:
  one: {{material: cu, shape: {{box: {{min: [0 mm], max: [2 mm]}}}}}}
  two: {{material: cu, shape: {{box: {{min: [4 mm], max: [6 mm]}}}}}}
  three: {{material: {third}, shape: {{box: {{min: [8 mm], max: [10 mm]}}}}}}
effects:
  torn: {{model: spall, limit: 1 GPa{only}}}
"""
SAID = "lets material open, but eos/mie_gruneisen of material"
LIMIT = ", tension_limit: -1 GPa"
CASES = [("two bodies of one copper without a limit", "", "al", "", ["'cu'"]),
         ("copper and steel without limits", "", "st", "", ["'cu'", "'st'"]),
         ("copper with a limit, a linear eos", LIMIT, "al", "", []),
         ("copper with a limit, steel without", LIMIT, "st", "", ["'st'"]),
         ("spall on the steel alone", "", "st", ", bodies: [three]", ["'st'"]),
         ("spall off", "", "st", ", enabled: off", [])]


def main():
    with tempfile.TemporaryDirectory() as scratch:
        scene = os.path.join(scratch, "plate.yaml")
        for what, limit, third, only, due in CASES:
            with open(scene, "w", encoding="utf-8") as file:
                file.write(PLATE.format(limit=limit, third=third, only=only))
            for command in ("check", "explain", "run"):
                to = ["-o", os.path.join(scratch, "out"), "--force"]
                options = to if command == "run" else []
                answer = gamut(command, scene, *options, cwd=scratch)
                told = [f"{SAID} {name}" in answer.said for name in due]
                report(answer.code == 0 and all(told) and answer.said.count(SAID) == len(due) and
                       answer.said.count("plate.yaml:13:9: warning") == len(due),
                       f"{command}: {what}: {len(due)} warnings", answer)
    done()


main()
