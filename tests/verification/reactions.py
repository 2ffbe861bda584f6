"""What planes and walls report: momentum given to the material against their impulse, the energy of
the material against their work, force against impulse, contact area. Prints TAP."""
import math
import os

import scenes  # before numpy: it skips the test where it is missing
import numpy

scenes.needs.modules("yaml")
import yaml  # noqa: E402

METAL = {"density": "8000 kg/m3", "eos": {"model": "linear", "bulk_modulus": "140 GPa"},
         "strength": {"model": "von_mises", "yield_stress": "90 MPa",
                      "hardening_modulus": "300 MPa"},
         "elasticity": {"model": "hypoelastic", "shear_modulus": "48 GPa"}}
AXES = {"1d": 1, "plane_strain": 2, "axisymmetric": 2, "3d": 3}
SIZE = 2e-3
CLOSE = 1e-12


def metres(numbers):
    return [f"{n} m" for n in numbers]


def plane(axes, along, place, sign):
    point, normal = [0.0] * axes, [0.0] * axes
    point[along], normal[along] = place, float(sign)
    return {"point": metres(point), "normal": normal}


def shape(geometry, axes):
    if geometry == "axisymmetric":
        return {"cylinder": {"radius": f"{SIZE} m", "length": f"{SIZE} m"}}
    return {"box": {"min": metres([0.0] * axes), "max": metres([SIZE] * axes)}}


def speeds(axes, along, value):
    numbers = [0.0] * axes
    numbers[along] = value
    return [f"{n} m/s" for n in numbers]


def quantities(effects, axes):
    """Histories of all that the effects report, and of the body."""
    found = {"kinetic": {"measure": "kinetic_energy"}, "internal": {"measure": "internal_energy"}}
    for k in "xyz"[:axes]:
        found[f"momentum_{k}"] = {"measure": "momentum", "axis": k}
    for name in effects:
        for measure in ("normal_force", "work", "contact_area"):
            found[f"{name}_{measure}"] = {"measure": measure, "effect": name}
        for measure in ("force", "impulse"):
            for k in "xyz"[:axes]:
                found[f"{name}_{measure}_{k}"] = {"measure": measure, "effect": name, "axis": k}
    return {name: {**q, "every": "1 ns"} for name, q in found.items()}


def scene(geometry, effects, velocity, solver):
    axes = AXES[geometry]
    return {"gamut": 1, "solver": {"model": "material_point_method", "geometry": geometry,
                                   "cell": "0.25 mm", "end": "1.2 us", **solver},
            "materials": {"metal": METAL},
            "bodies": {"block": {"material": "metal", "shape": shape(geometry, axes),
                                 "velocity": velocity}},
            "effects": effects, "quantities": quantities(effects, axes)}


def run(name, described):
    file = os.path.join(scenes.SCRATCH, name.replace(" ", "_").replace(",", "") + ".yaml")
    with open(file, "w", encoding="utf-8") as out:
        yaml.safe_dump(described, out)
    return scenes.run(file)


def series(result, name):
    return numpy.array(result.history(name)[1])


def check_momentum(name, result, effects, axes, scale):
    """Momentum lost by the block is the impulse on the planes, at every sample."""
    for k in axes:
        change = series(result, f"momentum_{k}")
        change = change - change[0]
        given = -sum(series(result, f"{effect}_impulse_{k}") for effect in effects)
        scenes.below(f"{name}: momentum along {k} against impulse, at {len(change)} samples",
                     abs(change - given).max() / scale, CLOSE)


def check_force(name, result, effect, along, sign, scale):
    """Force is the rate of impulse, the normal force its part against the normal. The first step,
    which is very short, stops the first layer of points: it is left out. Samples lie half a step
    beside the middle of what they are a mean of."""
    times = numpy.array(result.history(f"{effect}_impulse_{along}")[0])
    force, impulse = (series(result, f"{effect}_{what}_{along}") for what in ("force", "impulse"))
    normal = series(result, f"{effect}_normal_force")
    scenes.below(f"{name}: normal force of {effect} against its component",
                 abs(normal + sign * force).max() / max(abs(force).max(), 1.0), CLOSE)
    summed = (0.5 * (force[1:] + force[:-1]) * numpy.diff(times))[times[:-1] > 0.1e-6].sum()
    start = impulse[times > 0.1e-6][0]
    scenes.below(f"{name}: force of {effect} summed over time against impulse",
                 abs(summed - (impulse[-1] - start)) / scale, 0.03)


