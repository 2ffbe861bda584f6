"""Quantities of many points in one line of a scene: each is what a quantity of that one point is,
for any number of threads and after a restart. Prints TAP."""
import csv
import json

import scenes  # before h5py: it skips the test where it is missing
import h5py

LINE = [0.0, 5e-3, 10e-3, 15e-3, 20e-3]
SCENE = """gamut: 1
include: [materials/copper.yaml]
solver: {model: material_point_method, geometry: axisymmetric, cell: 1 mm, end: 12 us}
bodies:
  bar: {material: copper, shape: {cylinder: {radius: 4 mm, length: 20 mm}},
        velocity: [0 m/s, -150 m/s]}
effects:
  wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}
quantities:
  speed: {measure: velocity_y, every: 1 us,
          at: {body: bar, line: {from: [0 mm, 0 mm], to: [0 mm, 20 mm], points: 5}}}
  strain: {measure: plastic_strain, reduce: at end, at: {points: [[0 mm, 1 mm], [3 mm, 2 mm]]}}
  there: {measure: pressure, every: 1 us,
          at: {body: bar, points: [[0 mm, 1 mm], [0 mm, 16 mm]], follow: space}}
  many: {measure: stress_yy, every: 1 us,
         at: {line: {from: [0 mm, 0 mm], to: [4 mm, 20 mm], points: 100}}}
"""


def single(name, measure, place, more):
    return (f"  {name}: {{measure: {measure}, at: {{body: bar, point: [{place[0]} m, {place[1]} m]"
            f"{more}}}, every: 1 us}}\n")


def quantities(result):
    return result.summary["quantities"]


def check_alike(result):
    found = quantities(result)
    for i, y in enumerate(LINE):
        one, alone = found[f"speed.{i + 1}"], found[f"alone_{i + 1}"]
        scenes.report(one == alone, f"point {i + 1} of the line is a quantity of that point alone",
                      [one, alone])
        scenes.report(one["place"][0] >= 0 and abs(one["place"][1] - y) <= 0.5e-3
                      and one["distance"] < 0.75e-3,
                      f"it was at {one['place'][:2]} m, asked for y = {y} m")
    for i in (1, 2):
        scenes.report(found[f"there.{i}"] == found[f"there_alone_{i}"],
                      f"place {i} in space is one of that place alone")
    scenes.report(all(set(found[f"strain.{i}"]) >= {"value", "place", "point"} for i in (1, 2)),
                  "a reduction of each point of a list")
    scenes.report("many.001" in found and "many.100" in found and "many.1" not in found,
                  "names sort as the points do")


def check_files(result):
    with open(result.file("history.csv"), encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row[0] == "speed.3"]
    scenes.report([float(r[3]) for r in rows] == quantities(result)["speed.3"]["values"],
                  "history.csv has a curve for each point")
    with h5py.File(result.file("results.h5"), "r") as file:
        curve = file["quantities/speed.3"]
        scenes.report(list(curve.attrs["place"]) == quantities(result)["speed.3"]["place"]
                      and curve.attrs["family"] in ("speed", b"speed")
                      and list(curve["value"]) == quantities(result)["speed.3"]["values"],
                      "results.h5 too, with where the point was")


def check_same(path, result):
    other = scenes.run(path, threads=2)
    scenes.report(quantities(other) == quantities(result), "the same bits on two threads")
    changes = {"outputs": "{checkpoint: {every: 7 us}}"}
    process, folder = scenes.attempt(path, changes)
    if not scenes.report(process.returncode == 0, "with a checkpoint", [process.stderr]):
        return
    scenes.os.remove(scenes.os.path.join(folder, "summary.json"))
    process = scenes.subprocess.run(
        scenes.command(path, changes, ["-o", folder, "--resume", "--threads", "2"]), check=False,
        capture_output=True, text=True)
    with open(scenes.os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        resumed = json.load(file)["quantities"]
    scenes.report(process.returncode == 0 and resumed == quantities(result),
                  "the same bits after a restart", [process.stderr])


def check_gone():
    """A block flies out through an open plane, its points one row after the other."""
    path = scenes.os.path.join(scenes.TREE, "plugins/effect/outflow/outflow.scene.yaml")
    result = scenes.run(path, {"quantities": "{speed: {measure: velocity_y, every: 1 us, at: {body:"
                               " block, line: {from: [2 mm, 0.1 mm], to: [2 mm, 3.9 mm], points: 3}"
                               "}}}"})
    found = quantities(result)
    low, high = found["speed.1"], found["speed.3"]
    scenes.report(low["times"][-1] < 1.1e-6 and high["times"][-1] > 9.99e-6
                  and max(abs(v + 200) for v in low["values"] + high["values"]) < 1e-9,
                  "the curve of a point that leaves ends there, the others go on", [low, high])
    scenes.report("'speed.1' follows point" in result.said and "'speed.3' follows" not in
                  result.said, "and gamut says so", [result.said])


text = SCENE + "".join(single(f"alone_{i + 1}", "velocity_y", (0, y), "")
                       for i, y in enumerate(LINE))
text += single("there_alone_1", "pressure", (0, 1e-3), ", follow: space")
text += single("there_alone_2", "pressure", (0, 16e-3), ", follow: space")
file = scenes.written("tracers", text)
first = scenes.run(file)
check_alike(first)
check_files(first)
check_same(file, first)
check_gone()
process, _ = scenes.attempt(file, {"quantities.many.every": "1e-11 s"})
scenes.report(process.returncode == 3 and "there would be more than 1e+08 samples" in process.stderr
              and "(many)" in process.stderr, "too many samples in all are refused",
              [process.returncode, process.stderr])
scenes.done()
