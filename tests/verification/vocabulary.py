"""Fields that are there for everybody: first_position, temperature, cell_size,
deformation_gradient."""
import json
import math
import subprocess

import made
import scenes
from laws import drive, linear_eos, material, von_mises

EXTRA = ["--plugin-path", made.of_tree("effect/witness")]
CARD = material(linear_eos(140e9), von_mises(300e6), 48e9)


def attempt(name, scene, extra=()):
    return scenes.attempt(scenes.written(name, json.dumps(scene)), extra=[*EXTRA, *extra])[0]


def point(body, x, measure):
    return {"measure": measure, "reduce": "at end",
            "at": {"body": body, "point": [f"{x} mm"], "follow": "material"}}


# ---- on a grid ----------------------------------------------------------------------------------

def two_bodies():
    """One is heated by its plastic work; an effect looks at the temperature of both. One step moves
    them by a fifth of a cell."""
    bodies = {name: {"material": "metal", "shape": {"box": {"min": [f"{x} mm"],
                                                            "max": [f"{x + 2} mm"]}},
                     "velocity": ["1000 m/s"], "temperature": f"{kelvin} K"}
              for name, x, kelvin in (("hot", 0, 350), ("cold", 20, 411))}
    names = ("seen_place_x", "first_position_x", "position_x", "seen_temperature", "temperature")
    return {"gamut": 1,
            "solver": {"model": "material_point_method", "geometry": "1d", "cell": "0.5 mm",
                       "end": "2 us", "step": "0.1 us", "courant": 1.5},
            "materials": {"metal": {**CARD, "specific_heat": "477 J/(kg K)"}}, "bodies": bodies,
            "effects": {"look": {"model": "witness"},
                        "heat": {"model": "adiabatic_heating", "bodies": ["hot"]}},
            "quantities": {f"{body}_{name}": point(body, x, name) for name in names
                           for body, x in (("hot", 0.625), ("cold", 20.625))}}


def on_a_grid():
    scene = two_bodies()
    name = scenes.written("two_bodies", json.dumps(scene))
    run = scenes.run(name, extra=EXTRA)
    for body, x in (("hot", 0.625e-3), ("cold", 20.625e-3)):
        scenes.report(run.value(f"{body}_first_position_x") == x
                      and run.value(f"{body}_seen_place_x") == x,
                      f"{body}: first_position is where the point was before the first step: "
                      f"{run.value(body + '_first_position_x'):.17g} m")
        scenes.report(run.value(f"{body}_position_x") > x + 1.9e-3, f"{body}: it has moved since")
    seen = {body: run.value(f"{body}_seen_temperature") for body in ("hot", "cold")}
    scenes.report(seen == {"hot": 350.0, "cold": 411.0},
                  f"each body's temperature is seen, heated or not: {seen} K")
    scenes.drop(run)
    del scene["effects"]["heat"]
    run = scenes.run(scenes.written("unheated", json.dumps(scene)), extra=EXTRA)
    seen = {body: run.value(f"{body}_seen_temperature") for body in ("hot", "cold")}
    scenes.report(seen == {"hot": 350.0, "cold": 411.0},
                  f"nobody writes the temperature: an optional input is the body's: {seen} K")
    scenes.drop(run)


# ---- at one point -------------------------------------------------------------------------------

def at_a_point():
    control, look = {"xx": {"log_strain": 0.01}}, {"look": {"model": "witness"}}
    scene = {"gamut": 1, "solver": {"model": "material_driver", "end": "1 ms", "steps": 10,
                                    "control": control},
             "materials": {"metal": CARD}, "bodies": {"sample": {"material": "metal"}},
             "effects": look,
             "quantities": {"opening": {"measure": "opening", "body": "sample",
                                        "reduce": "at end"}}}
    done = attempt("no_cell", scene)
    scenes.report(done.returncode == 3 and "effect/witness needs 'cell_size'" in done.stderr
                  and "`cell:` of the solver" in done.stderr,
                  "an effect that needs a cell is refused by name where there is none",
                  [done.stderr])
    run = drive(CARD, control, 1e-3, 10, final=("opening", "volume_ratio", "seen_temperature"),
                effects=look, temperature=333.0,
                extra=[*EXTRA, "--set", "solver.cell=2 mm"])
    scenes.report(run["opening"] == (run["volume_ratio"] - 1.0) * 2e-3,
                  f"with a cell it has it: opening {run['opening']:.6g} m")
    scenes.report(run["seen_temperature"] == 333.0, "the point has its body's temperature")
    scene["quantities"] = {"place": {"measure": "seen_place_x", "body": "sample",
                                     "reduce": "at end"}}
    done = attempt("no_place", scene)
    scenes.report(done.returncode == 3 and "'first_position'" in done.stderr
                  and "nothing in this scene provides" in done.stderr,
                  "a solver without places has no first ones, and says so", [done.stderr])


