"""Cases in one dimension for every shape, transfer and order: scenes, runs and figures."""
import itertools
import json
import math
import os
import shutil

import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy
import waves

SHAPES = {
    "linear": {"shape": "linear"},
    "gimp": {"shape": "gimp", "gimp": "{domain: contiguous}"},
    "gimp fixed": {"shape": "gimp", "gimp": "{domain: fixed}"},
    "quadratic": {"shape": "quadratic"},
    "cubic": {"shape": "cubic"},
}
TRANSFERS = {
    "flip": {"transfer": "{model: flip}"},
    "pic 0.01": {"transfer": "{model: flip, pic: 0.01}"},
    "pic": {"transfer": "{model: pic}"},
    "apic": {"transfer": "{model: apic}"},
    "xpic 2": {"transfer": "{model: xpic, order: 2}"},
    "xpic 3": {"transfer": "{model: xpic, order: 3}"},
    "xpic 5": {"transfer": "{model: xpic, order: 5}"},
}
ORDERS = ("usl", "musl", "usf")

ELASTIC = """    density: {density} kg/m3
    eos: {{model: linear, youngs_modulus: {modulus} Pa, poissons_ratio: 0}}
    elasticity: {{model: hypoelastic, youngs_modulus: {modulus} Pa, poissons_ratio: 0}}
"""
BAR = """gamut: 1
solver: {{model: material_point_method, geometry: 1d, cell: {cell} m, end: {end} s}}
materials:
  soft:
{material}
bodies:
  bar:
    material: soft
    shape: {{box: {{min: [{low} m], max: [{high} m]}}}}
    points_per_cell: {points}
    velocity: ["{velocity}"]
"""
ENDS = """effects:
  left: {{model: boundary, kind: symmetry, plane: {{point: [{low} m], normal: [1]}}}}
  right: {{model: boundary, kind: symmetry, plane: {{point: [{high} m], normal: [-1]}}}}
"""
ENERGIES = """quantities:
  kinetic: {{measure: kinetic_energy, body: bar}}
  internal: {{measure: internal_energy, body: bar}}
"""
QUIET = "outputs: {{frames: 1, fields: [velocity]}}\n"


def settings(shape=None, transfer=None, order=None, **more):
    """What --set needs for a named shape, transfer and order; more keys of the solver."""
    found = dict(SHAPES[shape]) if shape else {}
    found.update(TRANSFERS[transfer] if transfer else {})
    found.update({"stress_update": order} if order else {})
    found.update(more)
    return {"solver." + key: value for key, value in found.items()}


def combinations(shapes=SHAPES, transfers=TRANSFERS, orders=ORDERS):
    return itertools.product(shapes, transfers, orders)


def bar(name, tail, **values):
    """A scene of one elastic bar; unset values make a bar of 1 m at a sound speed of 1 m/s."""
    values = {"cell": 0.1, "end": 1, "density": 1, "modulus": 1, "low": 0, "high": 1, "points": 2,
              "velocity": 0, **values}
    material = ELASTIC.format(**values).rstrip("\n")
    return scenes.written(name, BAR.format(material=material, **values) + tail.format(**values))


def energies(result):
    kinetic, internal = result.history("kinetic")[1], result.history("internal")[1]
    return [k + i for k, i in zip(kinetic, internal)]


def shots(result, body, names):
    """Of each frame: time and the named fields, along x, by id."""
    found = []
    with h5py.File(result.file("results.h5"), "r") as file:
        for key in sorted(file["frames"]):
            group = file["frames"][key]
            by_id = numpy.argsort(group[body]["id"][...])
            fields = {n: group[body][n][...][by_id] for n in names}
            found.append((float(group.attrs["time"]),
                          {n: f[:, 0] if f.ndim > 1 else f for n, f in fields.items()}))
    return found


def cost(result):
    part = result.summary["cost"]
    return {"cpu": part["cpu_s"], "point_steps": part["points"] * part["steps"]}


STANDING = ENDS + ENERGIES + QUIET


