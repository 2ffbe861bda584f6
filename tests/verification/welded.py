"""Bodies that share nodes are told of, once a pair, with their names and what lies between them;
bodies far apart are not; and a scheme that does not converge is told of. Prints TAP."""
import json
import os
import subprocess

import scenes

SCENE = """gamut: 1
solver: {{model: material_point_method, geometry: {geometry}, cell: 0.2 mm, end: 0.2 us, {solver}}}
materials:
  st: {{density: 7830 kg/m3, eos: {{model: linear, bulk_modulus: 164 GPa}},
       {strength}elasticity: {{model: hypoelastic, shear_modulus: 81.8 GPa}}}}
bodies:
{bodies}
effects: {{q: {{model: artificial_viscosity}}}}
quantities: {{p: {{measure: momentum, body: a, axis: x, reduce: at end}}}}
"""
REACH = {"linear": 2.0, "gimp": 2.5, "quadratic": 3.0, "cubic": 4.0}
WORDS = "share nodes"


def said(command, scene, extra=()):
    process = subprocess.run([scenes.GAMUT, "--no-user-plugins", command, *extra, scene],
                             stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                             cwd=scenes.SCRATCH, env=scenes.PATIENT)
    return process.returncode, process.stdout, process.stderr


def written(name, shapes, geometry="1d", solver="shape: quadratic", strength=""):
    bodies = "\n".join(f"  {body}: {{material: st, shape: {{{shape}}}}}"
                       for body, shape in shapes.items())
    return scenes.written(name.replace(" ", "_").replace(",", ""), SCENE.format(
        geometry=geometry, solver=solver, strength=strength, bodies=bodies))


def bar(low, high):
    return f"box: {{min: [{low!r} mm], max: [{high!r} mm]}}"


def pairs_of(text):
    return [line for line in text.splitlines() if WORDS in line]


def told(name, scene, pairs, words=(), commands=("check", "explain", "run")):
    """Whether each of these pairs is warned of once, and nobody else."""
    for command in commands:
        extra = ("-o", os.path.join(scenes.SCRATCH, "out"), "--force") if command == "run" else ()
        code, out, error = said(command, scene, extra)
        lines = pairs_of(error)
        right = len(lines) == len(pairs) and all(
            sum(f"'{a}' and '{b}'" in line for line in lines) == 1 for a, b in pairs)
        missing = [w for w in words if w not in error]
        scenes.report(code == 0 and right and not missing and WORDS not in out,
                      f"{name}, {command}: {len(lines)} warnings of pairs (due {len(pairs)}), exit "
                      f"{code}", [missing, error[-1500:]])


TOUCH = {"a": bar(-4.0, 0.0), "b": bar(0.0, 4.0)}
told("bars in contact", written("touch", TOUCH), [("a", "b")],
     ["touch", "(2.5 cells)", "neither slide on each other nor part"])
told("bars 0.3 mm apart", written("near", {"a": bar(-4.0, 0.0), "b": bar(0.3, 4.0)}), [("a", "b")],
     ["are 0.0003 m apart"])
told("bars 2 mm apart", written("far", {"a": bar(-4.0, 0.0), "b": bar(2.0, 4.0)}), [])
told("three bars", written("three", {"a": bar(-4.0, 0.0), "b": bar(0.0, 4.0), "c": bar(4.0, 8.0)}),
     [("a", "b"), ("b", "c")])
told("one body", written("one", {"a": bar(-4.0, 0.0)}), [])
# Points lie a quarter of a cell within a body's end, so that ends are half a cell closer.
for shape, reach in REACH.items():
    edge = 0.2 * (reach - 0.5)
    for what, gap, pairs in (("inside", edge - 0.01, [("a", "b")]), ("outside", edge + 0.01, [])):
        told(f"{shape}, a gap of {gap:.3g} mm just {what} the reach",
             written(f"{shape} {what}", {"a": bar(-4.0, 0.0), "b": bar(round(gap, 4), 4.0)},
                     solver=f"shape: {shape}"), pairs, commands=("check",))
SQUARE = {"a": "box: {min: [0 mm, 0 mm], max: [2 mm, 2 mm]}"}
told("squares that meet at a corner", written("corner", {
    **SQUARE, "b": "box: {min: [2 mm, 2 mm], max: [4 mm, 4 mm]}"}, "plane_strain"), [("a", "b")],
    commands=("check",))
told("squares apart along one axis", written("beside", {
    **SQUARE, "b": "box: {min: [0 mm, 3 mm], max: [2 mm, 5 mm]}"}, "plane_strain"), [],
    commands=("check",))
told("a ring around a disk, boxes one within the other", written("ring", {
    "a": "tube: {radius: 6 mm, inner_radius: 4 mm, length: 2 mm}",
    "b": "cylinder: {radius: 2 mm, length: 2 mm}"}, "axisymmetric"), [], commands=("check",))
told("a ball on a plate", written("ball", {
    "a": "sphere: {radius: 2.5 mm, centre: [0 mm, 2.5 mm]}",
    "b": "cylinder: {radius: 5 mm, length: 2 mm, base: [0 mm, -2 mm]}"}, "axisymmetric"),
    [("a", "b")], commands=("check",))
told("blocks in space", written("space", {
    "a": "box: {min: [0 mm, 0 mm, 0 mm], max: [1 mm, 1 mm, 1 mm]}",
    "b": "box: {min: [0 mm, 1.1 mm, 0 mm], max: [1 mm, 2 mm, 1 mm]}"}, "3d"), [("a", "b")],
    ["are 0.0001 m apart"], commands=("check",))

code, out, error = said("explain", written("touch json", TOUCH), ("--json",))
scenes.report(code == 0 and WORDS not in out and isinstance(json.loads(out), dict)
              and len(pairs_of(error)) == 1, "explain --json: the warning is not in the JSON")

PLASTIC = "strength: {model: von_mises, yield_stress: 90 MPa}, "
FLOWS = "does not converge where material flows"
for name, solver, strength, due in (
        ("linear", "shape: linear", PLASTIC, 1),
        ("linear, musl", "shape: linear, stress_update: musl", PLASTIC, 1),
        ("linear, usl", "shape: linear, stress_update: usl", PLASTIC, 0),
        ("linear, elastic", "shape: linear", "", 0),
        ("linear, a fluid", "shape: linear", "strength: {model: none}, ", 0),
        ("quadratic, musl", "shape: quadratic, stress_update: musl", PLASTIC, 0)):
    scene = written("scheme " + name, {"a": bar(-4.0, 0.0)}, solver=solver, strength=strength)
    for command in ("check", "explain"):
        code, _, error = said(command, scene)
        count = sum(FLOWS in line for line in error.splitlines())
        scenes.report(code == 0 and count == due,
                      f"{name}, {command}: {count} warnings of the scheme (due {due})",
                      [error[-800:]])
scenes.done()
