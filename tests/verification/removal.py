"""Points that leave a run: outflow, erosion, and the edge of the domain. Prints TAP."""
import re

import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy

METAL = """
materials:
  metal:
    density: 8000 kg/m3
    eos: {model: linear, bulk_modulus: 140 GPa}
    strength: {model: von_mises, yield_stress: 90 MPa, hardening_modulus: 300 MPa}
    elasticity: {model: hypoelastic, shear_modulus: 48 GPa}
"""
SPEED = 250.0
# geometry: shape, velocity, plane, area, distance of points
BARS = {
    "1d": ("{box: {min: [0 mm], max: [8 mm]}}", "[-250 m/s]", "{point: [0 mm], normal: [1]}",
           1.0, 0.25e-3),
    "axisymmetric": ("{cylinder: {radius: 2 mm, length: 8 mm}}", "[0 m/s, -250 m/s]",
                     "{point: [0 mm, 0 mm], normal: [0, 2]}", 4e-6 * numpy.pi, 0.25e-3),
    "3d": ("{box: {min: [0 mm, 0 mm, 0 mm], max: [2 mm, 8 mm, 2 mm]}}", "[0 m/s, -250 m/s, 0 m/s]",
           "{point: [0 mm, 0 mm, 0 mm], normal: [0, 1, 0]}", 4e-6, 0.25e-3)}


def bar(geometry, more=""):
    """A bar that flies through a plane; after 40 us it is all gone."""
    shape, velocity, plane, _, _ = BARS[geometry]
    return scenes.written("bar_" + geometry, f"""gamut: 1
solver: {{model: material_point_method, geometry: {geometry}, cell: 0.5 mm, end: 24 us}}
{METAL}
bodies:
  bar: {{material: metal, shape: {shape}, velocity: {velocity}}}
effects:
  exit: {{model: outflow, plane: {plane}}}
quantities:
  mass: {{measure: left_mass, effect: exit, every: 0.1 us}}
  points: {{measure: left_points, effect: exit}}
  stays: {{measure: body_mass, body: bar}}
{more}
outputs: {{every: 4 us, fields: [velocity]}}
""")


def points_of(result, body, frame=-1):
    """The ids of a frame."""
    with h5py.File(result.file("results.h5"), "r") as file:
        name = sorted(file["frames"])[frame]
        return set(file["frames"][name][body]["id"][:].tolist())


def line(result, account, name):
    return result.summary["ledger"][account]["lines"][name]["value"]


def outflow():
    for geometry, (_, _, _, area, distance) in BARS.items():
        result = scenes.run(bar(geometry), {"solver.end": "24 us"}, threads=2)
        times, masses = (numpy.array(x) for x in result.history("mass"))
        off = numpy.abs(masses - 8000.0 * area * SPEED * times).max() / (8000.0 * area * distance)
        scenes.below(f"{geometry}: mass that left against rho a v t, in layers of points", off, 1.0)
        scenes.below(f"{geometry}: residual of the ledger", result.residual(), 1e-10)
        left, first = result.history("points")[1][-1], points_of(result, "bar", 0)
        last = points_of(result, "bar")
        scenes.report(len(first) - len(last) == left > 0 and last < first,
                      f"{geometry}: {left:.0f} of {len(first)} points are no longer in the frames")
        gone = line(result, "mass", "outflow exit")
        scenes.below(f"{geometry}: the ledger's line against the measure", gone / masses[-1] - 1,
                     1e-14)
        scenes.report("note: outflow exit took" in result.said and "warning" not in result.said,
                      f"{geometry}: said in one note", [result.said])


def frames(result):
    found = {}

    def keep(name, node):
        if isinstance(node, h5py.Dataset):
            found[name] = numpy.asarray(node[...]).tobytes()

    with h5py.File(result.file("results.h5"), "r") as file:
        file["frames"].visititems(keep)
    with open(result.file("history.csv"), "rb") as file:
        found["history.csv"] = file.read()
    return found


def same_bits():
    eroding = {"effects.foot": "{model: erosion, plastic_strain: 0.5, flagged: true, lost: true}",
               "effects.foot.most": "0.5", "solver.end": "12 us", "solver.cell": "0.635 mm"}
    for name, scene, changes in (("outflow in 3d", bar("3d"), {"solver.end": "10 us"}),
                                 ("an eroding bar", "taylor_bar", eroding),
                                 ("an eroding bar, usf", "taylor_bar",
                                  {**eroding, "solver.stress_update": "usf",
                                   "solver.shape": "linear"})):
        first = frames(scenes.run(scene, changes))
        for threads, block in ((2, None), (3, 8), (2, 1024)):
            size = {} if block is None else {"solver.block": str(block)}
            again = frames(scenes.run(scene, {**changes, **size}, threads=threads))
            differ = sorted(k for k in set(first) | set(again) if first.get(k) != again.get(k))
            scenes.report(not differ, f"{name}: same bits with {threads} threads, blocks of "
                                      f"{block or 'the usual'} points", differ[:5])


