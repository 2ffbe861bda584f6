"""Files whose contents are part of a scene: results say which they were, and nothing goes on with
others."""
import os

import scenes

SCENE = """gamut: 1
solver: {model: material_point_method, geometry: plane_strain, cell: 2 mm, end: 2 us}
materials:
  metal: {density: 8 g/cm3, eos: {model: linear, bulk_modulus: 100 GPa}, strength: none}
bodies:
  plate: {material: metal, velocity: [10 m/s, 0 m/s],
          shape: {points: {file: points.csv, spacing: 1 mm}}}
quantities:
  length: {measure: extent, axis: x, reduce: at end}
outputs: {every: 1 us, checkpoint: {every: 1 us}}
"""
STUDY = """uncertainty: {estimator: {model: monte_carlo, runs: 2}, seed: 1}
"""
BESIDE = os.path.join(scenes.SCRATCH, "scenes")
KEY = "bodies.plate.shape.points.file"


def points(count):
    """So many points in each of two rows; the file's digest, FNV-1a of 64 bits."""
    text = "x [mm],y [mm]\n" + "".join(
        f"{k // 2 + 0.5},{k % 2 + 0.5}\n" for k in range(2 * count))
    with open(os.path.join(BESIDE, "points.csv"), "w", encoding="utf-8") as file:
        file.write(text)
    digest = 0xcbf29ce484222325
    for byte in text.encode():
        digest = (digest ^ byte) * 0x100000001b3 % 2 ** 64
    return f"{digest:016x}"


def refused(name, process, code, words):
    said = process.stderr
    scenes.report(process.returncode == code and all(word in said for word in words),
                  f"{name}: exit {process.returncode} ({code}), {words[0]}", [said])


def goes_on(name, process):
    scenes.report(process.returncode == 0, f"{name}: exit {process.returncode} (0)",
                  [process.stderr])


def attempt(scene, folder, *changes):
    arguments = ["--resume", "-o", folder]
    for change in changes:
        arguments += ["--set", change]
    return scenes.attempt(scene, extra=arguments)[0]


def run():
    digest = points(8)
    scene = scenes.written("points", SCENE)
    process, folder = scenes.attempt(scene)
    goes_on("a body from a file of points", process)
    if process.returncode:
        return
    said = scenes.read(folder, process).summary["input_files"]
    wanted = [{"key": KEY, "file": os.path.join(BESIDE, "points.csv"), "digest": digest}]
    scenes.report(said == wanted, f"the summary names its key, path and digest {digest}", [said])
    points(9)
    words = ["points.csv' was changed after the run in", f"({KEY})", "points.yaml:7:34"]
    refused("a run that ended, of another file", attempt(scene, folder), 3, words)
    refused("a later end, of another file", attempt(scene, folder, "solver.end=3 us"), 3, words)
    points(8)
    goes_on("a run that ended, of the same file", attempt(scene, folder))
    goes_on("a later end, of the same file", attempt(scene, folder, "solver.end=3 us"))


def study():
    points(8)
    scene = scenes.written("study", SCENE.replace(
        "bulk_modulus: 100 GPa", "bulk_modulus: {mean: 100 GPa, cv: 0.1}").replace(
            ", checkpoint: {every: 1 us}", "") + STUDY)
    process, folder = scenes.attempt(scene)
    goes_on("a study of a body from a file", process)
    points(9)
    refused("a study, of another file", attempt(scene, folder), 7,
            ["a file that it names"])
    points(8)
    goes_on("a study, of the same file", attempt(scene, folder))


os.makedirs(BESIDE, exist_ok=True)
run()
study()
scenes.done()
