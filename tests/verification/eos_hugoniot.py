"""On the Hugoniot p = rho0 Us up, whatever S1, S2, S3, gamma0, a; there dp/dgamma0 = dp/da = 0."""
import random
from decimal import Decimal

import scenes
from laws import evaluate

TOLERANCE = 1e-12
DRAWS = 60


def shock_speed(c, up):
    """Us from Us = C0 + S1 up + S2 up^2/Us + S3 up^3/Us^2, the first root from below."""
    def gap(us):
        return us - c["C0"] - up * (c["S1"] + up / us * (c["S2"] + up / us * c["S3"]))

    us = c["C0"] + c["S1"] * up
    for _ in range(200):
        h = us * Decimal("1e-25")
        step = gap(us) / ((gap(us + h) - gap(us - h)) / (2 * h))
        us -= step
        if abs(step) < us * Decimal("1e-50"):
            break
    return us


def state(c, up):
    """Compression, energy per reference volume and pressure behind the shock."""
    c, up = {name: Decimal(value) for name, value in c.items()}, Decimal(up)
    us = shock_speed(c, up)
    rho0 = c["reference_density"]
    return up / (us - up), rho0 * up * up / 2, rho0 * us * up


def before_pole(c, mu):
    """D > 0.2 on the whole way: the law holds and the first root is the right one."""
    return all(1 - (c["S1"] - 1) * m - c["S2"] * m * m / (1 + m) - c["S3"] * m ** 3 / (1 + m) ** 2
               > 0.2 for m in (mu * k / 50 for k in range(51)))


def measure(c, up):
    mu, energy, pressure = state(c, up)
    if not before_pole(c, float(mu)):
        return None
    parameters = {name: value for name, value in c.items() if name != "reference_density"}
    at = {"compression": mu, "energy": energy, "reference_density": c["reference_density"]}
    point = evaluate("eos/mie_gruneisen", parameters, at, "--derivatives")
    first = point["derivatives"]["pressure"]
    energy, mu = float(energy), float(mu)
    return (abs(point["outputs"]["pressure"] / float(pressure) - 1.0),
            abs(first["gamma0"]) / energy, abs(first["a"]) / (mu * energy))


def worst_of(draw, count, seed):
    generator = random.Random(seed)
    worst, done = [0.0, 0.0, 0.0], 0
    while done < count:
        figures = measure(*draw(generator.uniform))
        if figures:
            worst = [max(w, f) for w, f in zip(worst, figures)]
            done += 1
    return worst


def any_material(pick):
    return ({"C0": pick(1000, 6000), "S1": pick(0.8, 2.5), "S2": pick(-2, 2), "S3": pick(-1, 1),
             "gamma0": pick(0, 4), "a": pick(0, 3), "reference_density": pick(500, 20000)},
            pick(10, 1500))


def known(pick):
    steel = {"C0": 4569.0, "S1": 1.49, "S2": 0.0, "S3": 0.0, "gamma0": 2.17, "a": 0.46,
             "reference_density": 7830.0}
    copper = {"C0": 3940.0, "S1": 1.489, "S2": 0.0, "S3": 0.0, "gamma0": 2.02, "a": 0.47,
              "reference_density": 8960.0}
    return (steel if pick(0, 1) < 0.5 else copper), pick(25, 1000)


for title, draw, count in (("drawn coefficients", any_material, DRAWS),
                           ("steel and copper", known, DRAWS // 3)):
    told = worst_of(draw, count, 3)
    scenes.below(f"{title}, {count} shocks: p against rho0 Us up, relative", told[0], TOLERANCE)
    scenes.below(f"{title}: dp/dgamma0 over energy", told[1], TOLERANCE)
    scenes.below(f"{title}: dp/da over energy times compression", told[2], TOLERANCE)
scenes.done()