def spinning():
    """With apic points spin in themselves: that leaves as well, and is no loss of the method."""
    scene = scenes.written("spinning", f"""gamut: 1
solver: {{model: material_point_method, geometry: plane_strain, cell: 0.25 mm, end: 20 us,
         transfer: {{model: apic}}}}
{METAL}
bodies:
  block: {{material: metal, shape: {{box: {{min: [0 mm, 0 mm], max: [2 mm, 2 mm]}}}},
           velocity: ["-5e3 * (y - 0.001)", "5e3 * (x - 0.001) - 50"]}}
effects:
  exit: {{model: outflow, plane: {{point: [0 mm, 0 mm], normal: [0, 1]}}}}
""")
    for shape in ("gimp", "quadratic", "cubic"):
        result = scenes.run(scene, {"solver.shape": shape})
        lines = result.summary["ledger"]["angular_momentum_z"]["lines"]
        gone, loss = lines["outflow exit"]["value"], lines["gather loss"]["value"]
        scenes.report(abs(loss) < 1e-11 * abs(gone), f"{shape}, apic: of {gone:.4g} kg m2/s that "
                                                     f"left, {abs(loss / gone):.1e} is lost")
        scenes.below("  residual of the ledger", result.residual(), 1e-10)


def nothing_left():
    result = scenes.run(bar("3d", """
  extent: {measure: extent, body: bar, axis: y}
  foot: {measure: diameter, body: bar, of: current}
  speed: {measure: maximum, body: bar, field: velocity_y}
  point: {measure: velocity_y, at: {body: bar, point: [1 mm, 1 mm, 1 mm]}, every: 0.1 us}
  last: {measure: velocity_y, at: {body: bar, point: [1 mm, 1 mm, 1 mm]}, reduce: at end}
"""), {"solver.end": "50 us"}, threads=2)
    value = {name: result.history(name)[1][-1] for name in ("stays", "extent", "foot", "speed")}
    scenes.report(value == {"stays": 0.0, "extent": 0.0, "foot": 0.0, "speed": None}
                  and not points_of(result, "bar"),
                  "a body that has lost all its points weighs nothing, has no extent, and no "
                  "largest speed", [value])
    scenes.below("  residual of the ledger", result.residual(), 1e-10)
    times, values = result.history("point")
    scenes.report(3e-6 < times[-1] < 5e-6 and None not in values and
                  result.said.count("'point' follows point") == 1,
                  f"the history of a point ends when it leaves, at {times[-1]:.3g} s, with one "
                  "warning", [result.said])
    scenes.within("its value at the end is the last one", result.value("last"), -SPEED, 1e-9)


def erosion():
    changes = {"effects.foot": "{model: erosion, plastic_strain: 0.8, most: 0.2}",
               "solver.cell": "0.4 mm", "solver.end": "30 us",
               "quantities.mass": "{measure: eroded_mass, effect: foot}",
               "quantities.energy": "{measure: eroded_energy, effect: foot}",
               "quantities.points": "{measure: eroded_points, effect: foot}",
               "outputs.fields": "[plastic_strain]"}
    result = scenes.run("taylor_bar", changes, threads=2)
    gone = {name: result.history(name)[1][-1] for name in ("mass", "energy", "points")}
    scenes.below("an eroding bar: residual of the ledger", result.residual(), 1e-10)
    scenes.below("  mass of the measure and of the ledger",
                 gone["mass"] / line(result, "mass", "erosion foot") - 1, 1e-14)
    scenes.below("  energy of the measure and of the ledger",
                 gone["energy"] / line(result, "energy", "erosion foot") - 1, 1e-14)
    left = len(points_of(result, "bar", 0)) - len(points_of(result, "bar"))
    with h5py.File(result.file("results.h5"), "r") as file:
        strain = file["frames"][sorted(file["frames"])[-1]]["bar/plastic_strain"][:].max()
    scenes.report(left == gone["points"] > 0 and strain < 0.8,
                  f"  {left} points are gone, no other is strained by 0.8 (but {strain:.4g})")
    scenes.report(result.said.count("warning: erosion foot took") == 1, "  said in one warning",
                  [result.said])
    hot = {**changes, "effects.foot": "{model: erosion, temperature: 400 K, most: 0.5}"}
    result = scenes.run("taylor_bar", {**hot, "outputs.fields": "[temperature]"})
    with h5py.File(result.file("results.h5"), "r") as file:
        heat = file["frames"][sorted(file["frames"])[-1]]["bar/temperature"][:].max()
    scenes.report(result.history("points")[1][-1] > 0 and heat < 400.0,
                  f"by temperature: no point is hotter than {heat:.4g} K")
    process, _ = scenes.attempt("taylor_bar", {**changes, "effects.foot.most": "0.002"})
    scenes.report(process.returncode == 5 and "% of the mass of body 'bar'" in process.stderr and
                  "limit `most` is 0.2 %" in process.stderr and "at t = " in process.stderr,
                  f"more than `most`: exit {process.returncode} and how much", [process.stderr])


