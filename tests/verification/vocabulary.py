"""Fields that are there for everybody: first_position, temperature, cell_size."""
import json

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


made.verified("effect/witness")
on_a_grid()
at_a_point()
scenes.done()