# ---- the deformation gradient -------------------------------------------------------------------

FULL = [a + b for a in "xyz" for b in "xyz"]
F = [f"deformation_gradient_{c}" for c in FULL]


def determinant(f):
    return (f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6])
            + f[2] * (f[3] * f[7] - f[4] * f[6]))


def driven(title, control, due, steps=50):
    run = drive(CARD, control, 1e-3, steps, final=[*F, "volume_ratio"])
    off = max(abs(run[name] - wanted) for name, wanted in zip(F, due))
    scenes.below(f"{title}: F against its closed form", off, 1e-13)
    scenes.below(f"{title}: det F over the volume ratio - 1",
                 abs(determinant([run[name] for name in F]) / run["volume_ratio"] - 1.0), 1e-13)


def led():
    driven("stretch", {"xx": {"log_strain": 0.3}, "yy": {"log_strain": -0.1}},
           [math.exp(0.3), 0, 0, 0, math.exp(-0.1), 0, 0, 0, 1])
    driven("simple shear", {"xy": {"velocity_gradient": "300 1/s"}}, [1, 0.3, 0, 0, 1, 0, 0, 0, 1])
    angle = 2.5
    driven("rigid rotation", {"xy": {"velocity_gradient": f"{-angle * 1e3} 1/s"},
                              "yx": {"velocity_gradient": f"{angle * 1e3} 1/s"}},
           [math.cos(angle), -math.sin(angle), 0, math.sin(angle), math.cos(angle), 0, 0, 0, 1])


def impact(geometry, wanted):
    place = ["1 mm", "0.3 mm"]
    at = {"body": "block", "point": place, "follow": "material"}
    scene = {"gamut": 1,
             "solver": {"model": "material_point_method", "geometry": geometry, "cell": "0.5 mm",
                        "end": "6 us"},
             "materials": {"metal": CARD},
             "bodies": {"block": {"material": "metal", "velocity": ["0 m/s", "-200 m/s"],
                                  "shape": {"box": {"min": ["0 mm", "0 mm"],
                                                    "max": ["4 mm", "4 mm"]}}}},
             "effects": {"wall": {"model": "rigid_wall",
                                  "plane": {"point": ["0 mm", "0 mm"], "normal": [0, 1]}}},
             "quantities": {name: {"measure": name, "at": at, "reduce": "at end"}
                            for name in wanted}}
    return scenes.written(f"impact_{geometry}", json.dumps(scene))


def kept_fields(name):
    done = subprocess.run([scenes.GAMUT, "explain", name, "--json"], capture_output=True,
                          text=True, check=True, stdin=subprocess.DEVNULL)
    fields = json.loads(done.stdout)["fields"]
    return {field["name"] for field in fields if field["kept"] != "unused"}


def on_a_wall():
    for geometry in ("plane_strain", "axisymmetric"):
        run = scenes.run(impact(geometry, [*F, "volume_ratio"]))
        f = [run.value(name) for name in F]
        scenes.note(f"{geometry}: F {[round(x, 4) for x in f]}")
        scenes.below(f"{geometry}: det F over the volume ratio - 1",
                     abs(determinant(f) / run.value("volume_ratio") - 1.0), 1e-13)
        scenes.drop(run)
    bare, read = (kept_fields(impact("plane_strain", wanted))
                  for wanted in (["volume_ratio"], ["volume_ratio", F[0]]))
    scenes.report(read - bare == {"deformation_gradient"},
                  f"it is worked out only where it is read: {read - bare}")


made.verified("effect/witness")
led()
on_a_wall()
on_a_grid()
at_a_point()
scenes.done()