def flagged():
    fast = {"bodies.flyer.velocity": "[30 km/s]", "solver.cell": "0.1 mm", "solver.end": "1 us",
            "quantities": "{}"}
    process, _ = scenes.attempt("plate_impact", fast)
    said = process.stderr
    scenes.report(process.returncode == 5 and "eos/mie_gruneisen: C0 3940 m/s, S1 1.489" in said and
                  "density 8960 kg/m3" in said and " ;" not in said,
                  "a stop names the parameters of the point's material", [said])
    policy = {**fast, "effects.pole": "{model: erosion, flagged: true, most: 0.9}",
              "quantities.points": "{measure: eroded_points, effect: pole}"}
    result = scenes.run("plate_impact", policy)
    count = sum(f["count"] for f in result.summary["flags"] if f["message"] == "beyond_pole")
    scenes.report(result.history("points")[1][-1] == count > 0,
                  f"flagged points go instead: {count} points, as many as the flags")
    scenes.below("  residual of the ledger", result.residual(), 1e-10)


def lost():
    # The force is no number beyond x = 1 mm, where a block gets to.
    scene = scenes.written("no_number", f"""gamut: 1
solver: {{model: material_point_method, geometry: plane_strain, cell: 0.25 mm, end: 4 us}}
{METAL}
bodies:
  block: {{material: metal, shape: {{box: {{min: [0 mm, 0 mm], max: [2 mm, 2 mm]}}}},
           velocity: [100 m/s, 0 m/s]}}
effects:
  push: {{model: body_force, acceleration: {{y: "0 * sqrt(0.0022 - x)"}}}}
quantities:
  mass: {{measure: body_mass, body: block}}
""")
    process, _ = scenes.attempt(scene)
    scenes.report(process.returncode == 5, f"a force that is no number: exit {process.returncode}",
                  [process.stderr])
    for order in ("usl", "musl", "usf"):
        result = scenes.run(scene, {"effects.cut": "{model: erosion, lost: true, most: 0.5}",
                                    "quantities.cut": "{measure: eroded_points, effect: cut}",
                                    "solver.stress_update": order})
        count = result.history("cut")[1][-1]
        scenes.report(count == 32.0, f"{order}: lost points go, the {count:.0f} that get there")
        scenes.below("  residual of the ledger", result.residual(), 1e-10)


def domain():
    shot = {"solver.cell": "0.635 mm", "solver.end": "30 us",
            "solver.domain": "{min: [-1 mm, -1 mm], max: [4 mm, 30 mm], outside: remove}"}
    result = scenes.run("taylor_bar", shot, threads=2)
    gone = line(result, "mass", "left the domain")
    scenes.report(gone > 0 and result.said.count("points leave solver.domain") == 1,
                  f"outside: remove takes {gone:.3g} kg, said once", [result.said])
    scenes.below("  residual of the ledger", result.residual(), 1e-10)
    process, _ = scenes.attempt("taylor_bar_3d", {
        "solver.domain": "{min: [-4 mm, 0 mm, -4 mm], max: [4 mm, 30 mm, 4 mm]}"}, threads=2)
    errors = process.stderr.count("error:")
    more = re.search(r"\(and (\d+) more in this step\)", process.stderr)
    scenes.report(process.returncode == 5 and errors == 1 and more,
                  f"outside: stop names one point ({errors} error) and says "
                  f"{more.group(0) if more else 'nothing of the others'}", [process.stderr])


def refused():
    for name, changes, words in (
            ("no criterion", {"effects.cut": "{model: erosion}"},
             "the scene does not say which points go"),
            ("a range without 1", {"effects.cut": "{model: erosion, volume_ratio: [1.1, 2]}"},
             "points at their reference volume would go"),
            ("no direction", {"effects.exit.plane.normal": "[0]"}, "the normal has no length")):
        process, _ = scenes.attempt(bar("1d"), changes)
        scenes.report(process.returncode == 3 and words in process.stderr,
                      f"{name}: exit {process.returncode}", [process.stderr])


outflow()
same_bits()
spinning()
nothing_left()
erosion()
flagged()
lost()
domain()
refused()
scenes.done()
