"""Bodies that meet, spin, stretch, and follow manufactured motions; a quarter model. Prints TAP."""
import math

import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy


def frames(result, body, names):
    """Of each frame: time and the named fields, by id; the first holds places at the start."""
    found = []
    with h5py.File(result.file("results.h5"), "r") as file:
        for key in sorted(file["frames"]):
            group = file["frames"][key]
            order = numpy.argsort(group[body]["id"][...])
            found.append((float(group.attrs["time"]),
                          {n: group[body][n][...][order] for n in names}))
    return found


def displacement_error(scene, body, exact, axes, changes):
    """Root mean square of the error of displacement in the last frame over that of displacement."""
    result = scenes.run(scene, changes)
    shots = frames(result, body, ["position"])
    start, (time, last) = shots[0][1]["position"][:, :axes], shots[-1]
    target = exact(start, time)
    off = last["position"][:, :axes] - target
    return math.sqrt((off ** 2).sum() / ((target - start) ** 2).sum())


def order(errors):
    return [math.log2(a / b) for a, b in zip(errors, errors[1:])]


def in_block(start, time):
    return start + 0.02 * numpy.sin(2 * math.pi * start) * math.sin(99.3458827 * time)


def in_ring(start, time):
    radius = numpy.hypot(start[:, 0], start[:, 1])
    s = 2 * (1 - radius)
    angle = 0.2 * math.sin(math.pi * time) * (1 - 8 * s ** 2 + 16 * s ** 4)
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.stack([c * start[:, 0] - s * start[:, 1], s * start[:, 0] + c * start[:, 1]], 1)


def test_block():
    for shape, finest in (("quadratic", 2e-2), ("linear", None)):
        errors = [displacement_error("mms_axis_aligned", "block", in_block, 2, {
            "solver.cell": f"{cell} m", "solver.shape": shape}) for cell in (0.1, 0.05, 0.025)]
        scenes.note(f"manufactured motion, {shape}: " + ", ".join(f"{e:.3e}" for e in errors)
                    + "; orders " + ", ".join(f"{o:.2f}" for o in order(errors)))
        if finest:
            scenes.below(f"manufactured motion, {shape}: error at the finest", errors[-1], finest)
            scenes.report(errors[2] < errors[0], f"manufactured motion, {shape}: errors fall")


def test_vortex():
    errors = [displacement_error("vortex", "ring", in_ring, 2, {
        "solver.cell": f"{cell} m", "solver.end": "0.5 s"}) for cell in (0.1, 0.05, 0.025)]
    scenes.note("vortex at its widest: " + ", ".join(f"{e:.3e}" for e in errors)
                + "; orders " + ", ".join(f"{o:.2f}" for o in order(errors)))
    scenes.below("vortex: error at the finest cell", errors[-1], 0.02)
    scenes.report(errors[2] < errors[1] < errors[0], "vortex: errors fall")


def test_disks():
    result = scenes.run("colliding_disks")
    start = result.history("kinetic_lower")[1][0]
    end = result.history("kinetic_lower")[1][-1]
    scenes.within("disks: kinetic energy of both at the start", 2 * start, 2.513274122871835, 2e-3)
    scenes.report(end / start > 0.9, f"disks: kinetic energy kept {end / start:.4f} (at least 0.9)")
    scenes.within("disks: contact", result.value("contact"), 1.5857864376269049, 0.12)
    low, high = (result.history(n)[1] for n in ("velocity_lower", "velocity_upper"))
    scenes.below("disks: mirror symmetry of the velocities",
                 max(abs(a + b) for a, b in zip(low, high)) / 0.1, 1e-9)
    scenes.report(low[-1] < -0.09, f"disks: rebound at {low[-1]:.4f} m/s (at most -0.09)")
    scenes.below("disks: ledger", result.residual(), 1e-10)


def test_spin():
    result = scenes.run("rotating_block")
    kinetic = result.history("kinetic")[1]
    scenes.below("spinning block: kinetic energy lost in a turn",
                 1 - kinetic[-1] / kinetic[0], 0.06)
    scenes.below("spinning block: largest stress over Young's modulus",
                 max(result.history("stress")[1]) / 1e6, 1e-3)
    scenes.below("spinning block: change of volume",
                 max(abs(v - 1) for v in result.history("volume")[1]), 1e-3)


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
    errors = [displacement_error("self_weight", "column", column, 1, {"solver.cell": f"{c} m"})
              for c in (2, 1)]
    scenes.note("column: " + ", ".join(f"{e:.3e}" for e in errors))
    scenes.below("column: error of displacement", errors[-1], 0.01)


def test_quarter():
    whole, part = scenes.run("taylor_bar_3d"), scenes.run("taylor_bar_quarter")
    scenes.within("quarter: length", part.value("final_length"), whole.value("final_length"), 1e-6)
    scenes.within("quarter: force on the wall, four times its largest",
                  4 * max(part.history("wall_force")[1]), max(whole.history("wall_force")[1]), 0.02)


for test in (test_block, test_vortex, test_disks, test_spin, test_tension, test_column,
             test_quarter):
    try:
        test()
    except scenes.Failed as failed:
        scenes.report(False, f"{test.__name__} runs", [failed])
scenes.done()