def standing(cells, shape, transfer, order, courant=0.1, periods=10.0, samples=500):
    """Energy over that at the start, with time, `cells` a wavelength of 1 m, period of 1 s."""
    speed = 1e-4
    scene = bar("standing", STANDING, cell=1 / cells, high=0.5, end=periods,
                velocity=f"{speed} * sin(2 * pi * x)")
    every = f"{periods / samples} s"
    result = scenes.run(scene, {**settings(shape, transfer, order, courant=courant),
                                "quantities.kinetic.every": every,
                                "quantities.internal.every": every})
    kept = [e / (0.125 * speed ** 2) for e in energies(result)]
    scenes.drop(result)
    return kept


def drift(shape, transfer, order, courant=0.1, steps=100000, cells=32):
    """Energy of a standing wave over many steps: mean of the last tenth over that of the first (the
    points' velocity stands half a step before their stress, so that single samples swing)."""
    kept = standing(cells, shape, transfer, order, courant, steps * courant / cells, 5000)
    tenth = len(kept) // 10
    return sum(kept[-tenth:]) / sum(kept[:tenth]) - 1.0


MOTION = ENDS + """  force:
    model: body_force
    acceleration:
      x: >-
        {amplitude} * sin(2*pi*X) * sin(pi*t) * (-pi^2 + 4*pi^2 * (1/3 + 2/3
        * (1 + 2*pi*{amplitude}*cos(2*pi*X)*sin(pi*t)))
        / (1 + 2*pi*{amplitude}*cos(2*pi*X)*sin(pi*t))^2)
outputs: {{frames: 8, fields: [velocity, volume_ratio]}}
"""


def manufactured(cells, amplitude, shape, transfer="flip", order="auto", points=2, courant=0.2):
    """u = A sin(2 pi X) sin(pi t) for one period. Root mean square of the error over points and
    eight times over that of the displacement; processor time and point-steps."""
    scene = bar("manufactured", MOTION, cell=1 / cells, end=2, points=points, amplitude=amplitude,
                velocity=f"{amplitude} * pi * sin(2*pi*x)")
    result = scenes.run(scene, settings(shape, transfer, order, courant=courant))
    frames = shots(result, "bar", ["position"])
    start = frames[0][1]["position"]
    off = size = 0.0
    for time, fields in frames[1:]:
        exact = amplitude * numpy.sin(2 * math.pi * start) * math.sin(math.pi * time)
        off += ((fields["position"] - start - exact) ** 2).sum()
        size += (exact ** 2).sum()
    scenes.drop(result)
    return {"error": math.sqrt(off / size), **cost(result)}


def orders_of(errors):
    return [math.log2(a / b) for a, b in zip(errors, errors[1:])]


def vibrating(cells, shape, transfer="flip", order="auto"):
    """Frequency and amplitude over the exact ones, change of energy a period: inputs/."""
    result = scenes.run("vibrating_bar", {
        **settings(shape, transfer, order, cell=f"{25 / cells} m"),
        "quantities.internal": "{measure: internal_energy, body: bar}"})
    omega, amplitude = waves.fitted(*result.history("mean_velocity"))
    kinetic, internal = result.history("kinetic_energy")[1], result.history("internal")[1]
    scenes.drop(result)
    return {"omega": omega / waves.OMEGA - 1.0, "amplitude": amplitude / waves.AMPLITUDE - 1.0,
            "energy": ((kinetic[-1] + internal[-1]) / (kinetic[0] + internal[0]) - 1.0) / 2.0}


def uniaxial(stretch):
    """Cauchy stress of the law at uniaxial strain over Young's modulus, Poisson's ratio 0."""
    return ((1 - 1 / stretch) + 2 * numpy.log(stretch)) / 3


def column_places(start):
    """Where points of a column of 50 m come to rest that carries what stands above them."""
    grid = numpy.linspace(0, 50, 2001)
    low, high = numpy.full(2001, 0.1), numpy.ones(2001)
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = uniaxial(middle) < -0.01 * (50 - grid)
        low, high = numpy.where(below, middle, low), numpy.where(below, high, middle)
    place = numpy.concatenate([[0], numpy.cumsum(0.5 * (low[1:] + low[:-1]) * numpy.diff(grid))])
    return numpy.interp(start, grid, place)


