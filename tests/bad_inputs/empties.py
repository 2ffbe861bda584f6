"""Nothing where something is due: each mapping, list and value of good scenes is emptied in turn. Such a
scene is read (exit 0), or refused with a place in it (exit 3); never anything else. Prints TAP."""
import copy
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tap  # noqa: E402
from tap import report  # noqa: E402

try:
    import yaml
except ImportError:
    print("1..0 # SKIP no PyYAML (Debian: python3-yaml)")
    sys.exit(77)

HERE = os.path.dirname(os.path.abspath(__file__))
GAMUT = os.environ.get("GAMUT", os.path.join(HERE, "../../build/gamut"))
WHOLE = """
gamut: 1
title: everything
include: [materials/copper.yaml]
solver: {model: material_point_method, geometry: axisymmetric, cell: 1 mm, end: 1 us,
         transfer: {model: flip, pic: 0.01}, domain: {min: [0 mm, -30 mm], max: [30 mm, 30 mm]}}
materials:
  steel:
    specific_heat: 460 J/(kg K)
    density: {mean: 7850 kg/m3, cv: 0.01, truncate: true}
    source: [a book]
    eos: {model: linear, bulk_modulus: 160 GPa}
    strength: {model: johnson_cook, A: {distribution: uniform, lower: 80 MPa, upper: 99 MPa},
               B: 292 MPa, n: 0.31, C: 0.025, m: 1.09, T_melt: 1356 K}
    elasticity: {model: hypoelastic, shear_modulus: 80 GPa}
bodies:
  bar: {material: copper, velocity: [0 m/s, -1 m/s], temperature: 300 K, points_per_cell: 4,
        shape: {difference: {from: {cylinder: {radius: 4 mm, length: 20 mm}},
                             remove: [{sphere: {radius: 1 mm, centre: [0 mm, 10 mm]}}]}}}
  rod: {material: steel, shape: {union: [{box: {min: [6 mm, 1 mm], max: [9 mm, 5 mm]}}]}}
effects:
  wall: {model: rigid_wall, bodies: [bar], plane: {point: [0 mm, 0 mm], normal: [0, 1]}}
  heat: {model: adiabatic_heating, materials: [steel], enabled: auto}
quantities:
  length: {measure: extent, body: bar, axis: y, reduce: at end, every: 0.1 us}
  line: {measure: pressure, at: {body: bar, line: {from: [2 mm, 1 mm], to: [2 mm, 5 mm], points: 3},
         follow: material}, reduce: {max: [0 us, 1 us]}}
  force: {measure: force, effect: wall, axis: y}
outputs: {every: 1 us, fields: [velocity, plastic_strain], checkpoint: {every: 0.5 us}}
uncertainty: {estimator: {model: monte_carlo, runs: 8}, seed: 3, failures: 0.1,
              correlation: [[materials.steel.density, materials.steel.strength.A, 0.4]]}
"""
PLACE = re.compile(r"^scene\.yaml:\d+:\d+: error: ", re.MULTILINE)


yaml.SafeDumper.add_representer(
    type(None), lambda dumper, _: dumper.represent_scalar("tag:yaml.org,2002:null", ""))


def nodes(tree, path=()):
    """Every node below the root, with its path."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in items:
        yield path + (key,), value
        if isinstance(value, (dict, list)):
            yield from nodes(value, path + (key,))


def emptied(tree, path, nothing):
    made = copy.deepcopy(tree)
    at = made
    for step in path[:-1]:
        at = at[step]
    at[path[-1]] = nothing
    return made


def check(folder, text):
    with open(os.path.join(folder, "scene.yaml"), "w", encoding="utf-8") as file:
        file.write(text)
    done = subprocess.run([GAMUT, "--no-user-plugins", "check", "scene.yaml"], cwd=folder,
                          timeout=120, stdin=subprocess.DEVNULL, capture_output=True)
    return done.returncode, done.stderr.decode(errors="replace")


def main():
    whole = yaml.safe_load(WHOLE)
    with tempfile.TemporaryDirectory() as folder:
        code, said = check(folder, WHOLE)
        report(code == 0, "the whole scene is good", said)
        for path, value in nodes(whole):
            name = ".".join(str(step) for step in path)
            for nothing in ({} if isinstance(value, dict) else [], None):
                tree = emptied(whole, path, nothing)
                code, said = check(folder, yaml.safe_dump(tree, sort_keys=False))
                good = code == 0 or (code == 3 and PLACE.search(said))
                word = {"{}": "{}", "[]": "[]"}.get(repr(nothing), "nothing")
                report(good, f"{name}: {word}: exit {code}", said)
        for text in ("gamut: 1\nmaterials: {}\n", "gamut:\n", "gamut: 1\nbodies: {}\n",
                     "gamut: 1\nsolver: {}\n", "gamut: 1\ninclude: []\n", "{}\n", "[]\n"):
            code, said = check(folder, text)
            report(code == 3 and PLACE.search(said), f"{text.strip()!r}: refused", said)
    tap.done()


main()
