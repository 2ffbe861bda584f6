"""Energy and pressure together: an eos that is not linear in energy; cycles that must close."""
import math
import os
from decimal import Decimal

import made
import scenes
from laws import apart, drive, eliminate, linear_eos, material, order, rows, von_mises

CONSISTENT = 1e-12
G = 80e9
K, GAMMA, CURVE = 160e9, 2.0, 4e-10
COMPONENTS = ("xx", "yy", "zz")
NAMES = ["energy", "volume_ratio", "pressure", "work", *(f"stress_{c}" for c in COMPONENTS),
         *(("log_strain", c) for c in COMPONENTS)]
EOS = {"model": "quadratic_energy", "K": f"{K!r} Pa", "g": GAMMA, "q": f"{CURVE!r} 1/Pa"}


def build():
    """Builds the eos as a stranger would; returns the folder of plugins."""
    source = os.path.join(scenes.TREE, "tests/plugins/eos/quadratic_energy/quadratic_energy")
    with open(source + ".yaml", encoding="utf-8") as described, \
            open(source + ".c", encoding="utf-8") as code:
        return made.plugin("eos/quadratic_energy", described.read(), code.read())


def pressure(mu, e):
    return K * mu + GAMMA * e + CURVE * e * e


def middle(strain):
    return 2.0 * math.tanh(strain / 2.0)


# ---- from the histories -------------------------------------------------------------------------

def deviatoric_work(run, i):
    """Of step i, per reference volume, with the mean deviator."""
    h = [middle(run[f"log_strain_{c}"][i] - run[f"log_strain_{c}"][i - 1]) for c in COMPONENTS]
    mean = [0.5 * (run[f"stress_{c}"][i] + run["pressure"][i] + run[f"stress_{c}"][i - 1]
                   + run["pressure"][i - 1]) for c in COMPONENTS]
    average = sum(h) / 3
    J = 0.5 * (run["volume_ratio"][i] + run["volume_ratio"][i - 1])
    return J * sum(s * (x - average) for s, x in zip(mean, h))


def consistency(run):
    """Pressure from the point's compression and energy; energy from the balance of each step."""
    p, e, J = run["pressure"], run["energy"], run["volume_ratio"]
    largest_p, largest_e = max(map(abs, p)), max(map(abs, e))
    off_p = max(abs(p[i] - pressure(1.0 / J[i] - 1.0, e[i])) for i in range(len(p)))
    off_e = 0.0
    for i in range(1, len(e)):
        balance = e[i - 1] - 0.5 * (p[i] + p[i - 1]) * (J[i] - J[i - 1]) + deviatoric_work(run, i)
        off_e = max(off_e, abs(e[i] - balance))
    return off_p / largest_p, off_e / largest_e


def adiabat(end, pieces=20000):
    """Energy on the exact adiabat de = -p dJ at the log volume `end`, by Runge-Kutta."""
    def slope(x, e):
        J = math.exp(x)
        return -pressure(1.0 / J - 1.0, e) * J

    e, h = 0.0, end / pieces
    for i in range(pieces):
        x = i * h
        k1 = slope(x, e)
        k2 = slope(x + h / 2, e + h / 2 * k1)
        k3 = slope(x + h / 2, e + h / 2 * k2)
        e += h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(x + h, e + h * k3))
    return e


def trapezoid(strains):
    """The same steps in 60 digits: e1 + (p0 + p1)/2 dJ = e0 is a quadratic in e1."""
    e, p, J = Decimal(0), Decimal(0), Decimal(1)
    k, g, q = Decimal(K), Decimal(GAMMA), Decimal(CURVE)
    for strain in strains:
        J1 = Decimal(strain).exp()
        half = (J1 - J) / 2
        a, b = half * q, 1 + half * g
        c = half * (p + k * (1 / J1 - 1)) - e
        e = -2 * c / (b + (b * b - 4 * a * c).sqrt())
        p, J = k * (1 / J1 - 1) + g * e + q * e * e, J1
    return float(e), float(p)


