"""A point that tears, one that is heated while it is pressed, and a wall that is touched on the
axis alone, against closed forms (docs/theory/exact_solutions.md). Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy
from exact_solutions import SOLID, around_axis
from laws import drive, linear_eos, material, rows, von_mises


def torn(steps, shear=0.05, swell=0.01):
    """Sheared and pulled apart after it has torn in its first step: the internal energy that it
    gains over the work of shear that was taken back in all steps."""
    card = material(linear_eos(SOLID.bulk), None, SOLID.shear, SOLID.density)
    control = {c: {"log_strain": swell / 3.0} for c in ("xx", "yy", "zz")}
    control["xy"] = {"velocity_gradient": f"{shear} 1/s"}
    found = drive(card, control, 1.0, steps, final=["energy", "damage"],
                  effects={"tear": {"model": "spall", "limit": "1 Pa"}})
    # each step begins without a deviator: G gamma^2 / 2 of the strain of that step alone
    work = steps * 0.5 * SOLID.shear * (shear / steps) ** 2
    return found["energy"] / work, found["damage"], (shear + swell) / steps


def tears(steps, shear=2e-3, limit=1e9):
    """Elastically sheared, then pulled until it tears, and further: internal energy over the strain
    energy that it had when it tore; and how much the last step alone can add."""
    card = material(linear_eos(SOLID.bulk), None, SOLID.shear, SOLID.density)
    most = 2.0 * limit / SOLID.bulk
    control = {c: {"log_strain": rows([(0, 0), (1, 0), (2, most / 3.0)], "")}
               for c in ("xx", "yy", "zz")}
    control["xy"] = {"velocity_gradient": rows([(1, shear), (1, 0.0)], "1/s")}
    found = drive(card, control, 2.0, steps, final=["energy", "damage"],
                  effects={"tear": {"model": "spall", "limit": f"{limit!r} Pa"}})
    ratio = 1.0 / (1.0 - limit / SOLID.bulk)  # where p = K (1 / J - 1) is - limit
    held = 0.5 * SOLID.shear * shear ** 2 + SOLID.bulk * (ratio - 1.0 - math.log(ratio))
    return found["energy"] / held, found["damage"], limit * 2.0 * most / steps / held


def heated(steps, squeeze, flow=400e6, specific_heat=477.0, share=0.9):
    """Pressed along one axis, or pulled, by a log strain: rise of temperature over the exact one,
    and over that without the volume ratio."""
    card = material(linear_eos(SOLID.bulk), von_mises(flow), SOLID.shear, SOLID.density,
                    specific_heat)
    found = drive(card, {"xx": {"log_strain": squeeze}}, 1.0, steps, final=["temperature"],
                  adiabatic=True)
    rise, sign = found["temperature"] - 298.0, math.copysign(1.0, squeeze)
    onset = sign * flow / (2.0 * SOLID.shear)
    work = 2.0 / 3.0 * flow * abs(math.exp(squeeze) - math.exp(onset))
    plain = 2.0 / 3.0 * flow * abs(squeeze - onset)
    return rise * SOLID.density * specific_heat / share / numpy.array([work, plain])


def on_axis(shape):
    """A disc whose middle alone flies into a wall, at a node on the axis: the area that it touches
    over that of the disc within half a cell."""
    cell = 0.5e-3
    scene = around_axis(cell, 0.1e-6, "{cylinder: {radius: 4 mm, length: 4 mm}}",
                        '["0", "-10 + 2.5e4 * x"]',
                        "  area: {measure: contact_area, effect: wall, every: 1 ns, reduce: max}\n",
                        "  wall: {model: rigid_wall, plane: {point: [0 m, 0 m], normal: [0, 1]}}\n")
    result = scenes.run(scene, {"solver.shape": shape})
    scenes.drop(result)
    return result.value("area") / (math.pi * (0.5 * cell) ** 2)


def test_points():
    for steps in (50, 100):
        share, gone, strain = torn(steps)
        scenes.below(f"torn material sheared on in {steps} steps: energy gained over the work of "
                     "its "
                     "shear", share, strain)
    energy, gone, last = tears(400)
    scenes.within("material that tears keeps the strain energy that it had, and no more", energy,
                  1.0,
                  last)
    scenes.report(gone == 1.0, "  and has torn")
    for squeeze in (-0.5, 0.4):
        rises = [heated(n, squeeze) for n in (100, 200)]
        scenes.within(f"plastic heat at a volume ratio of {math.exp(squeeze):.3f}", rises[1][0],
                      1.0, 1e-5)
        scenes.note(f"without the volume ratio it would be {rises[1][0] / rises[1][1]:.4f}")
    for shape in ("linear", "gimp", "quadratic", "cubic"):
        scenes.within(f"a wall touched on the axis alone, {shape}: area", on_axis(shape), 1.0, 0.02)


if __name__ == "__main__":
    test_points()
    scenes.done()
