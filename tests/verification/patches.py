"""A body under uniform stress pushes only at its faces; a point just beyond a cell's face is not
thrown: by shape, wherever the grid lies. Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import schemes
import numpy
from rigid_motion import box, far_plane

PRESSED = """gamut: 1
title: A gas under uniform pressure that begins to expand
solver:
  {{model: material_point_method, geometry: {geometry}, cell: 1 m, step: {step} s, end: {end} s}}
materials: {{gas: {{density: 1 kg/m3, eos: {{model: ideal_gas, gamma: 1.4}}}}}}
bodies:
  block:
    material: gas
    shape: {shape}
    pressure: 1 Pa
    velocity: {velocity}
effects:
{planes}outputs: {{every: {step} s, fields: [velocity, stress, velocity_gradient]}}
"""
STEP = 1e-4
GEOMETRY = {1: "1d", 2: "plane_strain", 3: "3d"}


def pressed(axes, offset, shape, velocity=None, steps=1, step=STEP):
    planes = "".join(far_plane(k, -(50.0 + offset), axes) for k in range(axes))
    return scenes.written("pressed", PRESSED.format(
        geometry=GEOMETRY[axes], shape=shape, planes=planes, step=repr(step),
        end=repr(steps * step), velocity=velocity or "[" + ", ".join(["0 m/s"] * axes) + "]"))


def accelerations(scene, settings):
    """Of each point in the last step, over pressure / (density cell); and places at the start."""
    result = scenes.run(scene, settings)
    shots = schemes.frames(result, "block", ["position", "velocity", "stress"])
    scenes.drop(result)
    (t0, before), (t1, after) = shots[-2:]
    pull = (after["velocity"] - before["velocity"]) / (t1 - t0)
    return pull / numpy.abs(before["stress"][:, :1]).max(), shots


def lattice(axes, many, spacing):
    """A file of points, as a shape: that many along each axis, so far apart."""
    side = (numpy.arange(many) + 0.5) * spacing
    places = numpy.stack(numpy.meshgrid(*[side] * axes, indexing="ij"), -1).reshape(-1, axes)
    path = scenes.written("points", "")
    numpy.savetxt(path, places, delimiter=",", comments="", fmt="%.17g",
                  header=",".join("xyz"[:axes]))
    return f"{{points: {{file: {path}, spacing: {spacing!r} m}}}}"


def patch(axes, offset, settings, spacing=0.5, inner=4.5):
    """Largest acceleration of points farther than `inner` cells from the faces. `spacing`: of the
    points, in cells, which a deformed lattice has any of."""
    many = math.ceil(2 * (inner + 1) / spacing)
    scene = pressed(axes, offset, lattice(axes, many, spacing))
    pull, shots = accelerations(scene, settings)
    place = shots[0][1]["position"][:, :axes]
    mid = ((place > inner) & (place < many * spacing - inner)).all(axis=1)
    return float(numpy.abs(pull[mid]).max())


def stretched(settings, stretch, many=24):
    """As `patch`, of a block in the plane that has flown apart evenly, against hardly any
    pressure, to `stretch` times its size along x."""
    speed = 1e-3
    steps = 200
    step = (stretch - 1) / speed / steps
    scene = pressed(2, 0.13, box(2, 0.0, 0.5 * many), f'["{speed} * x", "0"]', steps, step)
    pull, shots = accelerations(scene, {**settings, "bodies.block.pressure": "1e-9 Pa"})
    place = shots[0][1]["position"][:, :2]
    mid = ((place > 4.0) & (place < 0.5 * many - 4.0)).all(axis=1)
    return float(numpy.abs(pull[mid]).max())


def falls_apart(settings, many=12):
    """Distance of the points, in cells, at which a block that flies apart along x is no longer one
    piece, and into how many it has fallen at 3.2."""
    speed, step = 1e-3, 10.0
    scene = pressed(2, 0.13, box(2, 0.0, 0.5 * many), f'["{speed} * x", "0"]', 540, step)
    result = scenes.run(scene, {
        **settings, "bodies.block.pressure": "1e-12 Pa", "outputs.every": "5400 s",
        "quantities.fragments": f"{{measure: fragments, body: block, every: {step} s}}"})
    times, fragments = result.history("fragments")
    scenes.drop(result)
    return (next((0.5 * (1 + speed * t) for t, n in zip(times, fragments) if n > 1), math.inf),
            int(fragments[-1]))


def beyond_a_face(axes, distance, threshold, settings):
    """A flying block under pressure whose outermost points lie `distance` cells beyond the place,
    in cells from a node, where they begin to touch further nodes. Largest acceleration and
    velocity gradient after a step; change of momentum after ten."""
    many = 16
    offset = threshold + distance - (0.5 * many - 0.25) % 1.0
    scene = pressed(axes, offset, lattice(axes, many, 0.5), "[" + ", ".join(["1 m/s"] * axes) + "]",
                    10)
    result = scenes.run(scene, settings)
    shots = [f for _, f in schemes.frames(result, "block", ["velocity", "velocity_gradient"])]
    change = 0.0
    for k in range(axes):
        before, after = schemes.stored(result, f"momentum_{'xyz'[k]}")
        change = max(change, abs(after / before - 1))
    scenes.drop(result)
    pull = (shots[1]["velocity"] - shots[0]["velocity"]) / STEP
    rate = shots[1]["velocity_gradient"] / STEP
    return {"acceleration": float(numpy.abs(pull).max()), "rate": float(numpy.abs(rate).max()),
            "momentum": change}


def test_patch(offsets, all_axes):
    """Any whole number of points a cell is exact for every shape; any spacing is for domains that
    touch. What the others make of a lattice that does not fit is told."""
    for shape in schemes.SHAPES:
        settings = schemes.scheme(shape)
        for axes in all_axes:
            worst = max(patch(axes, o, settings, s) for o in offsets for s in (0.5, 1 / 3))
            scenes.below(f"patch, {shape}, {axes} axes, 2 and 3 points a cell along each: "
                         "largest inner acceleration", worst, 1e-12)
        worst = max(patch(2, o, settings, s) for o in offsets for s in (0.55, 0.45))
        if shape.startswith("gimp"):
            scenes.below(f"patch, {shape}, points 0.45 and 0.55 cells apart", worst, 1e-12)
        else:
            scenes.note(f"patch, {shape}, points 0.45 and 0.55 cells apart: {worst:.2g}")
        pulled = [stretched(schemes.scheme(shape, order="usl"), s) for s in (1.1, 1.5)]
        scenes.note(f"patch, {shape}, flown apart by 1.1 and 1.5: "
                    + ", ".join(f"{p:.2g}" for p in pulled))
        if shape == "gimp":
            scenes.below(f"patch, {shape}, flown apart by 1.5", pulled[1], 2e-3)


def test_beyond_a_face(powers, all_axes):
    for shape in schemes.SHAPES:
        for axes in all_axes:
            found = [beyond_a_face(axes, 10.0 ** -k, t, schemes.scheme(shape))
                     for k in powers for t in (0.0, 0.25, 0.5)]
            name = f"points 1e-k beyond a face, k to {powers[-1]}, {shape}, {axes} axes"
            scenes.below(f"{name}: acceleration over pressure / (density cell)",
                         max(f["acceleration"] for f in found), 20)
            scenes.below(f"{name}: velocity gradient after a step over that of smooth motion",
                         max(f["rate"] for f in found), 20)
            scenes.below(f"{name}: momentum lost in ten steps",
                         max(f["momentum"] for f in found), 1e-13)


def test_fragments():
    """Neighbours share a node up to so many cells; a block whose points are farther apart is seen
    by the grid as fragments, which the measure counts."""
    for shape, cells in (("linear", 1), ("gimp", 2), ("gimp, fixed", 2), ("quadratic", 2),
                         ("cubic", 3)):
        apart, many = falls_apart(schemes.scheme(shape))
        scenes.report(cells < apart < cells + 0.2 and many > 1,
                      f"flown apart, {shape}: in fragments when points are {apart:.2f} cells apart "
                      f"({cells} to {cells + 0.2}), {many} fragments at 3.2")


def main(fine):
    test_fragments()
    test_patch([i / 20 for i in range(20)] if fine else (0.0, 0.37), (1, 2, 3) if fine else (2,))
    test_beyond_a_face(range(1, 13) if fine else (1, 6, 12), (1, 2, 3) if fine else (3,))


if __name__ == "__main__":
    main(False)
    scenes.done()
