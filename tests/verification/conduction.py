"""Passes over the grid, tried by heat conduction in an insulated bar.

Against the closed form T = T_mean + A cos(pi x / L) exp(-lambda t) with
lambda = diffusivity (pi / L)^2; its mean over the left half is T_mean + 2 A / pi exp(-lambda t).
"""
import json
import math
import sys

import made
import scenes

sys.path.insert(0, scenes.os.path.join(scenes.TREE, "tests/restart"))
import same  # noqa: E402

EXTRA = ["--plugin-path", made.of_tree("effect/conduction")]
LENGTH, DENSITY, CAPACITY, HALF = 10e-3, 8000.0, 500.0, 100.0
DIFFUSIVITY = 1.0
RATE = DIFFUSIVITY * (math.pi / LENGTH) ** 2
END = 0.5 / RATE


def exact():
    return 2.0 * HALF / math.pi * math.exp(-RATE * END)


def first_mean(cells):
    """Of the left half at the start: two points a cell."""
    return HALF / cells * sum(math.cos(math.pi * (j + 0.5) / (2 * cells)) for j in range(cells))


def bar(cells, axes=1, across=4, **solver):
    """Along x; steps fall with the square of the cell, as the error in space does."""
    names = {1: "1d", 2: "plane_strain", 3: "3d"}
    cell = LENGTH / cells

    def box(low, high):
        return {"box": {"min": [f"{low!r} m"] + ["0 m"] * (axes - 1),
                        "max": [f"{high!r} m"] + [f"{across * cell!r} m"] * (axes - 1)}}

    bodies = {"left": {"material": "metal", "shape": box(0.0, LENGTH / 2),
                       "energy": "1 GJ/m3"},
              "right": {"material": "metal", "shape": box(LENGTH / 2, LENGTH),
                        "energy": "1 GJ/m3"}}
    return {"gamut": 1,
            "solver": {"model": "material_point_method", "geometry": names[axes],
                       "cell": f"{cell!r} m", "end": f"{END!r} s",
                       "step": f"{0.1 * cell * cell / DIFFUSIVITY!r} s", **solver},
            "materials": {"metal": {"density": f"{DENSITY} kg/m3",
                                    "eos": {"model": "linear", "bulk_modulus": "1 GPa"},
                                    "elasticity": {"model": "hypoelastic",
                                                   "shear_modulus": "1 GPa"}}},
            "bodies": bodies,
            "effects": {"flow": {"model": "conduction",
                                 "initial": f"400 + {HALF!r} * cos({math.pi / LENGTH!r} * x)",
                                 "specific_heat": f"{CAPACITY} J/(kg K)",
                                 "conductivity": f"{DIFFUSIVITY * DENSITY * CAPACITY!r} W/(m K)"}},
            "quantities": {
                "left": {"measure": "mean", "body": "left", "field": "temperature",
                         "reduce": "at end"},
                "right": {"measure": "mean", "body": "right", "field": "temperature",
                          "reduce": "at end"},
                "energy": {"measure": "internal_energy", "body": "left", "reduce": "at end"}},
            "outputs": {"every": f"{END / 4!r} s", "fields": ["temperature", "heat_flux"]}}


def run(name, scene, threads=1):
    return scenes.run(scenes.written(name, json.dumps(scene)), threads=threads, extra=EXTRA)


def converges():
    off = {}
    for cells in (10, 20, 40):
        result = run(f"bar_{cells}", bar(cells))
        left, right = result.value("left") - 400.0, result.value("right") - 400.0
        off[cells] = abs(left - exact()) / exact()
        scenes.note(f"{cells} cells: left {left:.6f} K above the mean, exact {exact():.6f} K")
        scenes.below(f"{cells} cells: what one half loses the other gains, relative",
                     abs(left + right) / exact(), 1e-12)
        joule = DENSITY * CAPACITY * LENGTH / 2 * (left - first_mean(cells))
        scenes.below(f"{cells} cells: heat in the energy against temperature, relative",
                     abs((result.value("energy") - 1e9 * LENGTH / 2) / joule - 1.0), 1e-10)
        scenes.below(f"{cells} cells: the ledger's residual", result.residual(), 1e-12)
        scenes.drop(result)
    scenes.below("20 cells: off the closed form, relative", off[20], 0.01)
    for coarse, fine in ((10, 20), (20, 40)):
        order = math.log2(off[coarse] / off[fine])
        scenes.report(order > 1.8, f"order of convergence from {coarse} to {fine} cells: "
                      f"{order:.3f} (at least 1.8)")


def schemes():
    """Other shapes and axes see the same bar; each is within its own error of the closed form."""
    for title, scene in (("linear", bar(20, shape="linear")), ("gimp", bar(20, shape="gimp")),
                         ("cubic", bar(20, shape="cubic")),
                         ("xpic", bar(20, transfer={"model": "xpic", "order": 3})),
                         ("two axes", bar(20, 2)), ("three axes", bar(10, 3)),
                         ("three axes, linear", bar(10, 3, shape="linear"))):
        result = run("scheme", scene)
        limit = 0.04 if "three" in title else 0.01 if title != "cubic" else 0.015
        scenes.below(f"{title}: off the closed form, relative",
                     abs(result.value("left") - 400.0 - exact()) / exact(), limit)
        scenes.drop(result)


def same_bits():
    """Many blocks, so that threads share the work; and stopped half-way."""
    scene = scenes.written("bits", json.dumps(bar(64, 2, 64)))
    one, two = (scenes.os.path.join(scenes.SCRATCH, name) for name in ("one", "two"))
    settings = [f"solver.end={END / 200!r} s", f"outputs.every={END / 400!r} s"]
    done = same.run(scene, one, settings, *EXTRA)
    scenes.report(done.code == 0, "a plate of 64 by 64 cells runs", [done.said])
    done = same.run(scene, two, [*settings, f"outputs.checkpoint={{every: {END / 380!r} s}}"],
                    *EXTRA, threads=2)
    wrong = same.differences(one, two)
    scenes.report(done.code == 0 and not wrong,
                  f"one thread and two: the same bits {wrong[:4]}", [done.said])
    same.forget_the_end(two)
    at, total = same.checkpoint_step(two), same.steps(one)
    done = same.run(scene, two, settings, *EXTRA, "--resume")
    wrong = same.differences(one, two)
    scenes.report(done.code == 0 and 0 < at < total and not wrong,
                  f"stopped at step {at} of {total} and gone on: the same bits {wrong[:4]}",
                  [done.said])


def refused():
    scene = bar(10)
    scene["solver"] = {"model": "material_driver", "end": "1 ms", "steps": 10,
                       "control": {"xx": {"strain_rate": "100 1/s"}}}
    scene["bodies"] = {"left": {"material": "metal"}}
    del scene["quantities"], scene["outputs"]
    done, _ = scenes.attempt(scenes.written("driver", json.dumps(scene)), extra=EXTRA)
    scenes.report(done.returncode == 3 and "needs 'grid'" in done.stderr
                  and "material_driver" in done.stderr,
                  "a solver without a grid: refused by name", [done.stderr])


made.verified("effect/conduction")
converges()
schemes()
same_bits()
refused()
scenes.done()
