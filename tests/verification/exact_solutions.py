"""Whole runs against closed forms (docs/theory/exact_solutions.md): shells and bars that breathe,
collapse, ring, fly apart and are pulled; matter that tears, and that is heated while it is pressed.
Prints TAP."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy
import exact_flows
import schemes
from exact_references import (Elastic, breathing, collapse, collapse_strain, pochhammer,
                              pochhammer_mode)
from laws import drive, linear_eos, material, rows, von_mises

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


# ---- a point that tears, a point that is heated --------------------------------------------------

def torn(steps, shear=0.05, swell=0.01):
    """Sheared and pulled apart after it has torn in its first step: the internal energy that it
    gains over the work of shear that was taken back in all steps."""
    card = material(linear_eos(SOLID.bulk), None, SOLID.shear, SOLID.density)
    control = {c: {"log_strain": swell / 3.0} for c in ("xx", "yy", "zz")}
    control["xy"] = {"velocity_gradient": f"{shear} 1/s"}
    found = drive(card, control, 1.0, steps, final=["energy", "spalled"],
                  effects={"tear": {"model": "spall", "limit": "1 Pa"}})
    # each step begins without a deviator: G gamma^2 / 2 of the strain of that step alone
    work = steps * 0.5 * SOLID.shear * (shear / steps) ** 2
    return found["energy"] / work, found["spalled"], (shear + swell) / steps


def tears(steps, shear=2e-3, limit=1e9):
    """Elastically sheared, then pulled until it tears, and further: internal energy over the strain
    energy that it had when it tore; and how much the last step alone can add."""
    card = material(linear_eos(SOLID.bulk), None, SOLID.shear, SOLID.density)
    most = 2.0 * limit / SOLID.bulk
    control = {c: {"log_strain": rows([(0, 0), (1, 0), (2, most / 3.0)], "")}
               for c in ("xx", "yy", "zz")}
    control["xy"] = {"velocity_gradient": rows([(1, shear), (1, 0.0)], "1/s")}
    found = drive(card, control, 2.0, steps, final=["energy", "spalled"],
                  effects={"tear": {"model": "spall", "limit": f"{limit!r} Pa"}})
    ratio = 1.0 / (1.0 - limit / SOLID.bulk)  # where p = K (1 / J - 1) is - limit
    held = 0.5 * SOLID.shear * shear ** 2 + SOLID.bulk * (ratio - 1.0 - math.log(ratio))
    return found["energy"] / held, found["spalled"], limit * 2.0 * most / steps / held


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


# ---- contact on the axis -------------------------------------------------------------------------

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


def test_flows(shapes=tuple(schemes.SHAPES)):
    for geometry, start, steps in (("1d", 0, 100), ("plane_strain", 0, 100),
                                   ("axisymmetric", 60, 400)):
        for shape in ("linear", "gimp", "quadratic", "cubic"):
            off, edges = exact_flows.volume(geometry, 1.0, shape, steps, start)
            # musl smooths the velocity once more; in a ring a cell over the radius, squared
            scenes.below(f"matter that flies apart to twice its size, {geometry}, {shape}: volume "
                         "ratio off by", off, 2e-3 if shape == "linear" else 3e-4)
            if shape == "gimp":
                scenes.below(f"  the same, {geometry}: edges of the points' domains off by", edges,
                             3e-4)
    for geometry, rate in (("1d", 2.0), ("plane_strain", 2.0), ("plane_strain", -0.5),
                           ("axisymmetric", 2.0), ("3d", 2.0)):
        off, whole = exact_flows.extent(geometry, rate, "gimp")
        scenes.below(f"its extent, {1 + rate:g} times, {geometry}, from places and volumes of the "
                     "points: off by", off, 1e-12)
        scenes.note(f"extent over the exact one: {whole:.4f} (faces lag by a part of a cell)")


def test_traction():
    for geometry in ("1d", "plane_strain", "axisymmetric"):
        for rate in (1.0, -0.5):
            share, row = exact_flows.pulled(geometry, rate, "gimp")
            scenes.within(f"traction on matter that grows by {1 + rate:g}, {geometry}: impulse",
                          share, 1.0, 0.5 * row)


def test_points():
    for steps in (50, 100):
        share, gone, strain = torn(steps)
        scenes.below(f"torn matter sheared on in {steps} steps: energy gained over the work of its "
                     "shear", share, strain)
    energy, gone, last = tears(400)
    scenes.within("matter that tears keeps the strain energy that it had, and no more", energy, 1.0,
                  last)
    scenes.report(gone == 1.0, "  and has torn")
    for squeeze in (-0.5, 0.4):
        rises = [heated(n, squeeze) for n in (100, 200)]
        scenes.within(f"plastic heat at a volume ratio of {math.exp(squeeze):.3f}", rises[1][0],
                      1.0, 1e-5)
        scenes.note(f"without the volume ratio it would be {rises[1][0] / rises[1][1]:.4f}")
    for shape in ("linear", "gimp", "quadratic", "cubic"):
        scenes.within(f"a wall touched on the axis alone, {shape}: area", on_axis(shape), 1.0, 0.02)


def main(fine):
    test_points()
    test_flows()
    test_traction()
    test_collapse((32, 16) if fine else (16, 8))
    test_waves((8, 16, 32) if fine else (4, 8, 16))


if __name__ == "__main__":
    main(False)
    scenes.done()
