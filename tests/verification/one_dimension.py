"""The material point method in one dimension, each shape with each transfer and order: against an
independent program, closed forms, and hard cases. Prints TAP. one_dimension_long.py has the
ladders in full."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy
import one_dimension_cases as cases
from one_dimension_reference import Wave

# Energy kept after ten periods at 8, 16, 32 cells a wavelength: CPDI, another program.
KEPT = {"flip": (0.5767, 0.9280, 0.9831), "pic 0.01": (0.2185, 0.5567, 0.7607),
        "pic": (1.8e-32, 2.1e-23, 6.4e-12), "apic": (0.0530, 0.6431, 0.9359),
        "xpic 2": (3.5e-6, 0.1814, 0.7993), "xpic 3": (0.1344, 0.8809, 0.9815),
        "xpic 5": (0.5643, 0.9279, 0.9831)}
RULES = {"flip": ("flip", 0.0), "pic 0.01": ("flip", 0.01), "pic": ("xpic", 1), "apic": ("apic", 0),
         "xpic 2": ("xpic", 2), "xpic 3": ("xpic", 3), "xpic 5": ("xpic", 5)}


def offered(shape, transfer):
    return (shape, transfer) != ("linear", "apic")


def each(shapes=cases.SHAPES, transfers=cases.TRANSFERS, orders=cases.ORDERS):
    return [c for c in cases.combinations(shapes, transfers, orders) if offered(*c[:2])]


def named(values):
    return ", ".join(f"{v:.3g}" for v in values)


def test_refused():
    process, _ = scenes.attempt("vibrating_bar", cases.settings("linear", "apic"))
    scenes.report(process.returncode == 3 and "apic" in process.stderr,
                  "apic with linear shapes is refused by name, exit 3", [process.stderr])


def off_reference(shape, transfer, order, cells=16, steps=40, speed=0.3, courant=0.2):
    """Points cross cells; the largest difference of places, velocities and volumes."""
    tail = cases.ENDS + "outputs: {{frames: 1, fields: [velocity, volume_ratio]}}\n"
    step = courant / cells
    scene = cases.bar("reference", tail, cell=1 / cells, high=0.5, end=steps * step,
                      velocity=f"{speed} * sin(2 * pi * x)")
    result = scenes.run(scene, cases.settings(shape, transfer, order, step=f"{step} s"))
    wave = Wave(cells, shape.split(maxsplit=1)[0], RULES[transfer], order, speed,
                fixed="fixed" in shape)
    for _ in range(steps):
        wave.step(step)
    found = cases.shots(result, "bar", ["position", "velocity", "volume_ratio"])[-1][1]
    scenes.drop(result)
    if result.summary["cost"]["steps"] != steps:
        return math.inf
    return max(float(numpy.abs(found[name] - exact[:cells]).max()) / scale
               for name, exact, scale in (("position", wave.x, 1.0), ("velocity", wave.v, speed),
                                          ("volume_ratio", wave.stretch, 1.0)))


def test_reference():
    for shape in cases.SHAPES:
        off = {f"{t}, {o}": off_reference(shape, t, o) for _, t, o in each([shape])}
        where = max(off, key=off.get)
        scenes.below(f"{shape}: all transfers and orders against an independent program, 40 steps, "
                     f"worst ({where})", off[where], 1e-12)


def test_kept():
    for shape in ("linear", "gimp", "quadratic"):
        for i, cells in ((1, 16), (2, 32)):
            for transfer in ("flip", "xpic 5"):
                kept = cases.standing(cells, shape, transfer, "usl")[-1]
                scenes.within(f"standing wave, {shape}, {transfer}, usl, {cells} cells a "
                              "wavelength: energy kept", kept, KEPT[transfer][i], 0.03)
    for shape in cases.SHAPES:
        kept = [cases.standing(16, shape, t, "usl")[-1]
                for t in ("pic", "pic 0.01", "xpic 2", "xpic 3", "xpic 5", "flip")]
        rising = [kept[0], kept[2], kept[3], kept[4], kept[5] + 1e-3]
        scenes.report(rising == sorted(rising) and abs(kept[0]) < 1e-9,
                      f"standing wave, {shape}: pic, xpic 2, 3, 5, flip keep more and more: "
                      f"{named([kept[0], *kept[2:]])} (pic below 1e-9)")


def errors(shape, grids, amplitude, **more):
    return [cases.manufactured(n, amplitude, shape, **more)["error"] for n in grids]


def test_motion():
    for shape in cases.SHAPES:
        found = errors(shape, (16, 32, 64), 1e-4)
        order = cases.orders_of(found)[-1]
        scenes.report(order >= 1.9, f"manufactured motion, amplitude 1e-4, {shape}: "
                                    f"{named(found)}, order {order:.2f} (at least 1.9)")
    found = errors("gimp", (16, 32, 64, 128), 0.05)
    order = cases.orders_of(found)[-1]
    scenes.report(order >= 1.9, f"manufactured motion, amplitude 0.05, gimp: {named(found)}, order "
                                f"{order:.2f} (at least 1.9)")
    for shape, points, grids, least, most in (
            ("linear", 2, (16, 64), -math.inf, 0.0), ("gimp fixed", 2, (32, 64), -0.5, 0.5),
            ("quadratic", 2, (32, 64), -0.5, 0.5), ("cubic", 4, (32, 64), 1.9, 2.1)):
        found = errors(shape, grids, 0.05, points=points)
        order = math.log2(found[0] / found[1]) / math.log2(grids[1] / grids[0])
        scenes.report(least <= order <= most,
                      f"manufactured motion, amplitude 0.05, {shape}, {points} points a cell: "
                      f"{named(found)} at {grids} cells, order {order:.2f} (known to lie between "
                      f"{least:g} and {most:g})")


def test_column():
    for shape, order in (("gimp", 1.8), ("cubic", 1.5), ("quadratic", 0.5)):
        found = [cases.column(n, shape)["place"] for n in (12, 25)]
        reached = math.log2(found[0] / found[1]) / math.log2(25 / 12)
        scenes.report(found[1] <= 1e-3 and reached >= order,
                      f"column under its own weight, {shape}: error of displacement {named(found)} "
                      f"(at most 1e-3), order {reached:.2f} (at least {order})")


def test_tension():
    for shape, least in (("gimp", 2.0), ("quadratic", 2.0), ("cubic", 2.0), ("gimp fixed", 1.9)):
        found = cases.tension(4, shape, stretch=2.2)
        force = math.inf if found["force"] is None else found["force"]
        scenes.report(found["stretch"] >= least and force < 0.02,
                      f"tension, {shape}, 4 points a cell: holds to a stretch of "
                      f"{found['stretch']:.2f} (at least {least}), force off by "
                      f"{100 * force:.2f} % (at most 2 %)")


def test_conservation():
    for shape in cases.SHAPES:
        momentum = residual = 0.0
        for _, transfer, order in each([shape]):
            try:
                found = cases.free(shape, transfer, order)
            except scenes.Failed as failed:
                scenes.report(shape == "linear" and failed.code == 5,
                              f"free flight, {shape}, {transfer}, {order}: stops (linear only)",
                              [failed])
                continue
            momentum = max(momentum, abs(found["momentum"]))
            residual = max(residual, found["residual"])
        scenes.below(f"free flight, {shape}: change of momentum", momentum, 1e-13)
        scenes.below(f"free flight, {shape}: ledger", residual, 1e-12)


def test_noise():
    for shape in cases.SHAPES:
        found = {t: cases.noise(shape, t, "usl", cases.NULL, 1000)
                 for t in ("flip", "xpic 2", "pic 0.01")}
        most = max(f["most"] for f in found.values())
        scenes.report(most <= 1 + 1e-9,
                      f"noise that no node sees, {shape}, 1000 steps: kept "
                      + ", ".join(f"{t} {f['kept']:.2g}" for t, f in found.items())
                      + f"; at most {most:.6f} on the way (1)")


def test_places():
    for shape in cases.SHAPES:
        rate = max(cases.on_nodes(shape, "flip", order) for order in cases.ORDERS)
        scenes.below(f"points on nodes, {shape}: rate of strain of a rigid motion", rate, 1e-13)
        stress = cases.flight(shape, "flip", "auto", 100)
        scenes.below(f"flight through 100 cells, {shape}: stress over Young's modulus", stress,
                     1e-10)
        smooth = cases.near_face(None, shape)["acceleration"]
        found = [cases.near_face(k, shape) for k in (1, 4, 12)]
        most = max(f["acceleration"] for f in found) / smooth
        lost = max(f["momentum"] for f in found)
        scenes.report(most <= 10 and lost <= 1e-13,
                      f"last point 1e-1, 1e-4, 1e-12 cells beyond a node, {shape}: acceleration "
                      f"{most:.3f} of that at a quarter (at most 10), momentum to {lost:.1g} "
                      "(1e-13)")


def test_ladder(numbers=(0.5, 1.1, 2.5)):
    for shape in cases.SHAPES:
        for order in ("usl", "musl"):
            found = [cases.ladder(shape, order, n) for n in numbers]
            codes = [f["exit"] for f in found]
            sound = all(f["finite"] and f["exit"] in (0, 5) and (f["kept"] or 0) < 1.3
                        for f in found)
            scenes.report(sound and codes[0] == 0 and codes[-1] == 5,
                          f"steps of {numbers} cells over sound, {shape}, {order}: exit {codes} "
                          "(0 first, 5 at last, energy within 1.3 wherever it is 0, all finite)")


def test_long_waves():
    for shape in cases.SHAPES:
        for order in ("musl", "usf"):
            scenes.below(f"standing wave, 100 000 steps, 32 cells a wavelength, {shape}, {order}: "
                         "change of energy", cases.drift(shape, "flip", order), 0.01)
        kept = cases.standing(32, shape, "pic", "usl", 0.5)
        part = [sum(kept[i:i + 50]) for i in range(0, 200, 50)]
        scenes.report(part == sorted(part, reverse=True),
                      f"standing wave, {shape}, pic: energy falls period by period")


def test_long_noise():
    for shape, transfer, order in each():
        for name, velocity in (("null", cases.NULL), ("white", cases.WHITE)):
            found = cases.noise(shape, transfer, order, velocity)
            scenes.report(found["most"] <= 1.1,
                          f"{name} noise, 10 000 steps, {shape}, {transfer}, {order}: kept "
                          f"{found['kept']:.3g}, at most {found['most']:.4f} (1.1)")


def test_long_motion():
    for points, shape, order in ((2, "gimp", 1.95), (4, "gimp", 1.95), (4, "cubic", 1.9)):
        found = errors(shape, (32, 64, 128, 256), 0.05, points=points)
        reached = cases.orders_of(found)
        scenes.report(min(reached) >= order,
                      f"manufactured motion to 256 cells, {shape}, {points} points a cell: "
                      f"{named(found)}, orders {named(reached)} (at least {order})")


SHORT = (test_refused, test_reference, test_kept, test_motion, test_column, test_tension,
         test_conservation, test_noise, test_places, test_ladder)
LONG = (test_long_waves, test_long_noise, test_long_motion)


def run(tests):
    for test in tests:
        try:
            test()
        except scenes.Failed as failed:
            scenes.report(False, f"{test.__name__} runs", [failed])
    scenes.done()


if __name__ == "__main__":
    run(SHORT)
