"""Manufactured motions in two and three dimensions, by shape and transfer. Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import schemes
import numpy

PULSE, SIZE = 99.3458827, 0.02
FORCE = ("{size} * sin(2*pi*{own}) * sin({pulse}*t) * (-9869.6044 + 4 * pi^2 * (1000/3 + 2000/3"
         " * {volume}) / {stretch}^2)")
STRETCH = "(1 + {size}*2*pi*cos(2*pi*{own})*sin({pulse}*t))"
CUBE = """gamut: 1
title: The motion of mms_axis_aligned along three axes
solver: {{model: material_point_method, geometry: 3d, cell: 0.1 m, courant: 0.2, end: 0.02 s}}
materials:
  soft:
    density: 1000 kg/m3
    eos: {{model: linear, youngs_modulus: 1 MPa, poissons_ratio: 0}}
    elasticity: {{model: hypoelastic, youngs_modulus: 1 MPa, poissons_ratio: 0}}
bodies:
  block:
    material: soft
    shape: {{box: {{min: [0 m, 0 m, 0 m], max: [1 m, 1 m, 1 m]}}}}
    velocity: [{velocity}]
effects:
{planes}  force:
    model: body_force
    acceleration:
{force}outputs: {{frames: 1, fields: [velocity]}}
"""


def in_block(start, time):
    return start + SIZE * numpy.sin(2 * math.pi * start) * math.sin(PULSE * time)


def in_ring(start, time):
    radius = numpy.hypot(start[:, 0], start[:, 1])
    s = 2 * (1 - radius)
    angle = 0.2 * math.sin(math.pi * time) * (1 - 8 * s ** 2 + 16 * s ** 4)
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.stack([c * start[:, 0] - s * start[:, 1], s * start[:, 0] + c * start[:, 1]], 1)


def cube():
    """The scene of three axes: the same formula as along two."""
    stretch = {k: STRETCH.format(size=SIZE, own=k, pulse=PULSE) for k in "XYZ"}
    volume = "*".join(stretch.values())
    force = "".join(f"      {k.lower()}: >-\n        " + FORCE.format(
        size=SIZE, own=k, pulse=PULSE, volume=volume, stretch=stretch[k]) + "\n" for k in "XYZ")
    planes = ""
    for axis in range(3):
        for side, place in ((1, 0), (-1, 1)):
            point = ["0 m"] * 3
            normal = ["0"] * 3
            point[axis], normal[axis] = f"{place} m", str(side)
            planes += (f"  {'xyz'[axis]}{place}: {{model: boundary, kind: symmetry, plane: "
                       f"{{point: [{', '.join(point)}], normal: [{', '.join(normal)}]}}}}\n")
    velocity = ", ".join(f'"{SIZE * PULSE} * sin(2 * pi * {k})"' for k in "xyz")
    return scenes.written("cube", CUBE.format(velocity=velocity, planes=planes, force=force))


CASES = {"two axes": ("mms_axis_aligned", "block", in_block, 2, {}),
         "three axes": (None, "block", in_block, 3, {}),
         "vortex": ("vortex", "ring", in_ring, 2, {"solver.end": "0.5 s"})}


def error(case, cells, settings):
    """Of displacement, `cells` along 1 m."""
    scene, body, exact, axes, changes = CASES[case]
    return schemes.displacement_error(scene or cube(), body, exact, axes, {
        "solver.cell": f"{1 / cells!r} m", **changes, **settings})


def ladder(case, grids, settings):
    """Errors on grids, until one stops; then why."""
    errors = []
    for cells in grids:
        value, why = schemes.outcome(error, case, cells, settings)
        if value is None:
            return errors, why
        errors.append(value)
    return errors, ""


def told(case, shape, transfer, order, grids, changes=None):
    """The errors on the grids and the order from the first grid to the last."""
    errors, why = ladder(case, grids, {**schemes.scheme(shape, transfer, order), **(changes or {})})
    rates = schemes.orders(errors, [1 / n for n in grids])
    name = f"{case}, {schemes.name(shape, transfer, order)}"
    scenes.note(f"{name}: " + ", ".join(f"{e:.3e}" for e in errors)
                + "; orders " + ", ".join(f"{r:.2f}" for r in rates) + why[:60])
    mean = math.log(errors[0] / errors[-1]) / math.log(grids[-1] / grids[0]) if errors else 0.0
    return name, errors, mean


def converges(asked, finest, *what):
    name, errors, mean = told(*what)
    scenes.report(len(errors) == len(what[4]) and mean >= asked and errors[-1] <= finest,
                  f"{name}: order {mean:.2f} (at least {asked}), "
                  f"{errors[-1] if errors else math.nan:.3e} on the finest grid (allowed {finest})")


def main(fine):
    two, three, ring = ((10, 20, 40, 80), (10, 20), (10, 20, 40)) if fine else (
        (10, 20, 40), (8, 16), (10, 20))
    # on the finest grid the quadratic spline's sum over four points a cell begins to show
    for shape in ("gimp", "quadratic", "cubic"):
        converges(1.7 if fine and shape == "quadratic" else 1.8, 0.012, "two axes", shape, "flip",
                  "auto", two)
    converges(1.5 if fine else 1.7, 0.008, "two axes", "quadratic", "apic", "auto", two)
    converges(1.8, 0.06, "three axes", "quadratic", "flip", "auto", three)
    for shape in ("gimp", "quadratic"):
        converges(0.95, 0.04, "vortex", shape, "flip", "auto", ring)
    # points that cross the nodes of linear functions: the error grows as the cell shrinks
    _, errors, mean = told("two axes", "linear", "flip", "musl", two[:3])
    scenes.report(len(errors) == 3 and mean < 0,
                  f"two axes, linear: order {mean:.2f}, does not converge (known of this shape)")
    if fine:
        for scheme in schemes.table():
            told("two axes", *scheme, two[:3])
        for scheme in schemes.table(("gimp", "quadratic"), ("flip", "pic", "apic", "xpic 2")):
            told("vortex", *scheme, ring)


if __name__ == "__main__":
    main(False)
    scenes.done()
