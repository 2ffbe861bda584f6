"""A bar that is pulled, a column under its own weight, a quarter model. Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import schemes
import numpy


def exact_stress(stretch, modulus):
    """Uniaxial strain, Poisson's ratio 0."""
    return modulus * ((1 - 1 / stretch) + 2 * math.log(stretch)) / 3


def test_tension():
    result = scenes.run("tension_bar")
    times, force = result.history("foot_force")
    off = max(abs(abs(f) - exact_stress(1 + 0.01 * t, 1.0)) for t, f in zip(times[5:], force[5:]))
    scenes.below("tension: force off the exact one, over that at the end",
                 off / exact_stress(2, 1.0), 0.05)
    jump = max(abs(a - b) for a, b in zip(force[5:], force[6:]))
    scenes.below("tension: largest jump of force between samples",
                 jump / exact_stress(2, 1.0), 0.05)
    scenes.within("tension: length at the end", result.history("length")[1][-1], 2.0, 0.02)


def stretch_under(pressure, modulus):
    low, high = 0.1, 1.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if exact_stress(middle, modulus) < -pressure else (low, middle)
    return low


def column(start, _):
    """Places in a column of 50 m that carries what stands above."""
    grid = numpy.linspace(0, 50, 2001)
    stretch = numpy.array([stretch_under(1e4 * (50 - y), 1e6) for y in grid])
    place = numpy.concatenate([[0], numpy.cumsum(0.5 * (stretch[1:] + stretch[:-1])
                                                 * numpy.diff(grid))])
    return numpy.interp(start[:, 0], grid, place)[:, None]


def test_column():
    errors = [schemes.displacement_error("self_weight", "column", column, 1,
                                         {"solver.cell": f"{c} m"}) for c in (2, 1)]
    scenes.note("column: " + ", ".join(f"{e:.3e}" for e in errors))
    scenes.below("column: error of displacement", errors[-1], 0.01)


def test_quarter():
    whole, part = scenes.run("taylor_bar_3d"), scenes.run("taylor_bar_quarter")
    # Rounding grows in flight and impact: the two are the same motion, seen apart after a while.
    early = {"solver.end": "5 us"}
    scenes.within("quarter: length after 5 us",
                  scenes.run("taylor_bar_quarter", early).value("final_length"),
                  scenes.run("taylor_bar_3d", early).value("final_length"), 1e-8)
    scenes.within("quarter: length", part.value("final_length"), whole.value("final_length"), 1e-5)
    scenes.within("quarter: force on the wall, four times its largest",
                  4 * max(part.history("wall_force")[1]), max(whole.history("wall_force")[1]), 0.02)


for test in (test_tension, test_column, test_quarter):
    try:
        test()
    except scenes.Failed as failed:
        scenes.report(False, f"{test.__name__} runs", [failed])
scenes.done()