def column(cells, shape, transfer="pic 0.001", order="auto", points=2):
    """Root mean square of the error of displacement over that of displacement, and of stress over
    that at the foot, means over three swings: inputs/self_weight.yaml, let down more smoothly."""
    changes = settings(shape, None if transfer == "pic 0.001" else transfer, order,
                       cell=f"{50 / cells} m")
    result = scenes.run("self_weight", {
        **changes, "bodies.column.points_per_cell": points,
        "effects.weight.acceleration.x": "-10*(min(t,60)/60 - sin(2*pi*min(t,60)/60)/(2*pi))",
        "outputs": "{every: 0.5 s, fields: [stress]}"})
    frames = shots(result, "column", ["position", "stress"])
    start = frames[0][1]["position"]
    last = [f for time, f in frames if time > 60.9]
    place, stress = (numpy.mean([f[n] for f in last], axis=0) for n in ("position", "stress"))
    exact = column_places(start)
    off = math.sqrt(((place - exact) ** 2).sum() / ((exact - start) ** 2).sum())
    stress = math.sqrt(((stress + 1e4 * (50 - start)) ** 2).mean()) / 5e5
    scenes.drop(result)
    return {"place": off, "stress": stress}


PULL = """effects:
  foot: {{model: boundary, kind: fixed, plane: {{point: [0 m], normal: [1]}}}}
  pull:
    model: body_force
    acceleration:
      x: "X > 0.5 ? 8*(X - 0.5) * ((1 - 1/(1 + 0.01*t)) + 2*log(1 + 0.01*t)) / 3 : 0"
quantities:
  force: {{measure: force, effect: foot, axis: x, every: 1 s}}
  fragments: {{measure: fragments, body: bar, every: 1 s}}
outputs: {{frames: 1, fields: [velocity]}}
"""


def tension(points, shape, transfer="flip", order="auto", stretch=3.0):
    """A bar of 40 cells pulled slowly by a load on its outer half; the inner half is stretched
    evenly. Up to which stretch, what ends it, and the largest error of force from 1.1 to 2 before
    the last twentieth of that."""
    scene = bar("tension", PULL, cell=0.025, end=100 * (stretch - 1), points=points,
                velocity="0.01 * x")
    process, folder = scenes.attempt(
        scene, settings(shape, transfer, order, domain="{min: [-1 m], max: [5 m]}"))
    with open(f"{folder}/summary.json", encoding="utf-8") as text:
        summary = json.load(text)
    shutil.rmtree(folder, ignore_errors=True)
    force, fragments = (summary["quantities"][name] for name in ("force", "fragments"))
    apart = [t for t, n in zip(fragments["times"], fragments["values"]) if n > 1]
    last = 1 + 0.01 * (apart[0] if apart else summary["time"])
    reached = 1 + 0.01 * numpy.asarray(force["times"])
    off = numpy.abs(numpy.abs(force["values"]) / uniaxial(numpy.maximum(reached, 1.001)) - 1)
    sound = (reached > 1.1) & (reached <= min(2.0, 1 + 0.95 * (last - 1)))
    end = "parts" if apart else "stops" if process.returncode else "holds"
    return {"stretch": last, "end": end,
            "force": float(off[sound].max(initial=0.0)) if sound.any() else None}


FREE = ENERGIES + "outputs: {{frames: 1, fields: [velocity, mass]}}\n"


def free(shape, transfer, order, cells=16):
    """A vibrating bar that flies through 24 cells: change of momentum over it, residual of the
    ledger, change of the energy of the vibration over it."""
    end = 24 / cells / 0.3
    scene = bar("free", FREE, cell=1 / cells, end=end, velocity="0.3 + 0.05 * sin(2*pi*x)")
    result = scenes.run(scene, settings(shape, transfer, order))
    first, last = (f for _, f in shots(result, "bar", ["velocity", "mass"]))
    before, after = ((f["mass"] * f["velocity"]).sum() for f in (first, last))
    energy = energies(result)
    found = {"momentum": after / before - 1, "residual": result.residual(),
             "energy": (energy[-1] - energy[0]) / (energy[0] - 0.5 * before ** 2)}
    scenes.drop(result)
    return found


NULL = "1e-4 * cos(2 * pi * 16 * x - pi / 2)"
WHITE = "1e-4 * sin(12345.678 * x + 98765.43 * x^2)"


