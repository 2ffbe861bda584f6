"""A vibrating bar, a standing wave kept for ten periods, and Sod's tube. Prints TAP."""
import math

import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy
from references import Sod

OMEGA, AMPLITUDE = 0.628318530717958648, 0.0636619772367581343

STANDING_WAVE = """gamut: 1
title: Standing wave between two fixed ends, half a wavelength long
solver:
  model: material_point_method
  geometry: 1d
  cell: {cell} m
  shape: {shape}
  stress_update: {order}
  courant: 0.1
  end: 100 s
materials:
  bar:
    density: 1 kg/m3
    eos: {{model: linear, youngs_modulus: 100 Pa, poissons_ratio: 0}}
    elasticity: {{model: hypoelastic, youngs_modulus: 100 Pa, poissons_ratio: 0}}
bodies:
  bar:
    material: bar
    shape: {{box: {{min: [0 m], max: [50 m]}}}}
    velocity: ["0.001 * sin(3.14159265358979324 * x / 50)"]
effects:
  left: {{model: boundary, kind: fixed, plane: {{point: [0 m], normal: [1]}}}}
  right: {{model: boundary, kind: fixed, plane: {{point: [50 m], normal: [-1]}}}}
quantities:
  kinetic: {{measure: kinetic_energy, body: bar}}
  internal: {{measure: internal_energy, body: bar}}
outputs: {{every: 50 s, fields: [velocity]}}
"""
# Energy kept after ten periods, CPDI with FLIP, by cells a wavelength (an independent program).
KEPT_CPDI = {8: 0.5767002028769428, 16: 0.9279904370949137, 32: 0.9830927524013531}


def fitted(times, values):
    """Frequency and amplitude of the harmonic that fits best."""
    times, values = numpy.asarray(times), numpy.asarray(values)

    def misfit(omega):
        parts = numpy.column_stack([numpy.cos(omega * times), numpy.sin(omega * times)])
        share = numpy.linalg.lstsq(parts, values, rcond=None)[0]
        return float(((parts @ share - values) ** 2).sum()), float(numpy.hypot(*share))

    low, high = 0.95 * OMEGA, 1.05 * OMEGA
    for _ in range(80):
        third = (high - low) / 3.0
        if misfit(low + third)[0] < misfit(high - third)[0]:
            high -= third
        else:
            low += third
    return 0.5 * (low + high), misfit(0.5 * (low + high))[1]


def vibrating(cell, shape="quadratic", order="auto"):
    """Frequency, amplitude, and change of energy a period, over two periods."""
    result = scenes.run("vibrating_bar", {
        "solver.cell": f"{cell} m", "solver.shape": shape, "solver.stress_update": order,
        "quantities.internal": "{measure: internal_energy, body: bar}"})
    omega, amplitude = fitted(*result.history("mean_velocity"))
    energy = [k + i for k, i in zip(result.history("kinetic_energy")[1],
                                    result.history("internal")[1])]
    return {"omega": omega / OMEGA - 1.0, "amplitude": amplitude / AMPLITUDE - 1.0,
            "energy": (energy[-1] / energy[0] - 1.0) / 2.0}


def kept(cells, shape, order):
    """Energy after ten periods over that at the start, `cells` a wavelength of 100 m."""
    result = scenes.run(scenes.written("standing_wave", STANDING_WAVE.format(
        cell=100.0 / cells, shape=shape, order=order)))
    kinetic, internal = result.history("kinetic")[1], result.history("internal")[1]
    return (kinetic[-1] + internal[-1]) / (kinetic[0] + internal[0])


def sod(cell, changes=None):
    """Norms of the errors (density, velocity, pressure), and the plateaus over the exact ones."""
    fields = "{every: 0.1 s, fields: [velocity, pressure, density, mass]}"
    result = scenes.run("sod", {"solver.cell": f"{cell} mm", "outputs": fields, **(changes or {})})
    exact = Sod()
    with h5py.File(result.file("results.h5"), "r") as file:
        frame = file["frames"][sorted(file["frames"])[-1]]

        def both(name):
            parts = [frame[body][name][...] for body in ("left", "right")]
            return numpy.concatenate([p[:, 0] if p.ndim > 1 else p for p in parts])

        x, found = both("position"), [both(n) for n in ("density", "velocity", "pressure")]
        volume = both("mass") / found[0]
    norms = [float((numpy.abs(a - b) * volume).sum())
             for a, b in zip(found, exact.at(x, 0.2))]
    targets = {"plateau_pressure": exact.pressure, "plateau_velocity": exact.velocity,
               "density_left": exact.left, "density_right": exact.right,
               "shock_speed": exact.shock}
    return norms, {name: result.value(name) / target - 1.0 for name, target in targets.items()}


def test_vibrating():
    for shape, cell in (("quadratic", 0.5), ("quadratic", 1.25), ("linear", 1.25)):
        found = vibrating(cell, shape)
        name = f"vibrating bar, {shape}, {25.0 / cell:g} cells"
        scenes.below(f"{name}: frequency off", found["omega"], 0.003)
        scenes.below(f"{name}: amplitude off", found["amplitude"], 0.003)
        scenes.below(f"{name}: energy a period", found["energy"], 0.01)
    coarse, fine = vibrating(2.5)["omega"], vibrating(1.25)["omega"]
    order = math.log2(abs(coarse / fine))
    scenes.report(order > 1.8, f"vibrating bar: frequency converges with order {order:.2f} "
                               "(at least 1.8)")


def test_kept():
    for cells in (16, 32):
        for shape in ("quadratic", "linear"):
            value, cpdi = kept(cells, shape, "usl"), KEPT_CPDI[cells]
            scenes.report(abs(value / cpdi - 1.0) <= 0.03,
                          f"standing wave, flip, usl, {shape}, {cells} cells a wavelength: keeps "
                          f"{value:.4f} of its energy in ten periods (CPDI {cpdi:.4f}, 3 %)")
        value = kept(cells, "quadratic", "musl")
        scenes.report(abs(value - 1.0) <= 0.1,
                      f"standing wave, flip, musl, quadratic, {cells} cells a wavelength: keeps "
                      f"{value:.4f} (within 1 % a period)")


def test_sod():
    grids = [sod(cell) for cell in (5.0, 2.5, 1.25)]
    for name, off in grids[0][1].items():
        scenes.below(f"Sod, 200 cells, {name}: off by", off, 0.01)
    for i, name in enumerate(("density", "velocity", "pressure")):
        orders = [math.log2(grids[k][0][i] / grids[k + 1][0][i]) for k in (0, 1)]
        scenes.report(min(orders) >= 0.8,
                      f"Sod, L1 norm of {name}: {grids[0][0][i]:.5f}, {grids[1][0][i]:.5f}, "
                      f"{grids[2][0][i]:.5f} at 200, 400, 800 cells, orders "
                      f"{orders[0]:.2f}, {orders[1]:.2f} (at least 0.8)")


if __name__ == "__main__":
    test_vibrating()
    test_kept()
    test_sod()
    scenes.done()