def not_linear_in_energy(folder):
    extra = ["--plugin-path", folder]
    squeeze = {"xx": {"log_strain": rows([(0, 0), (1, -0.25), (2, -0.05)], "")}}
    fluid = drive(material(EOS, None, 0.0), squeeze, 2.0, 200, history=NAMES, extra=extra)
    solid = drive(material(EOS, von_mises(1e9), G), squeeze, 2.0, 200, history=NAMES, extra=extra)
    mixed = {"xx": {"log_strain": -0.2}, "yy": {"stress": "-3 GPa"},
             "zz": {"strain_rate": "0.05 1/s"}}
    led = drive(material(EOS, von_mises(1e9), G), mixed, 1.0, 200, history=NAMES, extra=extra)
    for name, run in (("fluid", fluid), ("solid that flows", solid), ("partly stress-led", led)):
        p, e = consistency(run)
        share = CURVE * max(map(abs, run["energy"])) / GAMMA
        scenes.below(f"{name}, quadratic part {100 * share:.0f} % of dp/de: pressure against "
                     "p(compression, energy), over the largest", p, CONSISTENT)
        scenes.below(f"{name}: energy against the balance of each step, over the largest", e,
                     CONSISTENT)
    e, p = trapezoid(fluid["log_strain_xx"][1:])
    scenes.below("fluid after 200 steps: energy against the same steps in 60 digits, relative",
                 apart(fluid["energy"][-1], e), CONSISTENT)
    scenes.below("fluid after 200 steps: pressure against the same steps in 60 digits, relative",
                 apart(fluid["pressure"][-1], p), CONSISTENT)
    exact = adiabat(-0.25)
    values = [drive(material(EOS, None, 0.0), {"xx": {"log_strain": -0.25}}, 1.0, steps,
                    final=["energy"], extra=extra)["energy"] for steps in (20, 40, 80, 160)]
    scenes.below("adiabat of the fluid, 160 steps: order of convergence apart from 2",
                 abs(order(*values[-2:], exact) - 2.0), 0.02)
    scenes.below("the same, extrapolated, relative", apart(eliminate(values, [2, 4, 6]), exact),
                 1e-9)


# ---- cycles -------------------------------------------------------------------------------------

def left_over(run):
    """Energy and stress at the end over their largest on the way."""
    largest = max(max(map(abs, run[f"stress_{c}"])) for c in (*COMPONENTS, "xy"))
    return (abs(run["energy"][-1]) / max(map(abs, run["energy"])),
            max(abs(run[f"stress_{c}"][-1]) for c in (*COMPONENTS, "xy")) / largest,
            abs(run["work"][-1]) / max(map(abs, run["work"])))


def cycles():
    mie_gruneisen = {"model": "mie_gruneisen", "C0": "4569 m/s", "S1": 1.49, "gamma0": 2.17,
                     "a": 0.46}
    names = ["energy", "work", *(f"stress_{c}" for c in (*COMPONENTS, "xy"))]
    out_and_back = [(0, 0), (1, -0.2), (2, 0)]
    cases = (
        ("fluid squeezed by 0.2 and let go", material(mie_gruneisen, None, 0.0),
         {"xx": {"log_strain": rows(out_and_back, "")}}, 2.0, 100),
        ("elastic solid squeezed by 0.2 and let go", material(mie_gruneisen, None, G),
         {"xx": {"log_strain": rows(out_and_back, "")}}, 2.0, 100),
        ("elastic solid sheared to 0.5 and back", material(mie_gruneisen, None, G),
         {"xy": {"velocity_gradient": rows([(1, 0.5), (1, -0.5)], "1/s")}}, 2.0, 100))
    for name, card, control, end, steps in cases:
        energy, stress, _ = left_over(drive(card, control, end, steps, history=names,
                                            adiabatic=False))
        scenes.below(f"{name}: energy left, over the largest", energy, 1e-10)
        scenes.below(f"{name}: stress left, over the largest", stress, 1e-10)
    triangle(material(mie_gruneisen, None, G), names)
    rectangle(material(linear_eos(K), None, G), names)


def triangle(card, names):
    """At constant volume; its legs have steps of different strain, each off by its cube / 12."""
    legs = {"xx": [(0, 0), (1, 0.02), (2, 0.0), (3, 0.0)],
            "yy": [(0, 0), (1, -0.01), (2, 0.02), (3, 0.0)],
            "zz": [(0, 0), (1, -0.01), (2, -0.02), (3, 0.0)]}
    control = {c: {"log_strain": rows(path, "")} for c, path in legs.items()}
    left = [left_over(drive(card, control, 3.0, steps, history=names)) for steps in (90, 180, 360)]
    name = "elastic solid on a triangle of constant volume"
    scenes.below(f"{name}: energy left, over the largest", left[0][0], 1e-10)
    scenes.below(f"{name}, {left[-1][1]:.1e} of the stress left: order of convergence apart from 2",
                 abs(order(left[-2][1], left[-1][1], 0.0) - 2.0), 0.02)
    scenes.below(f"{name}: stress left, extrapolated, over the largest",
                 abs(eliminate([x[1] for x in left], [2, 4])), 1e-10)


def rectangle(card, names):
    loop = {"xx": {"log_strain": rows([(0, 0), (1, -0.02), (2, -0.02), (3, 0), (4, 0)], "")},
            "yy": {"log_strain": rows([(0, 0), (1, 0), (2, -0.005), (3, -0.005), (4, 0)], "")}}
    shares = [left_over(drive(card, loop, 4.0, steps, history=names))[0] for steps in (40, 80, 160)]
    scenes.note("elastic solid on a rectangle of strains 0.02 by 0.005: energy left over the "
                "largest with 40, 80, 160 steps: " + ", ".join(f"{x:.3e}" for x in shares)
                + " (a stress rate has no potential: it is the law's, not the step's)")


not_linear_in_energy(build())
cycles()
scenes.done()