def check_work(name, result, effects):
    """What planes report against the ledger, and what the material has of it there."""
    lines = result.summary["ledger"]["energy"]["lines"]
    work = sum(series(result, f"{effect}_work")[-1] for effect in effects)
    scenes.below(f"{name}: work of the planes against the ledger's",
                 work / lines["planes"]["value"] - 1, CLOSE)
    part = {role: sum(line["value"] - line["start"] for line in lines.values()
                      if line["role"] == role) for role in ("stored", "lost")}
    scenes.below(f"{name}: work less losses against the material's energy",
                 (work - part["lost"] - part["stored"]) / work, CLOSE)


def area_of(geometry):
    return {"1d": 1.0, "plane_strain": SIZE, "axisymmetric": math.pi * SIZE ** 2,
            "3d": SIZE ** 2}[geometry]


def check(geometry, solver):
    """A block at rest on a wall that rubs, pressed by a moving plane."""
    name = ", ".join([geometry, *solver.values()])
    count = AXES[geometry]
    along = 0 if geometry == "1d" else 1
    axis = "xyz"[along]
    effects = {"foot": {"model": "rigid_wall", "plane": plane(count, along, 0.0, 1),
                        "friction": 0.3},
               "press": {"model": "boundary", "kind": "velocity",
                         "plane": plane(count, along, SIZE, -1),
                         "velocity": speeds(count, along, -20.0)}}
    if geometry == "3d":
        effects["side"] = {"model": "boundary", "kind": "symmetry", "plane": plane(3, 0, 0.0, 1)}
    result = run(name, scene(geometry, effects, speeds(count, along, 0.0), solver))
    scale = abs(series(result, f"press_impulse_{axis}")).max()
    # Around an axis there is no momentum along the radius.
    check_momentum(name, result, effects, "y" if geometry == "axisymmetric" else "xyz"[:count],
                   scale)
    check_force(name, result, "foot", axis, 1, scale)
    check_force(name, result, "press", axis, -1, scale)
    check_work(name, result, effects)
    area = dict(zip(*result.history("foot_contact_area")))
    scenes.within(f"{name}: contact area of the wall",
                  area[min(area, key=lambda t: abs(t - 0.6e-6))], area_of(geometry), 0.03)


def check_oblique():
    """A block that flies into a corner of two oblique walls, one of which moves."""
    effects = {"left": {"model": "rigid_wall", "friction": 0.2,
                        "plane": {"point": metres([-0.1e-3, 0.0]), "normal": [1.0, 1.0]}},
               "right": {"model": "rigid_wall", "velocity": ["-10 m/s", "0 m/s"],
                         "plane": {"point": metres([SIZE + 0.1e-3, 0.0]), "normal": [-1.0, 2.0]}}}
    result = run("oblique", scene("plane_strain", effects, ["5 m/s", "-100 m/s"],
                                  {"end": "3 us", "shape": "quadratic"}))
    scale = max(abs(series(result, f"{wall}_impulse_y")).max() for wall in effects)
    scenes.report(scale > 0, f"oblique walls are hit: {scale:.3g} N s")
    check_momentum("oblique walls", result, effects, "xy", scale)
    check_work("oblique walls", result, effects)
    for wall, normal in (("left", (1, 1)), ("right", (-1, 2))):
        length = math.hypot(*normal)
        force = sum(series(result, f"{wall}_force_{k}") * n / length
                    for k, n in zip("xy", normal))
        told = series(result, f"{wall}_normal_force")
        scenes.below(f"oblique walls: normal force of {wall} against its components",
                     abs(told + force).max() / abs(told).max(), CLOSE)


check_oblique()
for kind in AXES:
    for functions in ("linear", "gimp", "quadratic", "cubic"):
        check(kind, {"shape": functions})
scenes.done()
