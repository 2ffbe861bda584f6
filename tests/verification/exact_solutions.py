"""Shells that breathe and collapse, and a bar that rings, against closed forms
(docs/theory/exact_solutions.md). Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy
import schemes
from exact_references import (Elastic, breathing, collapse, collapse_strain, pochhammer,
                              pochhammer_mode)

SOLID = Elastic(8000.0, 140e9, 48e9)
CARD = """
materials:
  metal:
    density: 8000 kg/m3
    eos: {model: linear, bulk_modulus: 140 GPa}
    elasticity: {model: hypoelastic, shear_modulus: 48 GPa}
"""
INNER, OUTER = 4e-3, 8e-3


def polynomial(coefficients, variable):
    """Horner's scheme as text, highest power first."""
    text = repr(float(coefficients[0]))
    for c in coefficients[1:]:
        text = f"({text}) * {variable} + {float(c)!r}"
    return f"({text})"


def symmetry(name, along, place, sign, axes=2):
    point, normal = ["0 m"] * axes, ["0"] * axes
    point[along], normal[along] = f"{place!r} m", str(sign)
    return (f"  {name}: {{model: boundary, kind: symmetry, "
            f"plane: {{point: [{', '.join(point)}], normal: [{', '.join(normal)}]}}}}\n")


def shell(curved, length):
    """A tube, or a whole sphere around the origin."""
    if curved == 1:
        return (f"{{tube: {{radius: {OUTER!r} m, inner_radius: {INNER!r} m, "
                f"length: {length!r} m}}}}")
    return (f"{{difference: {{from: {{sphere: {{radius: {OUTER!r} m}}}}, "
            f"remove: [{{sphere: {{radius: {INNER!r} m}}}}]}}}}")


def around_axis(cell, end, shape, velocity, extra="", planes="", card=CARD):
    effects = f"effects:\n{planes}" if planes else ""
    return scenes.written("exact", f"""gamut: 1
solver: {{model: material_point_method, geometry: axisymmetric, cell: {cell!r} m, end: {end!r} s}}
{card}
bodies: {{body: {{material: metal, shape: {shape}, velocity: {velocity}}}}}
{effects}quantities:
  kinetic: {{measure: kinetic_energy, body: body, every: {end / 400!r} s}}
{extra}""")


# ---- waves --------------------------------------------------------------------------------------

def frequency(times, energy, guess):
    """Circular frequency of a kinetic energy that swings as 1 + cos 2 w t: the least residual."""
    times, energy = numpy.array(times), numpy.array(energy)

    def residual(omega):
        basis = numpy.stack([numpy.ones_like(times), numpy.cos(2 * omega * times),
                             numpy.sin(2 * omega * times)], axis=1)
        fit = numpy.linalg.lstsq(basis, energy, rcond=None)[0]
        return ((basis @ fit - energy) ** 2).sum()

    best, width = guess, 0.1
    while width > 1e-7:
        tried = best * (1.0 + width * numpy.linspace(-1.0, 1.0, 21))
        best = tried[numpy.argmin([residual(w) for w in tried])]
        width *= 0.2
    return best


def breathe(curved, cells, settings=None):
    """A hollow cylinder or sphere in its first radial mode, `cells` in its wall, for two periods:
    frequency over the exact one."""
    omega, mode = breathing(SOLID, INNER, OUTER, curved)
    cell, middle, half = (OUTER - INNER) / cells, 0.5 * (OUTER + INNER), 0.5 * (OUTER - INNER)
    radius = "x" if curved == 1 else "sqrt(x * x + y * y)"
    over = polynomial(0.1 / OUTER * mode / numpy.polyval(mode, 1.0),
                      f"(({radius} - {middle!r}) / {half!r})")
    speed = f'["{over} * x", "{0 if curved == 1 else over + " * y"}"]'
    length = 4 * cell
    planes = "" if curved == 2 else (symmetry("low", 1, 0.0, 1) + symmetry("high", 1, length, -1))
    scene = around_axis(cell, 4 * math.pi / omega, shell(curved, length), speed, planes=planes)
    result = scenes.run(scene, settings or {})
    scenes.drop(result)
    return frequency(*result.history("kinetic"), omega) / omega


def ring_of_bar(cells, settings=None, number=1.5):
    """Half a wave of the first longitudinal mode of a round bar, `cells` in its radius: frequency
    over that of Pochhammer and Chree. `number`: wave number times radius."""
    radius, cell = 1e-3, 1e-3 / cells
    length = round(math.pi * radius / number / cell) * cell
    k = math.pi / length
    omega, radial, axial = pochhammer_mode(SOLID, radius, k)
    scale = 0.1 / abs(axial[0])
    wide, along = (polynomial(scale * c[::-1], "(x * x)") for c in (radial, axial))
    speed = f'["{wide} * x * cos({k!r} * y)", "{along} * sin({k!r} * y)"]'
    scene = around_axis(cell, 4 * math.pi / omega,
                        f"{{cylinder: {{radius: {radius!r} m, length: {length!r} m}}}}", speed,
                        planes=symmetry("low", 1, 0.0, 1) + symmetry("high", 1, length, -1))
    result = scenes.run(scene, settings or {})
    scenes.drop(result)
    return frequency(*result.history("kinetic"), omega) / omega


