"""Material without strength that flies apart or together, evenly: its volume, the domains of its
points, its size, and what a traction gives it (docs/theory/exact_solutions.md). Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy
import schemes

AXES = {"1d": 1, "plane_strain": 2, "axisymmetric": 2, "3d": 3}
SPACING = 0.5


def bodies(geometry, size, start):
    """A box, or a tube at some distance from the axis; and its lowest corner."""
    axes = AXES[geometry]
    if geometry == "axisymmetric":
        radii = (f"radius: {start + size} m, inner_radius: {start} m" if start else
                 f"radius: {size} m")
        return (f"{{{'tube' if start else 'cylinder'}: {{{radii}, length: {size} m}}}}",
                [start, 0.0])
    corners = (", ".join([f"{x} m"] * axes) for x in (0, size))
    return "{{box: {{min: [{}], max: [{}]}}}}".format(*corners), [0.0] * axes


def flight(geometry, rate, steps, size=12, shape="gimp", start=0, effects="{}"):
    """One second of flight with the velocity rate times place: the result, its last frame."""
    form, lowest = bodies(geometry, size, start)
    speed = ", ".join(f'"{rate} * {k}"' for k in "xyz"[:AXES[geometry]])
    scene = scenes.written("flight", f"""gamut: 1
solver: {{model: material_point_method, geometry: {geometry}, cell: 1 m, step: {1 / steps!r} s,
         end: 1 s}}
materials: {{dust: {{density: 1 kg/m3, eos: {{model: linear, bulk_modulus: 1e-9 Pa}}}}}}
bodies: {{cloud: {{material: dust, shape: {form}, velocity: [{speed}]}}}}
effects: {effects}
quantities:
  size: {{measure: extent, body: cloud, axis: x, every: 0.25 s}}
  push: {{measure: momentum, body: cloud, axis: {"x" if geometry == "1d" else "y"}, every: 0.25 s}}
outputs: {{frames: 1, fields: [volume_ratio]}}
""")
    names = ["position", "volume_ratio"] + ["domain_length"] * (shape == "gimp")
    result = scenes.run(scene, {"solver.shape": shape,
                                "outputs.fields": f"[{', '.join(names[1:])}]"})
    shots = schemes.frames(result, "cloud", names)
    scenes.drop(result)
    axes = AXES[geometry]
    first = shots[0][1]["position"][:, :axes] - numpy.array(lowest)
    middle = (abs(first - 0.5 * size) < 0.25 * size).all(axis=1)
    return result, shots[-1][1], middle


def volume(geometry, rate, shape, steps=100, start=0):
    """Largest relative error of the volume ratio in the middle, and of the edges of domains."""
    _, last, middle = flight(geometry, rate, steps, shape=shape, start=start)
    power = 3 if geometry == "axisymmetric" else AXES[geometry]
    off = abs(last["volume_ratio"][middle] / (1.0 + rate) ** power - 1.0).max()
    if shape != "gimp":
        return off, 0.0
    length = last["domain_length"][middle][:, :AXES[geometry]]
    return off, abs(length / (SPACING * (1.0 + rate)) - 1.0).max()


def extent(geometry, rate, shape):
    """The extent along x over that of the points with half their size at both ends, less 1, and
    over the exact one; the size follows from their volume."""
    size = 6
    result, last, _ = flight(geometry, rate, 100, size=size, shape=shape)
    x, ratio = last["position"][:, 0], last["volume_ratio"]
    half = 0.5 * SPACING * ratio ** (1.0 / AXES[geometry])
    told = result.history("size")[1][-1]
    return told / ((x + half).max() - (x - half).min()) - 1.0, told / (size * (1.0 + rate))


def pulled(geometry, rate, shape):
    """Momentum that a traction gives in a second over the traction times the face's area summed
    over time, and the largest share of the layer that one row of points has."""
    size, depth, traction = 16, 4.0, 1e-7
    along = 0 if geometry == "1d" else 1
    axes = AXES[geometry]
    point, normal, pull = ["0 m"] * axes, ["0"] * axes, ["0 Pa"] * axes
    point[along], normal[along], pull[along] = "1.1 m", "1", f"{traction} Pa"
    effect = (f"{{pull: {{model: boundary, kind: traction, depth: {depth} m, traction: "
              f"[{', '.join(pull)}], plane: {{point: [{', '.join(point)}], "
              f"normal: [{', '.join(normal)}]}}}}}}")
    with_it, _, _ = flight(geometry, rate, 200, size=size, effects=effect, shape=shape)
    without, _, _ = flight(geometry, rate, 200, size=size, shape=shape)
    given = with_it.history("push")[1][-1] - without.history("push")[1][-1]
    end = 1.0 + rate
    # the face's area as a mean over time: 1, size s, pi (size s)^2 with s from 1 to end
    area = {"1d": 1.0, "plane_strain": size * (1.0 + end) / 2,
            "axisymmetric": math.pi * size ** 2 * (1.0 + end + end ** 2) / 3}[geometry]
    return given / (traction * area), SPACING * max(1.0, end) / depth


def test_flows():
    for geometry, start, steps in (("1d", 0, 100), ("plane_strain", 0, 100),
                                   ("axisymmetric", 60, 400)):
        for shape in ("linear", "gimp", "quadratic", "cubic"):
            off, edges = volume(geometry, 1.0, shape, steps, start)
            # musl smooths the velocity once more; in a ring a cell over the radius, squared
            scenes.below(f"material that flies apart to twice its size, {geometry}, {shape}: "
                         "volume "
                         "ratio off by", off, 2e-3 if shape == "linear" else 3e-4)
            if shape == "gimp":
                scenes.below(f"  the same, {geometry}: edges of the points' domains off by", edges,
                             3e-4)
    for geometry, rate in (("1d", 2.0), ("plane_strain", 2.0), ("plane_strain", -0.5),
                           ("axisymmetric", 2.0), ("3d", 2.0)):
        off, whole = extent(geometry, rate, "gimp")
        scenes.below(f"its extent, {1 + rate:g} times, {geometry}, from places and volumes of the "
                     "points: off by", off, 1e-12)
        scenes.note(f"extent over the exact one: {whole:.4f} (faces lag by a part of a cell)")


def test_traction():
    for geometry in ("1d", "plane_strain", "axisymmetric"):
        for rate in (1.0, -0.5):
            share, row = pulled(geometry, rate, "gimp")
            scenes.within(f"traction on material that grows by {1 + rate:g}, {geometry}: impulse",
                          share, 1.0, 0.5 * row)


if __name__ == "__main__":
    test_flows()
    test_traction()
    scenes.done()
