"""Transfers without forces against the same written as matrices, and the length of steps against
its formula (docs/theory/exact_solutions.md). Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy
import schemes

CELLS, POINTS, STEPS, STEP = 12, 2, 4, 1e-9


def weights(shape, x, nodes, reach=0.25):
    """Weights of the nodes at the points, cells of length 1: rows are points."""
    far = numpy.abs(x[:, None] - nodes[None, :])
    if shape == "linear":
        return numpy.maximum(1.0 - far, 0.0)
    if shape == "gimp":  # the linear function averaged over the point's domain
        def integral(d):
            inner = numpy.clip(d, -1.0, 1.0)
            return inner - numpy.sign(inner) * inner ** 2 / 2.0
        off = x[:, None] - nodes[None, :]
        return (integral(off + reach) - integral(off - reach)) / (2.0 * reach)
    if shape == "quadratic":
        return numpy.where(far <= 0.5, 0.75 - far ** 2, numpy.maximum(1.5 - far, 0.0) ** 2 / 2.0)
    return numpy.where(far <= 1.0, 2.0 / 3.0 - far ** 2 + far ** 3 / 2.0,
                       numpy.maximum(2.0 - far, 0.0) ** 3 / 6.0)


def expected(shape, transfer, velocity, x):
    """Velocity of the points after STEPS steps in which nothing moves."""
    nodes = numpy.arange(-3, CELLS + 4, dtype=float)
    n = weights(shape, x, nodes)
    mass = n.sum(axis=0)
    seen = mass > 1e-9
    n, nodes, mass = n[:, seen], nodes[seen], mass[seen]
    away = nodes[None, :] - x[:, None]
    second = (n * away ** 2).sum(axis=1)
    words = transfer.split()
    v, slope = velocity.copy(), numpy.zeros_like(velocity)
    for _ in range(STEPS):
        u = (n * (v[:, None] + slope[:, None] * away)).sum(axis=0) / mass
        if words[0] == "flip,":
            v = (1.0 - float(words[2])) * v + float(words[2]) * (n @ u)
        elif words[0] == "pic":
            v = n @ u
        elif words[0] == "apic":
            v, slope = n @ u, (n * away) @ u / second
        elif words[0] == "xpic":
            # (1 - (1 - A)^m) v, with A from points to nodes and back
            matrix = n @ (n / mass).T
            rest = numpy.eye(len(v)) - matrix
            v = v - numpy.linalg.matrix_power(rest, int(words[1])) @ v
    return v


def found(shape, transfer):
    """The same in the program, of a bar with a velocity that no grid shows whole."""
    velocity = "1 + sin(0.9 * x) + 0.3 * sin(6.283185307179586 * x) + 0.2 * x"
    scene = scenes.written("transfer", f"""gamut: 1
solver: {{model: material_point_method, geometry: 1d, cell: 1 m, step: {STEP!r} s,
         end: {STEPS * STEP!r} s}}
materials: {{dust: {{density: 1 kg/m3, eos: {{model: linear, bulk_modulus: 1e-9 Pa}}}}}}
bodies: {{bar: {{material: dust, shape: {{box: {{min: [0 m], max: [{CELLS} m]}}}},
         velocity: ["{velocity}"]}}}}
outputs: {{frames: 1, fields: [velocity]}}
""")
    result = scenes.run(scene, schemes.scheme(shape, transfer, "usl"))
    shots = schemes.frames(result, "bar", ["position", "velocity"])
    scenes.drop(result)
    x = shots[0][1]["position"][:, 0]
    start = 1 + numpy.sin(0.9 * x) + 0.3 * numpy.sin(2 * math.pi * x) + 0.2 * x
    return x, start, shots[-1][1]["velocity"][:, 0]


def steps_taken(end, courant, speed):
    """Steps of an elastic bar that flies, and at the end its step by the formula."""
    scene = scenes.written("steps", f"""gamut: 1
solver: {{model: material_point_method, geometry: 1d, cell: 1 mm, courant: {courant},
         end: {end!r} s}}
materials:
  metal: {{density: 8000 kg/m3, eos: {{model: linear, bulk_modulus: 140 GPa}},
          elasticity: {{model: hypoelastic, shear_modulus: 48 GPa}}}}
bodies: {{bar: {{material: metal, shape: {{box: {{min: [0 mm], max: [10 mm]}}}},
         velocity: [{speed} m/s]}}}}
""")
    result = scenes.run(scene)
    scenes.drop(result)
    sound = math.sqrt((140e9 + 4.0 / 3.0 * 48e9) / 8000.0)
    return result.summary["cost"]["steps"], courant * 1e-3 / (sound + speed)


def test_transfers():
    for shape in ("linear", "gimp", "quadratic", "cubic"):
        for transfer in ("flip, pic 0.01", "pic", "apic", "xpic 2", "xpic 3", "xpic 4", "xpic 5"):
            if not schemes.allowed(shape, transfer):
                continue
            x, start, last = found(shape, transfer)
            exact = expected(shape, transfer, start, x)
            # places move by a few 1e-9 of a cell, slopes of weights are below 1
            scenes.below(f"{shape}, {transfer}: velocities after {STEPS} steps against matrices",
                         numpy.abs(last - exact).max(), 1e-7)


def test_steps():
    for courant in (0.5, 0.2):
        for speed in (0.0, 2000.0):
            (many, length), (few, _) = (steps_taken(end, courant, speed) for end in (1e-4, 5e-5))
            scenes.report(abs((many - few) - 5e-5 / length) <= 2.0,
                          f"courant {courant}, bar at {speed:g} m/s: {many - few} steps in 50 us, "
                          f"by the formula {5e-5 / length:.1f} (allowed 2 more or less)")


if __name__ == "__main__":
    test_transfers()
    test_steps()
    scenes.done()