def noise(shape, transfer, order, velocity, steps=10000, cells=16):
    """Part of the energy of noise of the points' velocity that is left after so many steps. NULL is
    +-1 on the two points of each cell, a mode that no node sees."""
    end = steps * 0.5 / cells
    scene = bar("noise", STANDING, cell=1 / cells, end=end, velocity=velocity)
    result = scenes.run(scene, {**settings(shape, transfer, order), **{
        f"quantities.{name}.every": f"{end / 50} s" for name in ("kinetic", "internal")}})
    energy = energies(result)
    scenes.drop(result)
    return {"kept": energy[-1] / energy[0], "most": max(energy) / energy[0]}


def outcome(scene, changes):
    """Exit code of a run that may fail, and the energy at its end over that at the start; whether
    any number in its summary is not finite."""
    process, folder = scenes.attempt(scene, changes)
    found = {"exit": process.returncode, "kept": None, "finite": True, "said": process.stderr}
    path = f"{folder}/summary.json"
    if os.path.exists(path):
        with open(path, encoding="utf-8") as text:
            summary = json.load(text)
        energy = energies(scenes.Result(folder, summary))
        found["finite"] = all(e is not None and math.isfinite(e) for e in energy)
        found["kept"] = energy[-1] / energy[0] if found["finite"] else None
    shutil.rmtree(folder, ignore_errors=True)
    return found


def ladder(shape, order, courant, cells=32, steps=2000):
    """A standing wave with a step of `courant` times the cell over the speed of sound."""
    scene = bar("ladder", STANDING, cell=1 / cells, high=0.5, end=steps * courant / cells,
                velocity="1e-4 * sin(2 * pi * x)")
    return outcome(scene, {**settings(shape, "flip", order), "solver.step": f"{courant / cells} s"})


def flight(shape, transfer, order, cells=1000):
    """A bar without stress flies through many cells at the speed of sound: the largest stress over
    Young's modulus."""
    scene = bar("flight", "outputs: {{frames: 10, fields: [stress]}}\n", cell=0.125,
                end=0.125 * cells, velocity=1)
    result = scenes.run(scene, settings(shape, transfer, order))
    worst = max(float(numpy.abs(f["stress"]).max()) for _, f in shots(result, "bar", ["stress"]))
    scenes.drop(result)
    return worst


# Places the grid: nodes at whole numbers of cells.
FAR = """effects:
  far: {{model: boundary, kind: symmetry, plane: {{point: [-100 m], normal: [1]}}}}
"""


def on_nodes(shape, transfer, order):
    """One point a cell, each on a node, rigid motion, one step of a tenth of a cell: the rate of
    strain over speed by cell."""
    scene = bar("on_nodes", FAR + "outputs: {{frames: 1, fields: [volume_ratio]}}\n", cell=0.125,
                low=0.0625, high=1.0625, points=1, end=0.0125, velocity=1)
    result = scenes.run(scene, settings(shape, transfer, order, step="0.0125 s"))
    last = shots(result, "bar", ["volume_ratio"])[-1][1]["volume_ratio"]
    scenes.drop(result)
    return float(numpy.abs(last - 1).max()) / 0.1


def near_face(power, shape, transfer="flip", order="auto", steps=20):
    """A bar that is being stretched, its last point 10^-power of a cell beyond a node (none: a
    quarter): the largest acceleration of a point in any step, and the change of momentum over that
    of one half of the bar."""
    cell, step = 0.125, 0.025
    beyond = 0.25 if power is None else 10.0 ** -power
    low = (beyond - 0.75) * cell
    tail = FAR + f"outputs: {{{{frames: {steps}, fields: [velocity, mass]}}}}\n"
    scene = bar("near_face", tail,
                cell=cell, low=low, high=low + 1, end=steps * step,
                velocity=f"0.01 * (x - {low + 0.5})")
    result = scenes.run(scene, settings(shape, transfer, order, step=f"{step} s"))
    frames = shots(result, "bar", ["velocity", "mass"])
    scenes.drop(result)
    speeds = [f["velocity"] for _, f in frames]
    mass = frames[0][1]["mass"]
    return {"acceleration": max(float(numpy.abs(b - a).max()) / step
                                for a, b in zip(speeds, speeds[1:])),
            "momentum": abs(float((mass * (speeds[-1] - speeds[0])).sum()))
            / float((mass * numpy.abs(speeds[0])).sum())}
