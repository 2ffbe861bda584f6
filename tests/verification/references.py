"""Exact and independent solutions: shocks, an elastic-plastic plate, Sod's tube."""
import math

import numpy

COPPER = {"name": "copper", "density": 8960.0, "C0": 3940.0, "S1": 1.489, "gamma0": 2.02, "a": 0.47,
          "G": 47.27e9}
STEEL = {"name": "steel_4340", "density": 7830.0, "C0": 4569.0, "S1": 1.49, "gamma0": 2.17,
         "a": 0.46, "G": 81.8e9}


def hugoniot(metal, impact):
    """Symmetric impact without strength: shock speed, pressure."""
    up = 0.5 * impact
    speed = metal["C0"] + metal["S1"] * up
    return speed, metal["density"] * speed * up


def eos(metal, ratio):
    """Mie-Gruneisen as p = f + g e, at a volume ratio: f, g and bulk modulus at e = 0 roughly."""
    mu = 1.0 / ratio - 1.0
    stiffness = metal["density"] * metal["C0"] ** 2
    slope = metal["gamma0"] + metal["a"] * mu
    above = 1.0 + (1.0 - 0.5 * metal["gamma0"]) * mu - 0.5 * metal["a"] * mu**2
    squeezed = (stiffness * mu * above
                / (1.0 - (metal["S1"] - 1.0) * mu) ** 2)
    return numpy.where(mu > 0.0, squeezed, stiffness * mu), slope


def root(function, low, high):
    """By bisection."""
    sign = function(low) < 0.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        if (function(middle) < 0.0) == sign:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def elastic_plastic_impact(metal, yield_stress, impact):
    """Symmetric impact of a perfectly plastic metal: the precursor (a shock to the yield point) and
    the plastic shock behind it, by the jump conditions. All speeds in the laboratory."""
    density = metal["density"]
    ratio = math.exp(-0.5 * yield_stress / metal["G"])

    def stress_at(volume, stress, v, e):
        # Longitudinal stress behind a shock, compression positive: e by the energy jump.
        f, g = eos(metal, volume)
        part = 0.5 * (v - volume)
        return (f + g * (e + part * stress) + 2.0 / 3.0 * yield_stress) / (1.0 - g * part)

    precursor = float(stress_at(ratio, 0.0, 1.0, 0.0))
    speed = math.sqrt(precursor / (density * (1.0 - ratio)))
    up = precursor / (density * speed)
    energy = 0.5 * precursor * (1.0 - ratio)

    def velocity(volume):
        stress = stress_at(volume, precursor, ratio, energy)
        return up + math.sqrt((stress - precursor) * (ratio - volume) / density) - 0.5 * impact

    volume = root(velocity, 0.5, ratio - 1e-9)
    stress = float(stress_at(volume, precursor, ratio, energy))
    run = math.sqrt((stress - precursor) / (density * (ratio - volume)))  # into the material
    return {"precursor_stress": precursor, "precursor_speed": speed, "precursor_velocity": up,
            "plateau_stress": stress, "plastic_speed": up + run * ratio}


def plates(metal, yield_stress, impact, cells, end, thickness=0.01, samples=400):
    """The same impact on a Lagrangian grid (von Neumann and Richtmyer 1950, Wilkins 1964), cells a
    plate: times, and the velocity of the target's free surface."""
    n = 2 * cells
    h = thickness / cells
    density = metal["density"]
    x = numpy.linspace(-thickness, thickness, n + 1)
    v = numpy.where(x < -1e-12, impact, 0.0)
    v[cells] = 0.5 * impact
    mass = density * h * numpy.ones(n + 1)
    mass[0] = mass[-1] = 0.5 * density * h
    ratio, s, e, q = numpy.ones(n), numpy.zeros(n), numpy.zeros(n), numpy.zeros(n)
    p = numpy.zeros(n)
    fastest = math.sqrt(metal["C0"] ** 2 + 4.0 / 3.0 * metal["G"] / density) * 1.3
    steps = int(end / (0.3 * h / fastest)) + 1
    dt = end / steps
    times, speeds = [], []
    for step in range(steps):
        stress = s - p - q
        v[1:-1] += dt * (stress[1:] - stress[:-1]) / mass[1:-1]
        v[0] += dt * stress[0] / mass[0]
        v[-1] -= dt * stress[-1] / mass[-1]
        x += dt * v
        old, ratio = ratio, (x[1:] - x[:-1]) / h
        strain = numpy.log(ratio / old)
        trial = s + 4.0 / 3.0 * metal["G"] * strain
        limit = 2.0 / 3.0 * yield_stress
        new = numpy.clip(trial, -limit, limit)
        jump = v[1:] - v[:-1]
        viscous = numpy.where(jump < 0.0, density / ratio * (
            2.0 * jump**2 + 0.2 * fastest * numpy.abs(jump)), 0.0)
        f, g = eos(metal, ratio)
        dv = ratio - old
        e0 = e + 0.5 * (s + new) * dv - 0.5 * (p + q + viscous) * dv
        e = (e0 - 0.5 * f * dv) / (1.0 + 0.5 * g * dv)
        p, s, q = f + g * e, new, viscous
        if step % max(1, steps // samples) == 0:
            times.append((step + 1) * dt)
            speeds.append(v[-1])
    return numpy.array(times), numpy.array(speeds)


class Sod:
    """Sod's tube, gamma 1.4, diaphragm at 0.5 m (Riemann problem; Toro 2009, chapter 4)."""

    gamma, pressure, velocity = 1.4, 0.30313017805063314, 0.9274526200489447
    left, right, shock = 0.42631942817848145, 0.2655737117052997, 1.7521557320301404
    head, tail = -1.1832159566199232, -0.07027281256118212

    def at(self, x, time):
        """Density, velocity, pressure."""
        g, xi = self.gamma, (numpy.asarray(x) - 0.5) / time
        c = math.sqrt(g)
        fan = 2.0 / (g + 1.0) - (g - 1.0) / (g + 1.0) / c * numpy.clip(xi, self.head, self.tail)
        areas = [xi < self.head, xi < self.tail, xi < self.velocity, xi < self.shock]
        density = numpy.select(areas, [1.0, fan ** (2.0 / (g - 1.0)), self.left, self.right], 0.125)
        speed = numpy.select(areas, [0.0, 2.0 / (g + 1.0) * (c + xi), self.velocity, self.velocity],
                             0.0)
        pressure = numpy.select(areas, [1.0, fan ** (2.0 * g / (g - 1.0)), self.pressure,
                                        self.pressure], 0.1)
        return density, speed, pressure