# ---- collapse -----------------------------------------------------------------------------------

YIELD = 100e6
PLASTIC = CARD + "    strength: {model: von_mises, yield_stress: 100 MPa}\n"


def collapses(curved, cells, settings=None):
    """A plastic hollow cylinder or sphere thrown inwards, `cells` in its wall: how far the flow
    goes and how it strains, over what the closed form has."""
    speed = 90.0 if curved == 1 else 100.0
    time, stopped, _ = collapse(SOLID.density, YIELD, INNER, OUTER, curved, speed)
    cell = (OUTER - INNER) / cells
    flow = speed * INNER ** curved
    if curved == 1:
        velocity = f'["{-flow!r} / x", "0"]'
    else:
        velocity = "[" + ", ".join(f'"{-flow!r} * {k} / (x * x + y * y) ^ 1.5"' for k in "xy") + "]"
    length = 4 * cell
    planes = "" if curved == 2 else (symmetry("low", 1, 0.0, 1) + symmetry("high", 1, length, -1))
    scene = around_axis(cell, 1.5 * time, shell(curved, length), velocity,
                        "outputs: {frames: 1, fields: [plastic_strain]}", planes, PLASTIC)
    result = scenes.run(scene, settings or {})
    shots = schemes.frames(result, "body", ["position", "plastic_strain"])
    scenes.drop(result)
    first, last = (numpy.hypot(*f["position"].T[:2]) if curved == 2 else f["position"][:, 0]
                   for _, f in (shots[0], shots[-1]))
    n = curved + 1
    inner = (INNER ** n + ((last ** n - first ** n)).mean()) ** (1 / n)
    strain, exact = shots[-1][1]["plastic_strain"], collapse_strain(first, INNER, stopped, curved)
    times, kinetic = result.history("kinetic")
    return {"way": (INNER - inner) / (INNER - stopped),
            "strain": (strain * first).sum() / (exact * first).sum(),
            "apart": math.sqrt(((strain - exact) ** 2).sum() / (exact ** 2).sum()),
            "stopped": stopped, "left": min(kinetic) / kinetic[0]}


# ---- what is held to what ------------------------------------------------------------------------

WALL = {1: "hollow cylinder", 2: "hollow sphere"}


def test_waves(cells, shapes=("gimp", "quadratic")):
    """A stepped face is off by a part of a cell; a straight one, and motion, by its square."""
    for shape in shapes:
        settings = {"solver.shape": shape}
        for curved, least, grids in ((1, 1.8, cells), (2, 1.0, cells[:-1])):
            off = [breathe(curved, n, settings) - 1.0 for n in grids]
            order = math.log2(off[-2] / off[-1]) if off[-2] * off[-1] > 0.0 else math.inf
            name = f"breathing {WALL[curved]}, {shape}"
            told = ", ".join(f"{100 * o:+.3f} %" for o in off)
            scenes.report(order >= least, f"{name}: frequency off by {told} with "
                                          f"{', '.join(map(str, grids))} cells in the wall, order "
                                          f"{order:.2f} (at least {least})")
            # that of a thin rod or string of so many cells a half wave: (pi / 2 n)^2 / 6
            limit = (math.pi / (2 * grids[-1])) ** 2 / 6 if curved == 1 else 0.1 / grids[-1]
            scenes.below(f"{name}: frequency off by", off[-1], limit)
        off = [ring_of_bar(n, settings) - 1.0 for n in cells]
        scenes.report(math.log2(off[-2] / off[-1]) >= 1.8,
                      f"bar by Pochhammer and Chree, {shape}: frequency off by "
                      + ", ".join(f"{100 * o:+.3f} %" for o in off)
                      + f" with {', '.join(map(str, cells))} cells in the radius, order "
                      f"{math.log2(off[-2] / off[-1]):.2f} (at least 1.8)")
        scenes.below(f"bar by Pochhammer and Chree, {shape}: extrapolated",
                     off[-1] + (off[-1] - off[-2]) / 3.0, 2e-3)


def test_collapse(cells):
    for curved, n, allowed in ((1, cells[0], 0.015), (2, cells[1], 0.03)):
        found = collapses(curved, n)
        name = f"collapsing {WALL[curved]}, {n} cells in the wall"
        scenes.within(f"{name}: way of its inner face", found["way"] * (INNER - found["stopped"]),
                      INNER - found["stopped"], allowed, "mm", 1e-3)
        scenes.within(f"{name}: plastic strain, mean", found["strain"], 1.0, allowed)
        scenes.below(f"{name}: plastic strain of all points, off by", found["apart"], 2 * allowed)
        scenes.below(f"{name}: kinetic energy left when it stops", found["left"], 1e-3)


def main(fine):
    test_collapse((32, 16) if fine else (16, 8))
    test_waves((8, 16, 32) if fine else (4, 8, 16))


if __name__ == "__main__":
    main(False)
    scenes.done()
